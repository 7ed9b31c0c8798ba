/*
 * soft: the two-state Kalman filter that trusts a sample the less the further off it is, and no sample not at all.
 *
 * The update takes S_eff = max(S, r^2 / softgate^2) for the variance S of the innovation r (Chang 2014, scaled
 * innovation variance): within softgate sigmas it is kf bit for bit, beyond them its step falls with 1 / |r| but is
 * never zero, so it cannot be locked out even without re-acquisition. Samples beyond `gate` sigmas that agree among
 * themselves re-acquire as in sprf. Functions: filter.h.
 *
 * FILTER_GATED tells that the sample lies beyond the gate (as far out as sprf with that gate would refuse it) and
 * beyond softgate: it was taken in part only, so unlike in sprf the gain is not 0. gate_lsb2_q8 of the probe is the
 * limit of the squared innovation above which the weight falls, softgate^2 S.
 */
#ifndef SOFT_H
#define SOFT_H

#include "reacquire.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;          /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8;         /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s3;         /* power density of the white acceleration, LSB^2/s^3: 1..1e9; 0 is refused */
    uint16_t soft_sigma_q8;     /* sigmas of the innovation where the weight begins to fall: 1..16 (256..4096); 0: kf */
    uint16_t gate_sigma_q8;     /* samples beyond so many sigmas are flagged and may re-acquire: 1..16; 0: none */
    uint16_t reacquire_samples; /* consistent flagged samples that restart the filter: 3, 5 or 9; 0: never */
    uint32_t rate_max_lsb_s;    /* limit of the estimated rate, LSB/s: 10..1000000; 0 is refused */
} soft_config_t;

typedef struct {
    two_state_t core;
    uint16_t share_uq16; /* (softgate / gate)^2: a sample whose S / S_eff is smaller is flagged; 0: none is */
    reacquire_t again;
    uint16_t soft_sigma_q8;
} soft_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t soft_descriptor;

enum { soft_worst_cycles = 1300 }; /* of soft_update, as in filter.h */

void soft_defaults(soft_config_t *config, uint16_t rate_dhz);
bool soft_together(const soft_config_t *config);
bool soft_init(soft_t *f, const soft_config_t *config);
void soft_configure(soft_t *f, const soft_config_t *config);
void soft_set_noise(soft_t *f, uint32_t r_lsb2_q8);
void soft_reset(soft_t *f, int16_t z0_lsb);
bool soft_reset_step(soft_t *f, int16_t z0_lsb, uint8_t step);
int32_t soft_update(soft_t *f, int16_t z_lsb);
int32_t soft_coast(soft_t *f);
void soft_damp(soft_t *f);
void soft_hold(soft_t *f);
void soft_restart(soft_t *f);
uint8_t soft_flags(const soft_t *f);
void soft_probe(const soft_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void soft_gap(soft_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
