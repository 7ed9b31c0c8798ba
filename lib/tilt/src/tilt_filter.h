/*
 * The whole way from three readings to roll and pitch: noise estimate, filter, scale, angles, missing samples.
 *
 *   tilt_filter_t tilt;
 *   tilt_filter_begin(&tilt, 100);
 *   ...
 *   tilt_filter_update(&tilt, x, y, z);            each 10 ms; or tilt_filter_missing(&tilt) when none came
 *   use(tilt.angles.roll_cdeg, tilt.angles.pitch_cdeg, tilt.flags);
 *
 * The angles are those of the firmware of this project, bit for bit. Readings are in LSB, as the ADXL345 delivers them in
 * full resolution, 13 bit: -4096..4095, 16 g; a sample outside is clamped and flagged FILTER_SATURATED. A sensor with
 * more bits is read through a shift, see tilt_filter_sensor. One filter_t an axis: 350 bytes of RAM on an AVR. Main or
 * interrupt, one caller at a time.
 */
#ifndef TILT_FILTER_H
#define TILT_FILTER_H

#include "calibration.h"
#include "filter.h"
#include "noise.h"
#include "tilt.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TILT_FILTER_AXES = 3 };

/* Beside the FILTER_* of filter.h, the OR over the axes. */
enum tilt_filter_flag {
    TILT_FILTER_CLIPPED = 0x40,    /* an axis is at the rail of its range: its sample is taken for missing */
    TILT_FILTER_NOT_GRAVITY = 0x80 /* |a| is outside 0.85..1.15 g: the board accelerates, tilt is not to be trusted */
};

typedef struct {
    tilt_t angles;                  /* roll and pitch, 0.01 degree */
    int32_t a_q8[TILT_FILTER_AXES]; /* filtered accelerations, 1/256 g in Q8 */
    uint8_t flags;                  /* of the newest sample */
    uint8_t shift;                  /* places that a reading is shifted right by */
    int16_t rail_high_lsb;          /* readings from here on, and below its negative, are at the rail */
    uint16_t rate_dhz;
    calibration_applied_t calibration;
    noise_t noise[TILT_FILTER_AXES];
    filter_t filters[TILT_FILTER_AXES];
} tilt_filter_t;

/* With `adaptive` and the ADXL345 at 3.3 V; rate_hz: output data rate, 5..4000. */
void tilt_filter_begin(tilt_filter_t *t, uint16_t rate_hz);

/*
 * Another law, and its parameters other than as shipped (NULL: those; rate and R are the facade's). Begins again.
 * FILTER_ACCEPTED, or what is wrong, and nothing is changed.
 */
filter_answer_t tilt_filter_use(tilt_filter_t *t, const filter_law_t *law, const filter_config_t *config);

/*
 * Another sensor: readings of `bits` bits, 8 to 16, of so many LSB per g on x and y and on z, in the sensor's own LSB:
 * more than 13 bit are shifted to 13, with rounding. After the shift 200..330 LSB per g are legal; false: they are not,
 * and nothing is changed.
 */
bool tilt_filter_sensor(tilt_filter_t *t, uint8_t bits, uint16_t xy_lsb_per_g, uint16_t z_lsb_per_g);

/* One sample, or none; the result is in t->angles and t->flags. */
void tilt_filter_update(tilt_filter_t *t, int16_t x, int16_t y, int16_t z);
void tilt_filter_missing(tilt_filter_t *t);

#ifdef __cplusplus
}
#endif
#endif
