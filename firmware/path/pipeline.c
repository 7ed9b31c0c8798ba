/*
 * The sample path of main; how filters begin and change is in pipeline_change.c. Its cycles: sample_total in
 * docs/benchmarks.md.
 */
#include "path/pipeline.h"

#include "base/counters.h"
#include "fx.h"
#include "path/pipeline_state.h"
#include "path/silence.h"
#include "path/supervisor.h"
#include "settings/parameters.h"

enum { HUNG_SAMPLES = 16 }; /* with ROW_STUCK, on end: a filter has learned from them */

_Static_assert((int)TILT_GATED == (int)ROW_GATED && (int)TILT_COASTED == (int)ROW_COASTED &&
                   (int)TILT_REACQUIRED == (int)ROW_REACQUIRED && (int)TILT_CLIPPED == (int)ROW_CLIPPED &&
                   (int)TILT_WARMING_UP == (int)ROW_WARMING_UP,
               "same bits");

pipeline_t pipeline;

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

uint32_t pipeline_newest_us(void)
{
    return pipeline.newest.t_us;
}

uint32_t axis_r_lsb2_q8(const tilt_axis_t *axis)
{
    uint32_t set_lsb2_q8 = parameters_r_lsb2_q8();
    return set_lsb2_q8 != 0 ? set_lsb2_q8 : filter_noise_r_lsb2_q8(&axis->noise);
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
        estimates_q8[axis] = tilt_axis_estimate_q8(&pipeline.axes[axis]);
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
    bool own_r = parameters_r_lsb2_q8() != 0;
    uint8_t flags = 0;
    const int16_t *lsb = pipeline.newest.lsb;
    for (tilt_axis_t *axis = pipeline.axes; axis != pipeline.axes + AXES; axis++) {
        if (!sample) {
            flags |= tilt_axis_missing(axis);
            continue;
        }
        flags |= tilt_axis_update(axis, *lsb++, pipeline.rail_high_lsb, own_r);
        if (SUPERVISOR && (axis->filter.flags & FILTER_SWITCHED) != 0) {
            pipeline_flag(ROW_SWITCHED);
        }
    }
    pipeline_flag(flags);
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
    pipeline_mg(row->mg);
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
