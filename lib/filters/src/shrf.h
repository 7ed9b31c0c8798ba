/*
 * shrf: the structurally shortened robust filter of paper 002, (25)-(30) with (29) corrected: as pbf, but an outlier is
 * not used at all; in its place P grows with what the doubt about it is worth. Where P is at the end of its range
 * (32,768 R) and the sample is still an outlier beyond doubt the filter restarts from it (FILTER_REACQUIRED): in exact
 * arithmetic P would have grown until then. FILTER_GATED tells that the sample is more likely an outlier than not; its
 * gain is small, or 0. Functions: filter.h.
 */
#ifndef SHRF_H
#define SHRF_H

#include "mixture.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef mixture_config_t shrf_config_t;
typedef mixture_t shrf_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t shrf_descriptor;

enum { shrf_worst_cycles = 3450 }; /* of shrf_update, as in filter.h */

void shrf_defaults(shrf_config_t *config, uint16_t rate_dhz);
static inline bool shrf_together(const shrf_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool shrf_init(shrf_t *f, const shrf_config_t *config);
void shrf_configure(shrf_t *f, const shrf_config_t *config);
void shrf_set_noise(shrf_t *f, uint32_t r_lsb2_q8);
void shrf_reset(shrf_t *f, int16_t z0_lsb);
bool shrf_reset_step(shrf_t *f, int16_t z0_lsb, uint8_t step);
int32_t shrf_update(shrf_t *f, int16_t z_lsb);
int32_t shrf_coast(shrf_t *f);
void shrf_damp(shrf_t *f);
void shrf_hold(shrf_t *f);
void shrf_restart(shrf_t *f);
uint8_t shrf_flags(const shrf_t *f);
void shrf_probe(const shrf_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void shrf_gap(shrf_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
