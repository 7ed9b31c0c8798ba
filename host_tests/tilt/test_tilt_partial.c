/*
 * Angles from two axes and |a| = 1 g, against asin and acos in double over whole circles, and what noise makes of them.
 */
#include "support/random.h"
#include "support/test.h"
#include "tilt.h"
#include "tilt_partial.h"

#include <math.h>

#define SEED 80014u
#define G_Q8 65536.0
#define DEG_PER_RAD 57.295779513082320877
#define ANGLES_BOUND_DEG 0.0289 /* test_tilt_reference.c */

typedef struct {
    double x, y, z;
} vector_t;

static vector_t at_angles(double roll_deg, double pitch_deg)
{
    double r = roll_deg / DEG_PER_RAD;
    double p = pitch_deg / DEG_PER_RAD;
    return (vector_t){ -sin(p), sin(r) * cos(p), cos(r) * cos(p) };
}

/* The vector with the component `missing` taken from the two others, its sign from a vector that was good. */
static tilt_t tilt_without(uint8_t missing, vector_t a, vector_t good)
{
    int32_t q8[3] = { (int32_t)lrint(a.x * G_Q8), (int32_t)lrint(a.y * G_Q8), (int32_t)lrint(a.z * G_Q8) };
    const double signs[3] = { good.x, good.y, good.z };
    q8[missing] = 0;
    int32_t size_q8 = (int32_t)tilt_missing_q6(q8[0], q8[1], q8[2]) * 4;
    q8[missing] = (signs[missing] < 0.0) ? -size_q8 : size_q8;
    tilt_t out = { 0, 0, false };
    tilt_angles(&out, q8);
    return out;
}

static double apart_deg(double a_deg, double b_deg)
{
    return fabs(remainder(a_deg - b_deg, 360.0));
}

/* Two legs cut by 2^-14 g each: the missing one is off by that times their size over its own, and cut itself. */
static double bound_deg(double missing_g)
{
    return (sqrt(2.0) / missing_g + 1.0) / 16384.0 * DEG_PER_RAD + ANGLES_BOUND_DEG;
}

/* Roll without z is asin(y), without y acos(z), with the sign known; while the component is above a tenth of 1 g. */
TEST(test_roll_over_the_whole_circle)
{
    for (int tenth = -1800; tenth < 1800; tenth++) {
        double roll_deg = tenth / 10.0;
        vector_t a = at_angles(roll_deg, 0.0);
        double asin_deg = asin(a.y) * DEG_PER_RAD;
        double acos_deg = acos(a.z) * DEG_PER_RAD;
        double without_z_deg = (a.z < 0.0) ? 180.0 - asin_deg : asin_deg;
        double without_y_deg = (a.y < 0.0) ? -acos_deg : acos_deg;
        if (fabs(a.z) > 0.1) {
            TEST_ASSERT_TRUE(apart_deg(tilt_without(2, a, a).roll_cdeg / 100.0, without_z_deg) < bound_deg(fabs(a.z)));
        }
        if (fabs(a.y) > 0.1) {
            TEST_ASSERT_TRUE(apart_deg(tilt_without(1, a, a).roll_cdeg / 100.0, without_y_deg) < bound_deg(fabs(a.y)));
        }
    }
}

/* Both angles on the sphere, each axis left out. */
TEST(test_both_angles_on_the_sphere)
{
    for (int roll = -178; roll <= 180; roll += 2) {
        for (int pitch = -88; pitch <= 88; pitch += 2) {
            vector_t a = at_angles(roll, pitch);
            const double components[3] = { fabs(a.x), fabs(a.y), fabs(a.z) };
            for (uint8_t missing = 0; missing < 3; missing++) {
                if (components[missing] < 0.1) {
                    continue;
                }
                tilt_t t = tilt_without(missing, a, a);
                double bound = bound_deg(components[missing]);
                TEST_ASSERT_TRUE(apart_deg(t.pitch_cdeg / 100.0, pitch) < bound);
                TEST_ASSERT_TRUE(apart_deg(t.roll_cdeg / 100.0, roll) < bound / cos(pitch / DEG_PER_RAD));
            }
        }
    }
}

/* The sign is the last good one's: with the other one the angle is mirrored. */
TEST(test_the_sign_is_that_of_the_last_good_sample)
{
    vector_t a = at_angles(30.0, 0.0);
    vector_t mirrored = at_angles(150.0, 0.0);
    TEST_ASSERT_INT_WITHIN(4, 3000, tilt_without(2, a, a).roll_cdeg);
    TEST_ASSERT_INT_WITHIN(4, 15000, tilt_without(2, a, mirrored).roll_cdeg);
    TEST_ASSERT_INT_WITHIN(4, -3000, tilt_without(1, a, at_angles(-30.0, 0.0)).roll_cdeg);
}

