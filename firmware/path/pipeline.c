/*
 * Main's sample path: starts and changes filters, gives them the true rate, and takes samples, or the places of missing
 * ones, through them. Cycles: sample_total in docs/results/benchmarks.md.
 */
#include "path/pipeline.h"

#include "base/choice.h"
#include "base/counters.h"
#include "machine.h"
#include "path/gravity.h"
#include "path/silence.h"
#include "path/supervisor.h"
#include "tilt_axis.h"

enum { AXES = 3, WARM_ROWS = 5 };
enum { HUNG_SAMPLES = 16 };                /* samples in a row with ROW_STUCK: a filter has learned from them */
enum { CALLS_OFF = 5, STILL_LSB_Q2 = 18 }; /* pipeline_second; 1 degree */
enum { SECOND_SAMPLES = ROW_FAULT };       /* in a second's flags: samples came, or were missing */

/* What pipeline_work is to take through the filters: a sample, or the place of a missing one. */
typedef enum { WORK_NONE, WORK_SAMPLE, WORK_COAST } work_t;

static struct pipeline {
    const filter_choice_t *choice;
    adxl345_sample_t newest; /* or the time of the missing one, with the last readings */
    tilt_t tilt;
    tilt_t raw_tilt;
    int16_t rail_high_lsb;
    uint16_t rate_dhz; /* nominal */
    uint16_t true_dhz; /* the rate that the filters have */
    uint8_t calls_off;
    uint16_t flags;
    uint8_t second_flags; /* those since the last second, and SECOND_SAMPLES */
    uint8_t warm_rows;
    uint8_t work;     /* work_t */
    uint8_t to_begin; /* axes that are still to get a new filter, the last of them first */
    bool cold;        /* all of them before the next sample, with a new noise estimate; else one with each sample */
    bool turn;        /* one of them now */
    uint8_t new_kind; /* filter_kind_t */
    bool own_r;       /* R is the user's, not the estimated one */
    bool is_stuck;    /* the newest sample has ROW_STUCK */
    uint8_t stuck;    /* samples with ROW_STUCK in a row before this one, up to HUNG_SAMPLES */
    bool has_sample;
    uint16_t looked_lsb_q2[AXES]; /* the estimates one second ago */
#if SUPERVISOR
    const calibration_t *calibration; /* the one in force */
#endif
    calibration_applied_t applied;
    tilt_axis_t axes[AXES];
} pipeline;

/* With its address in a register, each access takes half the code, but only within its first 64 bytes. */
static inline struct pipeline *here(void)
{
    struct pipeline *p = &pipeline;
    MACHINE_POINTER(p);
    return p;
}

_Static_assert((int)TILT_GATED == (int)ROW_GATED && (int)TILT_COASTED == (int)ROW_COASTED &&
                   (int)TILT_REACQUIRED == (int)ROW_REACQUIRED && (int)TILT_CLIPPED == (int)ROW_CLIPPED &&
                   (int)TILT_WARMING_UP == (int)ROW_WARMING_UP,
               "same bits");

void pipeline_reset(void)
{
    pipeline.tilt = (tilt_t){ 0, 0, false };
    pipeline.raw_tilt = pipeline.tilt;
    pipeline.flags = 0;
    pipeline.second_flags = 0;
    gravity_forget();
#if SUPERVISOR
    supervisor_reset();
#endif
}

void pipeline_coast(uint32_t t_us)
{
    silence_step(pipeline.true_dhz);
    pipeline.newest.t_us = t_us;
    pipeline_flag(silence_samples() == SILENCE_FAULT_FROM ? ROW_COASTED | ROW_FAULT : ROW_COASTED);
    pipeline.work = WORK_COAST;
}

bool pipeline_changed(void)
{
    return pipeline.to_begin == 0;
}

const tilt_axis_t *pipeline_axes(void)
{
    return pipeline.axes;
}

uint32_t pipeline_newest_us(void)
{
    return pipeline.newest.t_us;
}

/*
 * Filters that continue from an output are changed one per sample, so that a row waits for only one of them: a Kalman
 * filter takes up to 2.4 ms to settle. Otherwise, and if the noise is not known either, all are changed at once: no
 * sample comes meanwhile.
 */
static void begin_all(bool cold)
{
    struct pipeline *p = here();
    p->cold = cold;
    p->turn = cold;
    p->to_begin = AXES;
}

