/* kf3: see law.h. */

/* After a prediction from P11 < 4 and all else below 1; held ones and those after an update lie within too. */
#define P12_END 1879048192UL /* 7 */
#define P_OF(k)                                                                                      \
    ((k).p.p11 < 13 * ONE && (k).p.p12 < P12_END && (k).p.p22 < 5 * ONE && (k).p13_uq28 < 4 * ONE && \
     (k).p23_uq28 < 3 * ONE && (k).p33_uq28 < 2 * ONE)
#define P_BOUND(f) P_OF((f)->own.kf3)
#define ACCELERATION(f) WITHIN((f)->own.kf3.acceleration_q16, X_MAX_Q16)
#define DRIVE(k) (16 <= (k).q33_uq28 <= 0x2000000 || ((k).fine == 0 && 16 <= (k).q33_uq28 <= ONE))
#define KEPT(f)                                                                                \
    (DRIVE((f)->own.kf3) && 3 <= (f)->own.kf3.r_lsb2_q8 <= R_END && FLAG((f)->own.kf3.fine) && \
     (f)->own.kf3.p22_start_uq28 <= 0x8000000 && SCALED((f)->own.kf3.drive_lsb2) && SCALED((f)->own.kf3.start_lsb2))
#define FORCE(f) (P_BOUND(f) && ACCELERATION(f))
#define KINDS 2 /* coarse and fine */
#define CONFIGURATIONS(law) 2
#include "kalman_bounds.h"

/* kalman.c and wide.c have functions of these names. */
#define correct correct_three
#define limited limited_kf3

/*@ requires -3 * X_MAX_Q16 <= v_q16 <= 3 * X_MAX_Q16;
    assigns f->flags, \result \from f->flags, v_q16;
    ensures -X_MAX_Q16 <= \result <= X_MAX_Q16;
*/
static int32_t limited(filter_t *f, int32_t v_q16);

/*@ requires gain_uq24 <= 0xFFFFFF; */
static uint32_t less(uint32_t p_uq28, uint32_t column_uq28, uint32_t gain_uq24);
/*@ requires gain_uq24 <= 0xFFFFFF; */
static int32_t moved(const filter_t *f, int32_t v_q16, uint32_t gain_uq24);

/*@ requires 16 <= k->q33_uq28 <= ONE && FLAG(k->fine);
    requires P_OF(*k);
    assigns k->p, k->p13_uq28, k->p23_uq28, k->p33_uq28, \result \from *k;
    ensures P_OF(*k);
    ensures FLAG(\result);
*/
static bool grow_covariance(filter_kf3_t *k);

/*@ requires KEPT(f) && TRACKED(f) && ACCELERATION(f) && f->collected == 5;
    requires P_BOUND(f);
    assigns f->own.kf3.p, f->own.kf3.p13_uq28, f->own.kf3.p23_uq28, f->own.kf3.p33_uq28, f->x_lsb_q16, f->rate_lsb,
            f->own.kf3.acceleration_q16, f->flags \from f->own, f->x_lsb_q16, f->rate_lsb, f->flags,
            f->size_lsb_uq16, f->negative;
    ensures P_BOUND(f);
    ensures TRACKED(f) && ACCELERATION(f);
*/
static void predict(filter_t *f);

/*@ requires KEPT(f) && TRACKED(f) && ACCELERATION(f) && f->collected == 5;
    requires P_BOUND(f);
    requires reach: f->collected == 5 && REACH(f);
    assigns f->own.kf3.p, f->own.kf3.p13_uq28, f->own.kf3.p23_uq28, f->own.kf3.p33_uq28, f->x_lsb_q16, f->rate_lsb,
            f->own.kf3.acceleration_q16, f->flags, f->gain_uq16 \from f->own, f->x_lsb_q16, f->rate_lsb,
            f->flags, f->size_lsb_uq16, f->negative;
    ensures P_BOUND(f);
    ensures TRACKED(f) && ACCELERATION(f);
*/
static void correct(filter_t *f);

