/*
 * The recording as the virtual sensor ticks it out, into the sample path. What the driver does with readings is made
 * up for in few lines: a reading of all ones is none, and the tenth equal one on end is marked.
 */
#include "libtilt.h"

#include <stdlib.h>
#include <string.h>

#include "base/choice.h"
#include "feed.h"
#include "filter_list.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "path/silence.h"
#include "settings/settings.h"

#define STUCK_REPEATS 9u /* ADXL345_STUCK_REPEATS of the driver's own header */

typedef struct {
    const libtilt_stream_t *in;
    libtilt_row_t *out;
    int64_t room;
    int64_t count;
    uint64_t now_us; /* of the sensor's clock: a period a tick */
    uint32_t period_us;
    int16_t rail_lsb;
    bool row_per_tick;
    bool running;          /* a sample has come */
    int64_t sample_us;     /* its time in the recording */
    uint64_t sample_at_us; /* and by the sensor's clock */
    int16_t last_lsb[3];
    uint8_t equal_run;
    bool has_last;
    uint16_t marks; /* of the driver, for the next row */
} replay_t;

/* Time in the recording of a row, by the sensor's clock not after now; its periods are the recording's median steps. */
static int64_t recorded_us(const replay_t *r, uint32_t t_us)
{
    uint32_t ago_us = (uint32_t)r->now_us - t_us;
    int64_t behind_us = (int64_t)(r->now_us - ago_us - r->sample_at_us);
    if (r->row_per_tick && r->in->step_us != 0) {
        behind_us = behind_us * r->in->step_us / (int64_t)r->period_us;
    }
    return r->sample_us + behind_us;
}

static void keep_row(replay_t *r, int32_t source)
{
    row_t row;
    pipeline_flag(r->marks);
    r->marks = 0;
    pipeline_finish();
    pipeline_row(&row);
    pipeline_row_done();
    if (r->count < r->room) {
        libtilt_row_t *out = &r->out[r->count];
        *out = (libtilt_row_t){ .t_us = recorded_us(r, row.t_us),
                                .source = source,
                                .roll_cdeg = row.roll_cdeg,
                                .pitch_cdeg = row.pitch_cdeg,
                                .flags = row.flags };
        memcpy(out->lsb, row.lsb, sizeof row.lsb);
        memcpy(out->mg, row.mg, sizeof row.mg);
    }
    r->count++;
}

static int16_t within_range(const replay_t *r, int16_t lsb)
{
    if (lsb > r->rail_lsb) {
        return r->rail_lsb;
    }
    return lsb < -r->rail_lsb - 1 ? (int16_t)(-r->rail_lsb - 1) : lsb;
}

/* Counts equal readings as the driver: a silence of three samples restarts the sensor, then none is known before it. */
static void look_for_repeats(replay_t *r, const int16_t lsb[3])
{
    bool known = r->has_last && !(r->running && silence_samples() >= SILENCE_FAULT_FROM);
    if (known && memcmp(lsb, r->last_lsb, sizeof r->last_lsb) == 0) {
        r->equal_run = (uint8_t)(r->equal_run + (r->equal_run < STUCK_REPEATS));
    } else if (known || r->equal_run != STUCK_REPEATS) {
        r->equal_run = 0;
    }
    r->has_last = true;
    memcpy(r->last_lsb, lsb, sizeof r->last_lsb);
}

/* As adxl345_integrity_judge. */
static bool plausible(replay_t *r, const int16_t lsb[3])
{
    if (lsb[0] == -1 && lsb[1] == -1 && lsb[2] == -1) {
        r->marks |= ROW_INTEGRITY;
        return false;
    }
    look_for_repeats(r, lsb);
    if (r->equal_run == STUCK_REPEATS) {
        r->marks |= ROW_STUCK;
    }
    return true;
}

