/*
 * The arc tangent's polynomial is the minimax one, its coefficients rounded to whole units of 1/800 degree: an error of
 * one unit in any of them shows in the mean over ratios near 1, far below the bounds of test_tilt_reference.c. And the
 * ends of the fixed-point steps about it.
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_coefficients_are_those_of_the_best_polynomial);
    RUN_TEST(test_the_coefficients_are_rounded_to_whole_units);
    return UNITY_END();
}
