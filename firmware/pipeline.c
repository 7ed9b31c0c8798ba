/*
 * The sample path of main; how filters begin and change is in pipeline_change.c. Its cycles: sample_total in
 * docs/benchmarks.md.
 */
#include "pipeline.h"

#include "counters.h"
#include "fx.h"
#include "parameters.h"
#include "pipeline_state.h"
#include "silence.h"
#include "supervisor.h"

enum { AWAY_SAMPLES = 2 };  /* on end, away from what was held: no bad reading */
enum { HUNG_SAMPLES = 16 }; /* with ROW_STUCK, on end: a filter has learned from them */

pipeline_t pipeline;

FX_ONCE int32_t estimate_q8(const axis_t *axis)
{
    return (axis->filter.x_lsb_q16 + 128) >> 8;
}

FX_ONCE int16_t estimate_lsb(const axis_t *axis)
{
    return (int16_t)((estimate_q8(axis) + 128) >> 8);
}

void pipeline_reset(void)
{
    pipeline.tilt = (tilt_t){ 0, 0, false };
    pipeline.raw_tilt = pipeline.tilt;
    pipeline.flags = 0;
#if SUPERVISOR
    supervisor_reset();
#endif
}

FX_ONCE void pipeline_coast(uint32_t t_us)
{
    silence_step(pipeline.true_dhz);
    pipeline.newest.t_us = t_us;
    pipeline_flag(silence_samples() == SILENCE_FAULT_FROM ? ROW_COASTED | ROW_FAULT : ROW_COASTED);
    pipeline.work = WORK_COAST;
}

static void coast_axis(axis_t *axis)
{
    (void)filter_missing(&axis->filter);
    noise_gap(&axis->noise);
    if (axis->filter.flags & FILTER_WARMING_UP) {
        pipeline_flag(ROW_WARMING_UP);
    }
    if (axis->filter.quarters == FILTER_HOLD_MS / 25) {
        axis->away = 1;
    }
}

uint32_t pipeline_newest_us(void)
{
    return pipeline.newest.t_us;
}

uint32_t axis_r_lsb2_q8(const axis_t *axis)
{
    uint32_t set_lsb2_q8 = parameters_r_lsb2_q8();
    return set_lsb2_q8 != 0 ? set_lsb2_q8 : noise_r_lsb2_q8(&axis->noise);
}

/* Within 2.8 sigmas of the estimate, by the R of the noise, which is 3.5 of a healthy sensor's. */
static bool near_estimate(const axis_t *axis, int16_t lsb)
{
    int16_t off_lsb = (int16_t)(lsb - estimate_lsb(axis));
    uint16_t size_lsb = (uint16_t)(off_lsb < 0 ? -off_lsb : off_lsb);
    return fx_mul_u16(size_lsb, size_lsb) <= noise_r_lsb2_q8(&axis->noise) >> 5;
}

/*
 * After a hold. True: the filter takes the sample; near the estimate it goes on from what was held. A single one away
 * from it may be a bad reading: with the second in a row that is not at the rail the filter restarts, with the noise as
 * it is known.
 */
static bool rejoins(axis_t *axis, int16_t lsb, uint8_t *flags)
{
    if (!near_estimate(axis, lsb)) {
        if ((*flags & ROW_CLIPPED) != 0 || axis->away++ < AWAY_SAMPLES) {
            *flags |= ROW_GATED;
            return false;
        }
        *flags |= ROW_REACQUIRED;
        filter_restart(&axis->filter);
    }
    axis->away = 0;
    return true;
}

_Static_assert((int)FILTER_GATED == (int)ROW_GATED && (int)FILTER_REACQUIRED == (int)ROW_REACQUIRED, "same bits");

static uint8_t update_axis(axis_t *axis, int16_t lsb)
{
    (void)filter_update(&axis->filter, lsb);
    uint8_t flags = axis->filter.flags;
    if (SUPERVISOR && (flags & FILTER_SWITCHED) != 0) {
        pipeline_flag(ROW_SWITCHED);
    }
    uint8_t same = flags & (FILTER_GATED | FILTER_REACQUIRED);
    return (flags & FILTER_WARMING_UP) ? same | ROW_WARMING_UP : same;
}

/* Returns those flags of the row that a byte holds. */
static uint8_t sample_axis(axis_t *axis, int16_t lsb)
{
    uint8_t flags = 0;
    if (lsb >= pipeline.rail_high_lsb || lsb <= (int16_t)(-pipeline.rail_high_lsb - 1)) {
        flags = ROW_CLIPPED;
    } else if (noise_update(&axis->noise, lsb)) {
        filter_set_noise(&axis->filter, axis_r_lsb2_q8(axis));
    }
    if (axis->away == 0 || rejoins(axis, lsb, &flags)) {
        flags |= update_axis(axis, lsb);
    }
    return flags;
}

