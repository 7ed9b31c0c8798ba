/*
 * What the calibration is made of: the one division against exact integers, how a mounting's elements are rounded, a
 * reading in g at its limits.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "calibration.h"
#include "calibration_inside.h"
#include "support/random.h"
#include "support/test.h"

static calibration_t c;

void setUp(void)
{
    calibration_plain(&c, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6);
}

/* |a| 2^16 / b + 1/2, cut, with the sign of a. */
static int64_t rounded_quotient(int64_t a, int64_t b)
{
    int64_t size = (2 * llabs(a) * 65536 + b) / (2 * b);
    return a < 0 ? -size : size;
}

static void check_quotient(int32_t a, uint16_t b)
{
    TEST_ASSERT_EQUAL_INT64(rounded_quotient(a, b), calibration_over(a, b));
}

/* Half away from zero, for any numbers that fit, and at their ends. */
TEST(test_the_division_is_rounded_half_away_from_zero)
{
    test_random_t random;
    random_seed(&random, 86);
    for (int run = 0; run < 300000; run++) {
        int32_t a = (int32_t)random_below(&random, 131071) - 65535;
        uint16_t b = (uint16_t)(2U + random_below(&random, 65534) / (1U << random_below(&random, 15)));
        check_quotient(a, b);
    }
    static const int32_t ends[] = { 0, 1, 2, 3, 32767, 32768, 65534, 65535 };
    static const uint16_t divisors[] = { 2, 3, 4, 12800, 16384, 21120, 32767, 32768, 65534, 65535 };
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        for (size_t j = 0; j < sizeof divisors / sizeof divisors[0]; j++) {
            check_quotient(ends[i], divisors[j]);
            check_quotient(-ends[i], divisors[j]);
        }
    }
    check_quotient(1, 43691); /* 1.49999 */
    check_quotient(1, 43690); /* 1.50002 */
}

/*
 * An element of the mounting is a product, rounded half up: over directions that come with all signs of x and y, those
 * beside the diagonal of rows 1 and 2 have the mean 0, as the exact ones. A product that is cut is half a unit of Q14
 * too small on average; 20,000 that are rounded scatter by 1 / sqrt(12 x 20,000) = 0.002 units, and by as much again
 * with the errors of their factors: five times that is the limit.
 */
TEST(test_products_of_the_mounting_are_rounded_not_cut)
{
    test_random_t random;
    random_seed(&random, 87);
    double sum[2] = { 0.0, 0.0 };
    enum { DIRECTIONS = 5000, SIGNS = 4 };
    for (int run = 0; run < DIRECTIONS; run++) {
        double polar = acos(0.95 * random_uniform(&random)); /* the upper half, x and y not both 0 */
        double turn = 1.5707963267948966 * random_uniform(&random);
        int16_t x = (int16_t)lround(16384.0 * sin(polar) * cos(turn));
        int16_t y = (int16_t)lround(16384.0 * sin(polar) * sin(turn));
        for (int signs = 0; signs < SIGNS; signs++) {
            calibration_applied_t applied;
            c.level_q14[0] = (int16_t)((signs & 1) != 0 ? -x : x);
            c.level_q14[1] = (int16_t)((signs & 2) != 0 ? -y : y);
            c.level_q14[2] = (int16_t)lround(16384.0 * cos(polar));
            TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
            sum[0] += applied.matrix_q14[1];
            sum[1] += applied.matrix_q14[3];
        }
    }
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.0, sum[i] / (DIRECTIONS * SIGNS)); /* of 0.5 when cut */
    }
}

/*
 * Without a mounting an element is 256 / scale: rounded to 2^-16, then half up to 2^-14, 1/8 and 1/2 unit of Q14. The
 * bias of an offset of 16 LSB is that of the element, and half a unit of Q8.
 */
TEST(test_elements_are_rounded_to_five_eighths_of_a_unit)
{
    for (uint16_t scale_uq6 = CALIBRATION_SCALE_MIN_UQ6; scale_uq6 <= CALIBRATION_SCALE_MAX_UQ6; scale_uq6++) {
        calibration_applied_t applied;
        setUp();
        for (uint8_t axis = 0; axis < 3; axis++) {
            c.scale_lsb_per_g_uq6[axis] = scale_uq6;
            c.offset_lsb_q4[axis] = -256;
        }
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
        for (uint8_t axis = 0; axis < 3; axis++) {
            int16_t element_q14 = applied.matrix_q14[4U * axis];
            TEST_ASSERT_DOUBLE_WITHIN(0.625, 16384.0 * 16384.0 / scale_uq6, element_q14);
            TEST_ASSERT_EQUAL_INT32(16 * element_q14 + 32, applied.bias_lsb_q14[axis]);
        }
    }
}

