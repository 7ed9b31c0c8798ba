/*
 * Inside the library: the tracker's verbs that laws are written with, and the descriptor that a law is. The functions
 * of filter.h are in filter.c; what a law shares with others of its kind is in kalman.h, wide.h, synth.h.
 */
#ifndef TRACKER_H
#define TRACKER_H

#include "filter.h"
#include "fx.h"

#ifdef __cplusplus
extern "C" {
#endif

/* `collected` of a filter that runs. */
#define FILTER_RUNNING FILTER_WARM_UP_SAMPLES

#define TRACKER_X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

/* What a law is like, beside its functions. */
enum filter_trait {
    LAW_COVARIANCE = 0x01,   /* its state begins with filter_covariance_t, which is damped with the rate */
    LAW_SETTLES = 0x02,      /* as if z0 had been read for ever: by updates */
    LAW_FINE_RATE = 0x04,    /* rate in Q24 */
    LAW_FIRST_SAMPLE = 0x08, /* starts on the first sample, as published, not on the median of five */
    LAW_GATED = 0x10         /* refuses samples */
};

/* What a step has: no sample, so a prediction alone; a sample; one that was read for ever, for its covariance. */
enum filter_step_kind { STEP_MISSING, STEP_SAMPLE, STEP_SETTLE };

/* Lives in program memory. */
struct filter_law {
    char name[12];
    uint8_t parameter_count;
    uint8_t traits;
    uint16_t worst_cycles;                           /* of filter_update; `make bench` of the project holds it */
    const filter_parameter_t *const *parameters;     /* a list in program memory of pointers into it */
    void (*standard)(filter_config_t *config);       /* shipped values that depend on the rate; NULL: R alone does */
    bool (*together)(const filter_config_t *config); /* NULL: each by itself */
    void (*set_up)(filter_t *f, const filter_config_t *config); /* from zero; the noise with set_noise */
    void (*set_noise)(filter_t *f, uint32_t r_lsb2_q8);         /* R within its range */
    uint32_t (*own_noise)(const filter_t *f); /* see filter_own_noise_lsb2_q8; NULL: it takes what is set */
    void (*start)(filter_t *f, bool settled); /* own state for a filter that begins at x: at rest for ever, or just */
    void (*step)(filter_t *f, int16_t z_lsb, uint8_t what); /* one sample on; what: filter_step_kind; flags are clear */
    void (*fade)(filter_t *f, bool first); /* samples begin to be missing, or the rate was halved; NULL */
    void (*report)(const filter_t *f, filter_probe_t *out); /* variance and gate */
};

/* What a law keeps over a start, from this member of its state on, lies after the samples of the start. */
#ifdef __cplusplus
#define LAW_ASSERT static_assert
#else
#define LAW_ASSERT _Static_assert
#endif
#define LAW_KEEPS_FROM(state, member) \
    LAW_ASSERT(offsetof(state, member) >= sizeof(filter_start_t), "the samples of the start would go over it")

/* A parameter of a law's own: its name, end and unit in one string, then the members of filter_parameter_t. */
#define LAW_PARAMETER(parameter, words, ...)                \
    static const char parameter##_words[] IN_FLASH = words; \
    static const filter_parameter_t parameter IN_FLASH = { parameter##_words, __VA_ARGS__ }

/*
 * What filter_probe needs of a law. A program that has no use for filter_probe is spared the code, 1.8 KB with seven
 * laws, by -DFILTER_WITHOUT_PROBE; filter_probe is not there then.
 */
#ifdef FILTER_WITHOUT_PROBE
#define LAW_REPORT(function) (true ? NULL : (function))
#else
#define LAW_REPORT(function) (function)
#endif

/* A function of the law in force. */
#define LAW_OF(f, function) FLASH_FUNCTION(&(f)->law->function)

/* All of a state to 0, gaps too. */
void filter_tracker_clear(void *state, size_t size);

/* A sample limited to the range that the bounds of all laws assume. */
int16_t filter_tracker_limited_z(int16_t z_lsb);

/*
 * R to start from at an output data rate: 1.5 x 0.02 x rate LSB^2 (0.14 LSB per root Hz, measured on real boards),
 * limited.
 */
uint32_t filter_tracker_default_r_lsb2_q8(uint16_t rate_dhz);

/* x within its bound by the high word: 4608 LSB and a fraction count as 4608. Flagged. */
MACHINE_INLINE int32_t tracker_bounded(filter_t *f, int32_t x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        f->flags |= FILTER_SATURATED;
        return (x_lsb_q16 < 0) ? -TRACKER_X_MAX_LSB_Q16 : TRACKER_X_MAX_LSB_Q16;
    }
    return x_lsb_q16;
}

/* Prediction of the estimate: x += v within its bound (<= 2 x 4608 LSB before it: fits). */
MACHINE_INLINE void tracker_predict(filter_t *f)
{
    f->x_lsb_q16 = tracker_bounded(f, f->x_lsb_q16 + f->rate_lsb);
}

/* Innovation of a sample. */
void filter_tracker_meet(filter_t *f, int16_t z_lsb);

/* Of a step without a sample. */
void filter_tracker_nothing(filter_t *f);

/* What the law does of its own when samples begin to be missing (first), or the rate was halved. */
void filter_tracker_fade(filter_t *f, bool first);

/* The rate halved: of a motion that was not seen for a while only a part is likely to go on. */
void filter_tracker_damp(filter_t *f);

/* x moved by so much in the direction of the innovation. */
void filter_tracker_move(filter_t *f, int32_t step_lsb_q16);

/*
 * The rate moved by so much in the direction of the innovation, within its limit (flagged). No overflow: see each law.
 */
void filter_tracker_turn(filter_t *f, int32_t step_lsb);

/* The limit of the rate in so many fraction bits, made of ratemax (LSB/s); 0: the bound of the format. Divides. */
void filter_tracker_limit_rate(filter_t *f, uint32_t rate_max_lsb_s, uint8_t fraction_bits);

/* Median of `count` ascending samples, LSB in Q16: the mean of the middle two when count is even; count >= 1. */
int32_t filter_tracker_median_q16(const int16_t *ascending_lsb, uint8_t count);

/* R limited to its legal range. */
uint32_t filter_tracker_limited_r(uint32_t r_lsb2_q8);

/* An element of a covariance halved. */
void filter_tracker_halve(uint32_t *p);

/*
 * k = 2 / memory in samples, UQ0.16 rounded down, of a fading memory of memory_ms (1..60000) at a rate (50..40000):
 * k_min_uq16 to TRACKER_K_MAX_UQ16, 0.6: with a memory below 3.3 samples a filter nearly follows the raw samples.
 */
#define TRACKER_K_MAX_UQ16 39322U
uint16_t filter_tracker_memory_k_uq16(uint16_t memory_ms, uint16_t rate_dhz, uint16_t k_min_uq16);

/* Variance of a fading memory with this k for samples of variance R: R k (10 - 14 k + 5 k^2) / (2 - k)^3. Divides. */
uint32_t filter_tracker_fading_variance(uint32_t r_lsb2_q8, uint16_t k_uq16);

/* Parameters that several laws have, beside filter_parameter_r. */
extern const filter_parameter_t filter_parameter_q, filter_parameter_gate, filter_parameter_reacquire,
    filter_parameter_ratemax;

#ifdef __cplusplus
}
#endif
#endif
