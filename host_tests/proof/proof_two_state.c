/* The core of the two-state filters: any state within its bounds, any sample. */
#include "two_state_bounds.h"

#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

void proof_clamp_x(void)
{
    two_state_t s;
    s.flags = 0;
    for (int8_t cell = -18; cell < 18; cell++) {
        (void)clamp_x(&s, ANY_S32(33554432L * cell, 33554432L * cell + 33554431L));
    }
    (void)clamp_x(&s, 2L * X_MAX_Q16);
}

static void predict_in_cell(uint32_t p12_from_uq28, uint32_t p22_from_uq28)
{
    two_state_t s;
    s.q22_uq28 = ANY_U32(16, ONE);
    s.u.p.p11_uq28 = ANY_U32(0, 2 * ONE - 1);
    s.u.p.p12_uq28 = ANY_U32(p12_from_uq28, p12_from_uq28 + ONE / 8 - 1);
    s.u.p.p22_uq28 = ANY_U32(p22_from_uq28, p22_from_uq28 + ONE / 8 - 1);
    predict_covariance(&s);
}

/* All elements below 2 in cells of 1/8 of P12 and P22, then the states that are held. */
void proof_predict_covariance(void)
{
    for (uint8_t i = 0; i < 16; i++) {
        for (uint8_t j = 0; j < 16; j++) {
            predict_in_cell((uint32_t)i * (ONE / 8), (uint32_t)j * (ONE / 8));
        }
    }
    two_state_t s;
    any_state(&s);
    /*@ admit s.u.p.p11_uq28 >= 4 * ONE || s.u.p.p11_uq28 >= 2 * ONE || s.u.p.p12_uq28 >= 2 * ONE ||
              s.u.p.p22_uq28 >= 2 * ONE; */
    //@ admit HELD(s.u.p);
    predict_covariance(&s);
}

/* Uses: fx_reciprocal_uq16, clamp_x, predict_covariance */
void proof_two_state_step(void)
{
    two_state_t s;
    any_state_of(&s, R_ANY);
    //@ admit COVARIANCE(&s);
    (void)two_state_step(&s, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), ANY_BOOL());
}

/* Uses: two_state_step */
void proof_two_state_settle(void)
{
    two_state_t s;
    any_state_of(&s, R_ANY);
    s.x_lsb_q16 = ANY_S32(-X_START, X_START - 1);
    //@ admit COVARIANCE(&s);
    two_state_settle(&s);
}

/* Uses: two_state_settle */
void proof_two_state_reset(void)
{
    two_state_t s;
    any_state_of(&s, R_ANY);
    (void)two_state_reset(&s, ANY_Z());
}

/* Uses: two_state_step */
void proof_two_state_reset_step(void)
{
    two_state_t s;
    any_state_of(&s, R_ANY);
    //@ admit COVARIANCE(&s);
    (void)two_state_reset_step(&s, ANY_Z(), ANY_U8(0, UINT8_MAX));
}

/* Any state and covariance, limited. */
void proof_two_state_begin(void)
{
    two_state_t s;
    any_start_of(&s, R_ANY);
    two_state_begin(&s, ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX), ANY_U32(0, UINT32_MAX),
                    ANY_U32(0, UINT32_MAX), ANY_U32(0, UINT32_MAX));
}

/* Uses: fx_normalise, rounded */
void proof_two_state_set_noise(void)
{
    two_state_t s;
    any_state(&s);
    two_state_set_noise(&s, ANY_U32(0, UINT32_MAX));
}

/* Uses: fx_normalise, rounded */
void proof_two_state_set_variance(void)
{
    two_state_t s;
    any_state(&s);
    two_state_set_variance(&s, ANY_U32(R_LEAST, R_ANY));
}

/* Uses: fx_normalise, rounded */
void proof_two_state_set_gate(void)
{
    two_state_t s;
    any_state(&s);
    two_state_set_gate(&s, ANY_U16(0, 4096));
}

/* Uses: fx_normalise, rounded */
void proof_two_state_init(void)
{
    two_state_t s;
    two_state_init(&s, ANY_U16(50, 40000), ANY_U32(3, 256000), ANY_U32(1, 1000000000), ANY_U32(0, 1000000));
    //@ check PARAMETERS(&s) && ESTIMATE(&s) && MODE(&s) && s.r_lsb2_q8 <= R_END;
}

void proof_two_state_probe(void)
{
    two_state_t s;
    filter_probe_t probe;
    any_state_of(&s, R_ANY);
    two_state_probe(&s, &probe);
    any_start_of(&s, R_ANY);
    two_state_probe(&s, &probe);
}
