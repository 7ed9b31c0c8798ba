/* The calibration in force and from one rest: any int32, any calibration, a legal one where the header asks for it. */
#include "calibration_bounds.h"

#include "fx.c"

#include "calibration.c"
#include "calibration_find.c"

static void any_legal(calibration_t *c)
{
    for (uint8_t i = 0; i < 3U; i++) {
        c->offset_lsb_q4[i] = ANY_S16(-1280, 1280);
        c->scale_lsb_per_g_uq6[i] = ANY_U16(12800, 21120);
        c->axes[i] = ANY_BOOL() ? ANY_S8(-3, -1) : ANY_S8(1, 3);
        c->level_q14[i] = ANY_S16(-LEVEL_END, LEVEL_END);
    }
}

static void any_means(int16_t mean_lsb_q4[3])
{
    for (uint8_t i = 0; i < 3U; i++) {
        mean_lsb_q4[i] = ANY_S16(-MEAN_END, MEAN_END);
    }
}

void proof_calibration_plain(void)
{
    calibration_t c;
    calibration_plain(&c, ANY_U16(12800, 21120), ANY_U16(12800, 21120));
    //@ check legal: LEGAL(&c);
}

void proof_calibration_over(void)
{
    (void)calibration_over(ANY_S32(-65535, -1), ANY_U16(2, UINT16_MAX));
    (void)calibration_over(0, ANY_U16(2, UINT16_MAX));
    (void)calibration_over(ANY_S32(1, 65535), ANY_U16(2, UINT16_MAX));
    int32_t half_away = calibration_over(-1, 131);
    //@ check rounded: half_away == -500;
}

void proof_calibration_square(void)
{
    (void)calibration_square(ANY_S16(S16_MIN, -1));
    (void)calibration_square(ANY_S16(0, 32767));
}

void proof_length_square_q28(void)
{
    const int16_t v_q14[3] = { ANY_Z(), ANY_Z(), ANY_Z() };
    (void)length_square_q28(v_q14);
}

/* What row_times adds, in signed numbers that may not wrap. */
static int32_t exact_row(int32_t sum, const int32_t a_q8[3], const int16_t row_q14[3])
{
    for (uint8_t i = 0; i < 3U; i++) {
        sum += (int32_t)(int16_t)(a_q8[i] >> 8) * row_q14[i];
        sum += ((int32_t)(a_q8[i] & 0xFF) * row_q14[i]) >> 8;
    }
    return sum;
}

/*
 * Of 4608 LSB with what 80 LSB of offset make, any row: the exact sum, and four times it, fit 32 bits; then for any
 * bits of all. Options: -no-warn-signed-downcast
 */
void proof_row_times(void)
{
    int32_t a_q8[3];
    int16_t row_q14[3];
    for (uint8_t i = 0; i < 3U; i++) {
        a_q8[i] = ANY_S32(-20480, 20480);
        row_q14[i] = ANY_Z();
    }
    int32_t bias = exact_row(HALF_Q14, a_q8, row_q14);
    for (uint8_t i = 0; i < 3U; i++) {
        a_q8[i] = ANY_S32(-4608L * 256L, 4608L * 256L);
    }
    int32_t sum = exact_row(bias, a_q8, row_q14);
    //@ check fits: -536870912 <= sum <= 536870911;
    for (uint8_t i = 0; i < 3U; i++) {
        a_q8[i] = ANY_S32(S32_MIN, INT32_MAX);
    }
    (void)row_times(ANY_S32(S32_MIN, INT32_MAX), a_q8, row_q14);
}

/* Options: -no-warn-signed-downcast */
void proof_calibration_apply(void)
{
    calibration_applied_t applied;
    int32_t a_q8[3];
    int32_t out_q8[3];
    for (uint8_t i = 0; i < 9U; i++) {
        applied.matrix_q14[i] = ANY_Z();
    }
    for (uint8_t i = 0; i < 3U; i++) {
        applied.bias_lsb_q14[i] = ANY_S32(S32_MIN, INT32_MAX);
        a_q8[i] = ANY_S32(S32_MIN, INT32_MAX);
    }
    calibration_apply(&applied, a_q8, out_q8);
}

