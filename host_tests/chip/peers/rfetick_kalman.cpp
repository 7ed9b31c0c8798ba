/* rfetick's Kalman filter with the matrices of BasicLinearAlgebra. */
#include "Kalman.h"
#include "peer.h"

PEER_FLOAT

static KALMAN<2, 1> filter;
static BLA::Matrix<1> sample;

void peer_start(void)
{
    filter.F = { 1.0f, 1.0f, 0.0f, 1.0f };
    filter.H = { 1.0f, 0.0f };
    filter.R = { PEER_R };
    filter.Q = { 0.0f, 0.0f, 0.0f, PEER_Q };
    filter.P = { PEER_R, 0.0f, 0.0f, PEER_RATE_VARIANCE };
}

void peer_step(void)
{
    sample(0) = z;
    filter.update(sample);
    x = filter.x(0);
}
