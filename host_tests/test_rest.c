/*
 * Sums at rest: mean and variance against exact integers, the limits of stillness from their definition, and what real
 * noise makes of them.
 */
#include "rest.h"
#include "support_random.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { HZ_100 = 1000, HZ_800 = 8000 };

static rest_t rest;

void setUp(void)
{
    rest_start(&rest);
}

void tearDown(void) {}

static void add(int x, int y, int z)
{
    const int16_t lsb[3] = { (int16_t)x, (int16_t)y, (int16_t)z };
    rest_add(&rest, lsb);
}

/* floor(a / b + 1/2) for b > 0 */
static int64_t half_up(int64_t a, int64_t b)
{
    int64_t twice = 2 * a + b;
    return (twice >= 0) ? twice / (2 * b) : -((-twice + 2 * b - 1) / (2 * b));
}

static void test_nothing_read_is_nothing(void)
{
    TEST_ASSERT_EQUAL_INT16(0, rest_mean_lsb_q4(&rest, 0));
    TEST_ASSERT_EQUAL_UINT32(0, rest_variance_lsb2_q8(&rest, 0));
    TEST_ASSERT_FALSE(rest_still(&rest, HZ_100));
}

/* Any centre, any spread, any number of readings, against sums of 64 bits over the readings themselves. */
static void test_mean_and_variance_against_exact_sums(void)
{
    test_random_t random;
    random_seed(&random, 71);
    for (int run = 0; run < 20000; run++) {
        int n = 1 + (int)random_below(&random, REST_SAMPLES_MAX);
        int spread = 1 + (int)random_below(&random, 127);
        int centre = (int)random_below(&random, 3001) - 1500;
        int64_t sum = 0;
        int64_t squares = 0;
        rest_start(&rest);
        for (int k = 0; k < n; k++) {
            int value = centre + (int)random_below(&random, (uint32_t)spread + 1U) - spread / 2;
            add(0, value, 0);
            sum += value;
            squares += (int64_t)value * value;
        }
        TEST_ASSERT_FALSE(rest.moved);
        TEST_ASSERT_EQUAL_INT(n, rest.samples);
        TEST_ASSERT_EQUAL_INT64(half_up(16 * sum, n), rest_mean_lsb_q4(&rest, 1));
        double exact_q8 = 256.0 * (double)(n * squares - sum * sum) / ((double)n * n);
        double got_q8 = rest_variance_lsb2_q8(&rest, 1);
        TEST_ASSERT_TRUE(got_q8 <= exact_q8 + 0.5 && got_q8 >= exact_q8 - 256.0 / n - 0.5);
    }
}

/* The largest sums: half of 512 readings 127 above the first, or all of them but it. */
static void test_the_largest_sums_do_not_wrap(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        rest_start(&rest);
        for (int k = 0; k < (int)REST_SAMPLES_MAX; k++) {
            add(k == 0 ? 0 : sign * 127, k < 256 ? 0 : sign * 127, -sign * 1900);
        }
        TEST_ASSERT_FALSE(rest.moved);
        TEST_ASSERT_EQUAL_INT16(half_up(16L * sign * 127 * 511, 512), rest_mean_lsb_q4(&rest, 0));
        TEST_ASSERT_EQUAL_INT16(sign * 1016, rest_mean_lsb_q4(&rest, 1)); /* 63.5 */
        TEST_ASSERT_EQUAL_INT16(-sign * 30400, rest_mean_lsb_q4(&rest, 2));
        TEST_ASSERT_EQUAL_UINT32(1032256, rest_variance_lsb2_q8(&rest, 1)); /* 63.5^2 = 4032.25 */
        TEST_ASSERT_EQUAL_UINT32(0, rest_variance_lsb2_q8(&rest, 2));
        TEST_ASSERT_FALSE(rest_still(&rest, HZ_100));
    }
}

static void test_no_more_than_the_most_readings_count(void)
{
    for (int k = 0; k < (int)REST_SAMPLES_MAX + 100; k++) {
        add(k < (int)REST_SAMPLES_MAX ? 10 : 60, 0, 256);
    }
    TEST_ASSERT_EQUAL_INT16(160, rest_mean_lsb_q4(&rest, 0));
    TEST_ASSERT_TRUE(rest_still(&rest, HZ_100));
}

static void test_a_reading_far_away_is_no_rest(void)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int off = -128; off <= 128; off += 1) {
            int16_t lsb[3] = { 3, -4, 256 };
            rest_start(&rest);
            rest_add(&rest, lsb);
            lsb[axis] = (int16_t)(lsb[axis] + off);
            rest_add(&rest, lsb);
            TEST_ASSERT_EQUAL(abs(off) == 128, rest.moved);
        }
    }
}

static void test_any_reading_is_safe(void)
{
    static const int ends[] = { -32768, -4096, -1901, -1900, 1900, 1901, 4095, 32767 };
    for (int i = 0; i < 8; i++) {
        for (int j = 0; j < 8; j++) {
            rest_start(&rest);
            add(0, 0, ends[i]);
            add(0, 0, ends[j]);
            TEST_ASSERT_EQUAL(!(i == j && abs(ends[i]) == 1900), rest.moved);
            for (int k = 0; k < 100; k++) {
                add(0, 0, 256);
            }
            TEST_ASSERT_FALSE(rest_still(&rest, HZ_800));
        }
    }
}

