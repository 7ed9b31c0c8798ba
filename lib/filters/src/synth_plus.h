/*
 * synth_plus: the synthesised filter with a memory of innovations, B(z) = b0 + b1 z^-1 + b2 z^-2 (paper 001 equation
 * 16, the past innovations inside x_e):
 *
 *   x_e = 2 x1 - x2 - a1 (x1 - 2 x2 + x3) + b1 u1 + b2 u2,   u = z - x_e,   x = x_e + b0 u
 *
 * so x / z = B / D with D = B + (1 - b0) A, A = (1 - z^-1)^2 (1 + a1 z^-1). Contains what `synth` cannot be, with the
 * acceleration's correlation rho = -a1 from sample to sample and gains k1, k2, k3 of x' = x + v, v' = v + a, a' = rho a
 *
 *   alpha-beta        rho = 0: b0 = alpha, b1 = beta - alpha, b2 = 0
 *   steady Singer     b0 = k1, b1 = k2 - (1 + rho) k1, b2 = rho (k1 - k2) + k3; of a Kalman filter that is
 *   filter            b2 = rho (1 - b0) (b1 + (2 + rho) b0)
 *   alpha-beta-gamma  the same with rho = 1
 *
 * At most three products a sample: b0 u, b1 u and, unless b2 is 0, b2 u, each of a state of 32 bits and a tap of 16,
 * that is two multiplications of 16 x 16 bits or eight of the chip's. Four free coefficients would need a fourth, so
 * rho = 1 - 2^-k: what is taken from the curvature is a shift. The chip, which shifts one place at a time, makes that
 * shift with four multiplications of its bytes by 2^(8-k), half of what a product takes. A process whose rho lies
 * between two of these is followed with the taps made for the nearer one (test_synth_plus_reference.c tells what that
 * costs). Not robust: every outlier passes with the gain b0. Functions: filter.h.
 */
#ifndef SYNTH_PLUS_H
#define SYNTH_PLUS_H

#include "synth_common.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Together the four must be stable: D has its zeros inside the unit circle, which is (Jury's test of the third order)
 *
 *   b0 + b1 + b2 > 0,   b0 - b1 + b2 + 4 (1 - b0) (1 + rho) > 0,   b0 - b2 > (1 - b0) rho (2 b0 + b1)
 *
 * and decided in exact integers.
 */
typedef struct {
    uint16_t rate_dhz;  /* output data rate, 0.1 Hz: 50..40000 */
    uint16_t b0_uq16;   /* gain: 0.01..0.99998 (656..65535); 0 is refused */
    uint16_t k;         /* rho = -a1 = 1 - 2^-k: 0..7, 0: a1 = 0; 8: rho = 1 */
    int32_t b1_q16;     /* of the last innovation: -0.99998..0.99998 (-65535..65535) */
    int32_t b2_q16;     /* of the one before, likewise */
    uint32_t r_lsb2_q8; /* measurement variance R, LSB^2: 0.01..1000 (3..256000), for start and probe; 0 is refused */
} synth_plus_config_t;

typedef struct {
    synth_core_t core;
    int32_t memory_lsb_q16; /* of the next x_e: b1 u1 + b2 u2 and curvature, |memory| <= 18432 LSB */
    synth_spread_t spread;
    uint16_t b0_uq16;
    uint16_t b1_uq16; /* magnitudes */
    uint16_t b2_uq16;
    uint8_t k;
    uint8_t rest_uq8; /* 2^-k, 0 with rho = 1 */
    bool b1_negative : 1;
    bool b2_negative : 1;
} synth_plus_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t synth_plus_descriptor;

enum { synth_plus_worst_cycles = 700 }; /* of synth_plus_update, as in filter.h */

/*
 * Alpha-beta with the steady gains of `kf` at its defaults (q = 10,000 LSB^2/s^3, R by rate): alpha by a rational
 * function of the rate within 0.1 % of them from 25 to 800 Hz, limited as they are to 0.022..0.769; beta = alpha^2 /
 * (2 - alpha), the relation that they have.
 */
void synth_plus_defaults(synth_plus_config_t *config, uint16_t rate_dhz);

/*
 * Variance of the estimate's error per R in the steady state, white noise, UQ16.16, saturated. Relative error below
 * 2^-9 where the poles are within 0.99. Meaningful for legal configurations; divides, 10,000 cycles.
 */
uint32_t synth_plus_noise_gain_uq16(const synth_plus_config_t *config);

bool synth_plus_together(const synth_plus_config_t *config);
bool synth_plus_init(synth_plus_t *f, const synth_plus_config_t *config);
void synth_plus_configure(synth_plus_t *f, const synth_plus_config_t *config);
void synth_plus_set_noise(synth_plus_t *f, uint32_t r_lsb2_q8);
void synth_plus_reset(synth_plus_t *f, int16_t z0_lsb);
bool synth_plus_reset_step(synth_plus_t *f, int16_t z0_lsb, uint8_t step);
int32_t synth_plus_update(synth_plus_t *f, int16_t z_lsb);
int32_t synth_plus_coast(synth_plus_t *f);
void synth_plus_damp(synth_plus_t *f);
void synth_plus_hold(synth_plus_t *f);
void synth_plus_restart(synth_plus_t *f);
uint8_t synth_plus_flags(const synth_plus_t *f);
void synth_plus_probe(const synth_plus_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void synth_plus_gap(synth_plus_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