static void count_sample(uint8_t flags)
{
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

void pipeline_calibrate(const calibration_t *calibration)
{
#if SUPERVISOR
    pipeline.calibration = calibration;
#endif
    (void)calibration_prepare(&pipeline.applied, calibration);
}

/* Once for the sample, or the missing one, because it is dear: the row takes what the check of gravity took. */
static void find_accelerations(void)
{
    int32_t estimates_q8[AXES];
    for (uint8_t axis = 0; axis < AXES; axis++) {
        estimates_q8[axis] = estimate_q8(&pipeline.axes[axis]);
    }
#if SUPERVISOR
    supervisor_complete(estimates_q8);
#endif
    calibration_apply(&pipeline.applied, estimates_q8, pipeline.a_q8);
}

static void end_sample(uint8_t flags)
{
    if (!tilt_gravity_plausible(pipeline.a_q8)) {
        pipeline_flag(ROW_NOT_GRAVITY);
    }
    pipeline_flag(flags);
    count_sample(flags);
    pipeline.has_sample = true;
}

/*
 * Counts what a sensor that hangs repeats. True: it has come back, and what the filters have learned of the noise was
 * that of readings without any, so that they would refuse what comes now.
 */
static bool hung(void)
{
    bool stuck = pipeline.is_stuck;
    bool back = pipeline.stuck == HUNG_SAMPLES && !stuck;
    if (!stuck) {
        pipeline.stuck = 0;
    } else if (pipeline.stuck != HUNG_SAMPLES) {
        pipeline.stuck++;
    }
    return back;
}

/* Apart: it needs every register, and most calls of pipeline_work find nothing to do. */
FX_NOINLINE void filter_axes(void)
{
    bool sample = pipeline.work == WORK_SAMPLE;
    uint8_t flags = 0;
    const int16_t *lsb = pipeline.newest.lsb;
    for (axis_t *axis = pipeline.axes; axis != pipeline.axes + AXES; axis++) {
        if (sample) {
            flags |= sample_axis(axis, *lsb++);
        } else {
            coast_axis(axis);
        }
    }
    find_accelerations();
    if (sample) {
        end_sample(flags);
    }
    pipeline.work = WORK_NONE;
}

bool pipeline_work(void)
{
    if (begin_next()) {
        return true;
    }
    if (pipeline.work == WORK_NONE) {
        return false;
    }
    if (pipeline.work == WORK_SAMPLE && hung()) {
        begin_all(true);
    } else {
        filter_axes();
    }
    return true;
}

void pipeline_finish(void)
{
    while (pipeline_work()) {
    }
}

void pipeline_sample(const adxl345_sample_t *sample)
{
    pipeline.is_stuck = false;
    silence_end();
#if SUPERVISOR
    supervisor_look(sample->lsb);
#endif
    pipeline.newest = *sample;
    pipeline.work = WORK_SAMPLE;
    pipeline.turn = true;
}

FX_ONCE void pipeline_flag(uint16_t flags)
{
    pipeline.flags |= flags;
    if (flags & ROW_STUCK) {
        pipeline.is_stuck = true;
    }
}

/*
 * 1/256 g in Q8 to mg: x 1000 / 256, rounded half up. Limited to 32 g, so that the product fits 32 bits and mg 16: 18 g
 * on all axes of a weak part can come to 41 g on one of a carrier that lies across. By the high word, which is cheap.
 */
static int16_t to_mg(int32_t value_q8)
{
    uint16_t above_least = (uint16_t)(((uint32_t)value_q8 >> 16) + 0x20U);
    if (above_least >= 0x40U) {
        return value_q8 < 0 ? -32000 : 32000;
    }
    return (int16_t)((value_q8 * 1000 + 32768) >> 16);
}

void pipeline_row(row_t *row)
{
    row->t_us = pipeline.newest.t_us;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        row->lsb[axis] = pipeline.newest.lsb[axis];
    }
    tilt_angles(&pipeline.tilt, pipeline.a_q8);
    row->roll_cdeg = pipeline.tilt.roll_cdeg;
    row->pitch_cdeg = pipeline.tilt.pitch_cdeg;
    row->flags = pipeline.flags;
    row->flags |= pipeline.tilt.roll_undefined ? ROW_ROLL_UNDEFINED : 0u;
    row->flags |= pipeline.warm_rows != 0 ? ROW_WARMING_UP : 0u;
}

void pipeline_mg(int16_t mg[3])
{
    for (uint8_t axis = 0; axis < AXES; axis++) {
        mg[axis] = to_mg(pipeline.a_q8[axis]);
    }
}

void pipeline_row_done(void)
{
    pipeline.flags = 0;
    if (pipeline.warm_rows != 0) {
        pipeline.warm_rows--;
    }
}

void pipeline_raw_angles(int16_t *roll_cdeg, int16_t *pitch_cdeg)
{
    int32_t readings_q8[AXES];
    int32_t a_q8[AXES];
    for (uint8_t axis = 0; axis < AXES; axis++) {
        readings_q8[axis] = (int32_t)pipeline.newest.lsb[axis] * 256;
    }
    calibration_apply(&pipeline.applied, readings_q8, a_q8);
    tilt_angles(&pipeline.raw_tilt, a_q8);
    *roll_cdeg = pipeline.raw_tilt.roll_cdeg;
    *pitch_cdeg = pipeline.raw_tilt.pitch_cdeg;
}
