/*
 * Square-root navigation: a strapdown INS whose errors a Kalman filter of 9 or 12 states finds from GPS, an altimeter
 * and a magnetometer (paper 003). The covariance is kept as U D U', so D >= 0 whatever is measured.
 *
 * It needs rates, forces, a field and positions: an accelerometer alone gives none of heading, rate and position.
 *
 * Frames: NED, and the body's. The quaternion (w, x, y, z) turns body to NED. Error state x = true - computed, in the
 * order position, velocity, attitude mu, gyro drift c; attitude: C_true = (I - [mu x]) C_computed.
 * Times are of any clock in microseconds and may wrap; a time is judged by the shorter way round.
 *
 * Work is cut into slots, one per IMU record: every nav_imu carries state and covariance on by one step and does ONE
 * job: take in the epochs that have arrived, or one scalar update, or the process noise of one state. Other calls
 * only look at their record and put it down. Longest slot on an ATmega328P at 16 MHz: docs/navigation.md.
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

#define NAV_LATE_US 150000UL      /* oldest epoch of GPS and altimeter that is taken */
#define NAV_FIELD_LATE_US 50000UL /* and of the magnetometer: turned on by the last rate, to first order */
#define NAV_BRIDGE_US 100000UL    /* missing IMU records are bridged in one step up to here */

enum {
    NAV_PACKED = (NAV_STATES == 9) ? 45 : 78, /* elements of a triangle */
    NAV_SCALARS = 9,                          /* of one epoch of each sensor: velocity, position, down, field (two) */
    NAV_NOISES = 1 + (NAV_STATES - 3),        /* jobs of process noise: position at once, then one per state */
    NAV_PAST = 10,                            /* positions and velocities kept for late epochs, 19 ms apart or more */
    NAV_REFUSALS = 5,                         /* epochs in a row that the gate may refuse a scalar */
    NAV_STRAYS = 10                           /* IMU records in a row whose times go back until they are believed */
};

typedef struct {
    nav_real_t quaternion[4]; /* body to NED: w, x, y, z; length 1 */
    nav_real_t velocity_mps[3];
    nav_real_t position_m[3];
    nav_real_t gyro_drift_rps[3]; /* taken off every rate; estimated with 12 states, kept as it began with 9 */
} nav_state_t;

/* All values finite. "0: none" is legal where it is said, and nowhere else. */
typedef struct {
    /* One IMU period before the first record. |quaternion| 0.5..2 (normalised), |velocity| <= 1e3 m/s,
       |position| <= 1e6 m, |drift| <= 1 rad/s. */
    nav_state_t start;
    nav_real_t field[3];         /* Earth's field, NED; length 1e-10..1e6 of any unit, north > -length / 2 */
    nav_real_t gravity_mps2;     /* 1..25 */
    nav_real_t start_position_m; /* 1 sigma of each component of the start: 0 (known exactly)..1e5 */
    nav_real_t start_velocity_mps;
    nav_real_t start_attitude_rad; /* small angles: what is beyond 0.3 is believed less than it should be */
    nav_real_t start_drift_rps;    /* of no use with 9 states */
    nav_real_t walk_position_m;    /* 1 sigma of what each IMU period adds to each component: 0 (nothing)..1 */
    nav_real_t walk_velocity_mps;
    nav_real_t walk_attitude_rad;
    nav_real_t walk_drift_rps; /* of no use with 9 states */
    nav_real_t sigma_field;    /* 1 sigma of each component of the field's direction: 1e-4..1e5, as the next */
    nav_real_t sigma_gps_velocity_mps;
    nav_real_t sigma_gps_position_m;
    nav_real_t sigma_down_m;
    nav_real_t gate;    /* refuse |innovation| > gate x its sigma: 1..100; 0: no gate */
    uint32_t period_us; /* of the IMU: 1000..100000 */
} nav_config_t;

typedef enum {
    NAV_TAKEN,
    NAV_GATED,        /* a scalar, when its job ran: never an answer to a call */
    NAV_BACKWARDS,    /* not after the last record of the same sensor */
    NAV_LATE,         /* its epoch is older than what is remembered */
    NAV_NOT_FINITE,   /* NaN or infinite */
    NAV_NO_LENGTH,    /* a field without direction */
    NAV_OUT_OF_RANGE, /* |rate| > 40 rad/s, |force| > 400 m/s^2, |velocity| > 1e3 m/s, |position| or |field| > 1e6; an
                         IMU time that leaps ahead */
    NAV_QUEUE_FULL,   /* scalars of this sensor's last epoch still wait */
    NAV_GAP,          /* IMU: the time before it is lost; other sensors: no IMU record near this epoch yet */
    NAV_ANSWERS
} nav_answer_t;

/* How often each was the answer; stays at 65535. */
typedef struct {
    uint16_t answer[NAV_ANSWERS];
} nav_counts_t;

