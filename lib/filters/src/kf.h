/*
 * kf: two-state Kalman filter (position, rate), driven by white acceleration. Optimal for Gaussian noise; every outlier
 * passes with the full gain: the yardstick for the robust filters. Functions: see filter.h.
 */
#ifndef KF_H
#define KF_H

#include "two_state.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;  /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8; /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s3; /* power density of the white acceleration, LSB^2/s^3: 1..1e9; 0 is refused */
} kf_config_t;

typedef struct {
    two_state_t core;
} kf_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t kf_descriptor;

enum { kf_worst_cycles = 800 }; /* of kf_update, as in filter.h */

void kf_defaults(kf_config_t *config, uint16_t rate_dhz);
static inline bool kf_together(const kf_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool kf_init(kf_t *f, const kf_config_t *config);
void kf_configure(kf_t *f, const kf_config_t *config);
void kf_set_noise(kf_t *f, uint32_t r_lsb2_q8);
void kf_reset(kf_t *f, int16_t z0_lsb);
bool kf_reset_step(kf_t *f, int16_t z0_lsb, uint8_t step);
int32_t kf_update(kf_t *f, int16_t z_lsb);
int32_t kf_coast(kf_t *f);
void kf_damp(kf_t *f);
void kf_hold(kf_t *f);
void kf_restart(kf_t *f);
uint8_t kf_flags(const kf_t *f);
void kf_probe(const kf_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void kf_gap(kf_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
