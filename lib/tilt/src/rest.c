/* Sums over readings at rest; see rest.h. */
#include "rest.h"

#include "machine.h"

enum { AXES = 3, HALF = REST_SAMPLES / 2U };

/* Limit for the difference of the second half's sum from the first's: 2 LSB for each of its readings. */
enum { DRIFT_LSB = 2 * HALF };

void rest_start(rest_t *rest)
{
    *rest = (rest_t){ 0 };
}

MACHINE_APART bool rest_add(rest_t *rest, const int16_t lsb[3])
{
    uint8_t before = rest->samples++;
    for (rest_axis_t *axis = rest->axes; axis != rest->axes + AXES; axis++) {
        int16_t value = *lsb++;
        if (before == 0) {
            axis->first_lsb = value;
            if ((uint16_t)((uint16_t)value + REST_LIMIT_LSB) > 2U * REST_LIMIT_LSB) {
                rest->moved = true;
            }
        }
        uint16_t off = (uint16_t)((uint16_t)value - (uint16_t)axis->first_lsb);
        int8_t near = (int8_t)off;
        if ((uint16_t)(off + 128U) > 255U) {
            rest->moved = true;
        }
        axis->sum_lsb = (int16_t)(axis->sum_lsb + near);
        if (before == HALF - 1U) {
            axis->half_lsb = axis->sum_lsb;
        }
        uint16_t square_lsb2 = (uint16_t)((int32_t)near * near);
        axis->squares_lsb2 += square_lsb2;
    }
    return rest->moved || rest->samples == 0;
}

int16_t rest_mean_lsb_q4(const rest_axis_t *axis)
{
    return (int16_t)((int32_t)axis->first_lsb * 16 + ((axis->sum_lsb + 8) >> 4));
}

/* 256 x variance = squares - sum^2 / 256 */
MACHINE_APART uint32_t rest_variance_lsb2_q8(const rest_axis_t *axis)
{
    return axis->squares_lsb2 - ((uint32_t)((int32_t)axis->sum_lsb * axis->sum_lsb) >> 8);
}

bool rest_still(const rest_t *rest, uint16_t rate_dhz)
{
    bool still = !rest->moved;
    for (const rest_axis_t *axis = rest->axes; axis != rest->axes + AXES; axis++) {
        uint16_t drift_lsb = (uint16_t)((uint16_t)axis->sum_lsb - 2U * (uint16_t)axis->half_lsb);
        uint16_t variance_lsb2 = (uint16_t)(rest_variance_lsb2_q8(axis) >> 8);
        if ((uint16_t)(drift_lsb + DRIFT_LSB) > 2U * DRIFT_LSB ||
            variance_lsb2 >= rate_dhz >> 3) { /* 0.2 x 62.5 / 100 */
            still = false;
        }
    }
    return still;
}
