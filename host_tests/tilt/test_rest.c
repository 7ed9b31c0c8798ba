/*
 * Sums at rest: mean and variance against exact integers, the limits of stillness from their definition, and what real
 * noise makes of them.
 */
#include "rest.h"
#include "support/documented_limits.h"
#include "support/random.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { HZ_100 = 1000, HZ_800 = 8000, N = LIMIT_REST_READINGS };

static rest_t rest;

void setUp(void)
{
    rest_start(&rest);
}

static bool add(int x, int y, int z)
{
    const int16_t lsb[3] = { (int16_t)x, (int16_t)y, (int16_t)z };
    return rest_add(&rest, lsb);
}

/* floor(a / b + 1/2) for b > 0 */
static int64_t half_up(int64_t a, int64_t b)
{
    int64_t twice = 2 * a + b;
    return (twice >= 0) ? twice / (2 * b) : -((-twice + 2 * b - 1) / (2 * b));
}

/* 256 readings, and each of them says whether it was the last. */
TEST(test_it_is_full_with_256_readings)
{
    for (int k = 1; k <= N; k++) {
        TEST_ASSERT_EQUAL(k == N, add(3, -4, 256));
    }
    TEST_ASSERT_EQUAL_INT16(48, rest_mean_lsb_q4(&rest.axes[0]));
    TEST_ASSERT_EQUAL_INT16(-64, rest_mean_lsb_q4(&rest.axes[1]));
    TEST_ASSERT_EQUAL_INT16(4096, rest_mean_lsb_q4(&rest.axes[2]));
    TEST_ASSERT_TRUE(rest_still(&rest, HZ_100));
}

/* Any centre and any spread, against sums of 64 bits over the readings themselves. */
TEST(test_mean_and_variance_against_exact_sums)
{
    test_random_t random;
    random_seed(&random, 71);
    for (int run = 0; run < 20000; run++) {
        int spread = 1 + (int)random_below(&random, 127);
        int centre = (int)random_below(&random, 3001) - 1500;
        int64_t sum = 0;
        int64_t squares = 0;
        rest_start(&rest);
        for (int k = 0; k < N; k++) {
            int value = centre + (int)random_below(&random, (uint32_t)spread + 1U) - spread / 2;
            (void)add(0, value, 0);
            sum += value;
            squares += (int64_t)value * value;
        }
        TEST_ASSERT_FALSE(rest.moved);
        TEST_ASSERT_EQUAL_INT64(half_up(16 * sum, N), rest_mean_lsb_q4(&rest.axes[1]));
        double exact_q8 = 256.0 * (double)(N * squares - sum * sum) / ((double)N * N);
        double got_q8 = rest_variance_lsb2_q8(&rest.axes[1]);
        TEST_ASSERT_TRUE(got_q8 >= exact_q8 && got_q8 < exact_q8 + 1.0);
    }
}

/* All but the first as far from it as may be, or the second half of them, on axes at the greatest first reading. */
TEST(test_the_largest_sums_do_not_wrap)
{
    for (int far = -128; far <= 127; far += 255) {
        rest_start(&rest);
        for (int k = 0; k < N; k++) {
            (void)add(k == 0 ? 0 : far, k < N / 2 ? 0 : far, far < 0 ? -1900 : 1900);
        }
        TEST_ASSERT_FALSE(rest.moved);
        TEST_ASSERT_EQUAL_INT16(half_up(16L * far * 255, 256), rest_mean_lsb_q4(&rest.axes[0]));
        TEST_ASSERT_EQUAL_INT16(8 * far, rest_mean_lsb_q4(&rest.axes[1]));
        TEST_ASSERT_EQUAL_INT16(far < 0 ? -30400 : 30400, rest_mean_lsb_q4(&rest.axes[2]));
        /* squares - sum^2 / 256: of 255 equal ones 255/256 of one square; of half of them a quarter of 256 squares */
        TEST_ASSERT_EQUAL_UINT32((far * far * 255 + 255) / 256, rest_variance_lsb2_q8(&rest.axes[0]));
        TEST_ASSERT_EQUAL_UINT32(far * far * 64, rest_variance_lsb2_q8(&rest.axes[1]));
        TEST_ASSERT_EQUAL_UINT32(0, rest_variance_lsb2_q8(&rest.axes[2]));
        TEST_ASSERT_FALSE(rest_still(&rest, HZ_800));
    }
}

/* -128..127 LSB from the first. */
TEST(test_a_difference_fits_eight_bits_or_it_has_moved)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int off = -300; off <= 300; off++) {
            int16_t lsb[3] = { 3, -4, 256 };
            rest_start(&rest);
            TEST_ASSERT_FALSE(rest_add(&rest, lsb));
            lsb[axis] = (int16_t)(lsb[axis] + off);
            bool near = off >= -128 && off <= 127;
            TEST_ASSERT_EQUAL(!near, rest_add(&rest, lsb));
            TEST_ASSERT_EQUAL(!near, rest.moved);
        }
    }
}

/* Whatever comes as first and second reading; one that is far away is never forgotten. */
TEST(test_any_reading_is_safe)
{
    static const int ends[] = { -32768, -4096, -1901, -1900, 1900, 1901, 4095, 32767 };
    for (int i = 0; i < 8; i++) {
        for (int j = 0; j < 8; j++) {
            rest_start(&rest);
            (void)add(0, 0, ends[i]);
            (void)add(0, 0, ends[j]);
            bool good = abs(ends[i]) == 1900 && abs(ends[j] - ends[i]) <= 1;
            TEST_ASSERT_EQUAL(!good, rest.moved);
            for (int k = 0; k < N - 2; k++) {
                (void)add(0, 0, ends[i]);
            }
            TEST_ASSERT_EQUAL(good, rest_still(&rest, HZ_800));
        }
    }
}

