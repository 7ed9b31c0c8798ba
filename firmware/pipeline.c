/* The sample path of main. Its cycles: sample_total in docs/benchmarks.md. */
#include "pipeline.h"

#include "counters.h"
#include "filter_any.h"
#include "fx.h"
#include "noise.h"
#include "tilt.h"

enum { AXES = 3, WARM_ROWS = 5 };

#define COAST_LIMIT_US 100000ul

static struct {
    filter_any_t filter[AXES];
    noise_t noise[AXES];
    tilt_t tilt;
    tilt_t raw_tilt;
    uint32_t last_us;
    int32_t estimate_q8[AXES];
    int16_t lsb[AXES];
    int16_t rail_high_lsb;
    uint16_t rate_dhz;
    uint16_t flags;
    uint8_t warm_rows;
    bool has_sample;
    bool changed; /* the next sample is the first of another configuration, before which none is missing */
} pipe;

FX_NOINLINE void keep_estimate(uint8_t axis, int32_t x_lsb_q16)
{
    pipe.estimate_q8[axis] = (x_lsb_q16 + 128) >> 8;
}

static void init_filter(uint8_t axis, uint8_t filter_kind)
{
    filter_any_config_t config;
    filter_any_defaults((filter_kind_t)filter_kind, &config, pipe.rate_dhz);
    (void)filter_any_init(&pipe.filter[axis], (filter_kind_t)filter_kind, &config);
    filter_any_set_noise(&pipe.filter[axis], noise_r_lsb2_q8(&pipe.noise[axis]));
}

void pipeline_reset(void)
{
    pipe.tilt = (tilt_t){ 0, 0, false };
    pipe.raw_tilt = pipe.tilt;
    pipe.flags = 0;
}

/* keep: the filters go on from the old output, the noise estimates too unless the rate is new. */
static void begin(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g, bool keep)
{
    bool new_noise = !keep || rate_dhz != pipe.rate_dhz;
    pipe.rate_dhz = rate_dhz;
    pipe.has_sample = keep;
    pipe.changed = true;
    pipe.warm_rows = WARM_ROWS;
    pipe.rail_high_lsb = (int16_t)(range_g * 256U - 1U);
    for (uint8_t axis = 0; axis < AXES; axis++) {
        if (new_noise) {
            noise_init(&pipe.noise[axis], rate_dhz, axis == 2);
        }
        init_filter(axis, filter_kind);
        if (keep) {
            filter_any_reset(&pipe.filter[axis], (int16_t)((pipe.estimate_q8[axis] + 128) >> 8));
        }
    }
}

void pipeline_start(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g)
{
    begin(filter_kind, rate_dhz, range_g, false);
}

void pipeline_change(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g)
{
    begin(filter_kind, rate_dhz, range_g, pipe.has_sample);
}

static void collect_flags(uint8_t filter_flags)
{
    pipe.flags |= (filter_flags & FILTER_GATED) ? ROW_GATED : 0u;
    pipe.flags |= (filter_flags & FILTER_REACQUIRED) ? ROW_REACQUIRED : 0u;
    pipe.flags |= (filter_flags & FILTER_WARMING_UP) ? ROW_WARMING_UP : 0u;
}

/* Every missing sample is one prediction step, so that the rate goes on; after 100 ms the estimate holds. */
static void coast_over_gap(uint32_t t_us, uint32_t period_us)
{
    uint32_t gap_us = t_us - pipe.last_us;
    uint32_t at_us = period_us + (period_us >> 1);
    if (!pipe.has_sample || gap_us <= at_us) {
        return;
    }
    if (!pipe.changed) {
        count_lost((gap_us - (period_us >> 1)) / period_us);
    }
    for (; at_us < gap_us && at_us < COAST_LIMIT_US; at_us += period_us) {
        for (uint8_t axis = 0; axis < AXES; axis++) {
            keep_estimate(axis, filter_any_coast(&pipe.filter[axis]));
        }
    }
    for (uint8_t axis = 0; axis < AXES; axis++) {
        noise_gap(&pipe.noise[axis]);
    }
}

