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
enum { CALLS_OFF = 5, STILL_LSB_Q2 = 18 }; /* pipeline_retime; 1 degree */
enum { AWAY_SAMPLES = 2 };                 /* on end, away from what was held: no bad reading */
enum { HUNG_SAMPLES = 16 };                /* with ROW_STUCK, on end: a filter has learned from them */

typedef enum {
    WORK_NONE,
    WORK_SAMPLE, /* through the filter of each axis */
    WORK_RENEW,  /* amid a sample: its axis gets a filter that begins anew */
    WORK_COAST,  /* the filter of each axis predicts */
    WORK_CHANGE  /* each axis gets its new filter */
} work_t;

typedef struct {
    int32_t estimate_q8;
    uint16_t looked_lsb_q2; /* the estimate a second ago */
    int16_t lsb;
    uint8_t away; /* after a hold: 1, and 1 more for each sample that lies away from what was held; else 0 */
    noise_t noise;
    filter_any_t filter;
} axis_t;

static struct {
    axis_t axes[AXES];
    tilt_t tilt;
    tilt_t raw_tilt;
    uint32_t last_us;
    int16_t rail_high_lsb;
    uint16_t rate_dhz; /* nominal */
    uint16_t true_dhz; /* that the filters have */
    uint8_t calls_off;
    uint16_t flags;
    uint16_t kept_flags; /* of the samples before the one under way */
    uint8_t passed;      /* times 25 ms, between the newest two steps of a silence */
    uint8_t warm_rows;
    uint8_t work; /* work_t */
    uint8_t axis; /* that the work goes on with */
    uint8_t step; /* of the change on that axis */
    uint8_t new_kind;
    bool new_noise;
    bool clipped;  /* the reading of this axis */
    uint8_t stuck; /* samples with ROW_STUCK on end before this one, up to HUNG_SAMPLES */
    bool has_sample;
} pipe;

/* The axis that the work goes on with. */
static axis_t *axis_now(void)
{
    axis_t *axis = &pipe.axes[pipe.axis];
    FX_FENCE_OF(axis); /* else its address is computed anew at each use */
    return axis;
}

FX_NOINLINE void keep_estimate(axis_t *axis, int32_t x_lsb_q16)
{
    axis->estimate_q8 = (x_lsb_q16 + 128) >> 8;
}

static int16_t estimate_lsb(const axis_t *axis)
{
    return (int16_t)((axis->estimate_q8 + 128) >> 8);
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
    pipe.stuck = keep ? pipe.stuck : 0;
    pipe.warm_rows = WARM_ROWS;
    pipe.rail_high_lsb = (int16_t)(range_g * 256U - 1U);
    change(cold);
}

FX_ONCE void pipeline_retime(uint32_t period_us)
{
    bool still = true;
    for (axis_t *axis = pipe.axes; axis != pipe.axes + AXES; axis++) {
        uint16_t now_lsb_q2 = (uint16_t)(axis->estimate_q8 >> 6);
        still = (uint16_t)(now_lsb_q2 - axis->looked_lsb_q2 + STILL_LSB_Q2) <= 2u * STILL_LSB_Q2 && still;
        axis->looked_lsb_q2 = now_lsb_q2;
    }
    uint16_t true_dhz = (uint16_t)(UINT32_C(10000000) / period_us);
    uint16_t near_dhz = (pipe.true_dhz >> 7) + 1u;
    if ((uint16_t)(true_dhz - pipe.true_dhz + near_dhz) <= (uint16_t)(2u * near_dhz)) {
        pipe.calls_off = 0;
    } else if (pipe.calls_off < CALLS_OFF) {
        pipe.calls_off++;
    } else if (still) {
        pipe.true_dhz = true_dhz;
        change(false);
    }
}

