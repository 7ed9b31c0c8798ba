/*
 * The whole path from three readings to roll and pitch: noise estimate, filter, scale, angles, missing samples.
 *
 *   tilt_filter_t tilt;
 *   tilt_filter_begin(&tilt, 100);                 // samples per second
 *   ...
 *   tilt_filter_update(&tilt, ax, ay, az);         // every 10 ms; without a sample: tilt_filter_missing(&tilt)
 *   show(tilt.angles.roll_cdeg, tilt.angles.pitch_cdeg, tilt.flags);
 *
 * On the same samples, at the nominal rate, angles and flags are those of this project's firmware, bit for bit; the
 * firmware also measures the true rate, and restarts its filters after a stuck sensor. Readings are those of the
 * ADXL345 in full resolution, 13 bits: -4096..4095 LSB of 1/256 g; see tilt_filter_sensor for others. A reading at the
 * end of its range or beyond is flagged TILT_CLIPPED and counts as missing. Axes as on the ADXL345: roll = atan2(y, z),
 * pitch = atan2(-x, sqrt(y^2 + z^2)). Plain data, 405 bytes on an AVR; one caller at a time, from main or from an
 * interrupt.
 */
#ifndef TILT_FILTER_H
#define TILT_FILTER_H

#include "calibration.h"
#include "filter.h"
#include "tilt.h"
#include "tilt_axis.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { TILT_FILTER_AXES = 3, TILT_FILTER_RATE_MIN_HZ = 5, TILT_FILTER_RATE_MAX_HZ = 4000 };

typedef struct {
    tilt_t angles;                  /* roll and pitch, 0.01 degree */
    uint16_t flags;                 /* TILT_* of the newest sample */
    int32_t a_q8[TILT_FILTER_AXES]; /* filtered accelerations, 1/256 g in Q8 */
    uint16_t rate_dhz;              /* 0.1 Hz */
    int16_t rail_high_lsb;
    uint8_t shift; /* places by which a reading is shifted right */
    calibration_applied_t calibration;
    tilt_axis_t axes[TILT_FILTER_AXES];
} tilt_filter_t;

/*
 * After a start: selects another law than `adaptive`, or other parameters than its defaults (NULL: the defaults; the
 * rate is the facade's, and R is estimated). Filters and noise estimates restart; the angles stay until the next
 * sample. Returns FILTER_ACCEPTED, or what is wrong (filter.h), in which case nothing is changed. Up to 45,000 cycles;
 * a start takes as long.
 */
filter_answer_t tilt_filter_use(tilt_filter_t *t, const filter_law_t *law, const filter_config_t *config);

/* As tilt_filter_begin, with this law. A program that starts this way links no other law. */
bool tilt_filter_begin_with(tilt_filter_t *t, uint16_t rate_hz, const filter_law_t *law);

/*
 * Starts with the law `adaptive` and an ADXL345 at 3.3 V. rate_hz: samples per second, rounded; outside 5..4000
 * returns false and uses the nearest legal rate.
 */
static inline bool tilt_filter_begin(tilt_filter_t *t, uint16_t rate_hz)
{
    return tilt_filter_begin_with(t, rate_hz, &filter_law_adaptive);
}

/*
 * Sets the sensor: bits per reading, at most 16, and LSB per g on x and y, and on z. Readings are shifted right, with
 * rounding, until they have at most 13 bits and 330 LSB per g; legal if at least 200 LSB per g and 8 bits are left.
 * False: not legal, nothing is changed. Examples: ADXL345 in its 2 g range 10, 265, 256; MPU-6050 in its 2 g range 16,
 * 16384, 16384. R is at least that of an ADXL345. Call before the first sample: what the filters have learnt is in the
 * LSB of the previous sensor.
 */
bool tilt_filter_sensor(tilt_filter_t *t, uint8_t bits, uint16_t xy_lsb_per_g, uint16_t z_lsb_per_g);

/*
 * Sets offsets, scales, axes and mounting as found by the firmware's calibration; returns the verdict, not good if one
 * is not legal, in which case nothing is changed. In the LSB of the shifted readings; call it after tilt_filter_sensor,
 * which replaces a calibration.
 */
calibration_verdict_t tilt_filter_calibrate(tilt_filter_t *t, const calibration_t *calibration);

/* One sample, or none; the result is in t->angles and t->flags. */
void tilt_filter_update(tilt_filter_t *t, int16_t ax, int16_t ay, int16_t az);
void tilt_filter_missing(tilt_filter_t *t);

#ifdef __cplusplus
}
#endif
#endif
