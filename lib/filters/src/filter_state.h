/*
 * State of a filter: what the tracker keeps for every law, followed by the law's own. Included by filter.h because
 * users declare a filter_t; read it through filter_probe.
 */
#ifndef FILTER_STATE_H
#define FILTER_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "fx.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct filter_law filter_law_t;

/*
 * The first part of a law's state is valid while the filter runs. Before that, the samples of the start are stored in
 * its place. The rest comes from the configuration or was learnt about the noise, and survives a restart.
 */
typedef struct {
    int16_t ascending_lsb[5]; /* the samples so far, ascending */
} filter_start_t;

/* Covariance of position and rate over R; kalman.h, wide.h and kf3.c each define the formats of the elements. */
typedef struct {
    uint32_t p11, p12, p22;
} filter_covariance_t;

/* kf, lrf, sprf, soft: see kalman.h. */
typedef struct {
    filter_covariance_t p;  /* P11 in UQ8.24, P12 and P22 in UQ6.26 */
    uint32_t limit_lsb2;    /* of the squared innovation at the last step: UQ16.16, UQ24.8 when coarse; 0: none yet */
    int16_t first_lsb;      /* first sample of the run of refused samples */
    uint8_t run;            /* its length so far */
    uint8_t refused;        /* samples refused since the last accepted one, up to a few */
    uint32_t q22_uq26;      /* process noise of the rate per sample / R */
    uint16_t gate_lsb2_uq6; /* gate^2 R, UQ10.6; when coarse, in 4 LSB^2 */
    bool gated;             /* there is a gate */
    bool coarse;
    uint16_t agree_lsb;      /* raw samples of one run differ by at most this */
    uint32_t p22_start_uq26; /* variance of the rate at the start / R */
    uint32_t r_lsb2_q8;      /* measurement variance in force */
    fx_scaled_t drive_lsb2;  /* q T^3 */
    fx_scaled_t start_lsb2;  /* variance of the rate per sample at the start */
    union {
        struct {
            uint16_t gate_sigma_q8; /* 0: no gate */
            uint16_t share_uq16;    /* soft: (softgate / gate)^2; a sample whose S / S_eff is smaller is flagged */
        } gated;
        uint32_t factor_uq16; /* lrf: R_L / R of a sample */
    } of;
    uint8_t steps; /* length of a run that restarts, less one, a power of two; 0: never */
} filter_kalman_t;

/* sprf_paper and the mixture: see wide.h. */
typedef struct {
    filter_covariance_t p;  /* UQ16.16, UQ8.24, UQ4.28 */
    fx_leading_t variance;  /* S of the last step, UQ16.16; 0: none yet */
    uint16_t inverse_uq16;  /* 1 / its mantissa */
    uint16_t gate2_uq8;     /* sprf_paper: squared gate; 0: none */
    uint32_t q22_uq28;      /* process noise of the rate per sample / R */
    uint32_t r_lsb2_q8;     /* measurement variance in force */
    fx_scaled_t per_r;      /* 1 / R, 1/LSB^2 */
    fx_scaled_t drive_lsb2; /* q T^3 */
    fx_scaled_t start_lsb2; /* variance of the rate per sample at the start */
    uint32_t p22_start_uq28;
} filter_wide_t;

/* pbf, shrf, af: see mixture.h. */
typedef struct {
    filter_wide_t core;
    uint32_t span_uq16;   /* N^2 - 1 */
    int16_t log_odds_q9;  /* ln(q / (1 - q)) */
    uint16_t clean_uq16;  /* q as configured */
    uint16_t learnt_from; /* samples that q was learnt from, initially 2; 0: q is not learnt */
    uint32_t normal_uq24; /* q in force */
    uint16_t leave_uq16;  /* outliers as a Markov chain: probability of a normal sample after an outlier; 0: no chain */
    uint16_t turn_uq16;   /* how much larger it is after a normal sample */
} filter_mixture_t;

/* synth, synth_opt, synth_plus: see synth.h. */
typedef struct {
    int32_t rate_before_lsb_q16; /* of the previous step */
    int32_t memory_lsb_q16;      /* synth_plus: added to the next prediction */
    uint8_t count;               /* samples since the start; SYNTH_STEADY: the gains are the steady ones */
    uint8_t unused;
    uint32_t r_lsb2_q8; /* measurement variance in force */
    uint16_t b0_uq16;   /* steady gain */
    uint16_t a1_uq16;   /* magnitude of the steady extrapolation; 0: a straight line */
    bool a1_negative;
    union {
        struct {
            uint32_t p0_lsb2_q8;
            uint8_t ratio_class;
            bool variant_u;
        } scheduled;
        struct {
            uint16_t b1_uq16; /* magnitudes */
            uint16_t b2_uq16;
            bool b1_negative;
            bool b2_negative;
            uint8_t k;
            uint8_t rest_uq8; /* 2^-k; 0 for rho = 1 */
        } plus;
    } of;
} filter_synth_t;