/* Initialised, then told its R, then settled where there is an output to go on from. True: that axis is done. */
static bool change_axis(void)
{
    enum { STEP_INIT, STEP_NOISE, STEP_RESET };
    axis_t *axis = axis_now();
    uint8_t step = pipe.step++;
    if (step == STEP_INIT) {
        if (pipe.new_noise) {
            noise_init(&axis->noise, pipe.rate_dhz, pipe.axis == 2);
        }
        filter_any_start(&axis->filter, (filter_kind_t)pipe.new_kind, pipe.true_dhz);
        return false;
    }
    if (step == STEP_NOISE) {
        filter_any_set_noise(&axis->filter, noise_r_lsb2_q8(&axis->noise));
        if (pipe.has_sample) {
            return false;
        }
        axis->away = 0;
        return true;
    }
    return !filter_any_reset_step(&axis->filter, estimate_lsb(axis), (uint8_t)(step - STEP_RESET));
}

FX_NOINLINE void change_step(void)
{
    if (!change_axis()) {
        return;
    }
    pipe.step = 0;
    if (++pipe.axis == AXES) {
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

FX_ONCE void pipeline_coast(uint32_t t_us)
{
    pipe.passed = silence_step(pipe.rate_dhz);
    pipe.last_us = t_us;
    pipeline_flag(silence_samples() == SILENCE_FAULT_FROM ? ROW_COASTED | ROW_FAULT : ROW_COASTED);
    pipe.work = WORK_COAST;
    pipe.axis = 0;
}

static void coast_axis(axis_t *axis)
{
    bool holds = silence_holds();
    if (!holds) {
        if (silence_samples() == 1u) {
            filter_any_gap(&axis->filter);
        }
        for (uint8_t left = pipe.passed; left != 0; left--) {
            filter_any_damp(&axis->filter);
        }
        keep_estimate(axis, filter_any_coast(&axis->filter));
        noise_gap(&axis->noise);
    }
    axis->away = holds && pipe.has_sample;
}

uint32_t pipeline_newest_us(void)
{
    return pipe.last_us;
}

/* Within 2.8 sigmas of the estimate, by the R of the noise, which is 3.5 of a healthy sensor's. */
static bool near_estimate(const axis_t *axis)
{
    int16_t off_lsb = (int16_t)(axis->lsb - estimate_lsb(axis));
    uint16_t size_lsb = (uint16_t)(off_lsb < 0 ? -off_lsb : off_lsb);
    return fx_mul_u16(size_lsb, size_lsb) <= noise_r_lsb2_q8(&axis->noise) >> 5;
}

/*
 * Amid a sample, the filter of its axis begins anew. From the estimate, where the noise that it has learned was that of
 * a sensor that hung: none, so that it would refuse what comes now. Else on the sample, with the noise as it is known.
 */
static void renew(bool from_estimate)
{
    pipe.work = WORK_RENEW;
    pipe.step = 0;
    pipe.new_noise = from_estimate;
    pipe.has_sample = from_estimate;
    pass.limit = PASS_CHANGING_US / HAL_LAP_US;
}

/*
 * After a hold. True: the filter takes the sample; near the estimate it goes on from what was held. A single one away
 * from it may be a bad reading: with the second on end that is not at the rail the filter begins anew, with the noise
 * as it is known. That is work of its own, amid the sample's.
 */
static bool rejoins(axis_t *axis)
{
    if (!near_estimate(axis)) {
        if (pipe.clipped || axis->away++ < AWAY_SAMPLES) {
            pipeline_flag(ROW_GATED);
            return false;
        }
        pipeline_flag(ROW_REACQUIRED);
        renew(false);
    }
    axis->away = 0;
    return true;
}

_Static_assert((int)FILTER_GATED == (int)ROW_GATED && (int)FILTER_REACQUIRED == (int)ROW_REACQUIRED, "same bits");

static void update_axis(axis_t *axis)
{
    keep_estimate(axis, filter_any_update(&axis->filter, axis->lsb));
    uint8_t flags = filter_any_flags(&axis->filter);
    uint8_t same = flags & (FILTER_GATED | FILTER_REACQUIRED);
    pipeline_flag((uint16_t)((flags & FILTER_WARMING_UP) ? same | ROW_WARMING_UP : same));
    if (pipe.clipped) {
        filter_any_hold(&axis->filter);
    }
}

/* What comes before the filter of an axis; false: it does not take the sample, or begins anew before it does. */
static bool prepare_axis(axis_t *axis)
{
    int16_t lsb = axis->lsb;
    bool clipped = lsb >= pipe.rail_high_lsb || lsb <= (int16_t)(-pipe.rail_high_lsb - 1);
    pipe.clipped = clipped;
    if (clipped) {
        pipeline_flag(ROW_CLIPPED);
        filter_any_hold(&axis->filter);
    }
    if (pipe.stuck == HUNG_SAMPLES && !(pipe.flags & ROW_STUCK)) {
        renew(true);
        return false;
    }
    if (!clipped && noise_update(&axis->noise, lsb)) {
        filter_any_set_noise(&axis->filter, noise_r_lsb2_q8(&axis->noise));
    }
    return axis->away == 0 || (rejoins(axis) && pipe.work != WORK_RENEW);
}

static void count_sample(void)
{
    uint8_t flags = (uint8_t)pipe.flags;
    count(COUNT_SAMPLES);
    if (flags & ROW_GATED) {
        count(COUNT_GATED);
    }
    if (flags & ROW_REACQUIRED) {
        count(COUNT_REACQUIRED);
    }
    if (flags & ROW_CLIPPED) {
        count(COUNT_CLIPPED);
    }
}

static void end_sample(void)
{
    if (!tilt_gravity_plausible(pipe.axes[0].estimate_q8, pipe.axes[1].estimate_q8, pipe.axes[2].estimate_q8)) {
        pipeline_flag(ROW_NOT_GRAVITY);
    }
    count_sample();
    if ((pipe.flags & ROW_STUCK) == 0) {
        pipe.stuck = 0;
    } else if (pipe.stuck != HUNG_SAMPLES) {
        pipe.stuck++;
    }
    pipeline_flag(pipe.kept_flags);
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
    axis_t *axis = axis_now();
    if (pipe.work == WORK_COAST) {
        coast_axis(axis);
    } else if (pipe.work == WORK_SAMPLE ? prepare_axis(axis) : renewed()) {
        update_axis(axis);
    } else if (pipe.work == WORK_RENEW) {
        return;
    }
    if (++pipe.axis == AXES) {
        if (pipe.work == WORK_SAMPLE) {
            end_sample();
        }
        pipe.work = WORK_NONE;
    }
}

/* Apart: it needs every register, and most calls of pipeline_work find nothing to do. */
FX_NOINLINE void axis_steps(void)
{
    do {
        axis_step();
    } while (pipe.work != WORK_NONE && pass_in_time());
}

bool pipeline_work(void)
{
    if (pipe.work == WORK_NONE) {
        return false;
    }
    if (pipe.work == WORK_CHANGE) {
        change_step();
    } else {
        axis_steps();
    }
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
        pipe.axes[axis].lsb = sample->lsb[axis];
    }
    pipe.work = WORK_SAMPLE;
    pipe.axis = 0;
}

FX_ONCE void pipeline_flag(uint16_t flags)
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
        row->lsb[axis] = pipe.axes[axis].lsb;
        row->mg[axis] = to_mg(pipe.axes[axis].estimate_q8);
    }
    tilt_angles(&pipe.tilt, pipe.axes[0].estimate_q8, pipe.axes[1].estimate_q8, pipe.axes[2].estimate_q8);
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
    tilt_angles(&pipe.raw_tilt, (int32_t)pipe.axes[0].lsb * 256, (int32_t)pipe.axes[1].lsb * 256,
                (int32_t)pipe.axes[2].lsb * 256);
    *roll_cdeg = pipe.raw_tilt.roll_cdeg;
    *pitch_cdeg = pipe.raw_tilt.pitch_cdeg;
}
