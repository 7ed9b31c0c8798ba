/*
 * The arc tangent's polynomial is the minimax one, its coefficients rounded to whole units of 1/800 degree: an error
 * of one unit in any of them shows in the mean over ratios near 1, far below the bounds of test_tilt_reference.c. And
 * pitch where its legs are scaled most: near the poles, and for numbers of any size.
 */
#include <math.h>

#include "support/documented_limits.h"
#include "support/test.h"
#include "tilt.h"

#define UNITS_PER_RAD (800.0 * 57.295779513082320877)

enum { TERMS = 4 };

/*
 * c of r (c0 - c1 r^2 + c2 r^4 - c3 r^6) for the arc tangent on 0..1 in 1/800 degree, by Remez' exchange in double.
 * That it is the best is seen from its error alone: it has its largest size five times with alternating signs
 * (Chebyshev).
 */
static const double minimax[TERMS] = { 45800.58743338, 14721.57618335, 6704.26916951, 1787.01017797 };

static double polynomial(const double c[TERMS], double r)
{
    double r2 = r * r;
    return r * (c[0] - r2 * (c[1] - r2 * (c[2] - r2 * c[3])));
}

TEST(test_the_coefficients_are_those_of_the_best_polynomial)
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
TEST(test_the_coefficients_are_rounded_to_whole_units)
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

/* a, b, c of (sqrt(1 + q) / 2 - 1/2) 2^16 = q (a - q (b - c q)) on 0..1, relative error of the root least: the same. */
static const double minimax_length[3] = { 16315.33749942, 3584.53972033, 845.99267662 };

TEST(test_the_coefficients_of_the_length_are_those_of_the_best_polynomial)
{
    enum { STEPS = 100000 };
    double extremes[5] = { 0.0 };
    size_t count = 0;
    for (int i = 1; i <= STEPS; i++) {
        double q = (double)i / STEPS;
        const double *c = minimax_length;
        double root = 32768.0 + q * (c[0] - q * (c[1] - q * c[2]));
        double error = root / (32768.0 * sqrt(1.0 + q)) - 1.0;
        if (count == 0 || (error > 0.0) != (extremes[count - 1] > 0.0)) {
            TEST_ASSERT_TRUE(count < 4);
            extremes[count++] = error;
        } else if (fabs(error) > fabs(extremes[count - 1])) {
            extremes[count - 1] = error;
        }
    }
    TEST_ASSERT_EQUAL_size_t(4, count);
    for (size_t i = 0; i < count; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(3e-8, 8.29e-5, fabs(extremes[i]));
    }
}

/*
 * With y = z that fit 15 bits the length is too short, relatively, by half a unit of 46,341 (its polynomial), half a
 * unit of itself, some 28,000, and 0.35 units of 46,341 as equal legs give 65,535: together 3.6e-5. That raises pitch
 * by half of it, 0.83 units of 1/800 degree, beside the 0.38 of the arc tangent. One unit in a coefficient makes 0.5.
 */
TEST(test_the_coefficients_of_the_length_are_rounded_to_whole_units)
{
    double whole[TERMS];
    for (int i = 0; i < TERMS; i++) {
        whole[i] = round(minimax[i]);
    }
    double half_root = 32768.0 + round(minimax_length[0]) - round(minimax_length[1]) + round(minimax_length[2]);
    double sum = 0.0;
    int count = 0;
    for (int32_t n = 16384; n * 1.41422 < 32767; n++, count++) {
        double yz = n * half_root / 32768.0;
        int32_t x = (int32_t)(yz * (0.98 + 0.02 * (n % 997) / 997.0));
        tilt_t tilt = { 0 };
        tilt_angles(&tilt, (const int32_t[]){ -x, n, n });
        sum += 8.0 * tilt.pitch_cdeg - polynomial(whole, x / yz);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.24, 0.83 + 0.38, sum / count);
}

