/* Inside the pipeline: its state, and what its two files call of each other. Main only. */
#ifndef PIPELINE_STATE_H
#define PIPELINE_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "calibration.h"
#include "filter.h"
#include "fx.h"
#include "noise.h"
#include "pipeline.h"
#include "tilt.h"

enum { AXES = 3, WARM_ROWS = 5 };

typedef enum {
    WORK_NONE,
    WORK_SAMPLE,  /* through the filter of each axis */
    WORK_RENEW,   /* amid a sample: its axis gets a filter that begins anew */
    WORK_COAST,   /* the filter of each axis predicts */
    WORK_REPLACE, /* ahead of a sample: one axis gets its new filter */
    WORK_CHANGE   /* each axis gets its new filter */
} work_t;

typedef struct {
    int32_t estimate_q8;
    uint16_t looked_lsb_q2; /* the estimate a second ago */
    int16_t lsb;
    uint8_t away; /* after a hold: 1, and 1 more for each sample that lies away from what was held; else 0 */
    noise_t noise;
    filter_t filter;
} axis_t;

typedef struct {
    axis_t axes[AXES];
    int32_t a_q8[AXES]; /* the estimates in the axes of the carrier, 1/256 g */
    calibration_applied_t applied;
    const calibration_t *calibration; /* that is applied */
    uint8_t columns;                  /* of its matrix that are ready: all when AXES */
    tilt_t tilt;
    tilt_t raw_tilt;
    uint32_t last_us;
    int16_t rail_high_lsb;
    uint16_t rate_dhz; /* nominal */
    uint16_t true_dhz; /* that the filters have */
    uint8_t calls_off;
    uint16_t flags;
    uint16_t kept_flags; /* of the samples before the one under way */
    uint8_t warm_rows;
    uint8_t work;       /* work_t */
    uint8_t axis;       /* that the work goes on with */
    uint8_t step;       /* of the change on that axis */
    uint8_t to_replace; /* axes whose filters change, each ahead of a sample */
    uint8_t new_kind;
    bool new_noise;
    bool clipped;  /* the reading of this axis */
    uint8_t stuck; /* samples with ROW_STUCK on end before this one, up to HUNG_SAMPLES of pipeline.c */
    bool has_sample;
} pipeline_t;

extern pipeline_t pipeline;

/* The axis that the work goes on with. */
static inline axis_t *axis_now(void)
{
    axis_t *axis = &pipeline.axes[pipeline.axis];
    FX_FENCE_OF(axis); /* else its address is computed anew at each use */
    return axis;
}

static inline int16_t estimate_lsb(const axis_t *axis)
{
    return (int16_t)((axis->estimate_q8 + 128) >> 8);
}

/* Measurement variance R that its filter is to have: the user's, else the estimated one; LSB^2 Q8. */
uint32_t axis_r_lsb2_q8(const axis_t *axis);

/* One piece of giving the axis its new filter: initialised, told its R, settled. True: it is done. */
bool change_axis(void);

/* Ahead of a sample's work: that of giving one axis its new filter, where one is to have it. */
void replace_axis(void);

/* One piece of WORK_CHANGE. */
void change_step(void);

#endif
