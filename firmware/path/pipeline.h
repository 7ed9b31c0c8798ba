/*
 * From samples to filtered tilt: one filter and one noise estimate per axis, in LSB; angles from the filtered states
 * including their fraction. Main only.
 */
#ifndef PIPELINE_H
#define PIPELINE_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345.h"
#include "base/choice.h"
#include "calibration.h"
#include "tilt.h"
#include "tilt_axis.h"

/* Bits of the row's `flags` column (docs/protocol.md). */
enum row_flag {
    ROW_GATED = 1,
    ROW_COASTED = 2,
    ROW_REACQUIRED = 4,
    ROW_CLIPPED = 8,
    ROW_FAULT = 16,
    ROW_STUCK = 32,
    ROW_INTEGRITY = 64,
    ROW_WARMING_UP = 128,
    ROW_DROPPED = 256,
    ROW_NOT_GRAVITY = 512,
    ROW_ROLL_UNDEFINED = 1024,
    ROW_SWITCHED = 2048, /* `auto` has chosen another member on an axis */
    ROW_LEFT_OUT = 4096  /* the angles leave out one axis, which is known to be bad */
};

enum { ROW_COLUMNS = 8 };

typedef struct {
    uint32_t t_us;
    union {
        struct {
            int16_t lsb[3]; /* as read; in a coasted row the last sample's */
            int16_t mg[3];  /* filtered accelerations */
            int16_t roll_cdeg;
            int16_t pitch_cdeg;
        };
        int16_t columns[ROW_COLUMNS]; /* the same, in the order of the csv rows */
    };
    uint16_t flags;
} row_t;

/* Once at start-up: both angles are 0. */
void pipeline_reset(void);

/* Sets the calibration that converts readings to accelerations; it must be legal (calibration.h) and stay in place. */
void pipeline_calibrate(const calibration_t *calibration);

/* There is no old output to continue from. A change must follow. */
void pipeline_forget(void);

/*
 * Sets filter, rate and range: the new filters continue from the old output, one axis before each of the next three
 * samples, so that no row waits for all of them. With another rate all change at once, and the noise estimates restart.
 * Without an old output all change at once too: filters collect a robust start, noise estimates start at their floor.
 * The choice must stay in place: it is read whenever a filter starts.
 */
void pipeline_change(const filter_choice_t *choice, uint16_t rate_dhz, uint8_t range_g);

/*
 * Call each second with the measured time between samples. If the measured rate differs from the filters' by more than
 * 1/128 and 0.1 Hz for 5 seconds, the filters continue from their outputs with the parameters of the measured rate.
 * That loses their rates of change, so it waits until the board is at rest: each axis' estimate is where it was a
 * second ago, within a degree (4.5 LSB). No row shows it. What such a second shows of gravity: gravity.h.
 */
void pipeline_second(uint32_t period_us);

/*
 * One piece of the work that pipeline_change, _second, _coast or _sample has started: the filter of an axis changed,
 * up to 2.4 ms, or a sample; false: nothing was left to do. So the main loop can do other things in between.
 * Start nothing else until it is done; only a change may replace a change.
 */
bool pipeline_work(void);

/* Does all that is left, for a program without a main loop. */
void pipeline_finish(void);

/*
 * One sample, which pipeline_work takes to filters and noise estimates. After a hold, each axis continues from the held
 * estimate if the sample agrees with it, and restarts with the second sample in a row that does not.
 */
void pipeline_sample(const adxl345_sample_t *sample);

/*
 * A sample is missing; t_us is the time that it would have had. The filters predict, for 100 ms at most, with the rate
 * of change halved every 25 ms; then the estimate holds.
 */
void pipeline_coast(uint32_t t_us);

/* No change is left to be done: all axes have the filters of the last one. */
bool pipeline_changed(void);

/* The three axes, for reading. */
const tilt_axis_t *pipeline_axes(void);

/* Time of the newest sample, or of the missing one. */
uint32_t pipeline_newest_us(void);

/* Sets flags for the next row. */
void pipeline_flag(uint16_t flags);

/*
 * The row for the newest sample, or for the missing one, with the flags of all samples since pipeline_row_done;
 * ROW_NOT_GRAVITY and ROW_LEFT_OUT refer only to this row's own acceleration.
 */
void pipeline_row(row_t *row);

/* The row went out: collects flags for the next row, and counts a warm-up row. */
void pipeline_row_done(void);

/* Roll and pitch of the newest raw sample, for the plotter. */
const tilt_t *pipeline_raw_tilt(void);

#endif
