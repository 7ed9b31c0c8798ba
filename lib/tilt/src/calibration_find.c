/* Calibration from a single rest: level, or the offsets. */
#include "calibration.h"
#include "calibration_inside.h"
#include "fx.h"

MACHINE_APART int16_t calibration_gravity_q14(const calibration_t *c, uint8_t axis, int16_t lsb_q4)
{
    int16_t off_q4 = (int16_t)((uint16_t)lsb_q4 - (uint16_t)c->offset_lsb_q4[axis]);
    return (int16_t)fx_clamp(calibration_over(off_q4, c->scale_lsb_per_g_uq6[axis]), INT16_MAX);
}

calibration_verdict_t calibration_commit(calibration_t *c, const calibration_t *found)
{
    calibration_verdict_t verdict = calibration_check(found);
    if (verdict.why == (uint8_t)CALIBRATION_GOOD) {
        *c = *found;
    }
    return verdict;
}

MACHINE_APART calibration_verdict_t calibration_tare(calibration_t *c, const int16_t mean_lsb_q4[3])
{
    calibration_t found = *c;
    for (uint8_t ours = 0; ours < 3U; ours++) {
        uint8_t theirs = calibration_named(c->axes[ours]);
        int16_t g_q14 = calibration_gravity_q14(c, theirs, mean_lsb_q4[theirs]);
        found.level_q14[ours] = (int16_t)(c->axes[ours] < 0 ? -g_q14 : g_q14);
    }
    return calibration_commit(c, &found);
}

uint8_t calibration_position(const int16_t mean_lsb_q4[3])
{
    uint8_t position = 0;
    uint16_t largest = 0;
    for (uint8_t i = 0; i < 3U; i++) {
        int16_t mean = mean_lsb_q4[i];
        uint16_t size = (uint16_t)(mean < 0 ? -mean : mean);
        if (size > largest) {
            largest = size;
            position = (uint8_t)(2U * i + (mean < 0 ? 1U : 0U));
        }
    }
    return position;
}

MACHINE_APART calibration_verdict_t calibration_single(calibration_t *c, const int16_t mean_lsb_q4[3])
{
    calibration_t found = *c;
    uint8_t position = calibration_position(mean_lsb_q4);
    uint8_t axis = position >> 1;
    for (uint8_t i = 0; i < 3U; i++) {
        found.offset_lsb_q4[i] = mean_lsb_q4[i];
    }
    int16_t one_g_q4 = (int16_t)((found.scale_lsb_per_g_uq6[axis] + 2U) >> 2);
    found.offset_lsb_q4[axis] = (int16_t)(found.offset_lsb_q4[axis] +
                                          ((position & 1U) != 0U ? one_g_q4 : (int16_t)-one_g_q4));
    return calibration_commit(c, &found);
}
