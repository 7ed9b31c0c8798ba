/* What holds of adaptive before and after every call, and contracts of its parts. */
#ifndef ADAPTIVE_BOUNDS_H
#define ADAPTIVE_BOUNDS_H

#include "eva.h"
#include "fx_contracts.h"

#include "adaptive.h"

#define X_MAX_Q16 301989888 /* 4608 LSB */
#define RATE_END 2130706432 /* 127 LSB */
#define MEAN_END 2147483647 /* below 128 LSB, so that it can be negated */
#define SIZE_END 570425344  /* 8704 LSB */
#define GATE_END 150994944  /* 2304 LSB: 16 sigma of 90 LSB times 1.6 */
#define K_END 2577072127    /* 39322 and a fraction */
#define THIRD_LEAST 3014656
#define THIRD_END 2667642879   /* 159 LSB and a fraction: the largest term */
#define SCATTER_LEAST 1698872  /* what the least third is, unguarded */
#define SCATTER_END 1509949440 /* 90 LSB */

#define WITHIN_X(x) (-X_MAX_Q16 <= (x) <= X_MAX_Q16)
#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define FLAG(v) ((v) == 0 || (v) == 1)
#define TOLD(f)                                                                                                      \
    (0 <= (f)->rate_max_lsb_q24 <= RATE_END && 256 <= (f)->gate_sigma_q8 <= 4096 && 32 <= (f)->slow_uq16 <= 39322 && \
     32 <= (f)->fast_uq16 <= 39322 && (f)->share_uq16 <= 15728 && (f)->confirm >= 3 && FLAG((f)->guarded) &&         \
     FLAG((f)->identify) && FLAG((f)->by_turns))
#define MOTION_OF(f) (WITHIN_X((f)->x_lsb_q16) && -RATE_END <= (f)->rate_lsb_q24 <= RATE_END && FLAG((f)->below))
#define MEMORY(f) (-MEAN_END <= (f)->mean_lsb_q24 <= MEAN_END && (f)->k_uq32 <= K_END)
#define SCATTER(f) (SCATTER_LEAST <= (f)->scatter_lsb_uq24 <= SCATTER_END)
#define THIRD(f) (THIRD_LEAST <= (f)->third_lsb_uq24 <= THIRD_END)
#define NOISE(f) (SCATTER(f) && THIRD(f))
#define SMALL(f) ((f)->small < 6 && (f)->largest_lsb_uq8 <= 40704)
#define HISTORY(f) \
    ((f)->filled <= 3 && SAMPLE((f)->history_lsb[0]) && SAMPLE((f)->history_lsb[1]) && SAMPLE((f)->history_lsb[2]))
/* A weight is for so many terms, of which some are left. */
#define WEIGHTS(f) ((f)->weight_uq16 * (f)->stage == 32768 && 1 <= (f)->terms <= 2 * (f)->stage)
#define LAST(f) (64 <= (f)->last_uq16 <= 1024 && (f)->weight_uq16 >= (f)->last_uq16)
#define RUNNING(f) ((f)->collected == 5 && (f)->u.run.size_lsb_uq16 <= SIZE_END && (f)->u.run.gate_lsb_uq16 <= GATE_END)
#define START(lsb) (SAMPLE((lsb)[0]) && SAMPLE((lsb)[1]) && SAMPLE((lsb)[2]) && SAMPLE((lsb)[3]) && SAMPLE((lsb)[4]))
#define STARTING(f) ((f)->collected < 5 && ((f)->flags & FILTER_WARMING_UP) != 0 && START((f)->u.start_lsb))
#define BOUND_BUT_NOISE(f)                                                                                          \
    (TOLD(f) && MOTION_OF(f) && MEMORY(f) && HISTORY(f) && WEIGHTS(f) && LAST(f) && FLAG((f)->third) && SMALL(f) && \
     (f)->flags < 32 && (STARTING(f) || RUNNING(f)))
#define BOUND(f) (BOUND_BUT_NOISE(f) && NOISE(f))

/*@ requires f->flags < 32;
    assigns f->x_lsb_q16, f->flags \from x_lsb_q16, f->flags;
    ensures WITHIN_X(f->x_lsb_q16);
    ensures f->flags < 32;
*/
static inline void limit_estimate(adaptive_t *f, int32_t x_lsb_q16);

/*
 * The mean from which a term differs is the one that moves, or, with a weight of at most 1/8, up to twice it. What
 * comes of it is told by the ranges that the callers tell apart, of which each looks at the upper half.
 */
/*@ requires part: mean_uq24 / 65536 <= from_uq8 &&
                   ((from_uq8 <= mean_uq24 / 65536 && THIRD_LEAST <= mean_uq24 && weight_uq16 <= 32768) ||
                    (from_uq8 <= mean_uq24 / 32768 && mean_uq24 <= SCATTER_END && weight_uq16 <= 8192));
    requires SCATTER_LEAST <= mean_uq24 <= THIRD_END;
    requires term_uq8 <= 40704 || weight_uq16 <= 8192;
    assigns \result \from mean_uq24, term_uq8, from_uq8, weight_uq16;
    ensures \result < 0x1A0000 || 0x1A0000 <= \result < THIRD_LEAST || THIRD_LEAST <= \result < SCATTER_END ||
            SCATTER_END <= \result;
    ensures \result <= THIRD_END || term_uq8 > 40704;
*/
static inline uint32_t averaged(uint32_t mean_uq24, uint16_t term_uq8, uint16_t from_uq8, uint16_t weight_uq16);

