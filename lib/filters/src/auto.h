/*
 * auto: three fading-memory filters side by side on the same samples, the estimate is that of the one that has
 * predicted best of late. Paper 004's rule, prediction against measurement, within one sensor.
 *
 *   x_e = x + v,  u = z - x_e,  x = x_e + (2 k - k^2) u,  v = v + k^2 u      k = 2 / memory in samples
 *
 * with a slow, a middle and a fast memory. Each member refuses a sample further off than its gate (the slow one, which
 * motion leaves behind, has twice the gate of the others); five refused on end and on the same side restart it there,
 * at rest, with a memory that grows by half a sample per sample up to its own.
 *
 * Each innovation is formed before its member is updated, refused ones too. The score of a member is the exponential
 * mean over eight samples of min(u^2, 64 R), so that an outlier, which all members meet alike, cannot decide alone. The
 * member with the least score is chosen, for this sample already, when it lies a thirty-second below that of the one
 * in force; FILTER_SWITCHED tells. Missing samples leave the scores alone.
 *
 * Through missing samples each member goes on by its rate, and the estimate is that of the middle one: its rate is
 * quiet enough for a gap at rest and quick enough for one in motion (auto_gap: stopped where it may be noise).
 * Functions: filter.h.
 */
#ifndef AUTO_H
#define AUTO_H

#include "filter.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;      /* output data rate, 0.1 Hz: 50..40000 */
    uint16_t gate_sigma_q8; /* gate in sigmas of a sample: 1..16 (256..4096), the slow member's is twice it; 0: none */
    uint32_t r_lsb2_q8;     /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint16_t slow_ms;       /* memories: 1..60000; each limited to 3.3..512 samples, not refused; in any order */
    uint16_t middle_ms;     /* of the member that also predicts what is missing */
    uint16_t fast_ms;
    uint32_t rate_max_lsb_s; /* limit of the estimated rates, LSB/s: 10..1000000; 0 is refused */
} auto_config_t;

enum auto_member { AUTO_SLOW, AUTO_MIDDLE, AUTO_FAST, AUTO_MEMBERS };

/* Refused samples on end and on one side that restart a member. */
enum { AUTO_RESTART_SAMPLES = 5 };

typedef struct {
    int32_t x_lsb_q16;       /* |x| <= FILTER_X_MAX_LSB */
    int32_t rate_lsb_q16;    /* per sample, |rate| <= rate_max_lsb_q16 */
    uint32_t score_lsb2_uq8; /* eight times the mean of the bounded squares, <= 8 x 64 R */
    uint16_t k_uq16;         /* 2 / memory in force: falls to that of the configuration */
    int8_t refused;          /* on end and on one side: samples above, or minus the samples below */
} auto_member_t;

typedef struct {
    union {
        auto_member_t members[AUTO_MEMBERS];
        int16_t start_lsb[FILTER_WARM_UP_SAMPLES]; /* while warming up: the samples seen, ascending */
    } u;
    int32_t innovation_lsb_q16; /* of the member shown, at the last update; 0 after a coast */
    uint32_t gate_lsb_uq8;      /* of the middle and the fast member */
    uint32_t rate_max_lsb_q16;
    uint32_t r_lsb2_q8;
    uint16_t eight_sigmas_lsb_uq8; /* the bound of an innovation in the score */
    uint16_t final_k_uq16[AUTO_MEMBERS];
    uint16_t still_uq16;    /* 1/8 of two sigmas of the middle member's rate, in sigmas of a sample */
    uint16_t gate_sigma_q8; /* as configured */
    uint16_t gain_uq16;     /* of the member shown, at the last update; 0: refused or coasted */
    uint8_t collected;      /* samples of the start, FILTER_WARM_UP_SAMPLES: running */
    uint8_t chosen;         /* member by the scores */
    uint8_t shown;          /* member whose estimate is told: the chosen one, through a gap the middle one */
    uint8_t flags;
} auto_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t auto_descriptor;

enum { auto_worst_cycles = 2450 }; /* of auto_update, as in filter.h */

void auto_defaults(auto_config_t *config, uint16_t rate_dhz);
static inline bool auto_together(const auto_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool auto_init(auto_t *f, const auto_config_t *config);
void auto_configure(auto_t *f, const auto_config_t *config);
void auto_set_noise(auto_t *f, uint32_t r_lsb2_q8);
void auto_reset(auto_t *f, int16_t z0_lsb);
bool auto_reset_step(auto_t *f, int16_t z0_lsb, uint8_t step);
int32_t auto_update(auto_t *f, int16_t z_lsb);
int32_t auto_coast(auto_t *f);
void auto_gap(auto_t *f);
void auto_damp(auto_t *f);
void auto_hold(auto_t *f);
void auto_restart(auto_t *f);
uint8_t auto_flags(const auto_t *f);
void auto_probe(const auto_t *f, filter_probe_t *out);

#ifdef __cplusplus
}
#endif
#endif