static void filter_axis(uint8_t axis, int16_t lsb)
{
    filter_any_t *filter = &pipe.filter[axis];
    bool clipped = lsb >= pipe.rail_high_lsb || lsb <= (int16_t)(-pipe.rail_high_lsb - 1);
    if (clipped) {
        pipe.flags |= ROW_CLIPPED;
    } else if (noise_update(&pipe.noise[axis], lsb)) {
        filter_any_set_noise(filter, noise_r_lsb2_q8(&pipe.noise[axis]));
    }
    keep_estimate(axis, filter_any_update(filter, lsb));
    collect_flags(filter_any_flags(filter));
    pipe.lsb[axis] = lsb;
}

static void count_sample(void)
{
    count(COUNT_SAMPLES);
    if ((pipe.flags & (ROW_GATED | ROW_REACQUIRED | ROW_CLIPPED)) == 0) {
        return;
    }
    if (pipe.flags & ROW_GATED) {
        count(COUNT_GATED);
    }
    if (pipe.flags & ROW_REACQUIRED) {
        count(COUNT_REACQUIRED);
    }
    if (pipe.flags & ROW_CLIPPED) {
        count(COUNT_CLIPPED);
    }
}

void pipeline_sample(const adxl345_sample_t *sample, uint32_t period_us)
{
    uint16_t kept = pipe.flags;
    pipe.flags = 0;
    coast_over_gap(sample->t_us, period_us);
    pipe.last_us = sample->t_us;
    pipe.has_sample = true;
    pipe.changed = false;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        filter_axis(axis, sample->lsb[axis]);
    }
    if (!tilt_gravity_plausible(pipe.estimate_q8[0], pipe.estimate_q8[1], pipe.estimate_q8[2])) {
        pipe.flags |= ROW_NOT_GRAVITY;
    }
    count_sample();
    pipe.flags |= kept;
}

void pipeline_flag(uint16_t flags)
{
    pipe.flags |= flags;
}

/* LSB/256 to mg: x 1000 / 256, rounded half up; |estimate_q8 x 1000| < 2^31 because |estimate| <= 4608 LSB. */
static int16_t to_mg(int32_t value_q8)
{
    return (int16_t)((value_q8 * 1000 + 32768) >> 16);
}

static void fill_row(row_t *row)
{
    for (uint8_t axis = 0; axis < AXES; axis++) {
        row->lsb[axis] = pipe.lsb[axis];
        row->mg[axis] = to_mg(pipe.estimate_q8[axis]);
    }
    tilt_angles(&pipe.tilt, pipe.estimate_q8[0], pipe.estimate_q8[1], pipe.estimate_q8[2]);
    row->roll_cdeg = pipe.tilt.roll_cdeg;
    row->pitch_cdeg = pipe.tilt.pitch_cdeg;
    row->flags = pipe.flags;
    row->flags |= pipe.tilt.roll_undefined ? ROW_ROLL_UNDEFINED : 0u;
    row->flags |= pipe.warm_rows != 0 ? ROW_WARMING_UP : 0u;
}

void pipeline_row(row_t *row)
{
    fill_row(row);
    row->t_us = pipe.last_us;
}

void pipeline_held_row(row_t *row, uint32_t now_us)
{
    fill_row(row);
    row->t_us = now_us;
    row->flags |= ROW_COASTED | ROW_FAULT;
}

void pipeline_row_done(void)
{
    pipe.flags = 0;
    if (pipe.warm_rows != 0) {
        pipe.warm_rows--;
    }
}

void pipeline_raw_angles(int16_t *roll_cdeg, int16_t *pitch_cdeg)
{
    tilt_angles(&pipe.raw_tilt, (int32_t)pipe.lsb[0] * 256, (int32_t)pipe.lsb[1] * 256, (int32_t)pipe.lsb[2] * 256);
    *roll_cdeg = pipe.raw_tilt.roll_cdeg;
    *pitch_cdeg = pipe.raw_tilt.pitch_cdeg;
}
