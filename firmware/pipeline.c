/* The sample path of main. Its cycles: sample_total in docs/benchmarks.md. */
#include "pipeline.h"

#include "counters.h"
#include "filter_any.h"
#include "fx.h"
#include "noise.h"
#include "pass.h"
#include "silence.h"
#include "tilt.h"

enum { AXES = 3, WARM_ROWS = 5 };
enum { CALLS_OFF = 5, STILL_LSB_Q4 = 72 }; /* pipeline_retime; 1 degree */

typedef enum {
    WORK_NONE,
    WORK_SAMPLE, /* through the filter of each axis */
    WORK_RENEW,  /* amid a sample: its axis gets a filter that begins anew */
    WORK_COAST,  /* the filter of each axis predicts */
    WORK_CHANGE  /* each axis gets its new filter */
} work_t;

enum { AWAY_SAMPLES = 2 }; /* on end, away from what was held: no bad reading */

pass_t pass;

static struct {
    filter_any_t filter[AXES];
    noise_t noise[AXES];
    tilt_t tilt;
    tilt_t raw_tilt;
    uint32_t last_us;
    int32_t estimate_q8[AXES];
    int16_t lsb[AXES];
    int16_t rail_high_lsb;
    uint16_t rate_dhz;      /* nominal */
    uint16_t true_dhz;      /* that the filters have */
    uint16_t looked_lsb_q4; /* the estimates in sum, a second ago */
    uint8_t calls_off;
    uint16_t flags;
    uint16_t kept_flags; /* of the samples before the one under way */
    uint8_t passed;      /* times 25 ms, between the newest two steps of a silence */
    uint8_t away[AXES];  /* after a hold: 1, and 1 more for each sample that lies away from what was held; else 0 */
    uint8_t warm_rows;
    uint8_t work; /* work_t */
    uint8_t axis; /* that the work goes on with */
    uint8_t step; /* of the change on that axis */
    uint8_t new_kind;
    bool new_noise;
    bool clipped; /* the reading of this axis */
    bool has_sample;
} pipe;

FX_NOINLINE void keep_estimate(uint8_t axis, int32_t x_lsb_q16)
{
    pipe.estimate_q8[axis] = (x_lsb_q16 + 128) >> 8;
}

void pipeline_reset(void)
{
    pipe.tilt = (tilt_t){ 0, 0, false };
    pipe.raw_tilt = pipe.tilt;
    pipe.flags = 0;
}

static void change(bool new_noise)
{
    pipe.new_noise = new_noise;
    pipe.work = WORK_CHANGE;
    pipe.axis = 0;
    pipe.step = 0;
    pass.limit = PASS_CHANGING_US / HAL_LAP_US;
}

/* keep: the filters go on from the old output, the noise estimates too unless the rate is new. */
static void begin(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g, bool keep)
{
    bool cold = !keep || rate_dhz != pipe.rate_dhz;
    if (cold) {
        pipe.true_dhz = rate_dhz;
        pipe.calls_off = 0;
    }
    pipe.new_kind = filter_kind;
    pipe.rate_dhz = rate_dhz;
    pipe.has_sample = keep;
    pipe.warm_rows = WARM_ROWS;
    pipe.rail_high_lsb = (int16_t)(range_g * 256U - 1U);
    change(cold);
}

FX_ONCE void pipeline_retime(uint32_t period_us)
{
    uint16_t now_lsb_q4 = (uint16_t)((pipe.estimate_q8[0] + pipe.estimate_q8[1] + pipe.estimate_q8[2]) >> 4);
    uint16_t moved_lsb_q4 = (uint16_t)(now_lsb_q4 - pipe.looked_lsb_q4 + STILL_LSB_Q4);
    pipe.looked_lsb_q4 = now_lsb_q4;
    uint16_t true_dhz = (uint16_t)(UINT32_C(10000000) / period_us);
    uint16_t near_dhz = (pipe.true_dhz >> 7) + 1u;
    if ((uint16_t)(true_dhz - pipe.true_dhz + near_dhz) <= (uint16_t)(2u * near_dhz)) {
        pipe.calls_off = 0;
    } else if (pipe.calls_off < CALLS_OFF) {
        pipe.calls_off++;
    } else if (moved_lsb_q4 <= 2u * STILL_LSB_Q4) {
        pipe.true_dhz = true_dhz;
        change(false);
    }
}

