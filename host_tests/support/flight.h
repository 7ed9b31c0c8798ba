/*
 * The flight of paper 003, 3.4: a circle of 300 s at 6 m/s, heading 2 pi t / T, pitch 0, roll 0.3 sin(10 heading), NED,
 * flown tail first (the only reading that fits the printed r0 and v0). Sensors with the paper's noises.
 */
#ifndef SUPPORT_FLIGHT_H
#define SUPPORT_FLIGHT_H

#include "support/random.h"

#include <stdbool.h>

#define FLIGHT_GRAVITY 9.81
#define FLIGHT_SPEED 6.0
#define FLIGHT_STEP 0.01

typedef struct {
    double position[3], velocity[3], acceleration[3];
    double rate[3];       /* body */
    double quaternion[4]; /* body to NED */
} flight_truth_t;

/* One sample of each sensor. */
typedef struct {
    double rate[3], force[3];
    double gps_velocity[3], gps_position[3];
    double down;
    double field[3];
} flight_sample_t;

typedef struct {
    double gyro[3], accelerometer[3]; /* constant errors */
} flight_drift_t;

/* mag of the paper, as printed; n_g and n_a. */
extern const double flight_field[3];
extern const flight_drift_t flight_no_drift, flight_gyro_drift, flight_both_drifts;

void flight_truth(flight_truth_t *truth, double t);

/* Sample k = 0, 1, ...: rates and forces of the middle of its period, the others of its end, (k + 1) 0.01 s. */
void flight_sample(flight_sample_t *sample, int k, const flight_drift_t *drift, test_random_t *random);

/* q1 q2 */
void flight_product(double out[4], const double q1[4], const double q2[4]);

/* Body to NED, row-major. */
void flight_dcm(double dcm[9], const double quaternion[4]);

/* Roll, pitch, heading. */
void flight_euler(double angles[3], const double quaternion[4]);

#endif