void proof_prepare_bias(void)
{
    calibration_applied_t applied;
    calibration_t c;
    any_legal(&c);
    for (uint8_t i = 0; i < 9U; i++) {
        applied.matrix_q14[i] = ANY_Z();
    }
    prepare_bias(&applied, &c);
}

/* Divisors in ranges, with every dividend that one of the range can have. Whole: calibration_over */
void proof_quotient_q14(void)
{
    for (uint32_t b = 12800; b <= UINT16_MAX; b += 512U) {
        int32_t last = (b + 511U < UINT16_MAX) ? (int32_t)b + 511 : UINT16_MAX;
        int32_t most = (last * 15) / 8;
        (void)quotient_q14(ANY_S32((most > 65533) ? -65533 : -most, -1), ANY_U16((uint16_t)b, (uint16_t)last));
        (void)quotient_q14(ANY_S32(0, (most > 65533) ? 65533 : most), ANY_U16((uint16_t)b, (uint16_t)last));
    }
}

void proof_prepare_column(void)
{
    for (uint8_t ours = 0; ours < 3U; ours++) {
        calibration_applied_t applied;
        calibration_t c;
        any_legal(&c);
        for (uint8_t i = 0; i < 9U; i++) {
            applied.matrix_q14[i] = ANY_Z();
        }
        const int32_t w_q14[3] = { ANY_Z(), ANY_Z(), ANY_S32(-16384, 49151) };
        prepare_column(&applied, &c, w_q14, ours);
    }
}

void proof_calibration_prepare(void)
{
    calibration_t c;
    calibration_applied_t applied;
    any_calibration(&c);
    (void)calibration_prepare(&applied, &c);
}

/* Beyond what a rest can show of legal offsets the difference wraps: 2 g still. Options: -no-warn-signed-downcast */
void proof_calibration_gravity_q14(void)
{
    calibration_t c;
    any_calibration(&c);
    for (uint8_t axis = 0; axis < 3U; axis++) {
        c.scale_lsb_per_g_uq6[axis] = ANY_U16(12000, SCALE_END);
        (void)calibration_gravity_q14(&c, axis, ANY_S16(-MEAN_END, MEAN_END));
    }
}

void proof_calibration_commit(void)
{
    calibration_t c;
    calibration_t found;
    any_legal(&c);
    any_calibration(&found);
    (void)calibration_commit(&c, &found);
}

void proof_calibration_tare(void)
{
    calibration_t c;
    int16_t mean_lsb_q4[3];
    any_legal(&c);
    any_means(mean_lsb_q4);
    (void)calibration_tare(&c, mean_lsb_q4);
}

void proof_calibration_position(void)
{
    int16_t mean_lsb_q4[3];
    any_means(mean_lsb_q4);
    (void)calibration_position(mean_lsb_q4);
    mean_lsb_q4[2] = ANY_S16(-MEAN_END, -4096);
    mean_lsb_q4[0] = ANY_S16(-4095, 4095);
    mean_lsb_q4[1] = ANY_S16(-4095, 4095);
    uint8_t down = calibration_position(mean_lsb_q4);
    //@ check down: down == 5;
}

/*
 * Sign by sign: 1 g is taken off the side on which the mean lies. Options: -eva-split-return-function
 * calibration_position:full
 */
void proof_calibration_single(void)
{
    for (uint8_t signs = 0; signs < 8U; signs++) {
        calibration_t c;
        int16_t mean_lsb_q4[3];
        any_legal(&c);
        for (uint8_t i = 0; i < 3U; i++) {
            mean_lsb_q4[i] = ((signs >> i) & 1U) != 0U ? ANY_S16(-MEAN_END, -1) : ANY_S16(0, MEAN_END);
        }
        (void)calibration_single(&c, mean_lsb_q4);
    }
}
