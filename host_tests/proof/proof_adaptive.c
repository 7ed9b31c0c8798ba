/* adaptive: see law.h. */
#define RATE_END 2130706432 /* 127 LSB */
#define MEAN_END 2147483647 /* below 128 LSB, so that it can be negated */
#define GATE_END 150994944  /* 2304 LSB: 16 sigma of 90 LSB times 1.6 */
#define K_END 2577072127    /* 39322 and a fraction */
#define THIRD_LEAST 3014656
#define THIRD_END 2667642879   /* 159 LSB and a fraction: the largest term */
#define SCATTER_LEAST 1698872  /* what the least third is, unguarded */
#define SCATTER_END 1509949440 /* 90 LSB */

#define TOLD(a)                                                                                                  \
    (256 <= (a)->gate_sigma_q8 <= 4096 && 32 <= (a)->slow_uq16 <= 39322 && 32 <= (a)->fast_uq16 <= 39322 &&      \
     (a)->share_uq16 <= 15728 && (a)->confirm >= 3 && FLAG((a)->guarded) && FLAG((a)->identify) && FLAG((a)->by_turns))
#define MEMORY(a) (-MEAN_END <= (a)->mean_lsb_q24 <= MEAN_END && (a)->k_uq32 <= K_END)
#define SCATTER(a) (SCATTER_LEAST <= (a)->scatter_lsb_uq24 <= SCATTER_END)
#define THIRD(a) (THIRD_LEAST <= (a)->third_lsb_uq24 <= THIRD_END)
#define SMALL(a) ((a)->small < 6 && (a)->largest_lsb_uq8 <= 40704)
#define HISTORY(a) ((a)->filled == 0 || (SAMPLE((a)->history_lsb[0]) && SAMPLE((a)->history_lsb[1])))
/* A weight is for so many terms, of which some are left. */
#define WEIGHTS(a) ((a)->weight_uq16 * (a)->stage == 32768 && 1 <= (a)->terms <= 2 * (a)->stage)
#define LAST(a) (64 <= (a)->last_uq16 <= 1024 && (a)->weight_uq16 >= (a)->last_uq16)
#define LEARNT(a) (SCATTER(a) && THIRD(a) && SMALL(a) && WEIGHTS(a) && LAST(a) && FLAG((a)->third))
#define KEPT(f) (TOLD(&(f)->own.adaptive) && LEARNT(&(f)->own.adaptive))
#define RUNNING(a) (MEMORY(a) && (a)->gate_lsb_uq16 <= GATE_END && (a)->filled <= 3 && (a)->verdict <= 4)
#define FORCE(f) (RUNNING(&(f)->own.adaptive) && HISTORY(&(f)->own.adaptive) && FLAG((f)->negative))
#define KINDS 100
#define CONFIGURATIONS 10
#include "law.h"
#include "adaptive.h"

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
static uint32_t averaged(uint32_t mean_uq24, uint16_t term_uq8, uint16_t from_uq8, uint16_t weight_uq16);

/* The mean of before, or a term: both are told apart at the least that is kept, as those of averaged. */
/*@ requires SMALL(a) && term_uq8 <= 40704 && mean_uq24 <= THIRD_END;
    assigns a->small, a->largest_lsb_uq8, \result \from a->small, a->largest_lsb_uq8, mean_uq24, term_uq8, before_uq8;
    ensures SMALL(a);
    ensures \result < THIRD_LEAST || THIRD_LEAST <= \result <= THIRD_END;
*/
static inline uint32_t doubted(filter_adaptive_t *a, uint32_t mean_uq24, uint16_t term_uq8, uint16_t before_uq8);

