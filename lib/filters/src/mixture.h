/* The parts of mixture.c that its tests use. Internal to the library. */
#ifndef MIXTURE_H
#define MIXTURE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * |L| from here on: p or 1 - p is exactly 0. Below, p (1 - p) u^2 still matters, because it is what makes P grow again.
 */
#define MIXTURE_TAIL_Q9 (12 * 512)

/* q stays this far from 0 and 1: 1/1024, as much as one sample can move a learnt q. */
#define MIXTURE_MARGIN_UQ24 0x4000U

/* p as min(p, 1 - p), and which of the two it is. */
typedef struct {
    uint32_t rest_uq24; /* UQ0.24 */
    bool outlier;       /* p < 1/2: rest is p */
} mixture_posterior_t;

/*
 * p for L: |error| <= 0.0016 in p, and 2 % and 2^-24 of min(p, 1 - p). Table of 25 nodes 0.5 apart, linear
 * interpolation, placed so that the error of the chords is centred.
 */
mixture_posterior_t filter_mixture_posterior(int16_t log_odds_q9);

/* ln(q / (1 - q)) for 2^-14 <= q <= 1 - 2^-14: |error| <= 0.006. */
int16_t filter_mixture_log_odds_q9(uint32_t q_uq24);

#ifdef __cplusplus
}
#endif
#endif
