/* adaptive: see law.h. */
#define RATE_END 2130706432 /* 127 LSB */
#define MEAN_END 2147483647 /* below 128 LSB, so that it can be negated */
#define GATE_END 268431360  /* below 4096 LSB: 16 times 256 */
#define K_END 2577072127    /* 39322 and a fraction */
#define SPREAD_END 36864    /* 90 LSB times 1.6 */

#define TOLD(a)                                                                                             \
    (256 <= (a)->gate_sigma_q8 <= 4096 && 32 <= (a)->slow_uq16 <= 39322 && 32 <= (a)->fast_uq16 <= 39322 && \
     (a)->share_uq16 <= 15728 && (a)->confirm >= 3 && FLAG((a)->guarded) && FLAG((a)->turn))
#define MEMORY(a) (WITHIN((a)->mean_lsb_q24, MEAN_END) && (a)->k_uq32 <= K_END)
#define SCATTER(v) (0x1A0000 <= (v) <= 0x5A000000)
#define LEARNT(a) (SCATTER((a)->scatter_lsb_uq24) && (a)->learnt <= 7)
#define RUNNING(a) (MEMORY(a) && (a)->gate_lsb_uq16 <= GATE_END && (a)->verdict <= 4)
#define KEPT(f) (TOLD(&(f)->own.adaptive) && LEARNT(&(f)->own.adaptive))
#define FORCE(f) (RUNNING(&(f)->own.adaptive) && FLAG((f)->negative))
#define KINDS 1
#define CONFIGURATIONS(law) 10
#include "adaptive.h"
#include "law.h"

/*
 * The mean of innovations, its top bit turned over, and terms of at least 0; or the scatter and what is expected of it.
 */
/*@ requires part: (expected_uq8 == mean_uq24 / 65536 && 1 <= mean_uq24 && 32768 <= term_uq8 && weight_uq16 <= 15728) ||
                   (mean_uq24 / 65536 <= expected_uq8 <= mean_uq24 / 32768 && SCATTER(mean_uq24) &&
                    weight_uq16 <= 8192);
    assigns \result \from mean_uq24, expected_uq8, term_uq8, weight_uq16;
    ensures \result >= 1;
*/
static inline uint32_t averaged(uint32_t mean_uq24, uint16_t expected_uq8, uint16_t term_uq8, uint16_t weight_uq16);

/*@ requires MEMORY(a) && a->share_uq16 <= 15728;
    assigns a->mean_lsb_q24 \from *a, taken;
    ensures least: a->mean_lsb_q24 >= -MEAN_END;
*/
static inline void average_innovation(filter_adaptive_t *a, uint32_t taken);

/*@ requires LEARNT(a) && MEMORY(a) && size_lsb_uq16 <= SIZE_END && spread_uq8 <= SPREAD_END;
    assigns a->scatter_lsb_uq24, a->learnt \from *a, size_lsb_uq16, spread_uq8;
    ensures LEARNT(a);
*/
static void disperse(filter_adaptive_t *a, uint32_t size_lsb_uq16, uint16_t spread_uq8);

/*@ requires TRACKED(f) && RUNNING(&f->own.adaptive) && FLAG(f->negative) && WITHIN(x1_lsb_q16, X_MAX_Q16);
    assigns f->flags, f->own.adaptive.verdict, f->own.adaptive.run, f->own.adaptive.strays, \result
            \from f->x_lsb_q16, f->rate_lsb, f->flags, f->own, f->size_lsb_uq16, f->negative, f->rate_max_lsb,
            f->previous_lsb, x1_lsb_q16;
    ensures \result <= SIZE_END;
    ensures f->own.adaptive.verdict <= 4;
*/
static uint32_t judge(filter_t *f, int32_t x1_lsb_q16);

/*@ requires MEMORY(a) && TOLD(a);
    requires spread_uq8 <= SPREAD_END;
    assigns a->k_uq32 \from *a, spread_uq8;
    ensures a->k_uq32 <= K_END;
*/
static void adapt(filter_adaptive_t *a, uint16_t spread_uq8);

/*@ requires WITHIN(f->rate_lsb, RATE_END) && f->rate_max_lsb <= RATE_END;
    requires 0 <= by_lsb_q24 <= RATE_END;
    assigns f->rate_lsb \from f->rate_lsb, f->rate_max_lsb, f->negative, by_lsb_q24;
    ensures upper: WITHIN(f->rate_lsb, RATE_END);
*/
static inline void turn(filter_t *f, int32_t by_lsb_q24);

/*@ requires taken <= SIZE_END && f->own.adaptive.k_uq32 <= K_END;
    requires WITHIN(f->x_lsb_q16, X_MAX_Q16) && WITHIN(f->rate_lsb, RATE_END) && f->rate_max_lsb <= RATE_END;
    assigns f->x_lsb_q16, f->rate_lsb, f->flags \from f->x_lsb_q16, f->rate_lsb, f->rate_max_lsb, f->negative, f->flags,
            f->own, taken;
    ensures WITHIN(f->x_lsb_q16, X_MAX_Q16) && WITHIN(f->rate_lsb, RATE_END);
*/
static void follow(filter_t *f, uint32_t taken);

#include "adaptive.c"

