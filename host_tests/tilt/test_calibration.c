/*
 * Calibration in integers, on the PC and on the chip: what is exact, what is refused, the ends of the ranges. Errors
 * against double: test_calibration_reference.c; whole parts: test_calibration_parts.c.
 */
#include "calibration.h"
#include "support/filters.h"
#include "support/test.h"
#include <stdlib.h>

static calibration_t c;
static calibration_applied_t applied;

void setUp(void)
{
    calibration_plain(&c, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6);
}

static void prepare(void)
{
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
}

TEST(test_256_lsb_per_g_changes_no_bit)
{
    prepare();
    uint32_t random = 91;
    for (uint32_t i = 0; i < ON_PC_OR_CHIP(2000000U, 2000U); i++) {
        int32_t a[3];
        int32_t out[3];
        for (uint8_t axis = 0; axis < 3; axis++) {
            a[axis] = (int32_t)random32_below(&random, 2359297U) - 1179648; /* +-4608 LSB */
        }
        calibration_apply(&applied, a, out);
        TEST_ASSERT_EQUAL_INT32_ARRAY(a, out, 3);
    }
    const int32_t ends[3] = { 1179648, -1179648, 0 };
    int32_t out[3];
    calibration_apply(&applied, ends, out);
    TEST_ASSERT_EQUAL_INT32_ARRAY(ends, out, 3);
}

/* 24 turns of the board and their 24 mirror images: exact, and each axis is where its name says. */
TEST(test_every_naming_of_the_axes)
{
    for (uint8_t code = 0; code < 27; code++) {
        const uint8_t digits[3] = { code % 3U, code / 3U % 3U, code / 9U };
        bool each_once = digits[0] != digits[1] && digits[0] != digits[2] && digits[1] != digits[2];
        for (uint8_t signs = 0; signs < 8; signs++) {
            const int32_t a[3] = { 12345, -67890, 7 };
            int32_t expected[3];
            int32_t out[3];
            for (uint8_t i = 0; i < 3; i++) {
                bool negative = (signs & (1U << i)) != 0U;
                c.axes[i] = (int8_t)(negative ? -(digits[i] + 1) : digits[i] + 1);
                expected[i] = negative ? -a[digits[i]] : a[digits[i]];
            }
            TEST_ASSERT_EQUAL_UINT8(each_once ? CALIBRATION_GOOD : CALIBRATION_AXES,
                                    calibration_prepare(&applied, &c).why);
            if (each_once) {
                calibration_apply(&applied, a, out);
                TEST_ASSERT_EQUAL_INT32_ARRAY(expected, out, 3);
            }
        }
    }
}

/* (64 - 10) LSB x 256/200 = 69.12 LSB, -(-16 - 10) ... : Q8 17694.72, with half a unit and the cut of 6/64. */
TEST(test_offset_and_scale_belong_to_the_sensors_axis)
{
    c.offset_lsb_q4[0] = 160;
    c.scale_lsb_per_g_uq6[0] = CALIBRATION_SCALE_UQ6(200U);
    c.axes[0] = 2;
    c.axes[1] = -1;
    prepare();
    const int32_t a[3] = { 64L * 256, 100L * 256, 256L * 256 };
    int32_t out[3];
    calibration_apply(&applied, a, out);
    TEST_ASSERT_EQUAL_INT32(25600, out[0]);
    TEST_ASSERT_INT32_WITHIN(1, -17695, out[1]);
    TEST_ASSERT_EQUAL_INT32(65536, out[2]);
}

/* Level upside down is diag(1, -1, -1) exactly; on its side, y up: our z is the sensor's y, our y its -z. */
TEST(test_mountings_that_are_exact)
{
    static const int16_t levels[5][3] = {
        { 0, 0, 16384 }, { 0, 0, -16384 }, { 0, 16384, 0 }, { 0, -16384, 0 }, { 16384, 0, 0 }
    };
    static const int8_t signs_and_axes[5][3] = { { 1, 2, 3 }, { 1, -2, -3 }, { 1, -3, 2 }, { 1, 3, -2 }, { -3, 2, 1 } };
    const int32_t a[3] = { 1111, -22222, 333333 };
    for (uint8_t i = 0; i < 5; i++) {
        int32_t out[3];
        for (uint8_t j = 0; j < 3; j++) {
            c.level_q14[j] = levels[i][j];
        }
        prepare();
        calibration_apply(&applied, a, out);
        for (uint8_t j = 0; j < 3; j++) {
            int8_t from = signs_and_axes[i][j];
            int32_t size = a[abs(from) - 1];
            TEST_ASSERT_EQUAL_INT32(from < 0 ? -size : size, out[j]);
        }
    }
}

