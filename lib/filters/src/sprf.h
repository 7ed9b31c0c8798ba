/*
 * sprf: the two-state Kalman filter with a binary gate, made safe against lock-out.
 *
 * A sample further from the prediction than gate x sigma (of the innovation) is refused: predict only. Refused samples
 * that agree among themselves on raw values re-acquire: position and rate restart from them. Where nothing agrees for
 * long it stands still. Paper 002, rule (34) with r^2 <= gate^2 S, plus the running-median start and consistency
 * re-acquisition that its start and a step need. Functions: filter.h.
 */
#ifndef SPRF_H
#define SPRF_H

#include "reacquire.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;          /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8;         /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s3;         /* power density of the white acceleration, LSB^2/s^3: 1..1e9; 0 is refused */
    uint16_t gate_sigma_q8;     /* gate in sigmas of the innovation: 1..16 (256..4096); 0: no gate */
    uint16_t reacquire_samples; /* consistent refused samples that restart the filter: 3, 5 or 9; 0: never */
    uint32_t rate_max_lsb_s;    /* limit of the estimated rate, LSB/s: 10..1000000; 0 is refused */
} sprf_config_t;

/* Samples refused in a row until the rate is no longer believed: the next one stops it. */
#define SPRF_RATE_HELD_SAMPLES 5U

typedef struct {
    two_state_t core;
    reacquire_t again;
    uint16_t gate_sigma_q8;
    uint8_t refused; /* samples refused since the last accepted one, up to SPRF_RATE_HELD_SAMPLES */
} sprf_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t sprf_descriptor;

enum { sprf_worst_cycles = 1000 }; /* of sprf_update, as in filter.h */

void sprf_defaults(sprf_config_t *config, uint16_t rate_dhz);
bool sprf_together(const sprf_config_t *config);
bool sprf_init(sprf_t *f, const sprf_config_t *config);
void sprf_configure(sprf_t *f, const sprf_config_t *config);
void sprf_set_noise(sprf_t *f, uint32_t r_lsb2_q8);
void sprf_reset(sprf_t *f, int16_t z0_lsb);
bool sprf_reset_step(sprf_t *f, int16_t z0_lsb, uint8_t step);
int32_t sprf_update(sprf_t *f, int16_t z_lsb);
int32_t sprf_coast(sprf_t *f);
void sprf_damp(sprf_t *f);
void sprf_hold(sprf_t *f);
void sprf_restart(sprf_t *f);
uint8_t sprf_flags(const sprf_t *f);
void sprf_probe(const sprf_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void sprf_gap(sprf_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
