/*
 * What shrf, pbf and af share: the sample is normal (variance R) with probability q, else an outlier (variance N^2 R),
 * and each sample counts by the probability p that it is normal, given those before (paper 002, equations (10)-(13),
 * (25)-(30)):
 *
 *   t = r^2 / (R S); b = 1 - S / S_N, S_N = P11 + N^2
 *   L = ln(q / (1 - q)) + 1/2 ln(S_N / S) - 1/2 b t;  p = 1 / (1 + e^-L)
 *   MIXTURE_BAYES      loss = b (1 - p), back = loss (1 + p b t)     both states of the channel, moments matched
 *   MIXTURE_SHORTENED  loss = 1 - p,     back = loss (1 + p t)       an outlier is not used at all
 *
 * with loss and back of two_state_wide.h. Where q is learnt: q += (p - q) / n, n = 3, 4 .. 1024. Internal to the
 * library.
 */
#ifndef MIXTURE_H
#define MIXTURE_H

#include "two_state_wide.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Probability of a normal sample, UQ0.16: at least one half, or a sample on the prediction would count as an outlier.
 * Ratio of the outliers' sigma to the noise's, UQ8.8.
 */
#define MIXTURE_CLEAN_MIN_UQ16 32768U
#define MIXTURE_CLEAN_MAX_UQ16 65470U
#define MIXTURE_CLEAN_DEFAULT_UQ16 55706U
#define MIXTURE_RATIO_MIN_Q8 512U
#define MIXTURE_RATIO_MAX_Q8 25600U
#define MIXTURE_RATIO_DEFAULT_Q8 5120U

/* L beyond this: p or 1 - p is exactly 0. Nearer p (1 - p) r^2 still matters, because it is what makes P grow again. */
#define MIXTURE_TAIL_Q9 (12 * 512)

/* A learnt q stays this far from 0 and 1: 1/1024, what one sample can move it. */
#define MIXTURE_LEARNT_MARGIN_UQ24 0x4000U

typedef struct {
    uint16_t rate_dhz;   /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8;  /* measurement variance R of normal samples, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s3;  /* power density of the white acceleration, LSB^2/s^3: 1..1e9; 0 is refused */
    uint16_t ratio_uq8;  /* N: sigma of outliers over that of normal samples: 2..100 (512..25600) */
    uint16_t clean_uq16; /* q: probability of a normal sample: 0.5..0.999 (32768..65470); what learning begins with */
} mixture_config_t;

typedef enum { MIXTURE_BAYES, MIXTURE_SHORTENED } mixture_rule_t;

typedef struct {
    two_state_wide_t core;
    uint32_t span_uq16;   /* N^2 - 1 */
    fx_leading_t span;    /* the same */
    int16_t log_odds_q9;  /* ln(q / (1 - q)) */
    uint16_t clean_uq16;  /* q as configured */
    uint16_t learnt_from; /* samples that q is learnt from, 2 to begin with; 0: q is given */
    uint32_t learnt_uq24; /* q, where it is learnt */
} mixture_t;

/* Parameters r, q, ratio, clean in program memory. */
#define MIXTURE_PARAMETERS 4U
extern const filter_parameter_t mixture_parameters[MIXTURE_PARAMETERS];

FX_ONCE void mixture_defaults(mixture_config_t *config, uint16_t rate_dhz);

/* False: a parameter is outside its legal range, f untouched. learning: of q. */
FX_ONCE bool mixture_init(mixture_t *f, const mixture_config_t *config, bool learning);
FX_ONCE void mixture_configure(mixture_t *f, const mixture_config_t *config, bool learning);

/* As F_reset of filter.h; what was learnt is forgotten. */
FX_ONCE void mixture_reset(mixture_t *f, int16_t z0_lsb);
FX_ONCE bool mixture_reset_step(mixture_t *f, int16_t z0_lsb, uint8_t step);

/* As F_update of filter.h. */
FX_ONCE int32_t mixture_update(mixture_t *f, int16_t z_lsb, mixture_rule_t rule);

/* The pieces, for the tests: p as min(p, 1 - p) and which of the two it is. */
typedef struct {
    uint32_t rest_uq24; /* UQ0.24 */
    bool outlier;       /* p < 1/2: rest is p */
} mixture_posterior_t;

/*
 * p for L: |error| <= 0.0016 in p, and 2 % and 2^-24 of min(p, 1 - p). Table of 25 nodes 0.5 apart, straight lines
 * between, placed so that the chords' error is centred.
 */
mixture_posterior_t mixture_posterior(int16_t log_odds_q9);

/* ln(q / (1 - q)) for 2^-14 <= q <= 1 - 2^-14: |error| <= 0.006. */
int16_t mixture_log_odds_q9(uint32_t q_uq24);

#ifdef __cplusplus
}
#endif
#endif
