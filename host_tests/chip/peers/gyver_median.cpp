/* GyverFilters' GMedian of its example's length, which is the best of 3 to 31 on this stream. */
#include "Arduino.h"
#include "filters/median.h"
#include "peer.h"

PEER_LSB

static GMedian<10, int16_t> filter;

void peer_start(void) {}

void peer_step(void)
{
    x = filter.filtered(z);
}
