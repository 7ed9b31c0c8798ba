/* What the Kalman laws share: any state within its bounds, any sample. */
#define KEPT PARAMETERS
#define R_MOST R_ANY
#include "kalman_bounds.h"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
}

static void grow_from(uint32_t p11_from, uint32_t p11_to, uint32_t p12_from, uint32_t p12_to, uint32_t p22_from,
                      uint32_t p22_to)
{
    filter_kalman_t k;
    k.q22_uq26 = ANY_U32(4, Q22_MOST);
    k.p.p11 = ANY_U32(p11_from, p11_to);
    k.p.p12 = ANY_U32(p12_from, p12_to);
    k.p.p22 = ANY_U32(p22_from, p22_to);
    grow(&k);
}

/* P that is predicted, by whole numbers of P11, then P that is not, for P11, for P12, for P22. */
void proof_grow(void)
{
    for (uint8_t whole = 0; whole < 4; whole++) {
        grow_from((uint32_t)whole << 24, ((uint32_t)whole << 24) + 0xFFFFFF, 0, 0x3FFFFFFF, 0, 0x3FFFFFFF);
    }
    grow_from(0x4000000, 0x33FFFFFF, 0, 0x7FFFFFFF, 0, 0x77FFFFFF);
    grow_from(0, 0x33FFFFFF, 0x40000000, 0x7FFFFFFF, 0, 0x77FFFFFF);
    grow_from(0, 0x33FFFFFF, 0, 0x7FFFFFFF, 0x40000000, 0x77FFFFFF);
}

void proof_kalman_limited_uq24(void)
{
    (void)kalman_limited_uq24(ANY_U32(0, 0xFFFFFF));
    (void)kalman_limited_uq24(ANY_U32(0x1000000, UINT32_MAX));
}

void proof_variance_uq10(void)
{
    filter_kalman_t k;
    k.p.p11 = ANY_U32(0, 0x33FFFFFF);
    (void)variance_uq10(&k);
}

static void gate_in(uint32_t from_lsb_uq8, uint32_t to_lsb_uq8, uint16_t gate_from_uq6, uint16_t gate_to_uq6)
{
    for (uint8_t coarse = 0; coarse < 2; coarse++) {
        filter_t f;
        any_running(&f, NULL, 0);
        f.own.kalman.p.p11 = ANY_U32(0, 0x33FFFFFF);
        f.own.kalman.coarse = coarse != 0U;
        uint32_t scale = (coarse != 0U) ? 16 : 1;
        uint32_t from = (coarse != 0U && from_lsb_uq8 == 1U) ? 32U : from_lsb_uq8 * scale;
        uint32_t to = (coarse != 0U && to_lsb_uq8 == 0U) ? 31U : to_lsb_uq8 * scale + (scale - 1U);
        f.size_lsb_uq16 = ANY_U32(from * 256U, to * 256U + 255U);
        f.own.kalman.gate_lsb2_uq6 = ANY_U16(gate_from_uq6, gate_to_uq6);
        (void)within_gate(&f);
    }
}

/* By powers of four of the size and of 16 of the gate. */
void proof_within_gate(void)
{
    uint16_t gate = 0;
    for (uint32_t above = 1; above <= 65536; above <<= 4) {
        gate_in(0, 0, gate, (uint16_t)(above - 1));
        gate_in(1, 31, gate, (uint16_t)(above - 1));
        gate_in(32, 127, gate, (uint16_t)(above - 1));
        gate_in(128, 511, gate, (uint16_t)(above - 1));
        gate_in(512, 2047, gate, (uint16_t)(above - 1));
        gate_in(2048, 65535, gate, (uint16_t)(above - 1));
        gate = (uint16_t)above;
    }
    filter_t f;
    any_running(&f, NULL, 0);
    f.own.kalman.p.p11 = ANY_U32(0, 0x33FFFFFF);
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
    (void)filter_kalman_step(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), ANY_U8(0, 2));
}

void proof_filter_kalman_refused(void)
{
    EACH_KIND(kind)
    {
        filter_t f;
        any_running(&f, NULL, kind);
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

void proof_set_gate(void)
{
    filter_t f;
    any_running(&f, NULL, 0);
    f.own.kalman.r_lsb2_q8 = ANY_U32(R_LEAST, R_END);
    set_gate(&f, ANY_U16(0, 4096));
}

/* As the laws' own, with any gate. */
static void any_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kalman_set_variance(f, r_lsb2_q8);
    set_gate(f, ANY_U16(0, 4096));
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