static void retime(uint32_t period_us, bool still)
{
    struct pipeline *p = here();
    uint16_t true_dhz = (uint16_t)(UINT32_C(10000000) / period_us);
    uint16_t near_dhz = (p->true_dhz >> 7) + 1u;
    if ((uint16_t)(true_dhz - p->true_dhz + near_dhz) <= (uint16_t)(2u * near_dhz)) {
        p->calls_off = 0;
    } else if (p->calls_off < CALLS_OFF) {
        p->calls_off++;
    } else if (still) {
        p->true_dhz = true_dhz;
        begin_all(false);
    }
}

/* Estimates are at most 4,608 LSB, so |a|^2 in Q4 is below 2^31. What disturbs a second's samples: its flags. */
void pipeline_second(uint32_t period_us)
{
    bool still = true;
    uint32_t square_lsb2_q4 = 0;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        int16_t now_lsb_q2 = (int16_t)(tilt_axis_estimate_q8(&pipeline.axes[axis]) >> 6);
        if ((uint16_t)((uint16_t)now_lsb_q2 - pipeline.looked_lsb_q2[axis] + STILL_LSB_Q2) > 2u * STILL_LSB_Q2) {
            still = false;
        }
        pipeline.looked_lsb_q2[axis] = (uint16_t)now_lsb_q2;
        square_lsb2_q4 += (uint32_t)((int32_t)now_lsb_q2 * now_lsb_q2);
    }
    retime(period_us, still);
    uint8_t seen = pipeline.second_flags & (ROW_COASTED | ROW_CLIPPED | SECOND_SAMPLES | ROW_STUCK | ROW_WARMING_UP);
    pipeline.second_flags = 0;
    if (seen == SECOND_SAMPLES) {
        gravity_second(still, (uint16_t)(square_lsb2_q4 >> 16));
    }
}

/* The filter continues from the old one's estimate, if there is one, or warms up. */
static MACHINE_APART void begin_axis(tilt_axis_t *axis)
{
    int16_t from_lsb = tilt_axis_estimate_lsb(axis);
    choice_begin(pipeline.choice, &axis->filter, (filter_kind_t)pipeline.new_kind, pipeline.true_dhz);
    uint32_t r_lsb2_q8 = choice_r_lsb2_q8(pipeline.choice);
    pipeline.own_r = r_lsb2_q8 != 0;
    if (r_lsb2_q8 == 0) {
        r_lsb2_q8 = filter_noise_r_lsb2_q8(&axis->noise);
    }
    filter_set_noise(&axis->filter, r_lsb2_q8);
    if (pipeline.has_sample) {
        filter_reset(&axis->filter, from_lsb);
    } else {
        axis->away = 0;
    }
}

static bool begin_next(void)
{
    uint8_t left = pipeline.to_begin;
    if (left == 0 || !pipeline.turn) {
        return false;
    }
    left--;
    pipeline.to_begin = left;
    pipeline.turn = pipeline.cold;
    tilt_axis_t *axis = &pipeline.axes[left];
    if (pipeline.cold) {
        filter_noise_init(&axis->noise, pipeline.rate_dhz, left == 2);
    }
    begin_axis(axis);
    return true;
}

/* The filters continue from the old output, if there is one, and so do the noise estimates unless the rate is new. */
void pipeline_change(const filter_choice_t *choice, uint16_t rate_dhz, uint8_t range_g)
{
    struct pipeline *p = here();
    bool cold = !p->has_sample || rate_dhz != p->rate_dhz;
    if (cold) {
        p->true_dhz = rate_dhz;
        p->calls_off = 0;
    }
    p->choice = choice;
    p->new_kind = choice->filter;
    p->rate_dhz = rate_dhz;
    p->warm_rows = WARM_ROWS;
    p->rail_high_lsb = (int16_t)(range_g * 256U - 1U);
    begin_all(cold);
}

