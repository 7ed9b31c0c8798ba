/* SimpleKalmanFilter: of q, which has no unit of ours, the best of 1, 0.5, 0.2, 0.1 ... 0.001 on this stream. */
#include "SimpleKalmanFilter.h"
#include "peer.h"

PEER_FLOAT

static SimpleKalmanFilter filter(PEER_R, PEER_R, 0.05f);

void peer_start(void) {}

void peer_step(void)
{
    x = filter.updateEstimate(z);
}
