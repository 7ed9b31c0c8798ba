/* Peers (host_tests/support/peers.h, robust_peers.h) over many samples, for ctypes; arrays are runs x samples. */
#include "support/chain.h"
#include "support/filters.h"
#include "support/peers.h"
#include "support/robust_peers.h"

#include <math.h>
#include <stddef.h>

void trace_peer(int kind, double rate_hz, int runs, int samples, const double *z, double *x);
void trace_robust(int kind, const double *variances, const double *start, int runs, int samples, const double *z,
                  double *x);
int trace_chain(const char *name, int rate_dhz, int axis, int runs, int samples, const double *z, double *x);

void trace_peer(int kind, double rate_hz, int runs, int samples, const double *z, double *x)
{
    for (int run = 0; run < runs; run++) {
        peer_t peer;
        peer_begin(&peer, (peer_kind_t)kind, rate_hz);
        for (int k = 0; k < samples; k++) {
            *x++ = peer_sample(&peer, *z++);
        }
    }
}

/* variances: R, of the rate's growth in a sample, of the rate at the start. start: x, v, P11, P22 one sample before the
   first, or NULL: begins at the first sample. */
void trace_robust(int kind, const double *variances, const double *start, int runs, int samples, const double *z,
                  double *x)
{
    for (int run = 0; run < runs; run++) {
        robust_peer_t peer;
        robust_peer_begin(&peer, (robust_kind_t)kind, variances[0], variances[1], variances[2]);
        if (start != NULL) {
            robust_state_t from = { start[0], start[1], start[2], 0.0, start[3] };
            robust_peer_from(&peer, &from);
        }
        for (int k = 0; k < samples; k++) {
            *x++ = robust_peer_sample(&peer, *z++);
        }
    }
}

/* The firmware's sample path of one axis (support/chain.h) with a filter's defaults; z in whole LSB. Not 0: refused. */
int trace_chain(const char *name, int rate_dhz, int axis, int runs, int samples, const double *z, double *x)
{
    const filter_kind_t kind = filter_find(name);
    for (int run = 0; run < runs; run++) {
        chain_t chain;
        if (kind == FILTER_KIND_COUNT || !chain_begin(&chain, kind, (uint16_t)rate_dhz, 16, axis)) {
            return 1;
        }
        for (int k = 0; k < samples; k++) {
            uint64_t t_us = (uint64_t)10000000U * (uint64_t)k / (uint64_t)rate_dhz;
            *x++ = chain_sample(&chain, t_us, (int16_t)lround(*z++)) / 65536.0;
        }
    }
    return 0;
}
