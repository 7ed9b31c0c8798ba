/*
 * Internal to the library: the tracker's functions that laws are built from, and the descriptor of a law. The functions
 * of filter.h are in filter.c; what similar laws share is in kalman.h, wide.h, synth.h.
 */
#ifndef TRACKER_H
#define TRACKER_H

#include "filter.h"
#include "fx.h"

#ifdef __cplusplus
extern "C" {
#endif

/* `collected` of a running filter. */
#define FILTER_RUNNING FILTER_WARM_UP_SAMPLES

#define TRACKER_X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

/* Properties of a law, beside its functions. */
enum filter_trait {
    LAW_COVARIANCE = 0x01,   /* its state begins with filter_covariance_t: damped with the rate, settled by a reset */
    LAW_FINE_RATE = 0x04,    /* rate in Q24 */
    LAW_FIRST_SAMPLE = 0x08, /* starts on the first sample, as published, not on the median of five */
    LAW_GATED = 0x10         /* can refuse samples */
};

/* What a step gets: no sample, prediction only; a sample; a sample only for the covariance to settle (filter_reset). */
enum filter_step_kind { STEP_MISSING, STEP_SAMPLE, STEP_SETTLE };

/* A name without a size, as GNU C allows, saves 44 bytes of the firmware's image; Frama-C cannot initialise one. */
#ifndef __FRAMAC__
#define LAW_NAME_SIZE
#else
#define LAW_NAME_SIZE 12
#endif

/* Lives in program memory. */
struct filter_law {
    uint8_t parameter_count;
    uint8_t traits;
    uint16_t worst_cycles;                           /* of filter_update; `make bench` of the project checks it */
    const filter_parameter_t *const *parameters;     /* a list in program memory of pointers into it */
    void (*standard)(filter_config_t *config);       /* defaults that depend on the rate; NULL: only R does */
    bool (*together)(const filter_config_t *config); /* checks values against each other; NULL: independent */
    void (*set_up)(filter_t *f, const filter_config_t *config); /* from a zeroed state; calls set_noise */
    void (*set_noise)(filter_t *f, uint32_t r_lsb2_q8);         /* R is within its range */
    uint32_t (*own_noise)(const filter_t *f); /* see filter_own_noise_lsb2_q8; NULL: uses the R that is set */
    void (*start)(filter_t *f, bool settled); /* own state for a filter that starts at x; settled: at rest */
    void (*step)(filter_t *f, int16_t z_lsb, uint8_t what); /* one sample; what: filter_step_kind; flags are clear */
    void (*fade)(filter_t *f, bool first); /* samples begin to be missing, or the rate was halved; or NULL */
    void (*report)(const filter_t *f, filter_probe_t *out); /* variance and gate */
    char name[LAW_NAME_SIZE];                               /* NUL-terminated, and as long as it is */
};

/*
 * Asserts that the part of a law's state that survives a start, from this member on, does not overlap the samples of
 * the start.
 */
#ifdef __cplusplus
#define LAW_ASSERT static_assert
#else
#define LAW_ASSERT _Static_assert
#endif
#define LAW_KEEPS_FROM(state, member) \
    LAW_ASSERT(offsetof(state, member) >= sizeof(filter_start_t), "the samples of the start would go over it")

/* A law's own parameter: name, NUL and unit in one string, then the members of filter_parameter_t. */
#define LAW_PARAMETER(parameter, words, ...)                \
    static const char parameter##_words[] IN_FLASH = words; \
    static const filter_parameter_t parameter IN_FLASH = { parameter##_words, __VA_ARGS__ }

/*
 * What filter_probe needs from a law. A program without filter_probe saves this code, 1.8 KB with seven laws, by
 * -DFILTER_WITHOUT_PROBE; filter_probe is then absent.
 */
#ifdef FILTER_WITHOUT_PROBE
#define LAW_REPORT(function) (true ? NULL : (function))
#else
#define LAW_REPORT(function) (function)
#endif

/* A function of the law in force. */
#define LAW_OF(f, function) FLASH_FUNCTION(&(f)->law->function)

/* Zeroes all of a state, padding too. */
void filter_tracker_clear(void *state, size_t size);

/* A sample limited to the range that the bounds of all laws assume. */
int16_t filter_tracker_limited_z(int16_t z_lsb);

/*
 * Initial R at an output data rate: 1.5 x 0.02 x rate LSB^2 (0.14 LSB per root Hz, measured on real boards), limited to
 * its legal range.
 */
uint32_t filter_tracker_default_r_lsb2_q8(uint16_t rate_dhz);

/* Limits x to its bound, judged by the high word: 4608 LSB plus a fraction count as 4608. Sets the flag. */
MACHINE_INLINE int32_t tracker_bounded(filter_t *f, int32_t x_lsb_q16)
{
    uint16_t whole_lsb = (uint16_t)((uint32_t)x_lsb_q16 >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        f->flags |= FILTER_SATURATED;
        return (x_lsb_q16 < 0) ? -TRACKER_X_MAX_LSB_Q16 : TRACKER_X_MAX_LSB_Q16;
    }
    return x_lsb_q16;
}

/* Predicts the estimate: x += v within its bound (<= 2 x 4608 LSB before the clamp: fits). */
MACHINE_INLINE void tracker_predict(filter_t *f)
{
    f->x_lsb_q16 = tracker_bounded(f, f->x_lsb_q16 + f->rate_lsb);
}

/* Innovation of a sample. */
void filter_tracker_meet(filter_t *f, int16_t z_lsb);

/* The innovation and gain of a step without a sample. */
void filter_tracker_nothing(filter_t *f);

/* The law's own handling when samples begin to be missing (first), or when the rate was halved. */
void filter_tracker_fade(filter_t *f, bool first);

/* Halves the rate: only part of a motion that was not observed for a while is likely to continue. */
void filter_tracker_damp(filter_t *f);

/* Moves x by this much in the direction of the innovation. */
void filter_tracker_move(filter_t *f, int32_t step_lsb_q16);

/*
 * Changes the rate by this much in the direction of the innovation, within its limit (flagged). No overflow: see each
 * law.
 */
void filter_tracker_turn(filter_t *f, int32_t step_lsb);

/* Sets the limit of the rate in the given fraction bits from ratemax (LSB/s); 0: the bound of the format. Divides. */
void filter_tracker_limit_rate(filter_t *f, uint32_t rate_max_lsb_s, uint8_t fraction_bits);

/* Median of `count` ascending samples, LSB in Q16: the mean of the middle two when count is even; count >= 1. */
int32_t filter_tracker_median_q16(const int16_t *ascending_lsb, uint8_t count);

/* R limited to its legal range. */
uint32_t filter_tracker_limited_r(uint32_t r_lsb2_q8);

/* Halves an element of a covariance. */
void filter_tracker_halve(uint32_t *p);

/*
 * k = 2 / memory in samples, UQ0.16 rounded down, of a fading memory of memory_ms (1..60000) at a rate (50..40000).
 * Limited to k_min_uq16..TRACKER_K_MAX_UQ16, 0.6: with a memory below 3.3 samples a filter nearly follows the raw
 * samples.
 */
#define TRACKER_K_MAX_UQ16 39322U
uint16_t filter_tracker_memory_k_uq16(uint16_t memory_ms, uint16_t rate_dhz, uint16_t k_min_uq16);

/* Variance of a fading memory with this k for samples of variance R: R k (10 - 14 k + 5 k^2) / (2 - k)^3. Divides. */
uint32_t filter_tracker_fading_variance(uint32_t r_lsb2_q8, uint16_t k_uq16);

/* Parameters that several laws share, besides filter_parameter_r. */
extern const filter_parameter_t filter_parameter_q, filter_parameter_gate, filter_parameter_reacquire,
    filter_parameter_ratemax;

#ifdef __cplusplus
}
#endif
#endif
