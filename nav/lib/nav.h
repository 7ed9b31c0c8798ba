/*
 * Square-root navigation: a strapdown INS whose errors a Kalman filter of 9 or 12 states estimates from GPS, an
 * altimeter and a magnetometer (paper 003). The covariance is kept as U D U', so D >= 0 whatever is measured.
 *
 * It needs rates, forces, a field and positions: an accelerometer alone provides no heading, rate or position.
 *
 * Frames: NED, and the body's. The quaternion (w, x, y, z) rotates body to NED. Error state x = true - computed, in the
 * order position, velocity, attitude mu, gyro drift c; attitude: C_true = (I - [mu x]) C_computed. Times are from any
 * clock in microseconds and may wrap; differences are taken the shorter way round.
 *
 * Work is divided into slots, one per IMU record: every nav_imu propagates state and covariance by one step and does
 * ONE job: take in the epochs that have arrived, or one scalar update, or the process noise of one state. Other calls
 * only check and store their record. Longest slot on the UNO: docs/results/navigation.md.
 *
 * No globals, no pointers inside nav_t: it may be copied. All functions of one nav_t belong to one context: call them
 * from the main loop, never from an interrupt.
 */
#ifndef NAV_H
#define NAV_H

#include "nav_real.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef NAV_STATES /* 9, or 12 with the gyro's drift */
#define NAV_STATES 12
#endif
#if NAV_STATES != 9 && NAV_STATES != 12
#error "NAV_STATES is 9 or 12"
#endif

#define NAV_LATE_US 150000UL      /* oldest epoch accepted from GPS and altimeter */
#define NAV_FIELD_LATE_US 50000UL /* and from the magnetometer: rotated with the last rate, to first order */
#define NAV_BRIDGE_US 100000UL    /* longest interval of missing IMU records that is bridged in one step */

enum {
    NAV_PACKED = (NAV_STATES == 9) ? 45 : 78, /* elements of a triangle */
    NAV_SCALARS = 9,                          /* of one epoch of each sensor: velocity, position, down, field (two) */
    NAV_NOISES = 1 + (NAV_STATES - 3),        /* jobs of process noise: position at once, then one per state */
    NAV_PAST = 10,                            /* positions and velocities kept for late epochs, 19 ms apart or more */
    NAV_REFUSALS = 5,                         /* epochs in a row in which the gate may refuse a scalar */
    NAV_STRAYS = 10                           /* IMU records in a row whose times go back until they are accepted */
};

typedef struct {
    nav_real_t quaternion[4]; /* body to NED: w, x, y, z; length 1 */
    nav_real_t velocity_mps[3];
    nav_real_t position_m[3];
    nav_real_t gyro_drift_rps[3]; /* subtracted from every rate; estimated with 12 states, constant with 9 */
} nav_state_t;

/* All values finite. 0 for "none" is legal only where stated. */
typedef struct {
    /* One IMU period before the first record. |quaternion| 0.5..2 (normalised), |velocity| <= 1e3 m/s,
       |position| <= 1e6 m, |drift| <= 1 rad/s. */
    nav_state_t start;
    nav_real_t field[3];         /* Earth's field, NED; length 1e-10..1e6 of any unit, north > -length / 2 */
    nav_real_t gravity_mps2;     /* 1..25 */
    nav_real_t start_position_m; /* 1 sigma of each component of the start: 0 (known exactly)..1e5 */
    nav_real_t start_velocity_mps;
    nav_real_t start_attitude_rad; /* small angles: above 0.3 it is trusted less than it should be */
    nav_real_t start_drift_rps;    /* unused with 9 states */
    nav_real_t walk_position_m;    /* 1 sigma of what each IMU period adds to each component: 0 (nothing)..1 */
    nav_real_t walk_velocity_mps;
    nav_real_t walk_attitude_rad;
    nav_real_t walk_drift_rps; /* unused with 9 states */
    nav_real_t sigma_field;    /* 1 sigma of each component of the field's direction: 1e-4..1e5, as are the next */
    nav_real_t sigma_gps_velocity_mps;
    nav_real_t sigma_gps_position_m;
    nav_real_t sigma_down_m;
    nav_real_t gate;    /* refuse |innovation| > gate x its sigma: 1..100; 0: no gate */
    uint32_t period_us; /* of the IMU: 1000..100000 */
} nav_config_t;

typedef enum {
    NAV_TAKEN,
    NAV_GATED,        /* a scalar, when its job ran: never the return value of a call */
    NAV_BACKWARDS,    /* not after the last record of the same sensor */
    NAV_LATE,         /* its epoch is older than the stored past */
    NAV_NOT_FINITE,   /* NaN or infinite */
    NAV_NO_LENGTH,    /* a field without a direction */
    NAV_OUT_OF_RANGE, /* |rate| > 40 rad/s, |force| > 400 m/s^2, |velocity| > 1e3 m/s, |position| or |field| > 1e6; an
                         IMU time that leaps ahead */
    NAV_QUEUE_FULL,   /* scalars of this sensor's last epoch are still waiting */
    NAV_GAP,          /* IMU: the time before it is lost; other sensors: no IMU record near this epoch yet */
    NAV_ANSWERS
} nav_answer_t;

/* How often each was returned; stops at 65535. */
typedef struct {
    uint16_t answer[NAV_ANSWERS];
} nav_counts_t;

/*
 * Past position and velocity without the corrections made since the start (their sums): a late epoch then finds what
 * would have been computed with everything known at present.
 */