/* Readings centre + size, centre - size by turns: the variance is size^2, and both halves have the same mean. */
static bool still_with(int axis, int size, uint16_t rate_dhz)
{
    rest_start(&rest);
    for (int k = 0; k < N; k++) {
        int16_t lsb[3] = { 0, 0, 256 };
        lsb[axis] = (int16_t)(lsb[axis] + ((k & 1) != 0 ? size : -size));
        (void)rest_add(&rest, lsb);
    }
    return rest_still(&rest, rate_dhz);
}

/*
 * Below 62.5 x 0.02 x rate: 125 LSB^2 at 100 Hz (11^2 = 121, 12^2 = 144), 1,000 at 800 Hz (31^2 = 961, 32^2 = 1024).
 * The limit itself is too much: 25 LSB^2 at 20 Hz, 100 LSB^2 at 80 Hz.
 */
TEST(test_the_limits_of_the_variance)
{
    static const uint16_t rates_dhz[] = { 200, 208, 800, HZ_100, HZ_800 };
    for (int i = 0; i < 3 * 5 * 40; i++) {
        int size = i / 15;
        uint16_t rate_dhz = rates_dhz[i / 3 % 5];
        bool below = size * size * HZ_100 < LIMIT_REST_VARIANCE_LSB2 * rate_dhz;
        TEST_ASSERT_EQUAL(below, still_with(i % 3, size, rate_dhz));
    }
}

/* A step in the middle by 2 LSB is the limit of the halves' means, and so is a rise by 4; the next readings beyond. */
TEST(test_a_small_drift_shows)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int step = -3; step <= 3; step++) {
            rest_start(&rest);
            for (int k = 0; k < N; k++) {
                int16_t lsb[3] = { 0, 0, 256 };
                lsb[axis] = (int16_t)(lsb[axis] + (k >= N / 2 ? step : 0));
                (void)rest_add(&rest, lsb);
            }
            TEST_ASSERT_EQUAL(abs(step) <= 2, rest_still(&rest, HZ_100));
        }
        for (int rise = 3; rise <= 5; rise++) {
            rest_start(&rest);
            for (int k = 0; k < N; k++) {
                int16_t lsb[3] = { 0, 0, 256 };
                lsb[axis] = (int16_t)(lsb[axis] - k * (rise + 1) / N); /* 0 to -rise */
                (void)rest_add(&rest, lsb);
            }
            TEST_ASSERT_EQUAL(rise < 4, rest_still(&rest, HZ_100));
        }
    }
}

/* Means of halves are 2 LSB apart when the sums of their 128 readings are 256 apart: one reading by 1 LSB decides. */
TEST(test_the_limit_of_the_drift_to_one_lsb_of_one_reading)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int apart = 250; apart <= 270; apart++) {
            rest_start(&rest);
            for (int k = 0; k < N; k++) {
                int in_half = k - N / 2;
                (void)add(0, in_half < 0 ? 0 : sign * (apart / (N / 2) + (in_half < apart % (N / 2))), 256);
            }
            TEST_ASSERT_EQUAL(apart <= LIMIT_REST_DRIFT_LSB * N / 2, rest_still(&rest, HZ_800));
        }
    }
}

/* Share of 2,000 rests with white noise and a steady turning that are called still. */
static double still_share(uint16_t rate_dhz, double variance_lsb2, double rise_lsb)
{
    test_random_t random;
    random_seed(&random, 72);
    int still = 0;
    for (int run = 0; run < 2000; run++) {
        bool last = false;
        rest_start(&rest);
        for (int k = 0; k < N && !last; k++) {
            int16_t lsb[3];
            for (int axis = 0; axis < 3; axis++) {
                double sigma = sqrt(variance_lsb2 * (axis == 2 ? 1.7 : 1.0));
                lsb[axis] = as_sample((axis == 2 ? 256.0 : rise_lsb * k / N) + sigma * random_normal(&random));
            }
            last = rest_add(&rest, lsb);
        }
        still += rest_still(&rest, rate_dhz);
    }
    printf("%5.1f Hz, %5.1f LSB^2, rise %4.1f LSB: still in %.2f %%\n", rate_dhz / 10.0, variance_lsb2, rise_lsb,
           still / 20.0);
    return still / 2000.0;
}

/*
 * The means of the halves differ by s = sqrt(V / 64) rms. A desk at 100 Hz, V = 2 (z 3.4): s = 0.18 and 0.23 LSB, 2 LSB
 * are 8 s. A powered airframe, V = 33 (z 56): s = 0.72, 0.94; P(still) = 0.9945^2 x 0.9666 = 0.956. At 800 Hz a sensor
 * alone has V = 16, z 27: s = 0.5, 0.65, 0.99994^2 x 0.9979 = 0.998. Turning by 6 LSB makes 3 of the 2 LSB: on two
 * axes with s = 0.18 never still. V = 160: above the limit by 35, whose deviation is 160 sqrt(2 / 256) = 14; on z more.
 */
TEST(test_desk_and_airframe_are_still_and_slow_turning_is_not)
{
    TEST_ASSERT_TRUE(still_share(HZ_100, 2.0, 0.0) == 1.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.004, 0.998, still_share(HZ_800, 16.0, 0.0));
    TEST_ASSERT_DOUBLE_WITHIN(0.018, 0.956, still_share(HZ_100, 33.0, 0.0));
    TEST_ASSERT_TRUE(still_share(HZ_100, 2.0, 6.0) <= 0.001);
    TEST_ASSERT_TRUE(still_share(HZ_100, 160.0, 0.0) <= 0.002);
}
