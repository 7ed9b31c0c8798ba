/* The feed: which row of a stream each tick of the virtual sensor takes, and the noise of a row that several take. */
#include <stdlib.h>
#include <string.h>

#include "feed.h"
#include "support/test.h"

enum { ROWS_MAX = 50, STEP_US = 10000 };

static stream_row_t rows[ROWS_MAX];
static stream_t stream;

/* A stream of 100 Hz; x is the row's number from 1 on. */
static void load(size_t count)
{
    stream = (stream_t){ .rows = rows, .count = count, .rate_hz = 100.0 };
    for (size_t i = 0; i < count; i++) {
        rows[i] = (stream_row_t){ .t_us = STEP_US * i, .lsb = { (int16_t)(i + 1), 0, 0 } };
    }
}

static void load_at(const uint64_t *t_us, size_t count)
{
    load(count);
    for (size_t i = 0; i < count; i++) {
        rows[i].t_us = t_us[i];
    }
}

static void load_readings(const int16_t (*lsb)[3], size_t count)
{
    load(count);
    for (size_t i = 0; i < count; i++) {
        memcpy(rows[i].lsb, lsb[i], sizeof rows[i].lsb);
    }
}

static feed_t feed_of(double odr_hz, bool loop)
{
    feed_t feed = { .stream = &stream, .loop = loop };
    feed_set_rate(&feed, &stream, odr_hz, 0);
    return feed;
}

static void assert_tick(feed_t *feed, uint64_t now_us, feed_result_t result, size_t row)
{
    size_t index = 999;
    TEST_ASSERT_EQUAL_INT(result, feed_tick(feed, now_us, &index));
    if (result == FEED_SAMPLE) {
        TEST_ASSERT_EQUAL_size_t(row, index);
    }
}

TEST(test_feed_mode_at_the_5_percent_border)
{
    load(3); /* 5 % of the sensor's rate */
    TEST_ASSERT_EQUAL_INT(FEED_ROW_PER_TICK, feed_of(100.0, false).mode);
    TEST_ASSERT_EQUAL_INT(FEED_ROW_PER_TICK, feed_of(105.2, false).mode);
    TEST_ASSERT_EQUAL_INT(FEED_IN_FORCE, feed_of(105.3, false).mode);
    TEST_ASSERT_EQUAL_INT(FEED_ROW_PER_TICK, feed_of(95.3, false).mode);
    TEST_ASSERT_EQUAL_INT(FEED_IN_FORCE, feed_of(95.2, false).mode);
}

TEST(test_feed_gaps_and_missing_rows_are_silent_ticks)
{
    /* 10 ms steps; rows 2 and 3 are 35 ms apart: 35/10 rounds to 4, so three ticks are silent; row 4 marked missing */
    static const uint64_t t_us[] = { 0, 10000, 20000, 55000, 65000, 75000 };
    load_at(t_us, 6);
    rows[4].missing = true;
    feed_t feed = feed_of(100.0, false);
    assert_tick(&feed, 0, FEED_SAMPLE, 0);
    assert_tick(&feed, 0, FEED_SAMPLE, 1);
    assert_tick(&feed, 0, FEED_SAMPLE, 2);
    for (int i = 0; i < 3; i++) {
        assert_tick(&feed, 0, FEED_NOTHING, 0);
    }
    assert_tick(&feed, 0, FEED_SAMPLE, 3);
    assert_tick(&feed, 0, FEED_NOTHING, 0);
    assert_tick(&feed, 0, FEED_SAMPLE, 5);
    assert_tick(&feed, 0, FEED_END, 0);
    assert_tick(&feed, 0, FEED_END, 0);
}

TEST(test_feed_jitter_below_half_a_step_is_no_gap)
{
    static const uint64_t t_us[] = { 0, 14900, 20000, 30000, 40000 };
    load_at(t_us, 5);
    feed_t feed = feed_of(100.0, false);
    for (size_t row = 0; row < 5; row++) {
        assert_tick(&feed, 0, FEED_SAMPLE, row);
    }
}