void pipeline_forget(void)
{
    pipeline.has_sample = false;
    pipeline.stuck = 0;
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

/*
 * Counts the repeated readings of a hung sensor. True: it has recovered, and the noise that the filters have learned is
 * that of constant readings, so that they would refuse the next ones.
 */
static bool hung(void)
{
    struct pipeline *p = here();
    bool stuck = p->is_stuck;
    bool back = p->stuck == HUNG_SAMPLES && !stuck;
    if (!stuck) {
        p->stuck = 0;
    } else if (p->stuck != HUNG_SAMPLES) {
        p->stuck++;
    }
    return back;
}

/* Out of line: it needs every register, and most calls of pipeline_work find nothing to do. */
static MACHINE_APART void filter_axes(void)
{
    bool sample = pipeline.work == WORK_SAMPLE;
    uint8_t flags = 0;
    const int16_t *lsb = pipeline.newest.lsb;
    tilt_axis_t *axis = pipeline.axes;
    for (uint8_t left = AXES; left != 0; left--, axis++) {
        if (!sample) {
            flags |= tilt_axis_missing(axis);
            continue;
        }
        flags |= tilt_axis_update(axis, *lsb++, pipeline.rail_high_lsb, pipeline.own_r);
        if (SUPERVISOR && (axis->filter.flags & FILTER_SWITCHED) != 0) {
            pipeline_flag(ROW_SWITCHED);
        }
    }
    pipeline_flag(flags);
#if SUPERVISOR
    supervisor_view_t view = { pipeline.axes, pipeline.newest.lsb, pipeline.rail_high_lsb, pipeline.calibration,
                               &pipeline.applied };
    supervisor_sample(&view);
#endif
    if (sample) {
        count_sample(flags);
        pipeline.has_sample = true;
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
    supervisor_look(pipeline.newest.lsb, sample->lsb);
#endif
    pipeline.newest = *sample;
    pipeline.work = WORK_SAMPLE;
    pipeline.turn = true;
}

void pipeline_flag(uint16_t flags)
{
    struct pipeline *p = here();
    p->flags |= flags;
    p->second_flags = (uint8_t)(p->second_flags | flags | SECOND_SAMPLES);
    if (flags & ROW_STUCK) {
        p->is_stuck = true;
    }
}

/*
 * 1/256 g in Q8 to mg: x 1000 / 256, rounded half up. Limited to 32 g, so that the product fits 32 bits and mg fits 16:
 * 18 g on all axes of a part of low gain can come to 41 g on one axis of a board mounted obliquely. Tested on the high
 * word, which is cheap.
 */
static int16_t to_mg(int32_t value_q8)
{
    uint16_t above_least = (uint16_t)(((uint32_t)value_q8 >> 16) + 0x20U);
    if (above_least >= 0x40U) {
        return value_q8 < 0 ? -32000 : 32000;
    }
    return (int16_t)((value_q8 * 1000 + 32768) >> 16);
}

/* Accelerations from readings or estimates, LSB in Q8, and their angles. For rows only, because it is expensive. */
static void find_angles(tilt_t *tilt, const int32_t lsb_q8[3], int32_t a_q8[3])
{
    calibration_apply(&pipeline.applied, lsb_q8, a_q8);
    tilt_angles(tilt, a_q8);
}

/* Adds what the acceleration of this row and the pipeline's state say. */
static uint16_t with_state(uint16_t flags, const int32_t a_q8[3])
{
    if (!tilt_gravity_plausible(a_q8)) {
        flags |= ROW_NOT_GRAVITY;
    }
    if (pipeline.tilt.roll_undefined) {
        flags |= ROW_ROLL_UNDEFINED;
    }
    if (pipeline.warm_rows != 0) {
        flags |= ROW_WARMING_UP;
    }
    return flags;
}

void pipeline_row(row_t *row)
{
    int32_t estimates_q8[AXES], a_q8[AXES];
    int32_t *estimate = estimates_q8;
    const int32_t *a = a_q8;
    MACHINE_POINTER(row); /* with its address in a register, each access takes half the code */
    for (const tilt_axis_t *axis = pipeline.axes; axis != pipeline.axes + AXES; axis++) {
        *estimate++ = tilt_axis_estimate_q8(axis);
    }
    uint16_t flags = pipeline.flags;
#if SUPERVISOR
    if (supervisor_complete(pipeline.calibration, estimates_q8)) {
        flags |= ROW_LEFT_OUT;
    }
#endif
    find_angles(&pipeline.tilt, estimates_q8, a_q8);
    row->t_us = pipeline.newest.t_us;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        row->lsb[axis] = pipeline.newest.lsb[axis];
        row->mg[axis] = to_mg(*a++);
    }
    row->roll_cdeg = pipeline.tilt.roll_cdeg;
    row->pitch_cdeg = pipeline.tilt.pitch_cdeg;
    row->flags = with_state(flags, a_q8);
}

void pipeline_row_done(void)
{
    struct pipeline *p = here();
    p->flags = 0;
    if (p->warm_rows != 0) {
        p->warm_rows--;
    }
}

const tilt_t *pipeline_raw_tilt(void)
{
    int32_t readings_q8[AXES];
    int32_t a_q8[AXES];
    for (uint8_t axis = 0; axis < AXES; axis++) {
        readings_q8[axis] = (int32_t)pipeline.newest.lsb[axis] * 256;
    }
    find_angles(&pipeline.raw_tilt, readings_q8, a_q8);
    return &pipeline.raw_tilt;
}
