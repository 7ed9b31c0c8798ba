/*
 * synth_opt: the synthesised filter with parametric synthesis (Zimchuk and Shapar, paper 000, algorithm 22): a1 and b0
 * change from sample to sample by a schedule that the variance of the start's error, P0 over R, determines.
 *
 *   x_e = 2 x1 - x2 - a1(n) (x1 - 2 x2 + x3),   x = x_e + b0(n) (z - x_e),   b0 = Pe / (Pe + R)
 *
 * As printed the schedule is chaotic and its variance goes negative, because (17)-(19) take the variance of a linear
 * combination for a squared shift operator. Two that work, made off line by tools/design/schedule.py:
 *
 *   exact  Pe = h S h' with the covariance S of the last three errors, a1 = its optimum: ends at (0, 2/3), P = 2/3 R
 *   U      a1 by the paper's (21), Pe as if the errors were uncorrelated, the closest working relative of (20):
 *          ends at (-1/6, 11/13); its own P = 11/13 R there, true are 0.8059 R
 *
 * both with a1 in [-1/3, 0] and b0 in [1/2, 1), where any switching is stable. The steady gains do not depend on R: R
 * on line changes the start only. Not robust: every outlier passes with the gain b0. Functions: filter.h.
 */
#ifndef SYNTH_OPT_H
#define SYNTH_OPT_H

#include "synth_common.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;   /* output data rate, 0.1 Hz: 50..40000 */
    uint16_t variant_u;  /* 0: exact, 1: variant U */
    uint32_t p0_lsb2_q8; /* variance of the start's error P0, LSB^2: 0.01..100000 (3..25600000); 0 is refused */
    uint32_t r_lsb2_q8;  /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
} synth_opt_config_t;

typedef struct {
    synth_core_t core; /* collected: 5..16 the schedule's steps */
    uint32_t p0_lsb2_q8;
    uint8_t ratio_class; /* of P0 / R as it was at the last sample of the warm-up, 0..5: nearest to 1, 4, 16..1024 */
    bool variant_u;
} synth_opt_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t synth_opt_descriptor;

enum { synth_opt_worst_cycles = 500 }; /* of synth_opt_update, as in filter.h */

/*
 * Exact; P0 that of the median of the warm-up on an axis that moves at 200 LSB/s (rms, as the start of kf): it is two
 * samples old, (2 x 200 LSB/s x T)^2, and has 0.29 R of noise.
 */
void synth_opt_defaults(synth_opt_config_t *config, uint16_t rate_dhz);

static inline bool synth_opt_together(const synth_opt_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool synth_opt_init(synth_opt_t *f, const synth_opt_config_t *config);
void synth_opt_configure(synth_opt_t *f, const synth_opt_config_t *config);
void synth_opt_set_noise(synth_opt_t *f, uint32_t r_lsb2_q8);
void synth_opt_reset(synth_opt_t *f, int16_t z0_lsb);
bool synth_opt_reset_step(synth_opt_t *f, int16_t z0_lsb, uint8_t step);
int32_t synth_opt_update(synth_opt_t *f, int16_t z_lsb);
int32_t synth_opt_coast(synth_opt_t *f);
void synth_opt_damp(synth_opt_t *f);
void synth_opt_gap(synth_opt_t *f);
void synth_opt_hold(synth_opt_t *f);
void synth_opt_restart(synth_opt_t *f);
uint8_t synth_opt_flags(const synth_opt_t *f);
void synth_opt_probe(const synth_opt_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