static void test_fifteen_readings_are_too_few(void)
{
    for (int k = 0; k < 16; k++) {
        TEST_ASSERT_FALSE(rest_still(&rest, HZ_100));
        add(0, 0, 256);
    }
    TEST_ASSERT_TRUE(rest_still(&rest, HZ_100));
}

/* Readings centre + size, centre - size by turns: the variance is size^2; a line through them rises by 12 size / 2n. */
static bool still_with(int axis, int size, uint16_t rate_dhz)
{
    rest_start(&rest);
    for (int k = 0; k < 64; k++) {
        int16_t lsb[3] = { 0, 0, 256 };
        lsb[axis] = (int16_t)(lsb[axis] + ((k & 1) != 0 ? size : -size));
        rest_add(&rest, lsb);
    }
    return rest_still(&rest, rate_dhz);
}

/* Limits by definition: 31.25 x 0.02 x 100 = 62.5 LSB^2 and 105.5 on z; at 800 Hz 500 and 843.8. */
static void test_the_limits_of_the_variance(void)
{
    for (int axis = 0; axis < 3; axis++) {
        TEST_ASSERT_TRUE(still_with(axis, axis == 2 ? 10 : 7, HZ_100));
        TEST_ASSERT_FALSE(still_with(axis, axis == 2 ? 11 : 8, HZ_100));
        TEST_ASSERT_TRUE(still_with(axis, axis == 2 ? 29 : 22, HZ_800));
        TEST_ASSERT_FALSE(still_with(axis, axis == 2 ? 30 : 23, HZ_800));
    }
}

/* A step in the middle by h: T = h n^2 / 8, so the line rises by 1.5 h; by 4 LSB at h = 2.67. */
static void test_a_small_step_in_the_middle_shows(void)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int step = -3; step <= 3; step++) {
            rest_start(&rest);
            for (int k = 0; k < 128; k++) {
                int16_t lsb[3] = { 0, 0, 256 };
                lsb[axis] = (int16_t)(lsb[axis] + (k >= 64 ? step : 0));
                rest_add(&rest, lsb);
            }
            TEST_ASSERT_EQUAL(abs(step) < 3, rest_still(&rest, HZ_100));
        }
    }
}

/* Share of 2,000 rests with white noise and a steady turning that are called still; n readings. */
static double still_share(uint16_t rate_dhz, double variance_lsb2, double rise_lsb, int n)
{
    test_random_t random;
    random_seed(&random, 72);
    int still = 0;
    for (int run = 0; run < 2000; run++) {
        rest_start(&rest);
        for (int k = 0; k < n; k++) {
            int16_t lsb[3];
            for (int axis = 0; axis < 3; axis++) {
                double sigma = sqrt(variance_lsb2 * (axis == 2 ? 1.7 : 1.0));
                lsb[axis] = as_sample((axis == 2 ? 256.0 : rise_lsb * k / n) + sigma * random_normal(&random));
            }
            rest_add(&rest, lsb);
        }
        still += rest_still(&rest, rate_dhz);
    }
    printf("%5.1f Hz, %5.1f LSB^2, rise %4.1f LSB, %3d readings: still in %.2f %%\n", rate_dhz / 10.0, variance_lsb2,
           rise_lsb, n, still / 20.0);
    return still / 2000.0;
}

/*
 * The rise of white noise has the deviation s = sqrt(12 V / n). A desk at 100 Hz, n = 100: V = 2 (z 3.4), s = 0.49 and
 * 0.64 LSB: 4 LSB are 6 s. A powered airframe, V = 33 (its z is no noisier than x; 56 here), n = 256: s = 1.24, 1.62,
 * so P(still) = 0.9988^2 x 0.986 = 0.984. Turning that makes 6 LSB: 2 LSB beyond the limit, 4 s: never.
 */
static void test_desk_and_airframe_are_still_and_slow_turning_is_not(void)
{
    TEST_ASSERT_TRUE(still_share(HZ_100, 2.0, 0.0, 100) == 1.0);
    TEST_ASSERT_TRUE(still_share(HZ_800, 16.0, 0.0, 512) == 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.012, 0.984, still_share(HZ_100, 33.0, 0.0, 256));
    TEST_ASSERT_TRUE(still_share(HZ_100, 2.0, 6.0, 100) <= 0.001);
    TEST_ASSERT_TRUE(still_share(HZ_100, 90.0, 0.0, 256) <= 0.001);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_nothing_read_is_nothing);
    RUN_TEST(test_mean_and_variance_against_exact_sums);
    RUN_TEST(test_the_largest_sums_do_not_wrap);
    RUN_TEST(test_no_more_than_the_most_readings_count);
    RUN_TEST(test_a_reading_far_away_is_no_rest);
    RUN_TEST(test_any_reading_is_safe);
    RUN_TEST(test_fifteen_readings_are_too_few);
    RUN_TEST(test_the_limits_of_the_variance);
    RUN_TEST(test_a_small_step_in_the_middle_shows);
    RUN_TEST(test_desk_and_airframe_are_still_and_slow_turning_is_not);
    return UNITY_END();
}
