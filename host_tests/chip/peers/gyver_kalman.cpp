/* GyverFilters' GKalman, which is SimpleKalmanFilter once more: the same parameters. */
#include "Arduino.h"
#include "filters/kalman.h"
#include "peer.h"

PEER_FLOAT

static GKalman filter(PEER_R, PEER_R, 0.05f);

void peer_start(void) {}

void peer_step(void)
{
    x = filter.filtered(z);
}
