/*
 * Every filter of this library is one tracker with a gain law.
 *
 *   predict  x += v                    x: estimate, LSB; v: its change per sample
 *   correct  u = z - x                 u: innovation of the sample z
 *            x += w1 t, v += w2 t      the law returns (w1, w2, t) for u
 *
 * The tracker (filter.c) holds what all filters share: start, prediction, bounds, missing samples, reset, restart. A
 * law is one constant descriptor in program memory: parameters, facts and functions. Only the laws that a program names
 * are linked.
 *
 *   filter_config_t config = filter_defaults(&filter_law_sprf, 1000);
 *   filter_t f;
 *   if (filter_init(&f, &filter_law_sprf, &config) != FILTER_ACCEPTED) { ... }
 *   int32_t x_lsb_q16 = filter_update(&f, sample);
 *
 * Every function that takes a filter_t, except filter_init, needs one that filter_init has accepted. It is plain data
 * without pointers to RAM: copy it, compare it, dump it. Nothing here does I/O, allocates, uses float or blocks. Every
 * function may be called from main or from an interrupt, by one caller at a time per filter_t.
 */
#ifndef FILTER_H
#define FILTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "filter_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Measurements outside this range are clamped to it: the ADXL345 delivers -4096..4095 (13 bit). */
#define FILTER_Z_MIN_LSB (-4096)
#define FILTER_Z_MAX_LSB 4095

/* Bound of the estimate, inductive over any sequence of calls: |x| <= FILTER_X_MAX_LSB. */
#define FILTER_X_MAX_LSB 4608

/* Legal ranges that all laws share: output data rate (0.1 Hz), measurement variance R. */
#define FILTER_RATE_MIN_DHZ 50U
#define FILTER_RATE_MAX_DHZ 40000U
#define FILTER_R_MIN_LSB2_Q8 3U
#define FILTER_R_MAX_LSB2_Q8 256000U

/* Samples that a filter collects after init before it runs; until then it outputs the running median. */
#define FILTER_WARM_UP_SAMPLES 5

/* After this long without a sample the estimate holds, ms; until then the rate of change is halved every 25 ms. */
#define FILTER_HOLD_MS 100

enum filter_flag {
    FILTER_GATED = 0x01,      /* beyond the gate: refused, or by some laws used in part */
    FILTER_COASTED = 0x02,    /* no sample: the output is a prediction */
    FILTER_REACQUIRED = 0x04, /* restarted from consistent refused samples */
    FILTER_SATURATED = 0x08,  /* a state was clamped to its bound */
    FILTER_WARMING_UP = 0x10, /* one of the samples that a start collects: after init and after a restart */
    FILTER_SWITCHED = 0x20    /* a filter made of several has switched to another of them (`auto`) */
};

/* Snapshot for telemetry and tests. */
typedef struct {
    int32_t x_lsb_q16;          /* estimate */
    int32_t rate_lsb_q16;       /* estimated change per sample; 0 while warming up */
    int32_t innovation_lsb_q16; /* measurement minus prediction of the last update; 0 after a missing sample */
    uint32_t p_lsb2_q8;         /* variance of the estimate after the last update */
    uint32_t gate_lsb2_q8;      /* limit of the squared innovation, saturated; UINT32_MAX: no gate */
    uint16_t gain_uq16;         /* gain of the last update, 0 when refused or missing */
    uint8_t flags;              /* FILTER_* */
} filter_probe_t;

/* One parameter of a law as a user sees it; lives in program memory (IN_FLASH in machine.h). */
typedef struct {
    const char *words;      /* in program memory: the name as typed, "gate", NUL, the unit: "sigma", "LSB2", "" */
    uint8_t fraction_bits;  /* binary point of the stored value */
    uint8_t zero_means_off; /* 1: 0 is legal, although below min, and switches the feature off */
    int32_t min, max;       /* legal range of the stored value; a law may refuse combinations within it */
    int32_t standard;       /* default; where it depends on the rate the law has the rule */
} filter_parameter_t;

/* Largest number of parameters of a law. */
#define FILTER_PARAMETERS_MAX 7

/* Values of a law's parameters in the order of its descriptor, as stored: fixed point, signed. */
typedef struct {
    uint16_t rate_dhz; /* output data rate, 0.1 Hz */
    int32_t value[FILTER_PARAMETERS_MAX];
} filter_config_t;

