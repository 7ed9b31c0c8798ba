/*
 * TKJ Electronics' Kalman filter of an angle and a gyro's bias: with no rate given, the bias is the rate backwards. The
 * sign of the rate does not matter to the estimate, nor the time of a sample, so it is 1.
 */
#include "Kalman.h"
#include "peer.h"

PEER_FLOAT

static Kalman filter;

/* The covariance cannot be set: it starts at 0. */
void peer_start(void)
{
    filter.setRmeasure(PEER_R);
    filter.setQangle(0.0f);
    filter.setQbias(PEER_Q);
}

void peer_step(void)
{
    x = filter.getAngle(z, 0.0f, 1.0f);
}
