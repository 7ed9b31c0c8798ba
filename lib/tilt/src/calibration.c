/*
 * Calibration in force: its numbers are turned into a matrix once, which is then applied to vectors; see calibration.h.
 */
#include "calibration.h"

#include "calibration_inside.h"
#include "fx.h"
#include "fx_dot.h"

enum { HALF_Q14 = 32 }; /* half a unit of Q8 */

void calibration_plain(calibration_t *c, uint16_t scale_xy_uq6, uint16_t scale_z_uq6)
{
    *c = (calibration_t){ .scale_lsb_per_g_uq6 = { scale_xy_uq6, scale_xy_uq6, scale_z_uq6 },
                          .axes = { 1, 2, 3 },
                          .level_q14 = { 0, 0, CALIBRATION_ONE_Q14 } };
}

MACHINE_APART int32_t calibration_over(int32_t a, uint16_t b)
{
    uint32_t size = ((filter_fx_abs32(a) << 16) + (b >> 1)) / b;
    return (a < 0) ? -(int32_t)size : (int32_t)size;
}

MACHINE_APART uint32_t calibration_square(int16_t a)
{
    return (uint32_t)((int32_t)a * a);
}

static uint32_t length_square_q28(const int16_t v_q14[3])
{
    return calibration_square(v_q14[0]) + calibration_square(v_q14[1]) + calibration_square(v_q14[2]);
}

calibration_verdict_t calibration_check(const calibration_t *c)
{
    uint8_t seen = 0;
    for (uint8_t i = 0; i < 3U; i++) {
        uint16_t offset = (uint16_t)((uint16_t)c->offset_lsb_q4[i] + CALIBRATION_OFFSET_MAX_LSB_Q4);
        if (offset > 2U * CALIBRATION_OFFSET_MAX_LSB_Q4) {
            return calibration_verdict(CALIBRATION_OFFSET, i);
        }
        uint16_t scale = (uint16_t)(c->scale_lsb_per_g_uq6[i] - CALIBRATION_SCALE_MIN_UQ6);
        if (scale > CALIBRATION_SCALE_MAX_UQ6 - CALIBRATION_SCALE_MIN_UQ6) {
            return calibration_verdict(CALIBRATION_SCALE, i);
        }
        uint8_t axis = calibration_named(c->axes[i]);
        seen = (uint8_t)(seen | (axis > 2U ? 8U : 1U << axis));
    }
    uint32_t level_q28 = length_square_q28(c->level_q14) - CALIBRATION_LEVEL_MIN_Q28;
    if (level_q28 > CALIBRATION_LEVEL_MAX_Q28 - CALIBRATION_LEVEL_MIN_Q28) {
        return calibration_verdict(CALIBRATION_NO_GRAVITY, 0);
    }
    return calibration_verdict(seen == 7U ? CALIBRATION_GOOD : CALIBRATION_AXES, 0);
}

static int32_t row_times(int32_t sum_q14, const int32_t a_q8[3], const int16_t row_q14[3])
{
    return fx_dot24(sum_q14, a_q8, row_q14);
}

/* a / b, Q14. */
static MACHINE_APART int16_t quotient_q14(int32_t a, uint16_t b)
{
    return (int16_t)((calibration_over(a, b) + 2) >> 2);
}

/* Effect of the offsets on all axes, through the whole matrix. */
static void prepare_bias(calibration_applied_t *applied, const calibration_t *c)
{
    int32_t away_q8[3];
    for (uint8_t i = 0; i < 3U; i++) {
        away_q8[i] = (int32_t)c->offset_lsb_q4[i] * -16;
    }
    for (uint8_t i = 0; i < 3U; i++) {
        applied->bias_lsb_q14[i] = row_times(HALF_Q14, away_q8, &applied->matrix_q14[3U * i]);
    }
}

/*
 * The mounting rotation is s_i (w_i w_j / (1 + z) - d_ij) with w = u + (0, 0, 1), s = (-1, -1, 1), d_ij = 1 for i = j,
 * else 0: the matrix of calibration.h, one rule for all elements. Upside down it is that of (x, -y, -z), with the
 * columns of y and z reversed.
 */
static void prepare_column(calibration_applied_t *applied, const calibration_t *c, const int32_t w_q14[3], uint8_t ours)
{
    uint8_t theirs = calibration_named(c->axes[ours]);
    int16_t share_q14 = quotient_q14(w_q14[ours], (uint16_t)w_q14[2]);
    bool reversed = (c->axes[ours] < 0) != (c->level_q14[2] < 0 && ours != 0U);
    for (uint8_t i = 0; i < 3U; i++) {
        int32_t m_q14 = (w_q14[i] * share_q14 + 8192) >> 14;
        if (i == ours) {
            m_q14 -= CALIBRATION_ONE_Q14;
        }
        m_q14 = (reversed == (i == 2U)) ? -m_q14 : m_q14;
        applied->matrix_q14[3U * i + theirs] = quotient_q14(m_q14, c->scale_lsb_per_g_uq6[theirs]);
    }
}

MACHINE_APART calibration_verdict_t calibration_prepare(calibration_applied_t *applied, const calibration_t *c)
{
    calibration_verdict_t verdict = calibration_check(c);
    if (verdict.why != (uint8_t)CALIBRATION_GOOD) {
        return verdict;
    }
    uint16_t length_q14 = filter_fx_isqrt32(length_square_q28(c->level_q14));
    bool down = c->level_q14[2] < 0;
    int32_t w_q14[3];
    for (uint8_t i = 0; i < 3U; i++) {
        int16_t level_q14 = c->level_q14[i];
        w_q14[i] = quotient_q14((down && i != 0U) ? -level_q14 : level_q14, length_q14);
    }
    w_q14[2] += CALIBRATION_ONE_Q14;
    for (uint8_t ours = 0; ours < 3U; ours++) {
        prepare_column(applied, c, w_q14, ours);
    }
    prepare_bias(applied, c);
    return verdict;
}

/* Q14 to Q8 as times four, less a byte: cheaper on an 8-bit machine than a shift by six. */
void calibration_apply(const calibration_applied_t *applied, const int32_t a_q8[3], int32_t out_q8[3])
{
    const int16_t *row_q14 = applied->matrix_q14;
    for (uint8_t i = 0; i < 3U; i++) {
        uint32_t sum_q14 = (uint32_t)row_times(applied->bias_lsb_q14[i], a_q8, row_q14);
        row_q14 += 3;
        sum_q14 += sum_q14;
        MACHINE_FENCE(sum_q14); /* otherwise the compiler makes a loop of the two */
        sum_q14 += sum_q14;
        out_q8[i] = (int32_t)sum_q14 >> 8;
    }
}
