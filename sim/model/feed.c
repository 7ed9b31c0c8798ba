/* Gaps, loops and rates of the stream that the virtual sensor measures. */
#include "feed.h"

enum { RATE_TOLERANCE_PERCENT = 5 };
enum { MOVES_WITHIN = 10 }; /* rows: the driver reports stuck after this many equal readings */

void feed_set_rate(feed_t *feed, const stream_t *stream, double odr_hz, uint64_t now_us)
{
    (void)now_us; /* the origin of FEED_IN_FORCE is the first tick after this */
    feed->stream = stream;
    double difference = stream->rate_hz - odr_hz;
    double tolerance = odr_hz * RATE_TOLERANCE_PERCENT / 100.0;
    bool agrees = stream->rate_hz <= 0.0 || (difference <= tolerance && difference >= -tolerance);
    feed_mode_t mode = agrees ? FEED_ROW_PER_TICK : FEED_IN_FORCE;
    feed->silent_ticks = mode == feed->mode ? feed->silent_ticks : 0;
    feed->mode = mode;
    feed->started = false;
    feed->repeats = 0;
}

/* Ticks without a sample between row - 1 and row. */
static uint32_t gap_ticks(const stream_t *stream, size_t row)
{
    double gap_us = (double)(stream->rows[row].t_us - stream->rows[row - 1].t_us);
    double ticks = gap_us * stream->rate_hz / 1e6 + 0.5;
    if (ticks < 2.0) {
        return 0;
    }
    return ticks > 4e9 ? UINT32_MAX : (uint32_t)ticks - 1u;
}

static feed_result_t row_result(const feed_t *feed, size_t row, size_t *row_index)
{
    *row_index = row;
    return feed->stream->rows[row].missing ? FEED_NOTHING : FEED_SAMPLE;
}

static feed_result_t tick_row(feed_t *feed, size_t *row_index)
{
    if (feed->next >= feed->stream->count) {
        if (!feed->loop) {
            return FEED_END;
        }
        feed->next = 0;
        feed->silent_ticks = 0;
    }
    if (feed->silent_ticks != 0) {
        feed->silent_ticks--;
        return FEED_NOTHING;
    }
    size_t row = feed->next++;
    if (feed->next < feed->stream->count) {
        feed->silent_ticks = gap_ticks(feed->stream, feed->next);
    }
    return row_result(feed, row, row_index);
}

static feed_result_t tick_in_force(feed_t *feed, uint64_t now_us, size_t *row_index)
{
    const stream_t *stream = feed->stream;
    const stream_row_t *rows = stream->rows;
    if (!feed->started) { /* the first tick is at the time of the next row */
        feed->next = feed->next < stream->count ? feed->next : (feed->loop ? 0 : stream->count - 1);
        feed->origin_us = now_us - rows[feed->next].t_us; /* may wrap below 0: only differences are used */
        feed->started = true;
    }
    uint64_t length_us = rows[stream->count - 1].t_us + (uint64_t)(1e6 / stream->rate_hz);
    uint64_t at_us = now_us - feed->origin_us;
    if (at_us >= length_us) {
        if (!feed->loop) {
            return FEED_END;
        }
        feed->origin_us += at_us / length_us * length_us;
        at_us %= length_us;
        feed->next = 0;
    }
    feed->repeats++;
    while (feed->next < stream->count && rows[feed->next].t_us <= at_us) {
        feed->next++;
        feed->repeats = 0;
    }
    return row_result(feed, feed->next - 1, row_index);
}

feed_result_t feed_tick(feed_t *feed, uint64_t now_us, size_t *row_index)
{
    return feed->mode == FEED_ROW_PER_TICK ? tick_row(feed, row_index) : tick_in_force(feed, now_us, row_index);
}

static bool without_power(const int16_t lsb[3])
{
    return lsb[0] == -1 && lsb[1] == -1 && lsb[2] == -1;
}

/* A rail of any range: 2^9, 2^10, 2^11 and 2^12 LSB, one less on the positive side. */
static bool at_a_rail(int16_t lsb)
{
    int32_t size = lsb < 0 ? -(int32_t)lsb : lsb + 1;
    return size >= 512 && (size & (size - 1)) == 0;
}

/* The stream changed this axis within the last rows; an axis that does not change is frozen, and stays so. */
static bool moves(const feed_t *feed, size_t axis)
{
    const stream_row_t *rows = feed->stream->rows;
    size_t row = feed->next - 1;
    for (size_t back = 0; back < MOVES_WITHIN && row > back; back++) {
        if (rows[row - back].lsb[axis] != rows[row - back - 1].lsb[axis]) {
            return true;
        }
    }
    return false;
}

/* Changes this axis by one LSB, unless that changes the meaning of the reading. */
static bool vary(int16_t lsb[3], size_t axis, int16_t by)
{
    int16_t read = lsb[axis];
    lsb[axis] = (int16_t)(read + by);
    if (at_a_rail(read) || at_a_rail(lsb[axis]) || without_power(lsb)) {
        lsb[axis] = read;
        return false;
    }
    return true;
}

void feed_vary(const feed_t *feed, int16_t lsb[3])
{
    if (feed->repeats == 0 || without_power(lsb)) {
        return;
    }
    size_t turn = feed->repeats + feed->next; /* at the next tick or row it is another axis, in the other direction */
    for (size_t axis = turn; axis < turn + 3; axis++) {
        if (moves(feed, axis % 3) && vary(lsb, axis % 3, turn % 2 == 0 ? 1 : -1)) {
            return;
        }
    }
}