static void take(replay_t *r, const feed_t *feed, size_t source)
{
    adxl345_sample_t sample = { .t_us = (uint32_t)r->now_us, .lsb = { 0, 0, 0 } };
    memcpy(sample.lsb, &r->in->lsb[3 * source], sizeof sample.lsb);
    feed_vary(feed, sample.lsb);
    for (int axis = 0; axis < 3; axis++) {
        sample.lsb[axis] = within_range(r, sample.lsb[axis]);
    }
    if (!plausible(r, sample.lsb) || !coast_sample(sample.t_us, r->period_us)) {
        return;
    }
    if (r->row_per_tick || !r->running) {
        r->sample_us = r->in->t_us[source];
    } else {
        r->sample_us += (int64_t)(r->now_us - r->sample_at_us);
    }
    r->sample_at_us = r->now_us;
    r->running = true;
    pipeline_sample(&sample);
    keep_row(r, (int32_t)source);
}

/* What is missing before this tick, each as the main loop finds it: at half a period after it was due. */
static void fill_gap(replay_t *r)
{
    while (r->running && coast_due((uint32_t)r->now_us) && coast_over(r->period_us, false)) {
        keep_row(r, -1);
    }
}

static void run(replay_t *r, feed_t *feed)
{
    size_t source;
    feed_result_t got = feed_tick(feed, r->now_us, &source);
    while (got != FEED_END && r->count <= r->room) {
        fill_gap(r);
        if (got == FEED_SAMPLE) {
            take(r, feed, source);
        }
        r->now_us += r->period_us;
        got = feed_tick(feed, r->now_us, &source);
    }
}

static bool make_stream(stream_t *stream, const libtilt_stream_t *in)
{
    size_t count = (size_t)in->count;
    *stream = (stream_t){ .rows = calloc(count, sizeof(stream_row_t)), .count = count };
    stream->rate_hz = in->step_us == 0 ? 0.0 : 1e6 / (double)in->step_us;
    for (size_t i = 0; stream->rows != NULL && i < count; i++) {
        stream->rows[i].t_us = (uint64_t)in->t_us[i];
        stream->rows[i].missing = in->missing[i] != 0;
        memcpy(stream->rows[i].lsb, &in->lsb[3 * i], sizeof stream->rows[i].lsb);
    }
    return stream->rows != NULL;
}

static feed_t make_feed(const stream_t *stream, uint16_t rate_dhz)
{
    feed_t feed = { .stream = stream };
    feed_set_rate(&feed, stream, rate_dhz / 10.0, 0);
    return feed;
}

int libtilt_row_per_tick(const libtilt_stream_t *in, uint16_t rate_dhz)
{
    stream_t stream = { .rate_hz = in->step_us == 0 ? 0.0 : 1e6 / (double)in->step_us };
    return make_feed(&stream, rate_dhz).mode == FEED_ROW_PER_TICK;
}

/* False: the firmware refuses the parameters. */
static bool choose(int kind, uint16_t rate_dhz, const int64_t *values, const uint8_t *changed)
{
    filter_choice_t *choice = &settings()->choice;
    settings_take_filter((uint8_t)kind);
    for (uint8_t i = 0; i < filter_parameter_count(choice_law(choice)); i++) {
        if (changed[i]) {
            choice->parameters[i] = (uint32_t)values[i];
            choice->own = (uint8_t)(choice->own | (1u << i));
        }
    }
    return choice_legal(choice, rate_dhz);
}

int64_t libtilt_replay(const libtilt_stream_t *in, int kind, uint16_t rate_dhz, uint8_t range_g, const int64_t *values,
                       const uint8_t *changed, libtilt_row_t *out, int64_t room)
{
    stream_t stream;
    settings_defaults();
    if (!choose(kind, rate_dhz, values, changed)) {
        return -3;
    }
    if (!make_stream(&stream, in)) {
        return -2;
    }
    feed_t feed = make_feed(&stream, rate_dhz);
    replay_t replay = { .in = in,
                        .out = out,
                        .room = room,
                        .period_us = 10000000u / rate_dhz,
                        .rail_lsb = (int16_t)(range_g * 256 - 1),
                        .row_per_tick = feed.mode == FEED_ROW_PER_TICK };
    silence_end();
    coast_wait(0);
    pipeline_reset();
    pipeline_calibrate(&settings()->calibration);
    pipeline_forget();
    pipeline_change(&settings()->choice, rate_dhz, range_g);
    pipeline_finish();
    run(&replay, &feed);
    free(stream.rows);
    return replay.count <= room ? replay.count : -1;
}