/* Noise of 4 mg on both axes: sigma of asin, acos and of both axes' arc tangent at four angles (rms, degree). */
TEST(test_sigmas_of_the_table)
{
    static const struct {
        double angle_deg, asin_deg, acos_deg, atan_deg;
    } table[] = { { 10.0, 0.231, 1.368, 0.228 },
                  { 45.0, 0.322, 0.322, 0.227 },
                  { 80.0, 1.365, 0.231, 0.228 },
                  { 85.0, 2.720, 0.229, 0.228 } };
    test_random_t random;
    random_seed(&random, SEED);
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        vector_t truth = at_angles(table[i].angle_deg, 0.0);
        double squares[3] = { 0.0 };
        enum { DRAWS = 40000 };
        for (int n = 0; n < DRAWS; n++) {
            vector_t a = { 0.0, truth.y + 0.004 * random_normal(&random), truth.z + 0.004 * random_normal(&random) };
            tilt_t both = { 0, 0, false };
            tilt_angles(&both, (const int32_t[]){ 0, (int32_t)lrint(a.y * G_Q8), (int32_t)lrint(a.z * G_Q8) });
            const double rolls[3] = { tilt_without(2, a, truth).roll_cdeg / 100.0,
                                      tilt_without(1, a, truth).roll_cdeg / 100.0, both.roll_cdeg / 100.0 };
            for (int k = 0; k < 3; k++) {
                squares[k] += (rolls[k] - table[i].angle_deg) * (rolls[k] - table[i].angle_deg);
            }
        }
        const double expected[3] = { table[i].asin_deg, table[i].acos_deg, table[i].atan_deg };
        for (int k = 0; k < 3; k++) { /* 40,000 draws: 0.35 % each for both tables' chance; 1 % more for the digits */
            TEST_ASSERT_DOUBLE_WITHIN(0.02 * expected[k], expected[k], sqrt(squares[k] / DRAWS));
        }
    }
}

/* 4 mg over the component: 1 / cos and 1 / sin to first order; nothing is known where nothing is left. */
TEST(test_the_sigma_reported)
{
    uint16_t sigma_q8 = (uint16_t)lrint(0.004 * G_Q8);
    for (int deg = 0; deg < 90; deg++) {
        double component = cos(deg / DEG_PER_RAD);
        double expected_cdeg = fmin(9000.0, 0.004 / component * DEG_PER_RAD * 100.0);
        uint16_t missing_q6 = (uint16_t)lrint(component * 16384.0);
        TEST_ASSERT_DOUBLE_WITHIN(1.0 + 0.003 * expected_cdeg, expected_cdeg,
                                  tilt_partial_sigma_cdeg(sigma_q8, missing_q6));
    }
    for (uint16_t missing_q6 = 1000; missing_q6 <= 65535 / 6; missing_q6++) {
        uint16_t large_q8 = (uint16_t)(missing_q6 * 6); /* 8,594 cdeg; the factor 1432.394 is a whole number: 2.8e-4 */
        double exact_cdeg = 100.0 * DEG_PER_RAD / 4.0 * large_q8 / missing_q6;
        TEST_ASSERT_DOUBLE_WITHIN(1.0 + 2.8e-4 * exact_cdeg, exact_cdeg, tilt_partial_sigma_cdeg(large_q8, missing_q6));
    }
    TEST_ASSERT_EQUAL_UINT16(9000, tilt_partial_sigma_cdeg(1, 0));
    TEST_ASSERT_EQUAL_UINT16(9000, tilt_partial_sigma_cdeg(65535, 1));
    TEST_ASSERT_EQUAL_UINT16(0, tilt_partial_sigma_cdeg(0, 16384));
}

/*
 * The bound of tilt_missing_q6, where all three parts are cut by most of a unit: the square of the result is too large
 * by less than 2 (x + y + z) + 3 <= 2 sqrt(3) 16384 + 3, and its root is cut.
 */
TEST(test_the_missing_component_is_within_its_bound)
{
    test_random_t random;
    random_seed(&random, SEED);
    for (int n = 0; n < 200000; n++) {
        double missing = pow(10.0, -3.0 + 3.0 * n / 200000.0);
        double a[3];
        double square = 0.0;
        for (int axis = 0; axis < 3; axis++) {
            a[axis] = 1.0 + 0.2 * random_normal(&random);
            square += a[axis] * a[axis];
        }
        int32_t q8[3];
        double known_q16 = 0.0;
        for (int axis = 0; axis < 3; axis++) {
            q8[axis] = (int32_t)(a[axis] * sqrt((1.0 - missing * missing) / square) * G_Q8) | 3;
            known_q16 += (double)q8[axis] * q8[axis];
        }
        double exact_q6 = sqrt(fmax(0.0, G_Q8 * G_Q8 - known_q16)) / 4.0;
        uint16_t result = tilt_missing_q6(q8[0], q8[1], q8[2]);
        TEST_ASSERT_TRUE(exact_q6 - 1.0 < result);
        TEST_ASSERT_TRUE(result == 0U || fabs(result - exact_q6) <= 56760.0 / result + 1.0);
    }
}

/* Beyond 1 g nothing is missing; no size of an input overflows. */
TEST(test_more_than_gravity_leaves_nothing)
{
    TEST_ASSERT_EQUAL_UINT16(16384, tilt_missing_q6(0, 0, 0));
    TEST_ASSERT_EQUAL_UINT16(0, tilt_missing_q6(65536, 0, 0));
    TEST_ASSERT_EQUAL_UINT16(0, tilt_missing_q6(INT32_MAX, INT32_MIN, INT32_MAX));
    TEST_ASSERT_EQUAL_UINT16(0, tilt_missing_q6(50000, -50000, 0));
    TEST_ASSERT_UINT_WITHIN(2, 11585, tilt_missing_q6(46341, 0, 0)); /* 16384 / sqrt(2) */
}
