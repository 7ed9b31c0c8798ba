/* Sums over readings at rest; see rest.h. */
#include "rest.h"

#include "fx.h"

enum { FAR_LSB = 127, MEAN_UNITS = 16, BIAS_LSB = 128 };

/* Limit of the variance per 0.1 Hz, LSB^2 in Q8: 31 x 0.02 x 256 / 10; z: 1.7 times that. */
enum { VARIANCE_Q8 = 16, VARIANCE_Z_Q8 = 27 };

void rest_start(rest_t *rest)
{
    *rest = (rest_t){ 0 };
}

FX_NOINLINE bool is_far(int16_t value, int16_t limit)
{
    return value > limit || value < (int16_t)-limit;
}

/* One axis; false: too far away. */
static bool add(rest_axis_t *axis, int16_t lsb, bool first)
{
    if (first) {
        axis->first_lsb = lsb;
    }
    if (is_far(lsb, REST_LIMIT_LSB)) {
        return false;
    }
    int16_t off = (int16_t)(lsb - axis->first_lsb);
    if (is_far(off, FAR_LSB)) {
        return false;
    }
    uint8_t size = (uint8_t)(off < 0 ? -off : off);
    axis->sum += off;
    axis->sums += axis->sum;
    axis->squares += (uint16_t)((uint16_t)size * size);
    return true;
}

FX_ONCE void rest_add(rest_t *rest, const int16_t lsb[3])
{
    if (rest->moved || rest->samples == REST_SAMPLES_MAX) {
        return;
    }
    for (uint8_t axis = 0; axis < 3U; axis++) {
        if (!add(&rest->axes[axis], lsb[axis], rest->samples == 0U)) {
            rest->moved = true;
            return;
        }
    }
    rest->samples++;
}

/* sum / readings = (sum + 128 readings) / readings - 128: what is divided is not negative, so it rounds one way. */
FX_ONCE int16_t rest_mean_lsb_q4(const rest_t *rest, uint8_t axis)
{
    uint32_t samples = rest->samples;
    if (samples == 0U) {
        return 0;
    }
    const rest_axis_t *sums = &rest->axes[axis];
    uint32_t twice_q4 = (uint32_t)(sums->sum + (int32_t)samples * BIAS_LSB) * 2U * MEAN_UNITS;
    uint16_t above_q4 = (uint16_t)((twice_q4 + samples) / (2U * samples));
    return (int16_t)((int32_t)(sums->first_lsb - BIAS_LSB) * MEAN_UNITS + (int32_t)above_q4);
}

/* readings^2 x variance = readings x squares - sum^2 */
FX_ONCE uint32_t rest_variance_lsb2_q8(const rest_t *rest, uint8_t axis)
{
    uint16_t samples = rest->samples;
    if (samples == 0U) {
        return 0;
    }
    uint32_t sum = fx_abs32(rest->axes[axis].sum);
    uint32_t scaled = samples * rest->axes[axis].squares - sum * sum;
    return ((scaled / samples) * 256U + (samples >> 1)) / samples;
}

/*
 * The line of least squares through d_1..d_n rises over n readings by 12 T / n^2 with T = sum of (k - (n + 1) / 2) d_k
 * (n^2 for n^2 - 1); 2 T = (n + 1) sum - 2 sums. True: by at most 4 LSB, 3 |2 T| <= 2 n^2. |2 T| <= 127 n^2 / 2.
 */
static bool holds_level(const rest_axis_t *axis, uint16_t samples)
{
    uint32_t twice = fx_abs32((int32_t)(samples + 1U) * axis->sum - 2 * axis->sums);
    return 3U * twice <= 2U * fx_mul_u16(samples, samples);
}

FX_ONCE bool rest_still(const rest_t *rest, uint16_t rate_dhz)
{
    if (rest->moved || rest->samples < REST_SAMPLES_MIN) {
        return false;
    }
    for (uint8_t axis = 0; axis < 3U; axis++) {
        uint32_t limit_q8 = fx_mul_u16(rate_dhz, axis == 2U ? VARIANCE_Z_Q8 : VARIANCE_Q8);
        if (rest_variance_lsb2_q8(rest, axis) > limit_q8 || !holds_level(&rest->axes[axis], rest->samples)) {
            return false;
        }
    }
    return true;
}