#include "kf3.c"

static void any_own(filter_t *f, uint8_t kind)
{
    filter_kf3_t *k = &f->own.kf3;
    k->p.p11 = ANY_U32(0, 13UL * ONE - 1U);
    k->p.p12 = ANY_U32(0, P12_END - 1U);
    k->p.p22 = ANY_U32(0, 5UL * ONE - 1U);
    k->p13_uq28 = ANY_U32(0, 4UL * ONE - 1U);
    k->p23_uq28 = ANY_U32(0, 3UL * ONE - 1U);
    k->p33_uq28 = ANY_U32(0, 2UL * ONE - 1U);
    k->acceleration_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    k->q33_uq28 = ANY_U32(16, (kind == 0U) ? ONE : 0x2000000);
    k->p22_start_uq28 = ANY_U32(0, P22_START_MAX_UQ28);
    k->r_lsb2_q8 = ANY_U32(3, R_END);
    k->drive_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    k->drive_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    k->start_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    k->start_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    k->fine = kind != 0U;
}

/* Coarse and fine. */
static void narrow_config(filter_config_t *config, uint16_t number)
{
    config->rate_dhz = (number == 0U) ? ANY_U16(50, FINE_FROM_DHZ - 1U) : ANY_U16(FINE_FROM_DHZ, 40000);
}

void proof_limited_kf3(void)
{
    filter_t f;
    f.flags = 0;
    (void)limited(&f, ANY_S32(-3L * X_MAX_Q16, -X_MAX_Q16 - 1L));
    (void)limited(&f, ANY_S32(-X_MAX_Q16, -1));
    (void)limited(&f, ANY_S32(0, X_MAX_Q16));
    (void)limited(&f, ANY_S32(X_MAX_Q16 + 1L, 3L * X_MAX_Q16));
}

/* All that is predicted; then each element at the end of its range, the others anywhere. */
void proof_grow_covariance(void)
{
    filter_t f;
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p.p11 = ANY_U32(0, 4UL * ONE - 1U);
    f.own.kf3.p.p12 = ANY_U32(0, ONE - 1U);
    f.own.kf3.p.p22 = ANY_U32(0, ONE - 1U);
    f.own.kf3.p13_uq28 = ANY_U32(0, ONE - 1U);
    f.own.kf3.p23_uq28 = ANY_U32(0, ONE - 1U);
    f.own.kf3.p33_uq28 = ANY_U32(0, ONE - 1U);
    (void)grow_covariance(&f.own.kf3);
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p.p11 = ANY_U32(4UL * ONE, 13UL * ONE - 1U);
    (void)grow_covariance(&f.own.kf3);
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p.p12 = ANY_U32(ONE, P12_END - 1U);
    (void)grow_covariance(&f.own.kf3);
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p.p22 = ANY_U32(ONE, 5UL * ONE - 1U);
    (void)grow_covariance(&f.own.kf3);
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p13_uq28 = ANY_U32(ONE, 4UL * ONE - 1U);
    (void)grow_covariance(&f.own.kf3);
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p23_uq28 = ANY_U32(ONE, 3UL * ONE - 1U);
    (void)grow_covariance(&f.own.kf3);
    any_running(&f, &filter_law_kf3, 0);
    f.own.kf3.p33_uq28 = ANY_U32(ONE, 2UL * ONE - 1U);
    (void)grow_covariance(&f.own.kf3);
}

void proof_predict(void)
{
    filter_t f;
    any_running(&f, &filter_law_kf3, 0);
    f.flags = 0;
    predict(&f);
}

/* Options: -eva-split-return-function filter_fx_leading:full */
void proof_correct_three(void)
{
    filter_t f;
    any_running(&f, &filter_law_kf3, 0);
    //@ admit REACH(&f);
    correct(&f);
}

/* Root by root. Options: -eva-split-return-function sixth_root_uq10:full */
PROVE_LAW(kf3)
