/*
 * pbf: the pseudo-Bayesian filter of paper 002, (8), (12), (13): each sample is normal with probability `clean`, else
 * an outlier whose sigma is `ratio` times as large; the update is weighted by the probability of each, and the two
 * outcomes merge into one estimate (GPB1). Nothing is refused for ever: an outlier moves the estimate a little, and P
 * by as much as the sample is surprising. FILTER_GATED tells that the sample is more likely an outlier than not; its
 * gain is small, not 0. Steady-state accuracy under the paper's outliers: the best of the family. Functions: filter.h.
 */
#ifndef PBF_H
#define PBF_H

#include "mixture.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef mixture_config_t pbf_config_t;
typedef mixture_t pbf_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t pbf_descriptor;

enum { pbf_worst_cycles = 3500 }; /* of pbf_update, as in filter.h */

void pbf_defaults(pbf_config_t *config, uint16_t rate_dhz);
static inline bool pbf_together(const pbf_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool pbf_init(pbf_t *f, const pbf_config_t *config);
void pbf_configure(pbf_t *f, const pbf_config_t *config);
void pbf_set_noise(pbf_t *f, uint32_t r_lsb2_q8);
void pbf_reset(pbf_t *f, int16_t z0_lsb);
bool pbf_reset_step(pbf_t *f, int16_t z0_lsb, uint8_t step);
int32_t pbf_update(pbf_t *f, int16_t z_lsb);
int32_t pbf_coast(pbf_t *f);
void pbf_damp(pbf_t *f);
void pbf_hold(pbf_t *f);
void pbf_restart(pbf_t *f);
uint8_t pbf_flags(const pbf_t *f);
void pbf_probe(const pbf_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void pbf_gap(pbf_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