/* A vector of three numbers whose squares have this sum: some row of them exists, but for 4^a (8 b + 7). */
static bool plausible_with(uint32_t sum_q12)
{
    for (uint32_t x = tilt_isqrt32(sum_q12); x > 0; x--) {
        uint32_t rest = sum_q12 - x * x;
        for (uint32_t y = tilt_isqrt32(rest); y * y * 2U >= rest && y > 0; y--) {
            uint32_t z = tilt_isqrt32(rest - y * y);
            if (z * z == rest - y * y) {
                return tilt_gravity_plausible(
                    (const int32_t[]){ (int32_t)x * 4 + 3, -(int32_t)y * 4, (int32_t)z * 4 + 1 });
            }
        }
    }
    TEST_FAIL_MESSAGE("no three squares");
    return false;
}

/* Square of so many hundredths of 1 g, 16384 in Q6: 0.85 g make 193,944,616.96, 1.15 g 355,005,890.56. */
static double square_q12(int percent)
{
    return pow(163.84 * percent, 2.0);
}

TEST(test_the_limits_of_gravity_to_the_last_unit)
{
    uint32_t least_q12 = (uint32_t)ceil(square_q12(100 - LIMIT_GRAVITY_PERCENT));
    uint32_t most_q12 = (uint32_t)floor(square_q12(100 + LIMIT_GRAVITY_PERCENT));
    TEST_ASSERT_FALSE(plausible_with(least_q12 - 1U));
    TEST_ASSERT_TRUE(plausible_with(least_q12));
    TEST_ASSERT_TRUE(plausible_with(least_q12 + 1U));
    TEST_ASSERT_TRUE(plausible_with(most_q12 - 1U));
    TEST_ASSERT_TRUE(plausible_with(most_q12));
    TEST_ASSERT_FALSE(plausible_with(most_q12 + 1U));
}

/* 1 g and a huge number across is not 1 g. */
TEST(test_a_huge_axis_is_not_left_out)
{
    for (int32_t huge = 131072; huge < (1 << 30); huge *= 2) {
        TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ huge, 0, 65536 }));
        TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ 65536, -huge, 0 }));
        TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ 0, 65536, huge - 1 }));
    }
}

/* |(y, z)| of 4 LSB is enough for roll, a unit of Q8 less is not. */
TEST(test_the_limit_of_roll)
{
    tilt_t tilt = { 0 };
    tilt_angles(&tilt, (const int32_t[]){ 65536, 256 * LIMIT_ROLL_MIN_LSB, 0 });
    TEST_ASSERT_FALSE(tilt.roll_undefined);
    TEST_ASSERT_EQUAL_INT16(9000, tilt.roll_cdeg);
    tilt_angles(&tilt, (const int32_t[]){ 65536, 256 * LIMIT_ROLL_MIN_LSB - 1, 0 });
    TEST_ASSERT_TRUE(tilt.roll_undefined);
}

static void check_point(int32_t x, int32_t y, int32_t z)
{
    const double pitch_bound_deg = 0.0289; /* test_tilt_reference.c */
    tilt_t tilt = { .roll_cdeg = 12345 };
    tilt_angles(&tilt, (const int32_t[]){ x, y, z });
    double yz = hypot(y, z);
    TEST_ASSERT_DOUBLE_WITHIN(pitch_bound_deg, atan2(-(double)x, yz) * 57.295779513082320877, tilt.pitch_cdeg / 100.0);
    TEST_ASSERT_EQUAL(tilt.roll_undefined, tilt.roll_cdeg == 12345);
    if (fabs(yz - TILT_ROLL_MIN_Q8) > 1.0) { /* a unit of Q8 is cut */
        TEST_ASSERT_EQUAL(yz < TILT_ROLL_MIN_Q8, tilt.roll_undefined);
    }
}

/* x is 0.25 g or more and nearly all of it: y and z are scaled up to 15 bits, and their length back. */
TEST(test_pitch_near_the_poles)
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
TEST(test_pitch_of_any_size)
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
