/*
 * synth: the synthesised polynomial filter with constant parameters (Zimchuk and Shapar; paper 000
 * equation 7, paper 001).
 *
 *   x_e = (2 - a1) x1 - (1 - 2 a1) x2 - a1 x3        extrapolation from the last three estimates
 *   x   = x_e + b0 (z - x_e)
 *
 * computed in the incremental form x_e = x1 + d - a1 (d - d'), d = x1 - x2, d' = x2 - x3: two products instead of four,
 * the same by algebra. The papers feed back the estimates, not x_e (as one example prints): with x_e fed back no
 * measurement would reach the prediction. Not robust: every outlier passes with the gain b0. With a1 <= 0 the variance
 * of the estimate cannot fall below R / 2, whatever b0 (notes of the papers: synthesised-filter). Functions: filter.h.
 */
#ifndef SYNTH_H
#define SYNTH_H

#include "synth_common.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Together a1 and b0 must lie inside the stability region: 1 + 2 a1 (1 - b0) > 0, which is exact within their ranges
 * (where the region's other condition, 4 - 3 b0 - 4 a1 (1 - b0) > 0, always holds). The papers' b0 > -a1 - 0.3 is
 * sufficient only.
 */
typedef struct {
    uint16_t rate_dhz;  /* output data rate, 0.1 Hz: 50..40000 */
    uint16_t b0_uq16;   /* gain: 0.01..0.99998 (656..65535); 0 is refused */
    int32_t a1_q16;     /* extrapolation: -0.99998..0.99998 (-65535..65535); 0: straight line through two estimates */
    uint32_t r_lsb2_q8; /* measurement variance R, LSB^2: 0.01..1000 (3..256000), for start and probe; 0 is refused */
} synth_config_t;

typedef struct {
    synth_core_t core;
    synth_spread_t spread;
    uint16_t a1_uq16; /* magnitude */
    uint16_t b0_uq16; /* steady gain */
    bool a1_negative;
} synth_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t synth_descriptor;

enum { synth_worst_cycles = 500 }; /* of synth_update, as in filter.h */

/* The preset to use: a1 = 0, b0 = 0.3. */
void synth_defaults(synth_config_t *config, uint16_t rate_dhz);

/* The preset of paper 001: a1 = -0.3, b0 = 0.1. It overshoots a step by 69 % and hardly smooths (variance 0.82 R). */
void synth_paper(synth_config_t *config, uint16_t rate_dhz);

/*
 * Variance of the estimate's error per R in the steady state, white noise, UQ16.16, saturated; 1 (65536) and more: the
 * filter amplifies noise. Relative error below 2^-11 for a1 <= 0.95, 4e-3 at the upper corner of the region. Meaningful
 * for legal configurations; divides, 6,000 cycles.
 */
uint32_t synth_noise_gain_uq16(uint16_t b0_uq16, int32_t a1_q16);

bool synth_together(const synth_config_t *config);
bool synth_init(synth_t *f, const synth_config_t *config);
void synth_configure(synth_t *f, const synth_config_t *config);
void synth_set_noise(synth_t *f, uint32_t r_lsb2_q8);
void synth_reset(synth_t *f, int16_t z0_lsb);
bool synth_reset_step(synth_t *f, int16_t z0_lsb, uint8_t step);
int32_t synth_update(synth_t *f, int16_t z_lsb);
int32_t synth_coast(synth_t *f);
void synth_damp(synth_t *f);
void synth_gap(synth_t *f);
void synth_hold(synth_t *f);
void synth_restart(synth_t *f);
uint8_t synth_flags(const synth_t *f);
void synth_probe(const synth_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
