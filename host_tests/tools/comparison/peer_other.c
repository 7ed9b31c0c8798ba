/* Filters that are written for the comparison, in float: host_tests/support/peers.c and robust_peers.c. */
#include "peer.h"
#include "support/peers.h"
#include "support/robust_peers.h"

PEER_LSB_TO_FLOAT

/* Compiled alone, as by make check, the first. */
#if !defined(PEER_KIND) && !defined(PEER_ROBUST)
#define PEER_KIND PEER_EMA_ALONE
#endif

#ifdef PEER_KIND
static peer_t filter;

void peer_start(void)
{
    peer_begin(&filter, PEER_KIND, 100.0);
}

void peer_step(void)
{
    x = (float)peer_sample(&filter, z);
}
#else
static robust_peer_t filter;

void peer_start(void)
{
    robust_peer_begin(&filter, PEER_ROBUST, PEER_R, PEER_Q, PEER_RATE_VARIANCE);
}

void peer_step(void)
{
    x = (float)robust_peer_sample(&filter, z);
}
#endif
