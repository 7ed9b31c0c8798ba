/*
 * Parameters on a longer path than the defaults, in force in the provoked regime of bench.c; included there once. A
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
NO_LONGER(lrf)
NO_LONGER(soft)
NO_LONGER(sprf)
NO_LONGER(sprf_paper)
NO_LONGER(shrf)
NO_LONGER(pbf)
NO_LONGER(af)

/* With a1 = 0 there is no second product. */
static inline void lengthen_synth(synth_config_t *config)
{
    synth_paper(config, config->rate_dhz);
}

#endif
