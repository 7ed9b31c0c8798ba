/*
 * af: the adaptive filter of paper 002: pbf that learns the probability of a normal sample while it runs. In place of
 * the paper's distribution on 50 points ((14)-(19), 584 multiplications) its mean alone is followed, q += (p - q) / n
 * with n up to 1024 samples: the same accuracy (notes of the paper: robust-filters) at a thirtieth of the cost. `clean`
 * is what it begins with. FILTER_GATED as in pbf. Functions: filter.h.
 */
#ifndef AF_H
#define AF_H

#include "mixture.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef mixture_config_t af_config_t;
typedef mixture_t af_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t af_descriptor;

enum { af_worst_cycles = 4200 }; /* of af_update, as in filter.h */

void af_defaults(af_config_t *config, uint16_t rate_dhz);
static inline bool af_together(const af_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool af_init(af_t *f, const af_config_t *config);
void af_configure(af_t *f, const af_config_t *config);
void af_set_noise(af_t *f, uint32_t r_lsb2_q8);
void af_reset(af_t *f, int16_t z0_lsb);
bool af_reset_step(af_t *f, int16_t z0_lsb, uint8_t step);
int32_t af_update(af_t *f, int16_t z_lsb);
int32_t af_coast(af_t *f);
void af_damp(af_t *f);
void af_hold(af_t *f);
void af_restart(af_t *f);
uint8_t af_flags(const af_t *f);
void af_probe(const af_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void af_gap(af_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
