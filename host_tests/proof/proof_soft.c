/* soft: any int16, any state within its bounds; the same bounds afterwards. */
#define REACQUIRE_BEFORE WIDTH
#define REACQUIRE_AFTER WIDTH
#include "reacquire_bounds.h"

#include "soft.h"

#define GATE(f) ((f)->soft_sigma_q8 <= 4096 && RUN(&(f)->again))
#define BOUND(f) \
    (PARAMETERS(&(f)->core) && (f)->core.r_lsb2_q8 <= R_END && ESTIMATE(&(f)->core) && MODE(&(f)->core) && GATE(f))

/*@ ensures \result ==> BOUND(f); */
bool soft_init(soft_t *f, const soft_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void soft_set_noise(soft_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void soft_reset(soft_t *f, int16_t z0_lsb);
bool soft_reset_step(soft_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t soft_update(soft_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures -X_MAX_Q16 <= \result <= X_MAX_Q16; */
int32_t soft_coast(soft_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void soft_damp(soft_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void soft_hold(soft_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void soft_restart(soft_t *f);

/*@ requires s->size_lsb_uq8 <= 8704 * 256 && s->u.p.p11_uq28 < 8 * ONE && ((s)->coarse == 0 || (s)->coarse == 1);
    assigns s->limit_lsb2, \result \from *s;
    ensures \result == 0 || \result == 1;
    ensures \result == 1 || FARTHER(s);
*/
static bool within_gate(two_state_t *s);

/*@ requires farther: s->size_lsb_uq8 >= 1 && (FARTHER(s));
    assigns \result \from *s;
    ensures \result < 0x1000000;
*/
static inline uint32_t weight_uq20(const two_state_t *s);

/*@ assigns \result \from w_uq24;
    ensures \result <= 0xFFFFFF;
*/
static inline uint32_t limited_uq24(uint32_t w_uq24);

/*@ requires PARAMETERS(&f->core) && f->core.r_lsb2_q8 <= R_END && ESTIMATE(&f->core) && GATE(f) && SAMPLE(z_lsb);
    requires f->core.collected == 5;
    requires WIDTH(f->core.u.p);
    requires reach: f->core.collected == 5 && (REACH(&f->core));
    assigns f->core.x_lsb_q16, f->core.rate_lsb_q16, f->core.u, f->core.size_lsb_uq8, f->core.limit_lsb2,
            f->core.gain_uq16, f->core.flags, f->core.collected, f->again.run, f->again.first_lsb,
            f->again.broken \from *f, z_lsb;
    ensures PARAMETERS(&f->core) && ESTIMATE(&f->core) && GATE(f);
    ensures f->core.collected == 5;
    ensures WIDTH(f->core.u.p);
    ensures covariance: COVARIANCE(&f->core);
*/
static void take_part(soft_t *f, int16_t z_lsb);

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "reacquire.c"

#include "soft.c"

static void any_gate(soft_t *f)
{
    f->soft_sigma_q8 = ANY_U16(0, 4096);
    f->share_uq16 = ANY_U16(0, UINT16_MAX);
    any_run(&f->again);
}

static void gate_in(uint32_t from_lsb_uq8, uint32_t to_lsb_uq8, uint16_t gate_from_uq4, uint16_t gate_to_uq4)
{
    for (uint8_t coarse = 0; coarse < 2; coarse++) {
        two_state_t s;
        any_state_of(&s, R_ANY);
        s.u.p.p11_uq28 = ANY_U32(0, 0x7FFFFFFF);
        s.coarse = coarse != 0U;
        uint32_t scale = s.coarse ? 16 : 1;
        s.size_lsb_uq8 = ANY_U32(from_lsb_uq8 * scale, to_lsb_uq8 * scale + (scale - 1));
        s.gate_lsb2_uq4 = ANY_U16(gate_from_uq4, gate_to_uq4);
        (void)within_gate(&s);
    }
}

/* By powers of four of the size and of 16 of the gate. */
void proof_within_gate(void)
{
    uint16_t gate = 0;
    for (uint32_t above = 1; above <= 65536; above <<= 4) {
        gate_in(0, 0, gate, (uint16_t)(above - 1));
        gate_in(1, 63, gate, (uint16_t)(above - 1));
        gate_in(64, 255, gate, (uint16_t)(above - 1));
        gate_in(256, 1023, gate, (uint16_t)(above - 1));
        gate_in(1024, 4095, gate, (uint16_t)(above - 1));
        gate_in(4096, 65535, gate, (uint16_t)(above - 1));
        gate = (uint16_t)above;
    }
    two_state_t s;
    any_state_of(&s, R_ANY);
    s.u.p.p11_uq28 = ANY_U32(0, 0x7FFFFFFF);
    s.size_lsb_uq8 = ANY_U32(65536, 8704UL * 256);
    s.coarse = false;
    (void)within_gate(&s);
    s.coarse = true;
    s.size_lsb_uq8 = ANY_U32(1048576, 8704UL * 256);
    (void)within_gate(&s);
}

static void weight_in(uint8_t bit, bool coarse, uint16_t gate_end_uq4)
{
    two_state_t s;
    any_state(&s);
    uint32_t from = (uint32_t)1 << bit;
    s.size_lsb_uq8 = ANY_U32(from, (bit == 21) ? 8704UL * 256 : from + (from - 1));
    s.coarse = coarse;
    s.gate_lsb2_uq4 = ANY_U16(0, gate_end_uq4);
    (void)weight_uq20(&s);
}

/* Uses: fx_inverse_m_uq16. By powers of two of the size, fine and coarse. */
void proof_weight_uq20(void)
{
    static const uint16_t gate_end_uq4[] = { 0, 15, 255, 4095 };
    for (uint8_t bit = 0; bit < 22; bit++) {
        weight_in(bit, false, (bit < 6) ? 0 : (bit < 12) ? gate_end_uq4[(bit - 4) / 2] : UINT16_MAX);
        if (bit >= 4) {
            weight_in(bit, true, (bit < 10) ? 0 : (bit < 16) ? gate_end_uq4[(bit - 8) / 2] : UINT16_MAX);
        }
    }
}

void proof_limited_uq24(void)
{
    (void)limited_uq24(ANY_U32(0, 0xFFFFFF));
    (void)limited_uq24(ANY_U32(0x1000000, UINT32_MAX));
}

/*
 * Uses: weight_uq20, limited_uq24. By cells of the estimate.
 * Options: -eva-split-return-function reacquire_refused:full
 */
void proof_take_part(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit WIDTH(f.core.u.p);
    //@ admit REACH(&f.core);
    take_part(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

static void init_with(const soft_config_t *core, uint16_t soft_sigma_q8, uint16_t gate_sigma_q8,
                      uint16_t reacquire_samples, uint32_t rate_max)
{
    soft_t f;
    soft_config_t config = *core;
    config.soft_sigma_q8 = soft_sigma_q8;
    config.gate_sigma_q8 = gate_sigma_q8;
    config.reacquire_samples = reacquire_samples;
    config.rate_max_lsb_s = rate_max;
    (void)soft_init(&f, &config);
}

static void init_gates(const soft_config_t *core)
{
    uint16_t gate = ANY_U16(0, UINT16_MAX);
    uint16_t reacquire = ANY_U16(0, UINT16_MAX);
    uint32_t rate_max = ANY_U32(0, UINT32_MAX);
    init_with(core, ANY_U16(0, 4096), ANY_U16(0, 4096), ANY_U16(0, 9), ANY_U32(10, 1000000));
    init_with(core, ANY_U16(4097, UINT16_MAX), gate, reacquire, rate_max);
    init_with(core, gate, ANY_U16(4097, UINT16_MAX), reacquire, rate_max);
    init_with(core, gate, gate, ANY_U16(10, UINT16_MAX), rate_max);
    init_with(core, gate, gate, reacquire, ANY_U32(0, 9));
    init_with(core, gate, gate, reacquire, ANY_U32(1000001, UINT32_MAX));
}

static void init_core(uint16_t rate_dhz, uint32_t r_lsb2_q8, uint32_t q_lsb2_s3)
{
    soft_config_t core = { rate_dhz, r_lsb2_q8, q_lsb2_s3, 0, 0, 0, 0 };
    init_gates(&core);
}

/*
 * Uses: fx_normalise, rounded, two_state_set_noise, two_state_set_gate, fx_isqrt32. A box that holds all legal
 * configurations,
 * then all with one parameter below or above it.
 */
void proof_soft_init(void)
{
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    uint32_t q_lsb2_s3 = ANY_U32(0, UINT32_MAX);
    init_core(ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000));
    init_core(ANY_U16(0, 49), r_lsb2_q8, q_lsb2_s3);
    init_core(ANY_U16(40001, UINT16_MAX), r_lsb2_q8, q_lsb2_s3);
    init_core(rate_dhz, ANY_U32(0, 2), q_lsb2_s3);
    init_core(rate_dhz, ANY_U32(256001, UINT32_MAX), q_lsb2_s3);
    init_core(rate_dhz, r_lsb2_q8, 0);
    init_core(rate_dhz, r_lsb2_q8, ANY_U32(1000000001, UINT32_MAX));
    soft_config_t config;
    soft_defaults(&config, ANY_U16(50, 40000));
}

/* Uses: two_state_set_noise, two_state_set_gate, fx_isqrt32 */
void proof_soft_set_noise(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    soft_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_start(&f.core);
    soft_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

/* Uses: two_state_reset */
void proof_soft_reset(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    soft_reset(&f, ANY_Z());
    any_start(&f.core);
    soft_reset(&f, ANY_Z());
}

/* Uses: two_state_step */
void proof_soft_reset_step(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)soft_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_start(&f.core);
    (void)soft_reset_step(&f, ANY_Z(), 0);
}

/* Uses: two_state_step, take_part */
void proof_soft_update(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)soft_update(&f, ANY_Z());
    any_gate(&f);
    any_start(&f.core);
    f.core.collected = ANY_U8(0, FILTER_WARM_UP_SAMPLES - 2);
    (void)soft_update(&f, ANY_Z());
    any_start(&f.core);
    f.core.collected = FILTER_WARM_UP_SAMPLES - 1;
    (void)soft_update(&f, ANY_Z());
}

/* Uses: two_state_step. Options: -eva-split-return-function two_state_coast:full */
void proof_soft_coast(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    (void)soft_coast(&f);
    any_start(&f.core);
    (void)soft_coast(&f);
    filter_probe_t probe;
    soft_probe(&f, &probe);
    (void)soft_flags(&f);
}

/* What is told of missing samples, of states as those of a coast. */
void proof_soft_gap(void)
{
    soft_t f;
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    soft_damp(&f);
    any_start(&f.core);
    soft_damp(&f);
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    soft_gap(&f);
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    soft_hold(&f);
    any_start(&f.core);
    soft_gap(&f);
    any_start(&f.core);
    soft_hold(&f);
    any_gate(&f);
    any_state(&f.core);
    //@ admit COVARIANCE(&f.core);
    soft_restart(&f);
    any_start(&f.core);
    soft_restart(&f);
}