TEST(test_feed_loops)
{
    load(3);
    feed_t feed = feed_of(100.0, true);
    for (size_t i = 0; i < 10; i++) {
        assert_tick(&feed, 0, FEED_SAMPLE, i % 3);
    }
    feed = feed_of(50.0, true);
    TEST_ASSERT_EQUAL_INT(FEED_IN_FORCE, feed.mode);
    /* 30 ms long, ticks 20 ms apart: at 0, 20, 40 = 10, 60 = 0 ms of the stream */
    assert_tick(&feed, 500000, FEED_SAMPLE, 0);
    assert_tick(&feed, 520000, FEED_SAMPLE, 2);
    assert_tick(&feed, 540000, FEED_SAMPLE, 1);
    assert_tick(&feed, 560000, FEED_SAMPLE, 0);
}

TEST(test_feed_in_force_takes_the_newest_row_not_later)
{
    load(4);
    feed_t feed = feed_of(400.0, false);
    static const size_t expected[] = { 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3 };
    for (size_t i = 0; i < 16; i++) { /* the first tick is at the first row's time */
        assert_tick(&feed, 77000 + 2500 * i, FEED_SAMPLE, expected[i]);
    }
    assert_tick(&feed, 77000 + 2500 * 16, FEED_END, 0);
}

TEST(test_feed_keeps_its_place_when_the_rate_changes)
{
    load(6);
    feed_t feed = feed_of(100.0, false);
    assert_tick(&feed, 0, FEED_SAMPLE, 0);
    assert_tick(&feed, 10000, FEED_SAMPLE, 1);
    feed_set_rate(&feed, &stream, 50.0, 10000);
    assert_tick(&feed, 90000, FEED_SAMPLE, 2);
    assert_tick(&feed, 110000, FEED_SAMPLE, 4);
    feed_set_rate(&feed, &stream, 100.0, 110000);
    assert_tick(&feed, 400000, FEED_SAMPLE, 5);
    assert_tick(&feed, 410000, FEED_END, 0);
}

static void varied(feed_t *feed, uint64_t now_us, int16_t lsb[3])
{
    size_t row = 0;
    TEST_ASSERT_EQUAL_INT(FEED_SAMPLE, feed_tick(feed, now_us, &row));
    memcpy(lsb, rows[row].lsb, 3 * sizeof *lsb);
    feed_vary(feed, lsb);
}

static int off(const int16_t a[3], const int16_t b[3])
{
    return abs(a[0] - b[0]) + abs(a[1] - b[1]) + abs(a[2] - b[2]);
}

/* Rows of 10 ms: row i is (x(i), -20, 256), x moving by one LSB where it moves. */
static void load_rows(size_t count, bool moves)
{
    load(count);
    for (size_t i = 0; i < count; i++) {
        const int16_t lsb[3] = { (int16_t)(moves ? 10 + i % 2 : 10), -20, 256 };
        memcpy(rows[i].lsb, lsb, sizeof lsb);
    }
}

/* How often a sample is as the one before; each lies within an LSB of its row. */
static unsigned repeated(double rate_hz, int ticks, int axis, int32_t *sum)
{
    feed_t feed = feed_of(rate_hz, false);
    unsigned equal = 0;
    int16_t before[3] = { 0, 0, 0 };
    for (int i = 0; i < ticks; i++) {
        int16_t lsb[3];
        varied(&feed, (uint64_t)(1e6 / rate_hz * i), lsb);
        TEST_ASSERT_LESS_OR_EQUAL_INT(1, off(lsb, rows[feed.next - 1].lsb));
        equal += lsb[axis] == before[axis];
        *sum += lsb[axis] - rows[feed.next - 1].lsb[axis];
        memcpy(before, lsb, sizeof before);
    }
    return equal;
}

