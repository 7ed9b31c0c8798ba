#include "support/peers.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define TWO_PI 6.283185307179586

static const char *const names[PEERS] = { "ema", "median3_ema", "median5_ema", "hampel7_ema", "one_euro" };

const char *peer_name(peer_kind_t kind)
{
    return names[kind];
}

void peer_begin(peer_t *peer, peer_kind_t kind, double rate_hz)
{
    memset(peer, 0, sizeof *peer);
    peer->kind = kind;
    peer->rate_hz = rate_hz;
    peer->weight = 1.0 - exp(-TWO_PI * PEER_EMA_HZ / rate_hz);
}

/* Of an even number the upper one of the middle. */
static double median_of(const double *value, unsigned count)
{
    double ascending[PEER_HAMPEL] = { 0.0 };
    for (unsigned i = 0; i < count; i++) {
        unsigned at = i;
        for (; at > 0 && ascending[at - 1] > value[i]; at--) {
            ascending[at] = ascending[at - 1];
        }
        ascending[at] = value[i];
    }
    return ascending[count / 2U];
}

/* The median of the last `window` samples, the newest among them. */
static double median_with(peer_t *peer, double z_lsb, unsigned window)
{
    memmove(peer->seen_lsb + 1, peer->seen_lsb, sizeof peer->seen_lsb - sizeof peer->seen_lsb[0]);
    peer->seen_lsb[0] = z_lsb;
    return median_of(peer->seen_lsb, peer->filled < window ? peer->filled : window);
}

static double hampel(peer_t *peer, double z_lsb)
{
    double median_lsb = median_with(peer, z_lsb, PEER_HAMPEL);
    double off_lsb[PEER_HAMPEL];
    for (unsigned i = 0; i < peer->filled; i++) {
        off_lsb[i] = fabs(peer->seen_lsb[i] - median_lsb);
    }
    double limit_lsb = 3.0 * 1.4826 * median_of(off_lsb, peer->filled);
    return fabs(z_lsb - median_lsb) > limit_lsb ? median_lsb : z_lsb;
}

static double ema(const peer_t *peer, double z_lsb)
{
    return peer->x_lsb + peer->weight * (z_lsb - peer->x_lsb);
}

/* Weight of the first-order low pass of the 1-euro filter. */
static double euro_weight(double cut_hz, double rate_hz)
{
    return 1.0 / (1.0 + rate_hz / (TWO_PI * cut_hz));
}

static double euro(peer_t *peer, double z_lsb)
{
    double slope_lsb_s = (z_lsb - peer->x_lsb) * peer->rate_hz;
    peer->slope_lsb_s += euro_weight(PEER_EURO_HZ, peer->rate_hz) * (slope_lsb_s - peer->slope_lsb_s);
    double cut_hz = PEER_EURO_HZ + PEER_EURO_BETA * fabs(peer->slope_lsb_s);
    return peer->x_lsb + euro_weight(cut_hz, peer->rate_hz) * (z_lsb - peer->x_lsb);
}

static double cleaned(peer_t *peer, double z_lsb)
{
    switch (peer->kind) {
    case PEER_MEDIAN3_EMA:
        return median_with(peer, z_lsb, PEER_SHORT_MEDIAN);
    case PEER_MEDIAN_EMA:
        return median_with(peer, z_lsb, PEER_MEDIAN);
    case PEER_HAMPEL_EMA:
        return hampel(peer, z_lsb);
    default:
        return z_lsb;
    }
}

double peer_sample(peer_t *peer, double z_lsb)
{
    bool first = peer->filled == 0;
    peer->filled = peer->filled < PEER_HAMPEL ? peer->filled + 1U : PEER_HAMPEL;
    double taken_lsb = cleaned(peer, z_lsb);
    if (first) {
        peer->x_lsb = z_lsb;
    } else {
        peer->x_lsb = peer->kind == PEER_EURO ? euro(peer, taken_lsb) : ema(peer, taken_lsb);
    }
    return peer->x_lsb;
}