/*
 * Index of each parameter in filter_config_t.value. Format and unit are in the names, ranges and defaults in the
 * descriptors (and in the library's README).
 */
enum filter_kf_parameter { KF_R_LSB2_Q8, KF_Q_LSB2_S3 };
enum filter_lrf_parameter { LRF_R_LSB2_Q8, LRF_Q_LSB2_S3, LRF_CLEAN_UQ16, LRF_RATIO_UQ8 };
enum filter_sprf_parameter {
    SPRF_R_LSB2_Q8,
    SPRF_Q_LSB2_S3,
    SPRF_GATE_SIGMA_Q8,
    SPRF_REACQUIRE_SAMPLES,
    SPRF_RATE_MAX_LSB_S
};
enum filter_soft_parameter {
    SOFT_R_LSB2_Q8,
    SOFT_Q_LSB2_S3,
    SOFT_SOFT_SIGMA_Q8,
    SOFT_GATE_SIGMA_Q8,
    SOFT_REACQUIRE_SAMPLES,
    SOFT_RATE_MAX_LSB_S
};
enum filter_sprf_paper_parameter { SPRF_PAPER_R_LSB2_Q8, SPRF_PAPER_Q_LSB2_S3, SPRF_PAPER_GATE_SIGMA_Q8 };
/* pbf, shrf, af */
enum filter_mixture_parameter {
    MIXTURE_R_LSB2_Q8,
    MIXTURE_Q_LSB2_S3,
    MIXTURE_RATIO_UQ8,
    MIXTURE_CLEAN_UQ16,
    MIXTURE_STAY_UQ16 /* not of af */
};
enum filter_synth_parameter { SYNTH_A1_Q16, SYNTH_B0_UQ16, SYNTH_R_LSB2_Q8, SYNTH_RATE_MAX_LSB_S };
enum filter_synth_opt_parameter {
    SYNTH_OPT_VARIANT_U,
    SYNTH_OPT_P0_LSB2_Q8,
    SYNTH_OPT_R_LSB2_Q8,
    SYNTH_OPT_RATE_MAX_LSB_S
};
enum filter_synth_plus_parameter {
    SYNTH_PLUS_K,
    SYNTH_PLUS_B0_UQ16,
    SYNTH_PLUS_B1_Q16,
    SYNTH_PLUS_B2_Q16,
    SYNTH_PLUS_R_LSB2_Q8
};
enum filter_adaptive_parameter {
    ADAPTIVE_GUARD_SIGMA_Q8,
    ADAPTIVE_R_LSB2_Q8,
    ADAPTIVE_IDENTIFY,
    ADAPTIVE_SLOW_MS,
    ADAPTIVE_FAST_MS,
    ADAPTIVE_CONFIRM_MS,
    ADAPTIVE_RATE_MAX_LSB_S
};
enum filter_kf3_parameter { KF3_R_LSB2_Q8, KF3_Q_LSB2_S5 };
enum filter_auto_parameter {
    AUTO_GATE_SIGMA_Q8,
    AUTO_R_LSB2_Q8,
    AUTO_SLOW_MS,
    AUTO_MIDDLE_MS,
    AUTO_FAST_MS,
    AUTO_RATE_MAX_LSB_S
};

/* Why filter_init refuses a configuration: FILTER_REFUSED_FIRST + i for parameter i outside its range. */
typedef uint8_t filter_answer_t;
enum filter_answer {
    FILTER_ACCEPTED = 0,
    FILTER_REFUSED_RATE = 1, /* rate_dhz */
    FILTER_REFUSED_TOGETHER =
        2, /* each is in its range, but one has an illegal value (reacquire: 3, 5, 9) or they conflict */
    FILTER_REFUSED_FIRST = 3
};

/*
 * Defaults of a law at an output data rate (FILTER_RATE_MIN_DHZ..MAX): as a value, or written into a configuration,
 * which saves its copies.
 */
filter_config_t filter_defaults(const filter_law_t *law, uint16_t rate_dhz);
void filter_set_defaults(filter_config_t *config, const filter_law_t *law, uint16_t rate_dhz);