TEST(test_any_reading_is_safe)
{
    static const int32_t ends[] = { INT32_MIN, -8388608, -1179648, 0, 1179648, 8388607, INT32_MAX };
    c.level_q14[0] = 9459; /* 1 / sqrt(3) */
    c.level_q14[1] = 9459;
    c.level_q14[2] = 9459;
    for (uint8_t i = 0; i < 3; i++) {
        c.scale_lsb_per_g_uq6[i] = CALIBRATION_SCALE_MIN_UQ6;
        c.offset_lsb_q4[i] = -CALIBRATION_OFFSET_MAX_LSB_Q4;
    }
    prepare();
    for (uint16_t code = 0; code < 343; code++) {
        const int32_t a[3] = { ends[code % 7], ends[code / 7 % 7], ends[code / 49] };
        int32_t out[3];
        calibration_apply(&applied, a, out);
    }
    /* the most that can come out: all axes at the end along the level: sqrt(3) x 1.28 x (4608 + 80) = 10393.6 LSB */
    const int32_t most[3] = { 1179648, 1179648, 1179648 };
    int32_t out[3];
    calibration_apply(&applied, most, out);
    TEST_ASSERT_INT32_WITHIN(1100, 2660752, out[2]); /* elements to 2^-15 of 0.74: 4.1e-5, and the length to 7e-5 */
}

TEST(test_what_is_not_legal_is_refused_and_nothing_written)
{
    prepare();
    const calibration_applied_t before = applied;
    for (uint8_t i = 0; i < 3; i++) {
        for (int8_t sign = -1; sign <= 1; sign = (int8_t)(sign + 2)) {
            setUp();
            c.offset_lsb_q4[i] = (int16_t)(sign * CALIBRATION_OFFSET_MAX_LSB_Q4);
            c.scale_lsb_per_g_uq6[i] = sign < 0 ? CALIBRATION_SCALE_MIN_UQ6 : CALIBRATION_SCALE_MAX_UQ6;
            TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_check(&c).why);
            c.offset_lsb_q4[i] = (int16_t)(sign * (CALIBRATION_OFFSET_MAX_LSB_Q4 + 1));
            calibration_verdict_t verdict = calibration_prepare(&applied, &c);
            TEST_ASSERT_TRUE(verdict.why == (uint8_t)CALIBRATION_OFFSET && verdict.where == i);
            setUp();
            c.scale_lsb_per_g_uq6[i] = (uint16_t)(sign < 0 ? CALIBRATION_SCALE_MIN_UQ6 - 1U
                                                           : CALIBRATION_SCALE_MAX_UQ6 + 1U);
            verdict = calibration_prepare(&applied, &c);
            TEST_ASSERT_TRUE(verdict.why == (uint8_t)CALIBRATION_SCALE && verdict.where == i);
        }
        static const int8_t no_axes[] = { 0, 4, -4, 127, -128, 9, -7 };
        for (uint8_t j = 0; j < sizeof no_axes; j++) {
            setUp();
            c.axes[i] = no_axes[j];
            TEST_ASSERT_EQUAL_UINT8(CALIBRATION_AXES, calibration_prepare(&applied, &c).why);
        }
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &applied, sizeof before);
}

/* Sums beyond 16 bits, which is what an int has on the chip. */
TEST(test_numbers_at_the_ends_of_16_bits_are_refused)
{
    static const int16_t ends[] = { INT16_MIN, -31489, 31488, INT16_MAX };
    for (uint8_t i = 0; i < 4; i++) {
        setUp();
        c.offset_lsb_q4[1] = ends[i];
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_OFFSET, calibration_check(&c).why);
    }
    /* the most that a rest can show, the farthest legal offset: 2,107 LSB apart */
    setUp();
    c.offset_lsb_q4[2] = -CALIBRATION_OFFSET_MAX_LSB_Q4;
    const int16_t far[3] = { 0, 0, 32440 };
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_NO_GRAVITY, calibration_tare(&c, far).why);
    /* 58,000 apart is 7,536 of 16 bits, as 235 LSB per g are */
    const int16_t means[18] = { -30000, 0, 0, 28000, 0, 0, 0, 4096, 0, 0, -4096, 0, 0, 0, 4096, 0, 0, -4096 };
    uint16_t residual_mg;
    TEST_ASSERT_NOT_EQUAL(CALIBRATION_GOOD, calibration_six(&c, means, &residual_mg).why);
}

