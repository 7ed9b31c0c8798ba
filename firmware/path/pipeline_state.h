/* Inside the pipeline: its state, and what its two files call of each other. Main only. */
#ifndef PIPELINE_STATE_H
#define PIPELINE_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "calibration.h"
#include "fx.h"
#include "path/pipeline.h"
#include "path/supervisor.h"
#include "tilt.h"
#include "tilt_axis.h"

enum { AXES = 3, WARM_ROWS = 5 };

/* What pipeline_work is to take through the filters: a sample, or the place of one that is missing. */
typedef enum { WORK_NONE, WORK_SAMPLE, WORK_COAST } work_t;

typedef struct {
    tilt_axis_t axes[AXES];
    uint16_t looked_lsb_q2[AXES]; /* the estimates a second ago */
    int32_t a_q8[AXES];           /* the estimates in the axes of the carrier, 1/256 g */
    calibration_applied_t applied;
#if SUPERVISOR
    const calibration_t *calibration; /* that is applied */
#endif
    adxl345_sample_t newest; /* or the time of the one that is missing, and the last readings */
    tilt_t tilt;
    tilt_t raw_tilt;
    int16_t rail_high_lsb;
    uint16_t rate_dhz; /* nominal */
    uint16_t true_dhz; /* that the filters have */
    uint8_t calls_off;
    uint16_t flags;
    uint8_t warm_rows;
    uint8_t work;     /* work_t */
    uint8_t to_begin; /* so many axes, the first ones, are to get a new filter */
    bool cold;        /* all of them before the next sample, and a new noise estimate; else one with each sample */
    bool turn;        /* one with this sample */
    uint8_t new_kind;
    bool is_stuck; /* the newest sample has ROW_STUCK */
    uint8_t stuck; /* samples with ROW_STUCK in a row before this one, up to HUNG_SAMPLES of pipeline.c */
    bool has_sample;
} pipeline_t;

extern pipeline_t pipeline;

/* Measurement variance R that its filter is to have: the user's, else the estimated one; LSB^2 Q8. */
uint32_t axis_r_lsb2_q8(const tilt_axis_t *axis);

/* Every axis is to get a new filter. */
void begin_all(bool cold);

/* Gives one axis its new filter, where one is to have it now; false: none. */
bool begin_next(void);

#endif