/* Reading less offset over scale, in Q14, to 2 g either way; LSB in Q4. */
TEST(test_a_reading_in_g)
{
    test_random_t random;
    random_seed(&random, 88);
    for (int run = 0; run < 200000; run++) {
        uint8_t axis = (uint8_t)(run % 3);
        c.offset_lsb_q4[axis] = (int16_t)((int)random_below(&random, 2561) - 1280);
        c.scale_lsb_per_g_uq6[axis] = (uint16_t)(12800U + random_below(&random, 8321));
        int16_t lsb_q4 = (int16_t)((int)random_below(&random, 61441) - 30720); /* 1,920 LSB: what a rest may show */
        int64_t g_q14 = rounded_quotient(lsb_q4 - c.offset_lsb_q4[axis], c.scale_lsb_per_g_uq6[axis]);
        g_q14 = g_q14 > 32767 ? 32767 : (g_q14 < -32767 ? -32767 : g_q14);
        TEST_ASSERT_EQUAL_INT16(g_q14, calibration_gravity_q14(&c, axis, lsb_q4));
    }
}

/* Offsets of one rest, by scales that are not whole in Q4: 1 g is the scale rounded half up to 1/16 LSB. */
TEST(test_one_g_of_a_single_rest_is_rounded)
{
    for (uint16_t scale_uq6 = CALIBRATION_SCALE_MIN_UQ6; scale_uq6 <= CALIBRATION_SCALE_MAX_UQ6; scale_uq6++) {
        for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
            uint8_t axis = position / 2U;
            int one_g_q4 = (int)floor(scale_uq6 / 4.0 + 0.5);
            int16_t mean[3] = { 100, -7, 33 };
            int16_t expected[3] = { 100, -7, 33 };
            setUp();
            c.scale_lsb_per_g_uq6[axis] = scale_uq6;
            mean[axis] = (int16_t)(mean[axis] + (position % 2U == 0 ? one_g_q4 : -one_g_q4));
            TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_single(&c, mean).why);
            TEST_ASSERT_EQUAL_INT16_ARRAY(expected, c.offset_lsb_q4, 3);
        }
    }
}

static const int16_t exact_means[18] = { 4096, 0, 0, -4096, 0, 0, 0, 4096, 0, 0, -4096, 0, 0, 0, 4096, 0, 0, -4096 };

/* One position of an exact part turned towards the next axis: 30 degrees are too much, whatever the others say. */
TEST(test_a_position_of_six_may_be_up_to_30_degrees_off)
{
    for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
        for (int half_degrees = 56; half_degrees <= 64; half_degrees++) {
            double angle = half_degrees / 2.0 / 57.29577951308232;
            uint8_t axis = position / 2U;
            int16_t means[18];
            memcpy(means, exact_means, sizeof means);
            means[3 * position + axis] = (int16_t)lround(means[3 * position + axis] * cos(angle));
            means[3 * position + (axis + 1) % 3] = (int16_t)lround(4096.0 * sin(angle) + (half_degrees == 60 ? 2 : 0));
            setUp();
            uint16_t residual_mg = 0;
            calibration_verdict_t verdict = calibration_six(&c, means, &residual_mg);
            bool tilted = verdict.why == (uint8_t)CALIBRATION_TILTED && verdict.where == position;
            TEST_ASSERT_EQUAL(half_degrees >= 60, tilted);
        }
    }
}

/* One with 1 g for each component, then six with what the round before has found (docs/protocol.md). */
TEST(test_six_positions_take_six_rounds_after_the_first)
{
    enum { ROUNDS = 1 + 6 };
    calibration_six_t six;
    calibration_six_start(&six, &c);
    unsigned rounds = 1;
    while (calibration_six_step(&six, exact_means)) {
        rounds++;
        TEST_ASSERT_TRUE(rounds <= ROUNDS);
    }
    TEST_ASSERT_EQUAL_UINT(ROUNDS, rounds);
}

/* What the last round changed, in Q14, is the residual in mg, rounded; above 160 they do not fit (calibration.h). */
TEST(test_the_residual_is_what_the_last_round_changed)
{
    for (uint16_t off_q14 = 0; off_q14 < 400; off_q14++) {
        calibration_six_t six;
        uint16_t residual_mg = 999;
        calibration_six_start(&six, &c);
        six.verdict = calibration_verdict(CALIBRATION_GOOD, 0);
        six.where = 3;
        six.off_q14 = off_q14;
        calibration_verdict_t verdict = calibration_six_end(&six, &c, &residual_mg);
        TEST_ASSERT_EQUAL_UINT8(off_q14 <= 160 ? CALIBRATION_GOOD : CALIBRATION_RESIDUAL, verdict.why);
        TEST_ASSERT_EQUAL_UINT8(off_q14 <= 160 ? 0 : 3, verdict.where);
        TEST_ASSERT_EQUAL_UINT16((uint16_t)floor(off_q14 * 1000.0 / 16384.0 + 0.5), residual_mg);
    }
}