#define STAGE(a, n) ((a)->stage == (n) && (a)->weight_uq16 == 32768 / (n) && 1 <= (a)->terms <= 2 * (n))
/*@ requires SCATTER(a) && THIRD(a) && SAMPLE(newest_lsb) && SAMPLE(z_lsb);
    requires SAMPLE(a->history_lsb[0]) && SAMPLE(a->history_lsb[1]);
    requires WEIGHTS(a) && LAST(a) && SMALL(a);
    assigns a->third_lsb_uq24, a->scatter_lsb_uq24, a->weight_uq16, a->terms, a->stage, a->small,
            a->largest_lsb_uq8 \from *a, newest_lsb, z_lsb;
    ensures SMALL(a);
    ensures SCATTER(a) && THIRD(a);
    ensures STAGE(a, 1) || STAGE(a, 2) || STAGE(a, 4) || STAGE(a, 8) || STAGE(a, 16) || STAGE(a, 32) ||
            STAGE(a, 64) || STAGE(a, 128) || STAGE(a, 256) || STAGE(a, 512);
    ensures LAST(a);
*/
void adaptive_identify(filter_adaptive_t *a, int16_t newest_lsb, int16_t z_lsb);

/*@ requires SCATTER(a) && THIRD(a) && MEMORY(a) && size_lsb_uq16 <= SIZE_END;
    requires spread_uq8 <= 36864;
    assigns a->scatter_lsb_uq24 \from *a, size_lsb_uq16, spread_uq8;
    ensures SCATTER(a);
*/
void adaptive_disperse(filter_adaptive_t *a, uint32_t size_lsb_uq16, uint16_t spread_uq8);

/*@ requires TRACKED(f) && RUNNING(&f->own.adaptive) && FLAG(f->negative);
    assigns f->flags, f->own.adaptive.verdict, f->own.adaptive.run, \result \from f->x_lsb_q16, f->rate_lsb, f->flags,
            f->own, f->size_lsb_uq16, f->negative, f->rate_max_lsb, f->previous_lsb;
    ensures \result <= SIZE_END;
    ensures f->own.adaptive.verdict <= 4;
*/
static uint32_t judge(filter_t *f);

/*@ requires MEMORY(a) && a->share_uq16 <= 15728;
    assigns a->mean_lsb_q24 \from *a, taken;
    ensures -MEAN_END <= a->mean_lsb_q24 <= MEAN_END;
*/
static inline void average_innovation(filter_adaptive_t *a, uint32_t taken);

/*@ requires MEMORY(a) && TOLD(a);
    requires spread_uq8 <= 36864;
    assigns a->k_uq32 \from *a, spread_uq8;
    ensures a->k_uq32 <= K_END;
*/
static inline void adapt(filter_adaptive_t *a, uint16_t spread_uq8);

/*@ requires WITHIN(f->rate_lsb, RATE_END) && f->rate_max_lsb <= RATE_END;
    requires 0 <= by_lsb_q24 <= RATE_END;
    assigns f->rate_lsb \from f->rate_lsb, f->rate_max_lsb, f->negative, by_lsb_q24;
    ensures upper: WITHIN(f->rate_lsb, RATE_END);
*/
static inline void turn(filter_t *f, int32_t by_lsb_q24);

/*@ requires taken <= SIZE_END && f->own.adaptive.k_uq32 <= K_END;
    requires WITHIN(f->rate_lsb, RATE_END) && f->rate_max_lsb <= RATE_END;
    assigns f->rate_lsb, \result \from f->rate_lsb, f->rate_max_lsb, f->negative, f->own, taken;
    ensures WITHIN(f->rate_lsb, RATE_END);
    ensures \result <= 2 * SIZE_END;
*/
static inline uint32_t gained(filter_t *f, uint32_t taken);

#include "adaptive_noise.c"
#include "adaptive_setup.c"
#include "adaptive.c"