/* adaptive: see adaptive.c. */
typedef struct {
    int32_t mean_lsb_q24;      /* of the innovations, each limited to the gate and 128 LSB; positive: as the last */
    uint32_t k_uq32;           /* 1 - fading factor, at the last update */
    uint32_t gate_lsb_uq16;    /* of the last step */
    uint16_t run;              /* samples in a row beyond the gate on one side */
    uint8_t verdict;           /* the guard's verdict on the last sample */
    uint8_t strays;            /* count of unused samples, see adaptive.h */
    uint32_t scatter_lsb_uq24; /* sigma of the innovations for k = 0: 0.1..90 */
    uint16_t gate_sigma_q8;    /* in sigmas of the innovation */
    bool guarded;              /* a gate is configured */
    uint8_t learnt;            /* terms that the scatter was learnt from, up to the opening ones */
    bool turn;                 /* the last sample contributed to the scatter */
    uint16_t share_uq16;       /* weight of a new innovation in their mean */
    uint16_t manoeuvre_uq16;   /* mean innovation, in sigmas of one, that shortens the memory */
    uint16_t fast_uq16;        /* k of the shortest and of the slowest memory */
    uint16_t slow_uq16;
    uint16_t confirm; /* samples until a jump is accepted */
} filter_adaptive_t;

/* kf3: see kf3.c. */
typedef struct {
    filter_covariance_t p; /* UQ4.28 */
    uint32_t p13_uq28;     /* P / R of the acceleration, in its unit */
    uint32_t p23_uq28;
    uint32_t p33_uq28;
    int32_t acceleration_q16; /* LSB per sample^2, in sixteenths when fine; |.| <= 4608 */
    uint32_t q33_uq28;        /* process noise of the acceleration per sample / R */
    uint32_t r_lsb2_q8;
    fx_scaled_t drive_lsb2; /* q T^5, 256 times that when fine */
    fx_scaled_t start_lsb2;
    uint32_t p22_start_uq28;
    bool fine; /* the acceleration is counted in sixteenths */
} filter_kf3_t;

/* One of the three members of auto: see auto.c. */
typedef struct {
    int32_t x_lsb_q16;       /* |x| <= FILTER_X_MAX_LSB */
    int32_t rate_lsb_q16;    /* per sample, |rate| <= rate_max */
    uint32_t score_lsb2_uq8; /* eight times the mean of the limited squares, <= 8 x 64 R */
    uint16_t k_uq16;         /* 2 / memory in force: falls to the configured one */
    int8_t refused;          /* refused in a row on one side: the number above, or minus the number below */
} filter_member_t;
enum filter_auto_member { AUTO_SLOW, AUTO_MIDDLE, AUTO_FAST, AUTO_MEMBERS };

typedef struct {
    filter_member_t members[AUTO_MEMBERS];
    uint8_t chosen;                /* member with the best score */
    uint8_t shown;                 /* member whose estimate is shown: the chosen one, through a gap the middle one */
    uint16_t eight_sigmas_lsb_uq8; /* limit of an innovation in the score */
    uint16_t still_uq16;           /* share of it below which the middle member's rate is noise */
    uint16_t final_k_uq16[AUTO_MEMBERS];
    uint16_t gate_sigma_q8; /* as configured */
} filter_auto_t;

typedef struct {
    int32_t x_lsb_q16;       /* estimate, |x| <= FILTER_X_MAX_LSB */
    uint8_t flags;           /* FILTER_* of the last update or missing sample */
    uint8_t collected;       /* samples of the start; FILTER_WARM_UP_SAMPLES: running */
    const filter_law_t *law; /* in program memory */
    int32_t rate_lsb;        /* change of x per sample, Q16, or Q24 with a fine law; |rate| <= rate_max */
    uint32_t size_lsb_uq16;  /* |innovation| of the last step, <= 8704 LSB; 0 after a missing sample */
    uint32_t rate_max_lsb;
    uint16_t gain_uq16;   /* w1 of the last step, 0 when refused or missing */
    int16_t previous_lsb; /* last raw sample */
    bool negative;        /* sign of the innovation */
    bool identifies;      /* the law identifies its noise itself: filter_own_noise_lsb2_q8 */
    bool broken;          /* a sample was missing since the run of refused ones began, see kalman.h */
    bool q_limited;       /* filter_limited */
    uint8_t quarters;     /* multiples of 25 ms without a sample, up to FILTER_HOLD_MS */
    union {
        filter_start_t start;
        filter_kalman_t kalman;
        filter_wide_t wide;
        filter_mixture_t mixture;
        filter_synth_t synth;
        filter_adaptive_t adaptive;
        filter_kf3_t kf3;
        filter_auto_t bank;
    } own;
    uint16_t quarter_dhz; /* part of the current 25 ms, in units of the rate */
    uint16_t rate_dhz;    /* output data rate */
} filter_t;

#ifdef __cplusplus
}
#endif
#endif
