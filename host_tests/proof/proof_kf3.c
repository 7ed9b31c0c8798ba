/* kf3: any int16, any state within its bounds; the same bounds afterwards. */
#include "two_state_bounds.h"

#include "kf3.h"

/* After a prediction from P11 < 4 and all else below 1; held ones and those after an update lie within too. */
#define P_BOUND(f)                                                                                                   \
    ((f)->core.u.p.p11_uq28 < 13 * ONE && (f)->core.u.p.p12_uq28 < 1879048192 && (f)->core.u.p.p22_uq28 < 5 * ONE && \
     (f)->p13_uq28 < 4 * ONE && (f)->p23_uq28 < 3 * ONE && (f)->p33_uq28 < 2 * ONE)
#define TOLD(f)                                                                                                       \
    (16 <= (f)->core.q22_uq28 <= ONE && 16 <= (f)->core.p22_start_uq28 <= ONE && 3 <= (f)->core.r_lsb2_q8 <= R_END && \
     SCALED((f)->core.drive_lsb2) && SCALED((f)->core.start_lsb2) && (f)->core.rate_max_lsb_q16 <= X_MAX_Q16 &&       \
     ((f)->fine == 0 || (f)->fine == 1))
#define MOTION(f) (ESTIMATE(&(f)->core) && -X_MAX_Q16 <= (f)->acceleration_q16 <= X_MAX_Q16)
#define RUNNING(f) ((f)->core.collected == 5 && P_BOUND(f))
#define BOUND(f) (TOLD(f) && MOTION(f) && (RUNNING(f) || ((f)->core.collected < 5 && SAMPLES(&(f)->core))))

/*@ requires -3 * X_MAX_Q16 <= v_q16 <= 3 * X_MAX_Q16;
    assigns f->core.flags, \result \from f->core.flags, v_q16;
    ensures -X_MAX_Q16 <= \result <= X_MAX_Q16;
*/
static int32_t limited(kf3_t *f, int32_t v_q16);

/*@ requires gain_uq24 <= 0xFFFFFF; */
static uint32_t less(uint32_t p_uq28, uint32_t column_uq28, uint32_t gain_uq24);
/*@ requires gain_uq24 <= 0xFFFFFF; */
static int32_t moved(const kf3_t *f, int32_t v_q16, uint32_t gain_uq24);

/*@ requires TOLD(f) && f->core.collected == 5;
    requires P_BOUND(f);
    assigns f->core.u, f->p13_uq28, f->p23_uq28, f->p33_uq28, \result \from *f;
    ensures P_BOUND(f);
    ensures \result == 0 || \result == 1;
*/
static bool grow_covariance(kf3_t *f);

/*@ requires TOLD(f) && MOTION(f) && f->core.collected == 5;
    requires P_BOUND(f);
    assigns f->core.u, f->p13_uq28, f->p23_uq28, f->p33_uq28, f->core.x_lsb_q16, f->core.rate_lsb_q16,
            f->acceleration_q16, f->core.flags \from *f;
    ensures P_BOUND(f);
    ensures MOTION(f);
*/
static void predict(kf3_t *f);

/*@ requires TOLD(f) && MOTION(f) && f->core.collected == 5;
    requires P_BOUND(f);
    requires reach: REACH(&f->core);
    assigns f->core.u, f->p13_uq28, f->p23_uq28, f->p33_uq28, f->core.x_lsb_q16, f->core.rate_lsb_q16,
            f->acceleration_q16, f->core.flags, f->core.gain_uq16 \from *f;
    ensures P_BOUND(f);
    ensures MOTION(f);
*/
static void correct(kf3_t *f);

/*@ requires SAMPLE(z_lsb);
    requires TOLD(f) && MOTION(f) && f->core.collected == 5;
    requires P_BOUND(f);
    assigns f->core.u, f->p13_uq28, f->p23_uq28, f->p33_uq28, f->core.x_lsb_q16, f->core.rate_lsb_q16,
            f->acceleration_q16, f->core.flags, f->core.gain_uq16, f->core.size_lsb_uq8, f->core.negative
            \from *f, z_lsb;
    ensures P_BOUND(f);
    ensures MOTION(f);
*/
static void take(kf3_t *f, int16_t z_lsb);

