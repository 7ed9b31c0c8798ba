/*
 * lrf: the linear robust filter of paper 002, rules (39), (40): the Kalman filter made for the mean variance of normal
 * and outlying samples, R_L = [q1 (1 - N^2) + N^2] R.
 *
 * The best that a constant gain can do against outliers of N sigma that come with probability 1 - q1, and the price is
 * paid without them: at q1 = 0.85, N = 20 it halves the error variance of kf under outliers (2.06) and raises it almost
 * six times on clean data (1 / 0.1715). Every outlier still passes, with a smaller gain. Functions: filter.h.
 */
#ifndef LRF_H
#define LRF_H

#include "two_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * R_L is limited to LRF_R_MAX_LSB2_Q8, 65,536 LSB^2: at the defaults (60.85 R) no legal R reaches it, at N = 32 and few
 * normal samples (1,024 R) R = 64 does. What binds first is the core's smallest q T^3 / R_L, 6e-8: where the paper's
 * formula asks for a gain below 0.022 the filter stays there (default q: above 550 Hz at the defaults).
 */
#define LRF_R_MAX_LSB2_Q8 0xFFFFFFU

typedef struct {
    uint16_t rate_dhz;   /* output data rate, 0.1 Hz: 50..40000 */
    uint32_t r_lsb2_q8;  /* measurement variance R of normal samples, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint32_t q_lsb2_s3;  /* power density of the white acceleration, LSB^2/s^3: 1..1e9; 0 is refused */
    uint16_t clean_uq16; /* probability of a normal sample q1: 0.01..0.99998 (656..65535); 0 is refused */
    uint16_t ratio_uq8;  /* sigma of an outlier over sigma N: 1..32 (256..8192), 1: kf; 0 is refused */
} lrf_config_t;

typedef struct {
    two_state_t core;     /* its R is R_L */
    uint32_t factor_uq16; /* R_L / R, 1..1024 */
} lrf_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t lrf_descriptor;

enum { lrf_worst_cycles = 800 }; /* of lrf_update, as in filter.h */

void lrf_defaults(lrf_config_t *config, uint16_t rate_dhz);
static inline bool lrf_together(const lrf_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool lrf_init(lrf_t *f, const lrf_config_t *config);
void lrf_configure(lrf_t *f, const lrf_config_t *config);
void lrf_set_noise(lrf_t *f, uint32_t r_lsb2_q8);
void lrf_reset(lrf_t *f, int16_t z0_lsb);
bool lrf_reset_step(lrf_t *f, int16_t z0_lsb, uint8_t step);
int32_t lrf_update(lrf_t *f, int16_t z_lsb);
int32_t lrf_coast(lrf_t *f);
void lrf_damp(lrf_t *f);
void lrf_hold(lrf_t *f);
void lrf_restart(lrf_t *f);
uint8_t lrf_flags(const lrf_t *f);
void lrf_probe(const lrf_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void lrf_gap(lrf_t *f)
{
    (void)f;
}

#ifdef __cplusplus
}
#endif
#endif
