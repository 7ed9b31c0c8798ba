/*
 * Parameters on a longer path than the defaults, in force in the regime `longer` of bench.c; included there once. A
 * filter without an entry does not build.
 */
#ifndef BENCH_LONGER_H
#define BENCH_LONGER_H

#include "filter_list.h"

#define NO_LONGER(F)                                      \
    static inline void lengthen_##F(F##_config_t *config) \
    {                                                     \
        (void)config;                                     \
    }
NO_LONGER(kf)
NO_LONGER(kf3)
NO_LONGER(lrf)
NO_LONGER(sprf)
NO_LONGER(sprf_paper)
NO_LONGER(auto)

/* From R = 16 LSB^2 on such a soft gate takes the coarse format. */
static inline void lengthen_soft(soft_config_t *config)
{
    config->soft_sigma_q8 = 4096;
}

/* The numbers whose normalising takes longest, of a search over the legal ones. */
static inline void lengthen_mixture(mixture_config_t *config)
{
    config->ratio_uq8 = 640;
    config->clean_uq16 = 45158;
}

static inline void lengthen_shrf(shrf_config_t *config)
{
    lengthen_mixture(config);
}

static inline void lengthen_pbf(pbf_config_t *config)
{
    lengthen_mixture(config);
}

static inline void lengthen_af(af_config_t *config)
{
    lengthen_mixture(config);
}

/* Unguarded it spares the verdict, and nothing else costs more. */
static inline void lengthen_adaptive(adaptive_config_t *config)
{
    config->guard_sigma_q8 = 0;
}

/* With a1 = 0 there is no second product. */
static inline void lengthen_synth(synth_config_t *config)
{
    synth_paper(config, config->rate_dhz);
}

/* Variant U has a second product. */
static inline void lengthen_synth_opt(synth_opt_config_t *config)
{
    config->variant_u = 1;
}

/* Three taps and the longest shift: near alpha-beta-gamma with 0.431, 0.129 and 0.0169 (lambda = 0.0005). */
static inline void lengthen_synth_plus(synth_plus_config_t *config)
{
    config->k = 7;
    config->b0_uq16 = 28266;
    config->b1_q16 = -48056;
    config->b2_q16 = 20895;
}

#endif