static void any_own(filter_t *f, uint8_t kind)
{
    filter_adaptive_t *a = &f->own.adaptive;
    (void)kind;
    a->gate_sigma_q8 = ANY_U16(256, 4096);
    a->manoeuvre_uq16 = ANY_U16(0, UINT16_MAX);
    a->slow_uq16 = ANY_U16(32, 39322);
    a->fast_uq16 = ANY_U16(32, 39322);
    a->share_uq16 = ANY_U16(0, 15728);
    a->confirm = ANY_U16(3, UINT16_MAX);
    a->guarded = ANY_BOOL();
    a->turn = ANY_BOOL();
    a->mean_lsb_q24 = ANY_S32(-MEAN_END, MEAN_END);
    a->k_uq32 = ANY_U32(0, K_END);
    a->gate_lsb_uq16 = ANY_U32(0, GATE_END);
    a->scatter_lsb_uq24 = ANY_U32(0x1A0000, 0x5A000000);
    a->learnt = ANY_U8(0, 7);
    a->verdict = ANY_U8(0, 4);
    a->run = ANY_U16(0, UINT16_MAX);
    a->strays = ANY_U8(0, UINT8_MAX);
}

/* By powers of 2 of the rate. */
static void narrow_config(filter_config_t *config, uint16_t number)
{
    uint16_t from = (number == 0U) ? 50U : (uint16_t)(64U << number);
    config->rate_dhz = ANY_U16(from, (number < 9U) ? (uint16_t)((128U << number) - 1U) : 40000U);
}

/*
 * By upper halves of the mean; that of innovations in ranges of which what is left to the end of the format is halved
 * each time. Options: -eva-domains octagon
 */
void proof_averaged(void)
{
    (void)averaged(ANY_U32(1, 65535), 0, ANY_U16(32768, UINT16_MAX), ANY_U16(0, 15728));
    uint16_t width = 1;
    for (uint32_t from = 1; from <= UINT16_MAX; from += width) {
        width = (uint16_t)((from < 32768U) ? from : (65537U - from) / 2U);
        uint16_t to = (uint16_t)(from + width - 1U);
        (void)averaged(ANY_U32(from << 16, ((uint32_t)to << 16) + 65535U), ANY_U16((uint16_t)from, to),
                       ANY_U16(32768, UINT16_MAX), ANY_U16(0, 15728));
    }
    for (uint16_t from = 26; from <= 23040U; from = (uint16_t)(2U * from)) {
        (void)averaged(ANY_U32((uint32_t)from << 16, (from < 11520U) ? ((uint32_t)from << 17) - 1U : 0x5A000000U),
                       ANY_U16(from, (from < 16384U) ? 4U * from : UINT16_MAX), ANY_U16(0, UINT16_MAX),
                       ANY_U16(0, 8192));
    }
}

/* Two's complement with its top bit turned over. Options: -no-warn-signed-downcast */
void proof_average_innovation(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 0);
    average_innovation(&f.own.adaptive, ANY_U32(0, SIZE_END));
}

void proof_disperse(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 0);
    disperse(&f.own.adaptive, ANY_U32(0, SIZE_END), ANY_U16(0, SPREAD_END));
}

/* Options: -eva-domains octagon */
void proof_judge(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 0);
    f.flags = 0;
    (void)judge(&f, ANY_S32(-X_MAX_Q16, X_MAX_Q16));
}

/* k by ranges of 1 to 4: what is taken is less than its sixth. */
void proof_adapt(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 0);
    f.own.adaptive.k_uq32 = ANY_U32(0, 0x1FFFFU);
    adapt(&f.own.adaptive, ANY_U16(0, SPREAD_END));
    for (uint32_t k = 2; k <= 39322U; k *= 4U) {
        any_running(&f, &filter_law_adaptive, 0);
        f.own.adaptive.k_uq32 = ANY_U32(k << 16, (k < 8192U) ? (k << 18) - 1U : K_END);
        adapt(&f.own.adaptive, ANY_U16(0, SPREAD_END));
    }
}

/* By the change, so that the test of the rate tells the sum. */
void proof_turn(void)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 0);
    for (int32_t by = 0; by < RATE_END; by += 0x800000L) {
        f.rate_lsb = ANY_S32(-RATE_END, RATE_END);
        turn(&f, ANY_S32(by, by + 0x800000L));
    }
}

/* k and what is taken in ranges narrow enough for 2 w to exceed k w wherever in them they are. */
static void any_followed(uint32_t from_k, uint32_t to_k)
{
    filter_t f;
    any_running(&f, &filter_law_adaptive, 0);
    f.own.adaptive.k_uq32 = ANY_U32(from_k << 16, (to_k << 16) + 65535U);
    uint32_t to = 0;
    for (uint32_t from = 0; from <= SIZE_END; from = to + 1U) {
        to = from + from / 4U;
        if (from < 0x100000U && to > (from | 0xFFFFU)) {
            to = from | 0xFFFFU; /* the product is one of halves */
        }
        f.x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
        f.rate_lsb = ANY_S32(-RATE_END, RATE_END);
        follow(&f, ANY_U32(from, (to < SIZE_END) ? to : SIZE_END));
    }
}

void proof_follow(void)
{
    any_followed(0, 0);
    for (uint32_t k = 1; k < 16384U; k *= 2U) {
        any_followed(k, 2U * k - 1U);
    }
    any_followed(16384, 20479);
    any_followed(20480, 25599);
    any_followed(25600, 31999);
    any_followed(32000, 32767); /* twice this rounds to 1, as twice the next */
    any_followed(32768, 39322);
}

PROVE_LAW(adaptive)
