/*
 * sprf_paper: the binary-gated filter of paper 002, (34), as published: it LOCKS OUT. Shipped to be compared with; use
 * sprf.
 *
 * A sample further from the prediction than gate x sigma (of the innovation; 2 as published, with Xi read as an RMS) is
 * refused: predict only. Nothing else: no re-acquisition, no robust start. The first sample is taken whatever it is (x
 * = z, P11 = R: what an update from P(0) without bound leaves), so an outlier there makes every good sample after it an
 * outlier, and so does a step, until P has grown to it: a step of n sigma waits for P11 = n^2 / 4 R. Only at the end of
 * P's range (32,768 R, 362 sigma; from rest after 273 samples at 100 Hz with the defaults, 1,034 with the paper's R and
 * q) the next sample is taken (FILTER_REACQUIRED), because P can grow no further. Functions: filter.h.
 */
#ifndef SPRF_PAPER_H
#define SPRF_PAPER_H

#include "two_state_wide.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;      /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8;     /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s3;     /* power density of the white acceleration, LSB^2/s^3: 1..1e9; 0 is refused */
    uint16_t gate_sigma_q8; /* gate in sigmas of the innovation: 1..16 (256..4096); 0 is refused */
} sprf_paper_config_t;

typedef struct {
    two_state_wide_t core;
    uint16_t gate2_uq8; /* squared gate */
} sprf_paper_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t sprf_paper_descriptor;

enum { sprf_paper_worst_cycles = 2150 }; /* of sprf_paper_update, as in filter.h */

void sprf_paper_defaults(sprf_paper_config_t *config, uint16_t rate_dhz);
static inline bool sprf_paper_together(const sprf_paper_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool sprf_paper_init(sprf_paper_t *f, const sprf_paper_config_t *config);
void sprf_paper_configure(sprf_paper_t *f, const sprf_paper_config_t *config);
void sprf_paper_set_noise(sprf_paper_t *f, uint32_t r_lsb2_q8);
void sprf_paper_reset(sprf_paper_t *f, int16_t z0_lsb);
bool sprf_paper_reset_step(sprf_paper_t *f, int16_t z0_lsb, uint8_t step);
int32_t sprf_paper_update(sprf_paper_t *f, int16_t z_lsb);
int32_t sprf_paper_coast(sprf_paper_t *f);
void sprf_paper_damp(sprf_paper_t *f);
void sprf_paper_hold(sprf_paper_t *f);
void sprf_paper_restart(sprf_paper_t *f);
uint8_t sprf_paper_flags(const sprf_paper_t *f);
void sprf_paper_probe(const sprf_paper_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void sprf_paper_gap(sprf_paper_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
