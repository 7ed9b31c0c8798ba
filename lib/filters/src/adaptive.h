/*
 * adaptive: a fading-memory filter whose memory the innovations drive, guarded against outliers. The future work that
 * paper 000 names: noise identified on line, the filter's parameters driven by it.
 *
 *   x_e = x + v                              straight line through the past, u = z - x_e
 *   x = x_e + (2 k - k^2) t, v = v + k^2 t   t: the part of u that is taken
 *
 * weights a sample n steps old by (1 - k)^n (fading memory of the first order): its memory is about 2 / k samples
 * and the innovation's sigma, within 6 % up to k = 0.6, (1 + k) sigma for noise of that sigma. k grows at once to that
 * of the shortest memory when the mean innovation is not explained by noise, and falls by k^2 / 4 a sample, which
 * lengthens the memory by half a sample, to that of the slowest.
 *
 * Guard: a sample further off than `guard` sigmas counts as motion only when the one before it, carried on with the
 * estimated rate, lies off to the same side too; what both agree on is taken and the memory is shortened. An isolated
 * one is taken up to the gate, and the less the further off it is, not at all from twice the gate on. An innovation
 * further beyond the gate than motion explains (an eighth of `ratemax`) is believed after `confirm` of samples on the
 * same side.
 *
 * Noise, with `identify` on (1): sigma of a sample from third differences, which see neither position, rate nor
 * acceleration (it feeds the unguarded filter and the probe), and the scatter of the innovations about their mean (it
 * feeds the guard, because motion that the line does not follow widens it); by turns, a sample each, and each limited
 * to 2.5 times what it is expected to be (3.1 for the differences' mean). R as configured or told by set_noise before
 * the first difference is what both start from, later calls change nothing: a pipeline that estimates an R of its own
 * may go on telling it, and need not. The differences' mean is their first one, unlimited for four; until the
 * sixteenth, six on end below its half put the largest of them in its place: what one bad read at the start leaves.
 * Below a sigma of 0.5 LSB most differences are 0 and R comes out too small. Off (0): both are the square root of that
 * R, always.
 *
 * FILTER_GATED tells that the sample lies beyond the gate and is taken in part or not at all, so its gain need not be
 * 0. Noise above 90 LSB counts as 90, a mean innovation above 128 LSB as 128. Reset keeps the
 * identified noise and forgets rate, mean innovation and history; the memory is the slowest. Functions: filter.h.
 */
#ifndef ADAPTIVE_H
#define ADAPTIVE_H

#include "filter.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    uint16_t rate_dhz;       /* output data rate, 0.1 Hz: 50..40000 */
    uint16_t guard_sigma_q8; /* gate in sigmas of the innovation: 1..16 (256..4096); 0: unguarded */
    uint32_t r_lsb2_q8;      /* measurement variance R, LSB^2: 0.01..1000 (3..256000); 0 is refused */
    uint16_t identify;       /* 1: noise identified on line, 0: R as given */
    uint16_t slow_ms;        /* slowest memory: 10..60000; limited to 3.3..4096 samples, not refused */
    uint16_t fast_ms;        /* shortest memory: 1..60000; limited to 3.3 samples..the slowest, not refused */
    uint16_t confirm_ms;     /* time until a jump is believed: 0..10000, at least 3 samples */
    uint32_t rate_max_lsb_s; /* limit of the estimated rate, LSB/s: 10..1000000, at most 127 LSB per sample of it */
} adaptive_config_t;

/*
 * The first 64 bytes an AVR reaches without computing an address: behind them lies what is parameters and read in one
 * or two places.
 */
