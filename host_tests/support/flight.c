/* The flight of paper 003, 3.4. */
#include "support/flight.h"

#include <math.h>

#define TWO_PI 6.283185307179586
#define ROUND_S 300.0
#define SIGMA_RATE 6e-3
#define SIGMA_FORCE 2e-2
#define SIGMA_VELOCITY 0.1
#define SIGMA_POSITION 5.0
#define SIGMA_DOWN 1.0
#define SIGMA_FIELD 0.0349

const double flight_field[3] = { 0.3914, 0.0429, 0.9192 };
const flight_drift_t flight_no_drift = { { 0, 0, 0 }, { 0, 0, 0 } };
const flight_drift_t flight_gyro_drift = { { 7.5e-4, -8.5e-4, 5e-4 }, { 0, 0, 0 } };
const flight_drift_t flight_both_drifts = { { 7.5e-4, -8.5e-4, 5e-4 }, { 7e-3, 5e-3, 6e-3 } };

void flight_product(double out[4], const double q1[4], const double q2[4])
{
    out[0] = q1[0] * q2[0] - q1[1] * q2[1] - q1[2] * q2[2] - q1[3] * q2[3];
    out[1] = q1[0] * q2[1] + q1[1] * q2[0] + q1[2] * q2[3] - q1[3] * q2[2];
    out[2] = q1[0] * q2[2] - q1[1] * q2[3] + q1[2] * q2[0] + q1[3] * q2[1];
    out[3] = q1[0] * q2[3] + q1[1] * q2[2] - q1[2] * q2[1] + q1[3] * q2[0];
}

void flight_dcm(double dcm[9], const double q[4])
{
    dcm[0] = q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3];
    dcm[1] = 2.0 * (q[1] * q[2] - q[0] * q[3]);
    dcm[2] = 2.0 * (q[1] * q[3] + q[0] * q[2]);
    dcm[3] = 2.0 * (q[1] * q[2] + q[0] * q[3]);
    dcm[4] = q[0] * q[0] - q[1] * q[1] + q[2] * q[2] - q[3] * q[3];
    dcm[5] = 2.0 * (q[2] * q[3] - q[0] * q[1]);
    dcm[6] = 2.0 * (q[1] * q[3] - q[0] * q[2]);
    dcm[7] = 2.0 * (q[2] * q[3] + q[0] * q[1]);
    dcm[8] = q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3];
}

void flight_euler(double angles[3], const double quaternion[4])
{
    double c[9];
    flight_dcm(c, quaternion);
    angles[0] = atan2(c[7], c[8]);
    angles[1] = -asin(fmax(-1.0, fmin(1.0, c[6])));
    angles[2] = atan2(c[3], c[0]);
}

void flight_truth(flight_truth_t *truth, double t)
{
    double turning = TWO_PI / ROUND_S;
    double heading = turning * t;
    double roll = 0.3 * sin(10.0 * heading);
    double rolling = 3.0 * turning * cos(10.0 * heading);
    double radius = FLIGHT_SPEED / turning;
    *truth = (flight_truth_t){
        .position = { -radius * sin(heading), radius * cos(heading), 0.0 },
        .velocity = { -FLIGHT_SPEED * cos(heading), -FLIGHT_SPEED * sin(heading), 0.0 },
        .acceleration = { turning * FLIGHT_SPEED * sin(heading), -turning * FLIGHT_SPEED * cos(heading), 0.0 },
        .rate = { rolling, turning * sin(roll), turning * cos(roll) },
    };
    const double about_z[4] = { cos(heading / 2.0), 0.0, 0.0, sin(heading / 2.0) };
    const double about_x[4] = { cos(roll / 2.0), sin(roll / 2.0), 0.0, 0.0 };
    flight_product(truth->quaternion, about_z, about_x);
}

/* NED to body. */
static void to_body(double out[3], const double quaternion[4], const double ned[3])
{
    double c[9];
    flight_dcm(c, quaternion);
    for (int i = 0; i < 3; i++) {
        out[i] = c[i] * ned[0] + c[3 + i] * ned[1] + c[6 + i] * ned[2];
    }
}

static void imu(flight_sample_t *sample, double t, const flight_drift_t *drift, test_random_t *random)
{
    flight_truth_t truth;
    flight_truth(&truth, t);
    const double force[3] = { truth.acceleration[0], truth.acceleration[1], truth.acceleration[2] - FLIGHT_GRAVITY };
    to_body(sample->force, truth.quaternion, force);
    for (int i = 0; i < 3; i++) {
        sample->rate[i] = truth.rate[i] + drift->gyro[i] + SIGMA_RATE * random_normal(random);
        sample->force[i] += drift->accelerometer[i] + SIGMA_FORCE * random_normal(random);
    }
}

void flight_sample(flight_sample_t *sample, int k, const flight_drift_t *drift, test_random_t *random)
{
    imu(sample, (k + 0.5) * FLIGHT_STEP, drift, random);
    flight_truth_t truth;
    flight_truth(&truth, (k + 1) * FLIGHT_STEP);
    double length = sqrt(flight_field[0] * flight_field[0] + flight_field[1] * flight_field[1] +
                         flight_field[2] * flight_field[2]);
    const double field[3] = { flight_field[0] / length, flight_field[1] / length, flight_field[2] / length };
    to_body(sample->field, truth.quaternion, field);
    for (int i = 0; i < 3; i++) {
        sample->field[i] += SIGMA_FIELD * random_normal(random);
        sample->gps_velocity[i] = truth.velocity[i] + SIGMA_VELOCITY * random_normal(random);
        sample->gps_position[i] = truth.position[i] + SIGMA_POSITION * random_normal(random);
    }
    sample->down = truth.position[2] + SIGMA_DOWN * random_normal(random);
}