/* The mean of before, or a term: both are told apart at the least that is kept, as those of averaged. */
/*@ requires SMALL(f) && term_uq8 <= 40704 && mean_uq24 <= THIRD_END;
    assigns f->small, f->largest_lsb_uq8, \result \from f->small, f->largest_lsb_uq8, mean_uq24, term_uq8, before_uq8;
    ensures SMALL(f);
    ensures \result < THIRD_LEAST || THIRD_LEAST <= \result <= THIRD_END;
*/
static inline uint32_t doubted(adaptive_t *f, uint32_t mean_uq24, uint16_t term_uq8, uint16_t before_uq8);

#define STAGE(f, n) ((f)->stage == (n) && (f)->weight_uq16 == 32768 / (n) && 1 <= (f)->terms <= 2 * (n))
/*@ requires NOISE(f) && HISTORY(f) && SAMPLE(z_lsb);
    requires WEIGHTS(f) && LAST(f) && SMALL(f);
    assigns f->third_lsb_uq24, f->scatter_lsb_uq24, f->weight_uq16, f->terms, f->stage, f->small,
            f->largest_lsb_uq8 \from *f, z_lsb;
    ensures SMALL(f);
    ensures NOISE(f);
    ensures STAGE(f, 1) || STAGE(f, 2) || STAGE(f, 4) || STAGE(f, 8) || STAGE(f, 16) || STAGE(f, 32) ||
            STAGE(f, 64) || STAGE(f, 128) || STAGE(f, 256) || STAGE(f, 512);
    ensures LAST(f);
*/
static void identify(adaptive_t *f, int16_t z_lsb);

/*@ requires NOISE(f) && MEMORY(f) && RUNNING(f);
    requires spread_uq8 <= 36864;
    assigns f->scatter_lsb_uq24 \from *f, spread_uq8;
    ensures SCATTER(f);
*/
static void disperse(adaptive_t *f, uint16_t spread_uq8);

/*@ requires SAMPLE(z_lsb) && STARTING(f);
    assigns f->u, f->collected, f->x_lsb_q16, f->flags, f->k_uq32 \from *f, z_lsb;
    ensures WITHIN_X(f->x_lsb_q16) && f->k_uq32 <= K_END && f->flags == FILTER_WARMING_UP;
    ensures STARTING(f) || RUNNING(f);
*/
static void collect(adaptive_t *f, int16_t z_lsb);

/*@ requires RUNNING(f);
    requires -SIZE_END <= f->u.run.before_lsb_q16 <= SIZE_END && FLAG(f->below);
    requires size <= SIZE_END;
    assigns f->flags, f->verdict, f->run, \result \from *f, size;
    ensures \result <= SIZE_END;
    ensures f->flags < 32;
*/
static uint32_t judge(adaptive_t *f, uint32_t size);

/*@ requires MEMORY(f) && f->share_uq16 <= 15728;
    assigns f->mean_lsb_q24 \from *f, taken;
    ensures -MEAN_END <= f->mean_lsb_q24 <= MEAN_END;
*/
static inline void average_innovation(adaptive_t *f, uint32_t taken);

/*@ requires MEMORY(f) && TOLD(f);
    requires spread_uq8 <= 36864;
    assigns f->k_uq32 \from *f, spread_uq8;
    ensures f->k_uq32 <= K_END;
*/
static inline void adapt(adaptive_t *f, uint16_t spread_uq8);

/*@ requires -RATE_END <= f->rate_lsb_q24 <= RATE_END && 0 <= f->rate_max_lsb_q24 <= RATE_END;
    requires 0 <= by_lsb_q24 <= RATE_END;
    assigns f->rate_lsb_q24 \from f->rate_lsb_q24, f->rate_max_lsb_q24, by_lsb_q24;
    ensures f->rate_lsb_q24 >= -RATE_END;
    ensures upper: f->rate_lsb_q24 <= RATE_END;
*/
static inline void turn(adaptive_t *f, int32_t by_lsb_q24);

/*@ requires taken <= SIZE_END && f->k_uq32 <= K_END;
    requires -RATE_END <= f->rate_lsb_q24 <= RATE_END && 0 <= f->rate_max_lsb_q24 <= RATE_END;
    assigns f->rate_lsb_q24, \result \from *f, taken;
    ensures -RATE_END <= f->rate_lsb_q24 <= RATE_END;
    ensures \result <= 2 * SIZE_END;
*/
static inline uint32_t gained(adaptive_t *f, uint32_t taken);

/*@ requires TOLD(f) && MOTION_OF(f) && MEMORY(f) && NOISE(f) && HISTORY(f) && RUNNING(f);
    requires SAMPLE(z_lsb) && 64 <= f->weight_uq16 <= 32768;
    assigns f->x_lsb_q16, f->rate_lsb_q24, f->mean_lsb_q24, f->k_uq32, f->scatter_lsb_uq24, f->u, f->flags, f->verdict,
            f->below, f->run \from *f, z_lsb;
    ensures MOTION_OF(f) && MEMORY(f) && SCATTER(f) && RUNNING(f);
    ensures f->flags < 32;
*/
static inline void step(adaptive_t *f, int16_t z_lsb);

#endif
