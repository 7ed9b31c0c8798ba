/* No filter: what is in every program of peer_run.c. */
#include "peer.h"

PEER_LSB_TO_FIX16

void peer_start(void) {}

void peer_step(void)
{
    x = z;
}
