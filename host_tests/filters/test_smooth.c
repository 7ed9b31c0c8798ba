/* What make default compares with: smoothing without lag, and a recording at a lower rate. */
#include "support/smooth.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define COUNT 2000U
#define RATE_HZ 100.0
#define CUT_HZ 5.0

static const double turn = 6.28318530717958648;
static double value[COUNT];

/* Largest distance from gain times the sine, two seconds from the ends. */
static double off_from_sine(double hz, double gain)
{
    double worst = 0.0;
    for (size_t i = 0; i < COUNT; i++) {
        value[i] = sin(turn * hz * (double)i / RATE_HZ);
    }
    TEST_ASSERT_TRUE(smooth_both_ways(value, COUNT, RATE_HZ, CUT_HZ));
    for (size_t i = 200; i + 200 < COUNT; i++) {
        worst = fmax(worst, fabs(value[i] - gain * sin(turn * hz * (double)i / RATE_HZ)));
    }
    return worst;
}

/* Twice through a Butterworth of the second order: 1 / (1 + (tan(pi f / rate) / tan(pi cut / rate))^4), and no lag. */
TEST(sines_keep_their_phase_and_the_cut_its_place)
{
    static const double hz[] = { 0.5, 2.5, 5.0, 7.0, 10.0, 30.0 };
    for (size_t i = 0; i < sizeof hz / sizeof hz[0]; i++) {
        double bent = tan(turn / 2.0 * hz[i] / RATE_HZ) / tan(turn / 2.0 * CUT_HZ / RATE_HZ);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, off_from_sine(hz[i], 1.0 / (1.0 + pow(bent, 4.0))));
    }
}

/* Their point reflection goes on straight, so no end bends; what starts the filter dies by exp(-22) in a second. */
TEST(lines_stay_up_to_their_ends)
{
    for (size_t i = 0; i < COUNT; i++) {
        value[i] = 250.0 - 0.3 * (double)i;
    }
    TEST_ASSERT_TRUE(smooth_both_ways(value, COUNT, RATE_HZ, CUT_HZ));
    for (size_t i = 0; i < COUNT; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 250.0 - 0.3 * (double)i, value[i]);
    }
}

TEST(one_value_is_refused)
{
    TEST_ASSERT_FALSE(smooth_both_ways(value, 1, RATE_HZ, CUT_HZ));
    value[0] = value[1] = 7.0;
    TEST_ASSERT_TRUE(smooth_both_ways(value, 2, RATE_HZ, CUT_HZ));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 7.0, value[1]);
}

/* --- a lower rate --- */

static stream_row_t rows[12];

static stream_t twelve_rows(size_t gap_before)
{
    memset(rows, 0, sizeof rows);
    for (size_t i = 0; i < 12; i++) {
        rows[i].t_us = 10000U * i + (i >= gap_before ? 20000U : 0U);
        rows[i].lsb[0] = (int16_t)(i * i);
        rows[i].lsb[2] = (int16_t)-i;
    }
    stream_t stream = { .rows = rows, .count = 12, .rate_hz = 100.0, .has_truth = true };
    return stream;
}

TEST(groups_are_rounded_means_at_the_time_of_their_last_row)
{
    static const int16_t x[] = { 2, 17, 50, 101 }; /* (0 + 1 + 4) / 3, (9 + 16 + 25) / 3, ... */
    static const int16_t z[] = { -1, -4, -7, -10 };
    stream_t whole = twelve_rows(12);
    divided_t divided;
    TEST_ASSERT_TRUE(stream_divide(&divided, &whole, 3));
    TEST_ASSERT_EQUAL_size_t(4, divided.stream.count);
    TEST_ASSERT_TRUE(divided.stream.has_truth);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 100.0 / 3.0, divided.stream.rate_hz);
    for (size_t i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT16(x[i], divided.stream.rows[i].lsb[0]);
        TEST_ASSERT_EQUAL_INT16(z[i], divided.stream.rows[i].lsb[2]);
        TEST_ASSERT_EQUAL_UINT64(20000U + 30000U * i, divided.stream.rows[i].t_us);
    }
    double square[12];
    for (size_t i = 0; i < 12; i++) {
        square[i] = (double)(i * i);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 50.0 / 3.0, divided_mean(&divided, 1, square));
    divided_free(&divided);
}

TEST(no_group_bridges_a_gap_and_single_rows_all_stay)
{
    stream_t whole = twelve_rows(4);
    divided_t divided;
    TEST_ASSERT_TRUE(stream_divide(&divided, &whole, 3));
    TEST_ASSERT_EQUAL_size_t(3, divided.stream.count); /* 0..2, then 4..6 and 7..9 */
    TEST_ASSERT_EQUAL_size_t(6, divided.last[1]);
    divided_free(&divided);
    TEST_ASSERT_TRUE(stream_divide(&divided, &whole, 1));
    TEST_ASSERT_EQUAL_size_t(12, divided.stream.count);
    TEST_ASSERT_EQUAL_MEMORY(rows, divided.stream.rows, sizeof rows);
    divided_free(&divided);
    TEST_ASSERT_FALSE(stream_divide(&divided, &whole, 8));
}
