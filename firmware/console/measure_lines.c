/* The numbers and verdicts of measurements; the texts around them are in reply_texts.h. */
#include "console/measure_lines.h"

#include "console/reply_texts.h"
#include "control/measure.h"
#include "settings/settings.h"
#include "tilt.h"

/*
 * At 3.3 V: 50..540 LSB (x; y with the opposite sign) and 75..875 LSB (z) at 2.5 V, times 1.77 and 1.47 (data sheet p.
 * 31, tables 14 and 15), are 88.5..955.8 and 110.25..1286.25 LSB.
 */
enum { LEAST_XY_Q4 = 1416, GREATEST_XY_Q4 = 15293, LEAST_Z_Q4 = 1764, GREATEST_Z_Q4 = 20580 };

/* Against y the force acts the other way. */
int16_t measure_shift_q4(uint8_t axis)
{
    int16_t lsb_q4 = measure_result_lsb_q4(axis);
    return axis == 1 ? (int16_t)-lsb_q4 : lsb_q4;
}

/* Too large a shift is "not necessarily a failure" (p. 22). */
uint8_t measure_verdict(uint8_t axis)
{
    int16_t shift = measure_shift_q4(axis);
    int16_t least = LEAST_XY_Q4;
    int16_t greatest = GREATEST_XY_Q4;
    if (axis == 2) {
        least = LEAST_Z_Q4;
        greatest = GREATEST_Z_Q4;
    }
    if (shift < least) {
        return VERDICT_FAIL;
    }
    return shift > greatest ? VERDICT_HIGH : VERDICT_PASS;
}

/*
 * The rms in Q8 of a variance V in Q8, below 2^22, is the integer root of 256 V; R is what the filters make of it
 * (noise.h), 1.5 V. A rate in 0.01 Hz, below 2^17, times 10 / rate_dhz is its percentage of the nominal one.
 */
int32_t measure_number_q8(uint8_t what, uint8_t axis)
{
    if (what == SAY_OFF) {
        return (int32_t)(adxl345_rate_chz() * 2560u / settings()->rate_dhz) - 25600;
    }
    uint32_t variance_q8 = rest_variance_lsb2_q8(&measure_rest()->axes[axis]);
    return what == SAY_RMS ? (int32_t)tilt_isqrt32(variance_q8 << 8) : (int32_t)(variance_q8 + (variance_q8 >> 1));
}