/* Of one axis that moves, at any rate: it never repeats within a row, and in the mean is what the stream says. */
TEST(test_a_row_measured_again_has_noise)
{
    static const double rates_hz[] = { 200.0, 400.0, 800.0 };
    for (size_t k = 0; k < 3; k++) {
        load_rows(50, true);
        int32_t sum = 0;
        int a_row = (int)(rates_hz[k] / 100.0);
        unsigned equal = repeated(rates_hz[k], 48 * a_row, 0, &sum);
        TEST_ASSERT_LESS_THAN_UINT((unsigned)a_row + 48u, equal); /* the first row, and at the seams */
        TEST_ASSERT_INT32_WITHIN(1, 0, sum); /* the signs alternate, in a row and from row to row */
    }
}

/* A sensor that hangs, and an axis that does, are frozen at any rate. */
TEST(test_what_is_frozen_stays_so)
{
    load_rows(50, false);
    int32_t sum = 0;
    TEST_ASSERT_EQUAL_UINT(399, repeated(800.0, 400, 0, &sum));
    TEST_ASSERT_EQUAL_INT32(0, sum);
    load_rows(50, true);
    TEST_ASSERT_EQUAL_UINT(399, repeated(800.0, 400, 2, &sum));
    TEST_ASSERT_EQUAL_INT32(0, sum);
}

TEST(test_at_the_rate_of_the_stream_readings_are_its_own)
{
    static const int16_t readings[4][3] = { { 1, 2, 3 }, { 1, 2, 3 }, { 2, 3, 4 }, { 2, 3, 4 } };
    load_readings(readings, 4);
    static const double rates_hz[] = { 100.0, 50.0 };
    for (size_t k = 0; k < 2; k++) {
        feed_t feed = feed_of(rates_hz[k], true);
        for (uint64_t i = 0; i < 40; i++) {
            int16_t lsb[3];
            varied(&feed, (uint64_t)(1e6 / rates_hz[k]) * i, lsb);
            TEST_ASSERT_EQUAL_INT(0, off(lsb, rows[feed.next - 1].lsb));
        }
    }
}

/* A reading at a rail stays there and none comes to it; a sensor without power is one, and none becomes one. */
TEST(test_noise_changes_no_meaning)
{
    static const int16_t readings[7][3] = { { -1, -1, -1 },         { 511, -512, 0 }, { 4095, 1024, 510 },
                                            { -4096, -511, -2047 }, { -1, -1, 0 },    { -1, -2, -1 },
                                            { -1, -1, -1 } };
    load_readings(readings, 7);
    static const int16_t least[7][3] = { { -1, -1, -1 }, { 511, -512, -1 }, { 4095, 1024, 509 }, { -4096, -511, -2047 },
                                         { -2, -2, 0 },  { -2, -3, -2 },    { -1, -1, -1 } };
    static const int16_t most[7][3] = { { -1, -1, -1 }, { 511, -512, 1 }, { 4095, 1025, 510 }, { -4096, -510, -2046 },
                                        { 0, 0, 1 },    { 0, -2, 0 },     { -1, -1, -1 } };
    bool reached[7][3][2] = { { { false } } };
    feed_t feed = feed_of(800.0, true);
    for (uint64_t i = 0; i < 7 * 8 * 4; i++) {
        size_t row = 0;
        TEST_ASSERT_EQUAL_INT(FEED_SAMPLE, feed_tick(&feed, 1250 * i, &row));
        int16_t lsb[3];
        memcpy(lsb, rows[row].lsb, sizeof lsb);
        feed_vary(&feed, lsb);
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_TRUE(lsb[axis] >= least[row][axis] && lsb[axis] <= most[row][axis]);
            reached[row][axis][0] |= lsb[axis] == least[row][axis];
            reached[row][axis][1] |= lsb[axis] == most[row][axis];
        }
        const int16_t off_now[3] = { -1, -1, -1 };
        TEST_ASSERT_EQUAL(row == 0 || row == 6, memcmp(lsb, off_now, sizeof lsb) == 0);
    }
    TEST_ASSERT_EACH_EQUAL_UINT8(true, reached, sizeof reached);
}