/*
 * Sets up a filter, which then begins to warm up. The configuration is checked first: any answer but FILTER_ACCEPTED
 * says what is wrong, and f is unchanged. Divides: up to 10,500 cycles.
 */
filter_answer_t filter_init(filter_t *f, const filter_law_t *law, const filter_config_t *config);

/*
 * Sets a new measurement variance R (estimated on line), limited to its legal range. To change another parameter:
 * filter_init, then filter_reset. Divides: up to 4,000 cycles.
 */
void filter_set_noise(filter_t *f, uint32_t r_lsb2_q8);

/*
 * Process noise over the R in force is at a limit of what the law's numbers hold: a q beyond it does not apply. Changes
 * with R. Always false for a law without q.
 */
bool filter_limited(const filter_t *f);

/*
 * The R that a law has identified itself, LSB^2 in Q8, at most 10,200 LSB^2. Such a law needs no filter_set_noise and
 * no noise estimate beside it. 0: the law uses the R that is set. About 80 cycles.
 */
uint32_t filter_own_noise_lsb2_q8(const filter_t *f);

/* Runs as if z0 had always been read; no warm-up. Takes about as long as 16 updates at most. */
void filter_reset(filter_t *f, int16_t z0_lsb);

/*
 * One sample in, estimate (LSB, Q16) out. Any int16, any history; cannot fail. A sample beyond FILTER_Z_MIN..MAX is
 * clamped and flagged FILTER_SATURATED. Scaling of x below; of the other states with each law.
 *
 *   z        Q0, clamped to -4096..4095 LSB
 *   x        Q15.16; |x| <= 4608 LSB by a clamp after the prediction, and a correction moves it towards a sample within
 *            4096 LSB; so |u| <= 8704 LSB < 2^30 / 2^16
 *   rate     Q15.16, or Q7.24 where the law says so, limited to the configured ratemax, if the law has one
 */
int32_t filter_update(filter_t *f, int16_t z_lsb);

/*
 * No sample, or one without information, such as at the sensor's rail: predicts. The rate of change is halved every 25
 * ms without a sample, and after FILTER_HOLD_MS the estimate holds.
 */
int32_t filter_missing(filter_t *f);

/*
 * Warms up again; parameters and what was learnt about the noise are kept. The estimate keeps its value until the next
 * call.
 */
void filter_restart(filter_t *f);

/* Gain, variance, innovation and gate of the last update; absent with -DFILTER_WITHOUT_PROBE. Divides. */
void filter_probe(const filter_t *f, filter_probe_t *out);

/* Facts of a law, from its descriptor in program memory. */
const char *filter_name(const filter_law_t *law); /* in program memory, as typed in `filter NAME` */
uint8_t filter_parameter_count(const filter_law_t *law);
/* In program memory; index is below filter_parameter_count. */
const filter_parameter_t *filter_parameter(const filter_law_t *law, uint8_t index);
/* The parameter's name, NUL-terminated, followed by its unit. Both in program memory. */
const char *filter_parameter_words(const filter_parameter_t *parameter);
/* Upper bound of filter_update on an ATmega328P; `stay` of pbf and shrf costs 500 more. */
uint16_t filter_worst_cycles(const filter_law_t *law);

/* The parameter for the measurement variance R: laws that have it and do not get a value estimate it. */
extern const filter_parameter_t filter_parameter_r;

/* Whether the value is within min..max, or 0 where that switches the feature off. */
bool filter_in_range(const filter_parameter_t *parameter, int32_t value);

/* Why filter_init would refuse this configuration. */
filter_answer_t filter_judge(const filter_law_t *law, const filter_config_t *config);

/* The laws, filter_law_NAME. Each is described in its own file, with its parameters, equations and bounds. */
#define FILTER_LAWS(X) \
    X(adaptive)        \
    X(kf)              \
    X(sprf)            \
    X(synth)           \
    X(lrf)             \
    X(soft)            \
    X(sprf_paper)      \
    X(shrf)            \
    X(pbf)             \
    X(af)              \
    X(synth_opt)       \
    X(synth_plus)      \
    X(kf3)             \
    X(auto)
#define FILTER_LAW(F) extern const filter_law_t filter_law_##F;
FILTER_LAWS(FILTER_LAW)
#undef FILTER_LAW

#ifdef __cplusplus
}
#endif
#endif
