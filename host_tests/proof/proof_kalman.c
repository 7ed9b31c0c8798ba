/* What the Kalman laws share: any state within its bounds, any sample. */
#define KEPT PARAMETERS
#define R_MOST R_ANY
#include "kalman_bounds.h"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
}

static void grow_in_cell(uint32_t p12_from_uq28, uint32_t p22_from_uq28)
{
    filter_kalman_t k;
    k.q22_uq28 = ANY_U32(16, ONE);
    k.p.p11 = ANY_U32(0, 2 * ONE - 1);
    k.p.p12 = ANY_U32(p12_from_uq28, p12_from_uq28 + ONE / 8 - 1);
    k.p.p22 = ANY_U32(p22_from_uq28, p22_from_uq28 + ONE / 8 - 1);
    grow(&k);
}

/* All elements below 2 in cells of 1/8 of P12 and P22, then the states that are held. */
void proof_grow(void)
{
    for (uint8_t i = 0; i < 16; i++) {
        for (uint8_t j = 0; j < 16; j++) {
            grow_in_cell((uint32_t)i * (ONE / 8), (uint32_t)j * (ONE / 8));
        }
    }
    filter_t f;
    any_kalman(&f, 0);
    /*@ admit f.own.kalman.p.p11 >= 4 * ONE || f.own.kalman.p.p11 >= 2 * ONE || f.own.kalman.p.p12 >= 2 * ONE ||
              f.own.kalman.p.p22 >= 2 * ONE; */
    //@ admit HELD(f.own.kalman.p);
    grow(&f.own.kalman);
}

static void gate_in(uint32_t from_lsb_uq8, uint32_t to_lsb_uq8, uint16_t gate_from_uq4, uint16_t gate_to_uq4)
{
    for (uint8_t coarse = 0; coarse < 2; coarse++) {
        filter_t f;
        any_running(&f, NULL, 0);
        f.own.kalman.p.p11 = ANY_U32(0, 0x7FFFFFFF);
        f.own.kalman.coarse = coarse != 0U;
        uint32_t scale = (coarse != 0U) ? 16 : 1;
        f.size_lsb_uq16 = ANY_U32(from_lsb_uq8 * scale * 256U, (to_lsb_uq8 * scale + (scale - 1)) * 256U + 255U);
        f.own.kalman.gate_lsb2_uq4 = ANY_U16(gate_from_uq4, gate_to_uq4);
        (void)within_gate(&f);
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
    filter_t f;
    any_running(&f, NULL, 0);
    f.own.kalman.p.p11 = ANY_U32(0, 0x7FFFFFFF);
    f.size_lsb_uq16 = ANY_U32(65536UL * 256, SIZE_END);
    f.own.kalman.coarse = false;
    (void)within_gate(&f);
    f.own.kalman.coarse = true;
    f.size_lsb_uq16 = ANY_U32(1048576UL * 256, SIZE_END);
    (void)within_gate(&f);
}

void proof_filter_kalman_step(void)
{
    filter_t f;
    any_running(&f, NULL, 1);
    //@ admit COVARIANCE(&f);
    (void)filter_kalman_step(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), ANY_U8(0, 2));
}

void proof_filter_kalman_refused(void)
{
    EACH_KIND(kind)
    {
        filter_t f;
        any_running(&f, NULL, kind);
        //@ admit HELD(f.own.kalman.p);
        (void)filter_kalman_refused(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

void proof_filter_kalman_set_variance(void)
{
    filter_t f;
    any_running(&f, NULL, 0);
    filter_kalman_set_variance(&f, ANY_U32(R_LEAST, R_END));
    filter_kalman_set_variance(&f, ANY_U32(R_END + 1, R_ANY));
}

void proof_filter_kalman_set_gate(void)
{
    filter_t f;
    any_running(&f, NULL, 0);
    f.own.kalman.r_lsb2_q8 = ANY_U32(R_LEAST, R_END);
    filter_kalman_set_gate(&f, ANY_U16(0, 4096));
}

/* As the laws' own, with any gate. */
static void any_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kalman_set_variance(f, r_lsb2_q8);
    filter_kalman_set_gate(f, ANY_U16(0, 4096));
}

/* Without a limit of the rate, and with one. */
void proof_filter_kalman_set_up(void)
{
    static const filter_law_t law = { .set_noise = any_noise };
    for (uint8_t limited = 0; limited < 2U; limited++) {
        filter_t f;
        any_running(&f, &law, 0);
        filter_config_t config = { ANY_U16(50, 40000), { ANY_S32(3, R_END), ANY_S32(1, 1000000000) } };
        filter_kalman_set_up(&f, &config, (limited != 0U) ? ANY_U32(1, 1000000) : 0);
    }
}