/* Position and velocity of the past, without the corrections made since the start (their sums): a late epoch finds
   what would have been computed then with all that is known now. */
typedef struct {
    uint32_t t_us[NAV_PAST];
    nav_real_t motion[NAV_PAST][6]; /* velocity, position */
    nav_real_t corrections[6];      /* sums */
    uint8_t newest, held;
} nav_past_t;

/* What waits: values as they came, then innovations. One epoch per sensor. */
typedef struct {
    nav_real_t value[NAV_SCALARS + 1]; /* and the field's third component, until it is taken in */
    uint32_t t_us[3]; /* epochs of GPS, altimeter, magnetometer: of those that wait, and the last of each */
    uint16_t waits;   /* a bit per scalar */
    uint8_t arrived;  /* a bit per sensor whose values are still as they came */
    uint8_t seen;     /* a bit per sensor that has an epoch in t_us */
    uint8_t in_a_row; /* jobs since the last of process noise */
    uint8_t refused[NAV_SCALARS];
} nav_queue_t;

typedef struct {
    nav_real_t rate_us[4];     /* variance per microsecond: position, velocity, attitude, drift */
    uint32_t t_us[NAV_NOISES]; /* until when each job has added its noise */
    nav_real_t gap_s;          /* length of the gap whose uncertainty is still owed */
    uint16_t owed;             /* a bit per job that owes it */
    uint8_t next;
} nav_noise_t;

typedef struct {
    nav_state_t state;
    nav_real_t ud[NAV_PACKED];             /* nav_ud.h */
    nav_real_t rate_rps[3], force_mps2[3]; /* last record */
    nav_real_t force_ned_mps2[3];
    nav_real_t tau[2][3];   /* rows 2 and 3 of (3.34) */
    nav_real_t variance[4]; /* of field, velocity, position, down as measured */
    nav_real_t gravity_mps2, gate_squared;
    uint32_t t_us, period_us;
    nav_past_t past;
    nav_queue_t queue;
    nav_noise_t noise;
    nav_counts_t counts;
    uint32_t stray_us; /* the last IMU time that did not go on, while strays are not 0 */
    uint8_t strays;    /* in a row; and a bit of nav.c */
} nav_t;

/* False, and *nav of no use: a field of *config is outside its range or not finite. */
bool nav_init(nav_t *nav, const nav_config_t *config);

/*
 * One IMU record: means of rate (rad/s) and specific force (m/s^2), body axes, over the interval that ends at t_us.
 * Carries everything on to t_us, then does one job: the longest slot.
 *
 * Missing records, up to 100 ms (or two periods, if longer): one step over the whole interval with the mean of the last
 * and this record. That is the trapezium's rule: over a step of T an angle errs by |rate''| T^3 / 12, by |last x this|
 * T^2 / 12 where the axis turns, and the noise of two records stands for that of all.
 * A time further ahead is refused, NAV_OUT_OF_RANGE, until the next record goes on from it: one stamp may be wrong.
 * NAV_GAP, then: time starts anew, position goes on with the velocity for 10 s at most, what waited is forgotten, and
 * the covariance grows by what T seconds (10 at most) may hold, unseen: a turn at 0.5 rad/s (0.5 rad at most), 5 m/s^2
 * and what they make of the position; in the next seven slots, before anything else. Ten records in a row that go back
 * in time are a clock that began anew, which counts as a gap of one second; ten that leap ahead, each by more than is
 * bridged, are a gap too. Where only the first record's time stands against them, it is the wrong one: a gap of 100 ms.
 *
 * NAV_TAKEN, NAV_GAP; or refused and no state changed: NAV_BACKWARDS, NAV_NOT_FINITE, NAV_OUT_OF_RANGE.
 */
nav_answer_t nav_imu(nav_t *nav, uint32_t t_us, const nav_real_t rate_rps[3], const nav_real_t force_mps2[3]);

/*
 * Velocity (m/s, NED) and position (m, NED) at the epoch t_us, which may be 150 ms before the last IMU record, and 100
 * ms after it: then it waits. State and its errors are carried to the epoch: computed values by linear interpolation
 * of the past (3.3.5), rows of H to first order in the age (nav_jobs.c). NAV_TAKEN: six scalars wait. NAV_LATE,
 * NAV_GAP, NAV_BACKWARDS, NAV_QUEUE_FULL, NAV_NOT_FINITE, NAV_OUT_OF_RANGE. A scalar that the gate refused in five
 * epochs in a row is believed: its variance grows until it fits.
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

/* Scalar updates that wait, 0..9. */
uint8_t nav_queued(const nav_t *nav);

/* All of D finite and not negative, ||quaternion|^2 - 1| <= 0.01, the state finite. */
bool nav_healthy(const nav_t *nav);

#ifdef __cplusplus
}
#endif
#endif