/* By the last weight (5 of them), the weight in force and whether the history is there. */
static void any_own(filter_t *f, uint8_t kind)
{
    filter_adaptive_t *a = &f->own.adaptive;
    uint16_t last = (uint16_t)(64U << (kind / 20U));
    uint16_t weight = (uint16_t)(32768U >> (kind % 20U >> 1));
    a->gate_sigma_q8 = ANY_U16(256, 4096);
    a->manoeuvre_uq16 = ANY_U16(0, UINT16_MAX);
    a->slow_uq16 = ANY_U16(32, 39322);
    a->fast_uq16 = ANY_U16(32, 39322);
    a->share_uq16 = ANY_U16(0, 15728);
    a->confirm = ANY_U16(3, UINT16_MAX);
    a->guarded = ANY_BOOL();
    a->identify = ANY_BOOL();
    a->by_turns = ANY_U8(0, 1);
    a->third = ANY_U8(0, 1);
    a->mean_lsb_q24 = ANY_S32(-MEAN_END, MEAN_END);
    a->k_uq32 = ANY_U32(0, K_END);
    a->gate_lsb_uq16 = ANY_U32(0, GATE_END);
    a->scatter_lsb_uq24 = ANY_U32(SCATTER_LEAST, SCATTER_END);
    a->third_lsb_uq24 = ANY_U32(THIRD_LEAST, THIRD_END);
    bool history = (kind & 1U) != 0U;
    a->filled = history ? ANY_U8(1, 3) : 0;
    a->history_lsb[0] = history ? ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB) : ANY_Z();
    a->history_lsb[1] = history ? ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB) : ANY_Z();
    a->verdict = ANY_U8(0, 4);
    a->run = ANY_U16(0, UINT16_MAX);
    a->small = ANY_U8(0, 5);
    a->largest_lsb_uq8 = ANY_U16(0, 40704);
    a->weight_uq16 = (weight < last) ? last : weight;
    a->stage = (uint16_t)(32768U / a->weight_uq16);
    a->terms = ANY_U16(1, 2U * a->stage);
    a->last_uq16 = last;
}

/* By powers of 2 of the rate. */
static void narrow_config(filter_config_t *config, uint16_t number)
{
    uint16_t from = (number == 0U) ? 50U : (uint16_t)(64U << number);
    config->rate_dhz = ANY_U16(from, (number < 9U) ? (uint16_t)((128U << number) - 1U) : 40000U);
    if (config->value[ADAPTIVE_GUARD_SIGMA_Q8] != 0) {
        config->value[ADAPTIVE_GUARD_SIGMA_Q8] = ANY_S32(256, 4096);
    }
}

/*
 * By upper halves of the mean, in ranges that narrow towards the end that it must not pass.
 * Options: -eva-domains octagon
 */
void proof_averaged(void)
{
    uint16_t width = 46;
    for (uint16_t from = 46; from <= 40704U; from = (uint16_t)(from + width)) {
        width = (uint16_t)((from < 20352U) ? from : (40706U - from) / 2U);
        uint16_t to = (uint16_t)(from + width - 1U);
        uint32_t mean = ANY_U32((uint32_t)from << 16, ((uint32_t)to << 16) + 65535U);
        (void)averaged(mean, ANY_U16(0, 40704), ANY_U16(from, to), ANY_U16(0, 32768));
    }
    for (uint16_t from = 25; from <= 23040U; from = (uint16_t)(from * 2U)) {
        uint32_t mean = ANY_U32((from == 25U) ? SCATTER_LEAST : (uint32_t)from << 16,
                                (from < 11520U) ? ((uint32_t)from << 17) - 1U : SCATTER_END);
        (void)averaged(mean, ANY_U16(0, UINT16_MAX), ANY_U16(from, (from < 16384U) ? 4U * from : UINT16_MAX),
                       ANY_U16(0, 8192));
    }
}

/* Each of mean, term and largest term below the least mean that is kept, and from it on. */
void proof_doubted(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    //@ loop unroll 8;
    for (uint8_t i = 0; i < 8U; i++) {
        uint32_t mean = (i & 1U) ? ANY_U32(THIRD_LEAST, THIRD_END) : ANY_U32(0, THIRD_LEAST - 1);
        uint16_t term = (i & 2U) ? ANY_U16(46, 40704) : ANY_U16(0, 45);
        f.own.adaptive.largest_lsb_uq8 = (i & 4U) ? ANY_U16(46, 40704) : ANY_U16(0, 45);
        f.own.adaptive.small = ANY_U8(0, 5);
        (void)doubted(&f.own.adaptive, mean, term, ANY_U16(0, UINT16_MAX));
    }
}

