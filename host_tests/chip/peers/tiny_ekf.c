/* TinyEKF, matrices of 2 x 2 by its loops. */
#define EKF_N 2
#define EKF_M 1
#include <stdint.h>

#include "tinyekf.h"

#include "peer.h"

PEER_FLOAT

static ekf_t filter;

void peer_start(void)
{
    const float variances[EKF_N] = { PEER_R, PEER_RATE_VARIANCE };
    ekf_initialize(&filter, variances);
}

void peer_step(void)
{
    static const float f[EKF_N * EKF_N] = { 1.0f, 1.0f, 0.0f, 1.0f };
    static const float q[EKF_N * EKF_N] = { 0.0f, 0.0f, 0.0f, PEER_Q };
    static const float h[EKF_M * EKF_N] = { 1.0f, 0.0f };
    static const float r[EKF_M * EKF_M] = { PEER_R };
    const float predicted[EKF_N] = { filter.x[0] + filter.x[1], filter.x[1] };
    ekf_predict(&filter, predicted, f, q);
    const float sample[EKF_M] = { z };
    const float expected[EKF_M] = { filter.x[0] };
    ekf_update(&filter, sample, expected, h, r);
    x = filter.x[0];
}
