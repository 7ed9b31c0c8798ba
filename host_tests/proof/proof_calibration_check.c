/* What of a calibration is not legal is refused, whatever the rest of it. */
#define TAKEN(c) (0 == 0)
#include "calibration_bounds.h"

#include "fx.c"

#include "calibration.c"

/* One thing out of its range, whatever the rest: refused. */
void proof_calibration_check(void)
{
    calibration_t c;
    any_calibration(&c);
    (void)calibration_check(&c);
    for (uint8_t i = 0; i < 3U; i++) {
        any_calibration(&c);
        c.offset_lsb_q4[i] = ANY_S16(S16_MIN, -1281);
        calibration_verdict_t least = calibration_check(&c);
        c.offset_lsb_q4[i] = ANY_S16(1281, 32767);
        calibration_verdict_t most = calibration_check(&c);
        //@ check offset: least.why != 0 && most.why != 0;
        any_calibration(&c);
        c.scale_lsb_per_g_uq6[i] = ANY_U16(0, 12799);
        least = calibration_check(&c);
        c.scale_lsb_per_g_uq6[i] = ANY_U16(21121, UINT16_MAX);
        most = calibration_check(&c);
        //@ check scale: least.why != 0 && most.why != 0;
        any_calibration(&c);
        c.axes[i] = 0;
        calibration_verdict_t none = calibration_check(&c);
        c.axes[i] = ANY_S8(-128, -4);
        least = calibration_check(&c);
        c.axes[i] = ANY_S8(4, 127);
        most = calibration_check(&c);
        //@ check named: none.why != 0 && least.why != 0 && most.why != 0;
    }
}

/*
 * Each axis has to be named once. A level too short or too long, in whichever component, is refused.
 * Whole: calibration_check, length_square_q28, calibration_square
 */
void proof_calibration_named(void)
{
    calibration_t c;
    calibration_plain(&c, 16384, 16384);
    //@ loop unroll 216;
    for (uint8_t k = 0; k < 216U; k++) {
        c.axes[0] = (int8_t)(k % 6U) - 3;
        c.axes[1] = (int8_t)(k / 6U % 6U) - 3;
        c.axes[2] = (int8_t)(k / 36U) - 3;
        for (uint8_t i = 0; i < 3U; i++) {
            c.axes[i] = (int8_t)(c.axes[i] + (c.axes[i] >= 0 ? 1 : 0));
        }
        uint8_t x = calibration_named(c.axes[0]);
        uint8_t y = calibration_named(c.axes[1]);
        uint8_t z = calibration_named(c.axes[2]);
        calibration_verdict_t verdict = calibration_check(&c);
        //@ check once: (verdict.why == 0) == (x != y && y != z && x != z);
    }
    calibration_plain(&c, 16384, 16384);
    for (uint8_t i = 0; i < 3U; i++) {
        c.level_q14[i] = ANY_S16(0, 8040);
    }
    calibration_verdict_t faint = calibration_check(&c);
    //@ check faint: faint.why != 0;
    for (uint8_t i = 0; i < 3U; i++) {
        for (uint8_t k = 0; k < 3U; k++) {
            c.level_q14[k] = ANY_BOOL() ? ANY_S16(S16_MIN, -1) : ANY_S16(0, 32767);
        }
        c.level_q14[i] = ANY_S16(LEVEL_END + 1, 32767);
        calibration_verdict_t most = calibration_check(&c);
        c.level_q14[i] = ANY_S16(S16_MIN, -LEVEL_END - 1);
        calibration_verdict_t least = calibration_check(&c);
        //@ check strong: least.why != 0 && most.why != 0;
    }
}