/*@ ensures \result ==> BOUND(f); */
bool kf3_init(kf3_t *f, const kf3_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf3_set_noise(kf3_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf3_reset(kf3_t *f, int16_t z0_lsb);
bool kf3_reset_step(kf3_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t kf3_update(kf3_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t kf3_coast(kf3_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf3_damp(kf3_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf3_hold(kf3_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void kf3_restart(kf3_t *f);

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "kf3.c"

#define P12_END 1879048192UL /* 7 */

static void any_told(kf3_t *f)
{
    any_state(&f->core);
    f->core.r_lsb2_q8 = ANY_U32(3, R_END);
    f->acceleration_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    f->fine = ANY_BOOL();
}

static void any_run(kf3_t *f)
{
    any_told(f);
    f->core.u.p.p11_uq28 = ANY_U32(0, 13UL * ONE - 1U);
    f->core.u.p.p12_uq28 = ANY_U32(0, P12_END - 1U);
    f->core.u.p.p22_uq28 = ANY_U32(0, 5UL * ONE - 1U);
    f->p13_uq28 = ANY_U32(0, 4UL * ONE - 1U);
    f->p23_uq28 = ANY_U32(0, 3UL * ONE - 1U);
    f->p33_uq28 = ANY_U32(0, 2UL * ONE - 1U);
}

static void any_warm_up(kf3_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_run(f);
    any_start(&f->core);
    f->core.r_lsb2_q8 = ANY_U32(3, R_END);
    f->core.collected = ANY_U8(from_collected, to_collected);
}

void proof_limited(void)
{
    kf3_t f;
    f.core.flags = 0;
    (void)limited(&f, ANY_S32(-3L * X_MAX_Q16, -X_MAX_Q16 - 1L));
    (void)limited(&f, ANY_S32(-X_MAX_Q16, -1));
    (void)limited(&f, ANY_S32(0, X_MAX_Q16));
    (void)limited(&f, ANY_S32(X_MAX_Q16 + 1L, 3L * X_MAX_Q16));
}

/* All that is predicted; then each element at the end of its range, the others anywhere. */
void proof_grow_covariance(void)
{
    kf3_t f;
    any_told(&f);
    f.core.u.p.p11_uq28 = ANY_U32(0, 4UL * ONE - 1U);
    f.core.u.p.p12_uq28 = ANY_U32(0, ONE - 1U);
    f.core.u.p.p22_uq28 = ANY_U32(0, ONE - 1U);
    f.p13_uq28 = ANY_U32(0, ONE - 1U);
    f.p23_uq28 = ANY_U32(0, ONE - 1U);
    f.p33_uq28 = ANY_U32(0, ONE - 1U);
    (void)grow_covariance(&f);
    any_run(&f);
    f.core.u.p.p11_uq28 = ANY_U32(4UL * ONE, 13UL * ONE - 1U);
    (void)grow_covariance(&f);
    any_run(&f);
    f.core.u.p.p12_uq28 = ANY_U32(ONE, P12_END - 1U);
    (void)grow_covariance(&f);
    any_run(&f);
    f.core.u.p.p22_uq28 = ANY_U32(ONE, 5UL * ONE - 1U);
    (void)grow_covariance(&f);
    any_run(&f);
    f.p13_uq28 = ANY_U32(ONE, 4UL * ONE - 1U);
    (void)grow_covariance(&f);
    any_run(&f);
    f.p23_uq28 = ANY_U32(ONE, 3UL * ONE - 1U);
    (void)grow_covariance(&f);
    any_run(&f);
    f.p33_uq28 = ANY_U32(ONE, 2UL * ONE - 1U);
    (void)grow_covariance(&f);
}

/* Uses: limited, grow_covariance */
void proof_predict(void)
{
    kf3_t f;
    any_run(&f);
    f.core.flags = 0;
    predict(&f);
}

/* Uses: fx_normalise, fx_inverse_m_uq16, limited. Options: -eva-split-return-function fx_leading:full */
void proof_correct(void)
{
    kf3_t f;
    any_run(&f);
    //@ admit REACH(&f.core);
    correct(&f);
}

/* Uses: predict, correct */
void proof_take(void)
{
    kf3_t f;
    any_run(&f);
    take(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

/*
 * Uses: fx_normalise, rounded. All legal configurations, coarse and fine, then all with one parameter below or above.
 */
void proof_kf3_init(void)
{
    kf3_t f;
    kf3_config_t config;
    for (uint8_t number = 0; number < CASES(3); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, KF3_FINE_FROM_DHZ - 1U);
        config.r_lsb2_q8 = any_u32(part_of(number, 1), 3, 256000, UINT32_MAX);
        config.q_lsb2_s5 = any_u32(part_of(number, 2), 1, 1000000000, UINT32_MAX);
        if (number == 2U) {
            config.rate_dhz = ANY_U16(40001, UINT16_MAX);
        }
        (void)kf3_init(&f, &config);
        if (number == 0U) {
            config.rate_dhz = ANY_U16(KF3_FINE_FROM_DHZ, 40000);
            (void)kf3_init(&f, &config);
        }
    }
    kf3_defaults(&config, ANY_U16(50, 40000));
}

/* Uses: fx_normalise, rounded */
void proof_kf3_set_noise(void)
{
    kf3_t f;
    any_run(&f);
    kf3_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_warm_up(&f, 0, 4);
    kf3_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

/* Uses: take */
void proof_kf3_reset(void)
{
    kf3_t f;
    any_run(&f);
    kf3_reset(&f, ANY_Z());
    any_warm_up(&f, 0, 4);
    kf3_reset(&f, ANY_Z());
}

/* Uses: take */
void proof_kf3_reset_step(void)
{
    kf3_t f;
    any_run(&f);
    (void)kf3_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_warm_up(&f, 0, 4);
    (void)kf3_reset_step(&f, ANY_Z(), 0);
}

/* Uses: take */
void proof_kf3_update(void)
{
    kf3_t f;
    any_run(&f);
    (void)kf3_update(&f, ANY_Z());
    any_warm_up(&f, 0, 3);
    (void)kf3_update(&f, ANY_Z());
    any_warm_up(&f, 4, 4);
    (void)kf3_update(&f, ANY_Z());
}

/* Uses: predict */
void proof_kf3_coast(void)
{
    kf3_t f;
    any_run(&f);
    (void)kf3_coast(&f);
    any_warm_up(&f, 0, 4);
    (void)kf3_coast(&f);
    filter_probe_t probe;
    any_run(&f);
    kf3_probe(&f, &probe);
    (void)kf3_flags(&f);
}

/* What is told of missing samples, of states as those of a coast. */
void proof_kf3_gap(void)
{
    kf3_t f;
    any_run(&f);
    kf3_damp(&f);
    any_warm_up(&f, 0, 4);
    kf3_damp(&f);
    any_run(&f);
    kf3_gap(&f);
    any_run(&f);
    kf3_hold(&f);
    any_warm_up(&f, 0, 4);
    kf3_gap(&f);
    any_warm_up(&f, 0, 4);
    kf3_hold(&f);
    any_run(&f);
    kf3_restart(&f);
    any_warm_up(&f, 0, 4);
    kf3_restart(&f);
}
