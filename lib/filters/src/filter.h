/*
 * What all filters share: flags, probe, descriptor. One header per filter adds F_config_t, F_t and the functions
 *
 *   void     F_defaults(F_config_t *config, uint16_t rate_dhz);   the shipped values at that output data rate
 *   bool     F_init(F_t *f, const F_config_t *config);            false: a parameter is outside its legal range, f
 *            untouched
 *   bool     F_together(const F_config_t *config);                parameters within the ranges of the descriptor, and a
 *            legal rate, are what F_init takes: no gap in a range, no condition over several
 *   void     F_configure(F_t *f, const F_config_t *config);       the same for what is known to be legal, as the
 *            defaults are at a rate of FILTER_RATE_MIN_DHZ to FILTER_RATE_MAX_DHZ
 *   void     F_set_noise(F_t *f, uint32_t r_lsb2_q8);             measurement variance R changed (estimated on line)
 *   void     F_reset(F_t *f, int16_t z0_lsb);                     as if z0 had been read for ever; no warm-up
 *   bool     F_reset_step(F_t *f, int16_t z0_lsb, uint8_t step);  F_reset in parts that take no longer than an update:
 *            step 0, 1, 2 ... until it is false; no other call in between
 *   int32_t  F_update(F_t *f, int16_t z_lsb);                     one sample in, estimate (LSB, Q16) out; total, cannot
 *            fail
 *   int32_t  F_coast(F_t *f);                                     sample missing: prediction only
 *   void     F_gap(F_t *f);                                       samples begin to be missing, before the first
 *            F_coast: a rate that may be all noise is not believed
 *   void     F_damp(F_t *f);                                      the estimated rate of change halved: samples have
 *            been missing for a while
 *   void     F_hold(F_t *f);                                      before and after an update with a sample that tells
 *            no position, as one at the sensor's rail: it is used, but the filter does not restart on it
 *   void     F_restart(F_t *f);                                   warming up anew, parameters and what was learnt of
 *            the noise stay; the next call is F_update, until then the estimate means nothing
 *   uint8_t  F_flags(const F_t *f);                               FILTER_* of the last update or coast
 *   void     F_probe(const F_t *f, filter_probe_t *out);          gain, variance, innovation, gate of the last update
 *
 * and F_worst_cycles: what F_update takes at most on an ATmega328P, for callers that must know whether it fits their
 * sample period; `make bench` of the project holds it to the measured worst case (never below, at most 10 % above).
 *
 * F_t is plain data without pointers: copy it, compare it, dump it. Nothing here does I/O, allocates, uses float or
 * blocks; every function may be called from main or from an interrupt, one caller at a time per F_t.
 */
#ifndef FILTER_H
#define FILTER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Measurements outside this range are clamped to it: the ADXL345 delivers -4096..4095 (13 bit). */
#define FILTER_Z_MIN_LSB (-4096)
#define FILTER_Z_MAX_LSB 4095

/* Bound of the estimate, inductive over any sequence of calls: |x| <= FILTER_X_MAX_LSB. */
#define FILTER_X_MAX_LSB 4608

/* Legal ranges shared by the configurations of all filters: output data rate (0.1 Hz), measurement variance R. */
#define FILTER_RATE_MIN_DHZ 50U
#define FILTER_RATE_MAX_DHZ 40000U
#define FILTER_R_MIN_LSB2_Q8 3U
#define FILTER_R_MAX_LSB2_Q8 256000U

/* Samples that a filter collects after init before it runs; until then it puts out the running median. */
#define FILTER_WARM_UP_SAMPLES 5

enum filter_flag {
    FILTER_GATED = 0x01,      /* beyond the gate: refused, or by `soft` taken in part */
    FILTER_COASTED = 0x02,    /* no sample: the output is a prediction */
    FILTER_REACQUIRED = 0x04, /* the filter restarted on consistent refused samples */
    FILTER_SATURATED = 0x08,  /* a state was clamped to its bound */
    FILTER_WARMING_UP = 0x10, /* fewer than FILTER_WARM_UP_SAMPLES since init */
    FILTER_SWITCHED = 0x20    /* a filter made of several has chosen another of them (`auto`) */
};

/* A sample limited to the range that the bounds of all filters assume. */
static inline int16_t filter_clamp_z(int16_t z_lsb)
{
    if (z_lsb > FILTER_Z_MAX_LSB) {
        return FILTER_Z_MAX_LSB;
    }
    return (int16_t)((z_lsb < FILTER_Z_MIN_LSB) ? FILTER_Z_MIN_LSB : z_lsb);
}

/* Snapshot for telemetry and tests. */
typedef struct {
    int32_t x_lsb_q16;          /* estimate */
    int32_t rate_lsb_q16;       /* estimated change per sample; 0 while warming up and for filters without a rate */
    int32_t innovation_lsb_q16; /* measurement minus prediction of the last update; 0 after a coast */
    uint32_t p_lsb2_q8;         /* variance of the estimate after the last update */
    uint32_t gate_lsb2_q8;      /* limit of the squared innovation, saturated; UINT32_MAX: no gate */
    uint16_t gain_uq16;         /* gain of the last update, 0 when refused or coasted */
    uint8_t flags;              /* FILTER_* */
} filter_probe_t;

/* One parameter of a filter as a person sees it; lives in program memory (FX_FLASH in fx.h). */
typedef struct {
    char name[10];          /* as typed in a command, e.g. "gate" */
    char unit[8];           /* e.g. "sigma", "LSB2", "LSB2/s3" */
    uint8_t offset;         /* of the field in F_config_t */
    uint8_t size;           /* of the field: 2 or 4 bytes */
    uint8_t fraction_bits;  /* binary point of the stored value */
    uint8_t zero_means_off; /* 1: 0 is legal and switches the feature off although below min */
    uint8_t is_signed;      /* 1: the field is in two's complement */
    int32_t min, max;       /* legal range of the stored value; a filter may refuse combinations within it */
} filter_parameter_t;

/* What F is; lives in program memory. Default values come from F_defaults, which knows the rate. */
typedef struct {
    char name[12]; /* as typed in `filter NAME` */
    uint8_t parameter_count;
    const filter_parameter_t *parameters; /* in program memory too */
} filter_descriptor_t;

#ifdef __cplusplus
}
#endif
#endif
