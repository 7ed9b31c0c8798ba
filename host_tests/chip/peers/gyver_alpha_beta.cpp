/* GyverFilters' GABfilter: its gains follow from one ratio, of 0.5, 0.2, 0.1 ... 0.000001 the best on this stream. */
#include "Arduino.h"
#include "filters/alfaBeta.h"
#include "peer.h"

PEER_FLOAT

static GABfilter filter(1.0f, 0.0001f, 1.0f);

void peer_start(void) {}

void peer_step(void)
{
    x = filter.filtered(z);
}