void proof_adaptive_identify(void)
{
    filter_t f;
    EACH_KIND(kind)
    {
        any_running(&f, &filter_law_adaptive, kind | 1U);
        filter_adaptive_t *a = &f.own.adaptive;
        a->terms = ((kind & 1U) != 0U) ? 1 : ANY_U16(2, 2U * a->stage);
        adaptive_identify(a, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

void proof_adaptive_disperse(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    f.own.adaptive.weight_uq16 = ANY_U16(64, 32768);
    adaptive_disperse(&f.own.adaptive, ANY_U32(0, SIZE_END), ANY_U16(0, 36864));
}

/* Options: -eva-domains octagon */
void proof_judge(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    f.flags = 0;
    (void)judge(&f);
}

/* What is left to the end of the format halved each time. Options: -eva-domains octagon */
void proof_average_innovation(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    f.own.adaptive.mean_lsb_q24 = ANY_S32(-MEAN_END, -1);
    average_innovation(&f.own.adaptive, ANY_U32(0, SIZE_END));
    for (uint32_t left = 0x80000000U; left >= 0x10000U; left >>= 1) {
        any_running(&f, &filter_law_adaptive, 1);
        f.own.adaptive.mean_lsb_q24 = ANY_S32((int32_t)(0x80000000U - left),
                                 (int32_t)(0x7FFFFFFFU - ((left == 0x10000U) ? 0U : left / 2U)));
        average_innovation(&f.own.adaptive, ANY_U32(0, SIZE_END));
    }
}

/* k by ranges of 1 to 4: what is taken is less than its sixth. */
void proof_adapt(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    f.own.adaptive.k_uq32 = ANY_U32(0, 0x1FFFFU);
    adapt(&f.own.adaptive, ANY_U16(0, 36864));
    for (uint32_t k = 2; k <= 39322U; k *= 4U) {
        any_running(&f, &filter_law_adaptive, 1);
        f.own.adaptive.k_uq32 = ANY_U32(k << 16, (k < 8192U) ? (k << 18) - 1U : K_END);
        adapt(&f.own.adaptive, ANY_U16(0, 36864));
    }
}

/* By the change, so that the test of the rate tells the sum. */
void proof_turn(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    for (int32_t by = 0; by < RATE_END; by += 0x800000L) {
        f.rate_lsb = ANY_S32(-RATE_END, RATE_END);
        turn(&f, ANY_S32(by, by + 0x800000L));
    }
}

static void any_gained(uint32_t from_k, uint32_t to_k)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 1);
    f.own.adaptive.k_uq32 = ANY_U32(from_k << 16, (to_k << 16) + 65535U);
    (void)gained(&f, ANY_U32(0, 255));
    uint32_t to = 0;
    for (uint32_t from = 1; from < (SIZE_END >> 8); from = to + 1U) {
        to = from + from / 4U;
        if (to > (from | 0xFFFFU)) {
            to = from | 0xFFFFU; /* the product is one of halves */
        }
        f.rate_lsb = ANY_S32(-RATE_END, RATE_END);
        (void)gained(&f, ANY_U32(from << 8, (to < (SIZE_END >> 8)) ? (to << 8) + 255U : SIZE_END));
    }
}

/* k and what is taken in ranges narrow enough for 2 w to exceed k w wherever in them they are. */
void proof_gained(void)
{
    any_gained(0, 0);
    for (uint32_t k = 1; k < 16384U; k *= 2U) {
        any_gained(k, 2U * k - 1U);
    }
    any_gained(16384, 20479);
    any_gained(20480, 25599);
    any_gained(25600, 31999);
    any_gained(32000, 39322);
}

PROVE_LAW(adaptive)
