/*
 * The arc tangent's polynomial is the minimax one, its coefficients rounded to whole units of 1/800 degree: an error of
 * one unit in any of them shows in the mean over ratios near 1, far below the bounds of test_tilt_reference.c. And pitch
 * where its legs are scaled most: near the poles, and for numbers of any size.
 */
#include <math.h>

#include "tilt.h"
#include "unity.h"

#define UNITS_PER_RAD (800.0 * 57.295779513082320877)

enum { TERMS = 4 };

/*
 * c of r (c0 - c1 r^2 + c2 r^4 - c3 r^6) for the arc tangent on 0..1 in 1/800 degree, by Remez' exchange in double. That
 * it is the best is seen from its error alone: it has its largest size five times with alternating signs (Chebyshev).
 */
static const double minimax[TERMS] = { 45800.58743338, 14721.57618335, 6704.26916951, 1787.01017797 };

void setUp(void) {}

void tearDown(void) {}

static double polynomial(const double c[TERMS], double r)
{
    double r2 = r * r;
    return r * (c[0] - r2 * (c[1] - r2 * (c[2] - r2 * c[3])));
}

static void test_the_coefficients_are_those_of_the_best_polynomial(void)
{
    enum { STEPS = 100000 };
    double extremes[TERMS + 2] = { 0.0 };
    size_t count = 0;
    for (int i = 1; i <= STEPS; i++) {
        double r = (double)i / STEPS;
        double error = polynomial(minimax, r) - atan(r) * UNITS_PER_RAD;
        if (count == 0 || (error > 0.0) != (extremes[count - 1] > 0.0)) {
            TEST_ASSERT_TRUE(count < TERMS + 1);
            extremes[count++] = error;
        } else if (fabs(error) > fabs(extremes[count - 1])) {
            extremes[count - 1] = error;
        }
    }
    TEST_ASSERT_EQUAL_size_t(TERMS + 1, count);
    for (size_t i = 0; i < count; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.001, 3.7298, fabs(extremes[i])); /* 0.00466 degree: the 0.0047 of tilt.c */
    }
}

/*
 * Cuts of the four products cancel near r = 1 but for what rounding the last three bits adds, (x + 4) >> 3: half a unit
 * more on average. A ratio is cut by 2^-17 on average, which takes 0.17 units, its square gives back 0.05. So the mean
 * is 0.38 units above the polynomial of whole coefficients; 20,000 ratios scatter by 2.3 / sqrt(20,000) = 0.02.
 */
static void test_the_coefficients_are_rounded_to_whole_units(void)
{
    double whole[TERMS];
    for (int i = 0; i < TERMS; i++) {
        whole[i] = round(minimax[i]);
    }
    enum { FROM = 980000, RATIOS = 20000 };
    double sum = 0.0;
    for (int32_t n = FROM; n < FROM + RATIOS; n++) {
        double r = n / 1000003.0;
        sum += 8.0 * tilt_atan2_cdeg(n * 1000, 1000003000) - polynomial(whole, r);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.25, 0.38, sum / RATIOS);
}

static void check_point(int32_t x, int32_t y, int32_t z)
{
    const double pitch_bound_deg = 0.0289; /* test_tilt_reference.c */
    tilt_t tilt = { .roll_cdeg = 12345 };
    tilt_angles(&tilt, x, y, z);
    double yz = hypot(y, z);
    TEST_ASSERT_DOUBLE_WITHIN(pitch_bound_deg, atan2(-(double)x, yz) * 57.295779513082320877, tilt.pitch_cdeg / 100.0);
    TEST_ASSERT_EQUAL(tilt.roll_undefined, tilt.roll_cdeg == 12345);
    if (fabs(yz - TILT_ROLL_MIN_Q8) > 1.0) { /* a unit of Q8 is cut */
        TEST_ASSERT_EQUAL(yz < TILT_ROLL_MIN_Q8, tilt.roll_undefined);
    }
}

/* x is 0.25 g or more and nearly all of it: y and z are scaled up to 15 bits, and their length back. */
static void test_pitch_near_the_poles(void)
{
    static const int32_t far_q8[] = { 16384, -16384, 65536, -1179648 };
    for (size_t i = 0; i < 4; i++) {
        for (int32_t y = 0; y < 1600; y += 1 + y / 7) {
            for (int32_t z = 0; z < 1600; z += 1 + z / 7) {
                check_point(far_q8[i], y, -z);
                check_point(far_q8[i], -y, z);
            }
        }
    }
}

/* The same direction at any size: both legs, and x with them, are shifted down by what does not fit. */
static void test_pitch_of_any_size(void)
{
    for (int bits = 14; bits <= 30; bits++) {
        for (int32_t part = 8; part <= 16; part++) {
            int32_t one = (int32_t)((INT64_C(1) << bits) * part / 16);
            check_point(one, one, one / 3);
            check_point(-one, one / 5, -one);
            check_point(one / 2, one / 9, one / 7);
            check_point(one, one / 50, one / 1000);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_coefficients_are_those_of_the_best_polynomial);
    RUN_TEST(test_the_coefficients_are_rounded_to_whole_units);
    RUN_TEST(test_pitch_near_the_poles);
    RUN_TEST(test_pitch_of_any_size);
    return UNITY_END();
}