typedef struct {
    int32_t x_lsb_q16;         /* estimate, |x| <= FILTER_X_MAX_LSB */
    int32_t rate_lsb_q24;      /* per sample, |rate| <= rate_max_lsb_q24; towards `below` */
    int32_t mean_lsb_q24;      /* of the innovations, each limited to the gate and 128 LSB; towards `below` */
    uint32_t k_uq32;           /* 1 - fading factor, of the last update */
    uint32_t scatter_lsb_uq24; /* sigma of the innovations for k = 0: 0.1..90 */
    uint32_t third_lsb_uq24;   /* half of the mean |third difference|: 1.774 sigma of a sample */
    union {
        struct {
            uint32_t size_lsb_uq16; /* of the last innovation, <= 8704 LSB; 0 after a coast */
            uint32_t gate_lsb_uq16; /* of the last step */
            int32_t before_lsb_q16; /* what the sample before is off, carried on with the rate; 0: there is none */
        } run;
        int16_t start_lsb[FILTER_WARM_UP_SAMPLES]; /* ascending */
    } u;
    int16_t history_lsb[3];   /* samples, newest first */
    uint16_t weight_uq16;     /* of a new term in the identification: one over the number of terms it averages over */
    uint16_t terms;           /* until the weight is halved */
    uint16_t stage;           /* terms that a weight is for, half of the next */
    uint16_t last_uq16;       /* the weight at last */
    uint16_t largest_lsb_uq8; /* of the terms on end that lie below half of the mean */
    uint16_t run;             /* samples beyond the gate on one side, up to the last */
    uint8_t small;            /* terms on end that lie below half of the mean, while the start is doubted */
    uint8_t filled;           /* samples of history without a gap, <= 3 */
    uint8_t third;            /* 1: of the next sample the third difference is a term, 0: the innovation */
    uint8_t by_turns;         /* 1: the two by turns */
    uint8_t collected;        /* samples of the start, <= FILTER_WARM_UP_SAMPLES */
    uint8_t flags;
    uint8_t verdict;         /* of the guard on the last sample */
    bool guarded;            /* a gate was configured */
    bool identify;           /* noise identified on line */
    bool below;              /* the run is below the estimate */
    uint16_t gate_sigma_q8;  /* in sigmas of the innovation */
    uint16_t manoeuvre_uq16; /* mean innovation, in sigmas of one, that shortens the memory */
    uint16_t slow_uq16;      /* k of the slowest and of the shortest memory */
    uint16_t fast_uq16;
    uint16_t share_uq16;   /* of a new innovation in their mean */
    uint16_t confirm;      /* samples until a jump is believed */
    uint16_t jump_lsb_uq8; /* beyond the gate, what motion does not explain */
    int32_t rate_max_lsb_q24;
} adaptive_t;

/* Descriptor in program memory. */
extern const filter_descriptor_t adaptive_descriptor;

enum { adaptive_worst_cycles = 1410 }; /* of adaptive_update, as in filter.h */

void adaptive_defaults(adaptive_config_t *config, uint16_t rate_dhz);
static inline bool adaptive_together(const adaptive_config_t *config)
{
    (void)config; /* each by itself */
    return true;
}

bool adaptive_init(adaptive_t *f, const adaptive_config_t *config);
void adaptive_configure(adaptive_t *f, const adaptive_config_t *config);
void adaptive_set_noise(adaptive_t *f, uint32_t r_lsb2_q8);
void adaptive_reset(adaptive_t *f, int16_t z0_lsb);
bool adaptive_reset_step(adaptive_t *f, int16_t z0_lsb, uint8_t step);
int32_t adaptive_update(adaptive_t *f, int16_t z_lsb);
int32_t adaptive_coast(adaptive_t *f);
void adaptive_damp(adaptive_t *f);
void adaptive_hold(adaptive_t *f);
void adaptive_restart(adaptive_t *f);
uint8_t adaptive_flags(const adaptive_t *f);
void adaptive_probe(const adaptive_t *f, filter_probe_t *out);

/* Its rate is worth more than one sample's noise. */
static inline void adaptive_gap(adaptive_t *f)
{
    (void)f;
}

/* The measurement variance R in force, identified or given: LSB^2 in Q8. */
uint32_t adaptive_r_lsb2_q8(const adaptive_t *f);

#ifdef __cplusplus
}
#endif
#endif
