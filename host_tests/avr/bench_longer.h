/*
 * Parameters on a longer path than the defaults, in force in the regime `longer` of bench.c; included there once. A
 * filter without an entry does not build.
 */
#ifndef BENCH_LONGER_H
#define BENCH_LONGER_H

#include "filter_list.h"

#define NO_LONGER(F)                                      \
    static inline void lengthen_##F(filter_config_t *config) \
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
static inline void lengthen_soft(filter_config_t *config)
{
    config->value[SOFT_SOFT_SIGMA_Q8] = 4096;
}

/* The numbers whose normalising takes longest, of a search over the legal ones. */
static inline void lengthen_mixture(filter_config_t *config)
{
    config->value[MIXTURE_RATIO_UQ8] = 640;
    config->value[MIXTURE_CLEAN_UQ16] = 45158;
}

static inline void lengthen_shrf(filter_config_t *config)
{
    lengthen_mixture(config);
}

static inline void lengthen_pbf(filter_config_t *config)
{
    lengthen_mixture(config);
}

static inline void lengthen_af(filter_config_t *config)
{
    lengthen_mixture(config);
}

/* Unguarded it spares the verdict, and nothing else costs more. */
static inline void lengthen_adaptive(filter_config_t *config)
{
    config->value[ADAPTIVE_GUARD_SIGMA_Q8] = 0;
}

/* With a1 = 0 there is no second product. */
static inline void lengthen_synth(filter_config_t *config)
{
    synth_paper(config, config->rate_dhz);
}

/* Variant U has a second product. */
static inline void lengthen_synth_opt(filter_config_t *config)
{
    config->value[SYNTH_OPT_VARIANT_U] = 1;
}

/* Three taps and the longest shift: near alpha-beta-gamma with 0.431, 0.129 and 0.0169 (lambda = 0.0005). */
static inline void lengthen_synth_plus(filter_config_t *config)
{
    config->value[SYNTH_PLUS_K] = 7;
    config->value[SYNTH_PLUS_B0_UQ16] = 28266;
    config->value[SYNTH_PLUS_B1_Q16] = -48056;
    config->value[SYNTH_PLUS_B2_Q16] = 20895;
}

#endif