typedef struct {
    uint32_t t_us[NAV_PAST];
    nav_real_t motion[NAV_PAST][6]; /* velocity, position */
    nav_real_t corrections[6];      /* sums */
    uint8_t newest, held;
} nav_past_t;

/* Waiting measurements: values as received, then innovations. One epoch per sensor. */
typedef struct {
    nav_real_t value[NAV_SCALARS + 1]; /* plus the field's third component until it is taken in */
    uint32_t t_us[3]; /* epochs of GPS, altimeter, magnetometer: the waiting one, or the last of each */
    uint16_t waits;   /* a bit per scalar */
    uint8_t arrived;  /* a bit per sensor whose values are still as received */
    uint8_t seen;     /* a bit per sensor that has an epoch in t_us */
    uint8_t in_a_row; /* jobs since the last one of process noise */
    uint8_t refused[NAV_SCALARS];
} nav_queue_t;

typedef struct {
    nav_real_t rate_us[4];     /* variance per microsecond: position, velocity, attitude, drift */
    uint32_t t_us[NAV_NOISES]; /* time up to which each job has added its noise */
    nav_real_t gap_s;          /* length of the gap whose uncertainty is still to be added */
    uint16_t owed;             /* a bit per job that still has to add it */
    uint8_t next;
} nav_noise_t;

typedef struct {
    nav_state_t state;
    nav_real_t ud[NAV_PACKED];             /* nav_ud.h */
    nav_real_t rate_rps[3], force_mps2[3]; /* last record */
    nav_real_t force_ned_mps2[3];
    nav_real_t tau[2][3];   /* rows 2 and 3 of (3.34) */
    nav_real_t variance[4]; /* measurement variances of field, velocity, position, down */
    nav_real_t gravity_mps2, gate_squared;
    uint32_t t_us, period_us;
    nav_past_t past;
    nav_queue_t queue;
    nav_noise_t noise;
    nav_counts_t counts;
    uint32_t stray_us; /* the last IMU time that did not continue, while strays is not 0 */
    uint8_t strays;    /* in a row; plus a bit defined in nav.c */
} nav_t;

/* False, with *nav unusable: a field of *config is outside its range or not finite. */
bool nav_init(nav_t *nav, const nav_config_t *config);

/*
 * One IMU record: means of rate (rad/s) and specific force (m/s^2), body axes, over the interval that ends at t_us.
 * Propagates everything to t_us, then does one job: the longest slot.
 *
 * Missing records, up to 100 ms (or two periods, if longer): one step over the whole interval with the mean of the last
 * and this record. That is the trapezoidal rule: over a step of T an angle errs by |rate''| T^3 / 12, by |last x this|
 * T^2 / 12 where the axis turns, and the noise of two records is used for that of all. A time further ahead is refused,
 * NAV_OUT_OF_RANGE, until the next record continues from it: one stamp may be wrong. Then NAV_GAP: time restarts, the
 * position moves on with the velocity for 10 s at most, waiting measurements are dropped, and the covariance grows by
 * what may have happened unobserved in T seconds (10 at most): a turn at 0.5 rad/s (0.5 rad at most), 5 m/s^2 and their
 * effect on the position; this takes the next seven slots, before anything else. Ten records in a row that go back in
 * time are a restarted clock, which counts as a gap of one second; ten that leap ahead, each by more than is bridged,
 * are a gap too. If only the first record's time contradicts them, that one is wrong: a gap of 100 ms.
 *
 * NAV_TAKEN, NAV_GAP; or refused with no state changed: NAV_BACKWARDS, NAV_NOT_FINITE, NAV_OUT_OF_RANGE.
 */
nav_answer_t nav_imu(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3]);

/*
 * Velocity (m/s, NED) and position (m, NED) at the epoch t_us, which may be up to 150 ms before the last IMU record, or
 * up to 100 ms after it: then it waits. State and errors are transferred to the epoch: computed values by linear
 * interpolation of the past (3.3.5), rows of H to first order in the age (nav_jobs.c). NAV_TAKEN: six scalars wait.
 * NAV_LATE, NAV_GAP, NAV_BACKWARDS, NAV_QUEUE_FULL, NAV_NOT_FINITE, NAV_OUT_OF_RANGE. A scalar that the gate refused in
 * five epochs in a row is accepted: the covariance grows until it fits.
 */
nav_answer_t nav_gps(nav_t *nav, uint32_t t_us, const nav_real_t velocity_mps[3], const nav_real_t position_m[3]);

/* Altimeter: the third component of the position, DOWN, m. Otherwise as nav_gps, one scalar. */
nav_answer_t nav_down(nav_t *nav, uint32_t t_us, nav_real_t down_m);

/* Field in body axes, of any unit. Two scalars; up to 50 ms old. Also NAV_NO_LENGTH. Otherwise as nav_gps. */
nav_answer_t nav_field(nav_t *nav, uint32_t t_us, const nav_real_t field_body[3]);

/* At the time of the last IMU record; valid as long as *nav. */
const nav_state_t *nav_state(const nav_t *nav);

/* Diagonal of P: m^2, (m/s)^2, rad^2, (rad/s)^2. With 12 states 66 x three float operations: not for every slot. */
void nav_variances(const nav_t *nav, nav_real_t variance[NAV_STATES]);

const nav_counts_t *nav_counts(const nav_t *nav);

/* Waiting scalar updates, 0..9. */
uint8_t nav_queued(const nav_t *nav);

/* All of D finite and not negative, ||quaternion|^2 - 1| <= 0.01, the state finite. */
bool nav_healthy(const nav_t *nav);

#ifdef __cplusplus
}
#endif
#endif