/* Initialised, then told its R, then settled where there is an output to go on from. True: that axis is done. */
static bool change_axis(void)
{
    enum { STEP_INIT, STEP_NOISE, STEP_RESET };
    uint8_t axis = pipe.axis;
    filter_any_t *filter = &pipe.filter[axis];
    noise_t *noise = &pipe.noise[axis];
    FX_FENCE_OF(filter); /* else both addresses are computed anew at each use */
    FX_FENCE_OF(noise);
    uint8_t step = pipe.step++;
    if (step == STEP_INIT) {
        if (pipe.new_noise) {
            noise_init(noise, pipe.rate_dhz, axis == 2);
        }
        filter_any_start(filter, (filter_kind_t)pipe.new_kind, pipe.true_dhz);
        return false;
    }
    if (step == STEP_NOISE) {
        filter_any_set_noise(filter, noise_r_lsb2_q8(noise));
        if (pipe.has_sample) {
            return false;
        }
        pipe.away[axis] = 0;
        return true;
    }
    int16_t lsb = (int16_t)((pipe.estimate_q8[axis] + 128) >> 8);
    return !filter_any_reset_step(filter, lsb, (uint8_t)(step - STEP_RESET));
}

FX_NOINLINE void change_step(void)
{
    if (!change_axis()) {
        return;
    }
    pipe.step = 0;
    pipe.axis++;
    if (pipe.axis == AXES) {
        pipe.work = WORK_NONE;
        pass.limit = PASS_US / HAL_LAP_US;
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

FX_ONCE void pipeline_coast(uint32_t t_us)
{
    pipe.passed = silence_step(pipe.rate_dhz);
    pipe.last_us = t_us;
    pipe.flags |= ROW_COASTED;
    if (silence_samples() == SILENCE_FAULT_FROM) {
        pipe.flags |= ROW_FAULT;
    }
    pipe.work = WORK_COAST;
    pipe.axis = 0;
}

static void coast_axis(uint8_t axis)
{
    bool holds = silence_holds();
    if (!holds) {
        if (silence_samples() == 1u) {
            filter_any_gap(&pipe.filter[axis]);
        }
        for (uint8_t left = pipe.passed; left != 0; left--) {
            filter_any_damp(&pipe.filter[axis]);
        }
        keep_estimate(axis, filter_any_coast(&pipe.filter[axis]));
        noise_gap(&pipe.noise[axis]);
    }
    pipe.away[axis] = holds && pipe.has_sample;
}

uint32_t pipeline_newest_us(void)
{
    return pipe.last_us;
}

/* Within 2.8 sigmas of the estimate, by the R of the noise, which is 3.5 of a healthy sensor's. */
static bool near_estimate(uint8_t axis, int16_t lsb)
{
    int16_t off_lsb = (int16_t)(lsb - (int16_t)((pipe.estimate_q8[axis] + 128) >> 8));
    uint16_t size_lsb = (uint16_t)(off_lsb < 0 ? -off_lsb : off_lsb);
    return fx_mul_u16(size_lsb, size_lsb) <= noise_r_lsb2_q8(&pipe.noise[axis]) >> 5;
}

/*
 * After a hold. True: the filter takes the sample; near the estimate it goes on from what was held. A single one away
 * from it may be a bad reading: with the second on end that is not at the rail the filter begins anew, with the noise
 * as it is known. That is work of its own, amid the sample's.
 */
static bool rejoins(uint8_t axis, int16_t lsb)
{
    if (!near_estimate(axis, lsb)) {
        if (pipe.clipped || pipe.away[axis]++ < AWAY_SAMPLES) {
            pipe.flags |= ROW_GATED;
            return false;
        }
        pipe.flags |= ROW_REACQUIRED;
        pipe.work = WORK_RENEW;
        pipe.step = 0;
        pipe.new_noise = false;
        pipe.has_sample = false;
        pass.limit = PASS_CHANGING_US / HAL_LAP_US;
    }
    pipe.away[axis] = 0;
    return true;
}

static void update_axis(uint8_t axis)
{
    filter_any_t *filter = &pipe.filter[axis];
    keep_estimate(axis, filter_any_update(filter, pipe.lsb[axis]));
    collect_flags(filter_any_flags(filter));
    if (pipe.clipped) {
        filter_any_hold(filter);
    }
}

/* What comes before the filter of an axis; false: it does not take the sample, or begins anew before it does. */
static bool prepare_axis(uint8_t axis)
{
    int16_t lsb = pipe.lsb[axis];
    bool clipped = lsb >= pipe.rail_high_lsb || lsb <= (int16_t)(-pipe.rail_high_lsb - 1);
    pipe.clipped = clipped;
    if (clipped) {
        pipe.flags |= ROW_CLIPPED;
        filter_any_hold(&pipe.filter[axis]);
    } else if (noise_update(&pipe.noise[axis], lsb)) {
        filter_any_set_noise(&pipe.filter[axis], noise_r_lsb2_q8(&pipe.noise[axis]));
    }
    return pipe.away[axis] == 0 || (rejoins(axis, lsb) && pipe.work != WORK_RENEW);
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

static void end_sample(void)
{
    if (!tilt_gravity_plausible(pipe.estimate_q8[0], pipe.estimate_q8[1], pipe.estimate_q8[2])) {
        pipe.flags |= ROW_NOT_GRAVITY;
    }
    count_sample();
    pipe.flags |= pipe.kept_flags;
}

static bool renewed(void)
{
    if (!change_axis()) {
        return false;
    }
    pipe.work = WORK_SAMPLE;
    pipe.has_sample = true;
    pass.limit = PASS_US / HAL_LAP_US;
    return true;
}

/* One axis of a sample, or of one that is missing; a part of it while its filter begins anew. */
static void axis_step(void)
{
    uint8_t axis = pipe.axis;
    if (pipe.work == WORK_COAST) {
        coast_axis(axis);
    } else if (pipe.work == WORK_SAMPLE ? prepare_axis(axis) : renewed()) {
        update_axis(axis);
    } else if (pipe.work == WORK_RENEW) {
        return;
    }
    axis++;
    pipe.axis = axis;
    if (axis == AXES) {
        if (pipe.work == WORK_SAMPLE) {
            end_sample();
        }
        pipe.work = WORK_NONE;
    }
}

bool pipeline_work(void)
{
    if (pipe.work == WORK_NONE) {
        return false;
    }
    if (pipe.work == WORK_CHANGE) {
        change_step();
        return true;
    }
    do {
        axis_step();
    } while (pipe.work != WORK_NONE && pass_in_time());
    return true;
}

bool pipeline_changing(void)
{
    return pipe.work == WORK_CHANGE;
}

void pipeline_finish(void)
{
    while (pipeline_work()) {
    }
}

void pipeline_sample(const adxl345_sample_t *sample)
{
    pipe.kept_flags = pipe.flags;
    pipe.flags = 0;
    silence_end();
    pipe.last_us = sample->t_us;
    pipe.has_sample = true;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        pipe.lsb[axis] = sample->lsb[axis];
    }
    pipe.work = WORK_SAMPLE;
    pipe.axis = 0;
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

void pipeline_row(row_t *row)
{
    row->t_us = pipe.last_us;
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