/* 0.85 g = 13926.4, 1.15 g = 18841.6 of Q14. */
TEST(test_level_is_gravity)
{
    static const int16_t lengths[] = { 13926, 13927, 18841, 18842, 0, -13926, -13927, -18841, -18842, INT16_MIN };
    static const bool good[] = { false, true, true, false, false, false, true, true, false, false };
    for (uint8_t axis = 0; axis < 3; axis++) {
        for (uint8_t i = 0; i < sizeof good; i++) {
            setUp();
            c.level_q14[2] = 0;
            c.level_q14[axis] = lengths[i];
            TEST_ASSERT_EQUAL_UINT8(good[i] ? CALIBRATION_GOOD : CALIBRATION_NO_GRAVITY, calibration_check(&c).why);
        }
    }
}

/* The middle of a scale of 256 LSB/g and an offset of (16, -8, 4) LSB, y down. */
TEST(test_single_takes_the_offsets_from_the_nearest_position)
{
    for (uint8_t position = 0; position < 6; position++) {
        int16_t mean[3] = { 256, -128, 64 };
        int16_t one_g = position % 2U == 0 ? 4096 : -4096;
        mean[position / 2U] = (int16_t)(mean[position / 2U] + one_g);
        setUp();
        TEST_ASSERT_EQUAL_UINT8(position, calibration_position(mean));
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_single(&c, mean).why);
        const int16_t expected[3] = { 256, -128, 64 };
        TEST_ASSERT_EQUAL_INT16_ARRAY(expected, c.offset_lsb_q4, 3);
    }
}

/* The least mean that has a direction. */
TEST(test_the_nearest_position_has_the_sign_of_any_mean)
{
    for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
        int16_t mean[3] = { 0, 0, 0 };
        mean[position / 2U] = position % 2U == 0 ? 1 : -1;
        TEST_ASSERT_EQUAL_UINT8(position, calibration_position(mean));
    }
}

TEST(test_single_refuses_what_is_no_offset_and_keeps_the_old)
{
    static const int16_t means[6][3] = { { 0, 0, 4096 + 1281 }, { 0, 0, -4096 - 1281 }, { 1281, 0, 4096 },
                                         { 0, -1281, -4096 },   { 0, 0, 32767 },        { -32768, 32767, 0 } };
    static const uint8_t axes[6] = { 2, 2, 0, 1, 2, 0 };
    for (uint8_t i = 0; i < 6; i++) {
        setUp();
        const calibration_t before = c;
        calibration_verdict_t verdict = calibration_single(&c, means[i]);
        TEST_ASSERT_TRUE(verdict.why == (uint8_t)CALIBRATION_OFFSET && verdict.where == axes[i]);
        TEST_ASSERT_EQUAL_MEMORY(&before, &c, sizeof before);
    }
}

/* The reading of 265 LSB/g and an offset of 10 LSB on x, axes turned: level is what was read, in the new axes. */
TEST(test_tare_takes_the_calibrated_vector_in_the_axes_in_force)
{
    calibration_plain(&c, CALIBRATION_SCALE_3V3_XY_UQ6, CALIBRATION_SCALE_3V3_Z_UQ6);
    c.offset_lsb_q4[0] = 160;
    c.axes[0] = -3;
    c.axes[1] = 2;
    c.axes[2] = 1;
    const int16_t mean[3] = { 160 + 16 * 212, 0, 16 * -154 }; /* 0.8 g on x, -0.6016 g on z */
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_tare(&c, mean).why);
    TEST_ASSERT_EQUAL_INT16(9856, c.level_q14[0]);
    TEST_ASSERT_EQUAL_INT16(0, c.level_q14[1]);
    TEST_ASSERT_EQUAL_INT16(13107, c.level_q14[2]); /* 13107.2 */
}

TEST(test_tare_refuses_what_is_no_gravity_and_keeps_the_old)
{
    static const int16_t means[6][3] = { { 0, 0, 0 },          { 0, 0, 3481 },          { 0, 0, 4711 },
                                         { 3000, 3000, 3000 }, { 32767, 32767, 32767 }, { 0, -32768, 0 } };
    for (uint8_t i = 0; i < 6; i++) {
        const calibration_t before = c;
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_NO_GRAVITY, calibration_tare(&c, means[i]).why);
        TEST_ASSERT_EQUAL_MEMORY(&before, &c, sizeof before);
    }
}
