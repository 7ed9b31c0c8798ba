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

/* Changes a legal calibration by the means of a rest. */
typedef void change_t(calibration_t *c, const int16_t mean_lsb_q4[3]);

static void level(calibration_t *c, const int16_t mean_lsb_q4[3])
{
    for (uint8_t ours = 0; ours < 3U; ours++) {
        uint8_t theirs = calibration_named(c->axes[ours]);
        int16_t g_q14 = calibration_gravity_q14(c, theirs, mean_lsb_q4[theirs]);
        c->level_q14[ours] = (int16_t)(c->axes[ours] < 0 ? -g_q14 : g_q14);
    }
}

static void offsets(calibration_t *c, const int16_t mean_lsb_q4[3])
{
    uint8_t position = calibration_position(mean_lsb_q4);
    for (uint8_t i = 0; i < 3U; i++) {
        int16_t offset_q4 = mean_lsb_q4[i];
        if (i == position >> 1) {
            int16_t one_g_q4 = (int16_t)((c->scale_lsb_per_g_uq6[i] + 2U) >> 2);
            offset_q4 = (int16_t)((position & 1U) != 0U ? offset_q4 + one_g_q4 : offset_q4 - one_g_q4);
        }
        c->offset_lsb_q4[i] = offset_q4;
    }
}

/* *c is changed if the result is legal. */
static calibration_verdict_t change(calibration_t *c, const int16_t mean_lsb_q4[3], change_t *by)
{
    calibration_t found = *c;
    by(&found, mean_lsb_q4);
    return calibration_commit(c, &found);
}

calibration_verdict_t calibration_tare(calibration_t *c, const int16_t mean_lsb_q4[3])
{
    return change(c, mean_lsb_q4, level);
}

calibration_verdict_t calibration_single(calibration_t *c, const int16_t mean_lsb_q4[3])
{
    return change(c, mean_lsb_q4, offsets);
}
