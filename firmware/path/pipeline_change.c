/* The filters of the axes: chosen, begun, changed, told the sensor's true rate. */
#include "fx.h"
#include "path/pipeline_state.h"
#include "settings/parameters.h"

enum { CALLS_OFF = 5, STILL_LSB_Q2 = 18 }; /* pipeline_retime; 1 degree */

/*
 * Filters that go on from an output are changed one with each sample, so that a row waits for one of them: a Kalman
 * filter takes up to 2.4 ms to settle. Else, and where the noise is not known either, all at once: no sample comes
 * meanwhile.
 */
FX_ONCE void begin_all(bool cold)
{
    pipeline.cold = cold;
    pipeline.turn = false;
    pipeline.to_begin = AXES;
}

FX_ONCE void pipeline_retime(uint32_t period_us)
{
    bool still = true;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        uint16_t now_lsb_q2 = (uint16_t)(tilt_axis_estimate_q8(&pipeline.axes[axis]) >> 6);
        still = (uint16_t)(now_lsb_q2 - pipeline.looked_lsb_q2[axis] + STILL_LSB_Q2) <= 2u * STILL_LSB_Q2 && still;
        pipeline.looked_lsb_q2[axis] = now_lsb_q2;
    }
    uint16_t true_dhz = (uint16_t)(UINT32_C(10000000) / period_us);
    uint16_t near_dhz = (pipeline.true_dhz >> 7) + 1u;
    if ((uint16_t)(true_dhz - pipeline.true_dhz + near_dhz) <= (uint16_t)(2u * near_dhz)) {
        pipeline.calls_off = 0;
    } else if (pipeline.calls_off < CALLS_OFF) {
        pipeline.calls_off++;
    } else if (still) {
        pipeline.true_dhz = true_dhz;
        begin_all(false);
    }
}

/* The filter goes on from the old one's estimate, where there is one, or warms up. */
FX_NOINLINE void begin_axis(tilt_axis_t *axis)
{
    int16_t from_lsb = tilt_axis_estimate_lsb(axis);
    parameters_start(&axis->filter, (filter_kind_t)pipeline.new_kind, pipeline.true_dhz);
    filter_set_noise(&axis->filter, axis_r_lsb2_q8(axis));
    if (pipeline.has_sample) {
        filter_reset(&axis->filter, from_lsb);
    } else {
        axis->away = 0;
    }
}

FX_ONCE bool begin_next(void)
{
    uint8_t left = pipeline.to_begin;
    if (left == 0 || !(pipeline.turn || pipeline.cold)) {
        return false;
    }
    left--;
    pipeline.to_begin = left;
    pipeline.turn = false;
    tilt_axis_t *axis = &pipeline.axes[left];
    if (pipeline.cold) {
        filter_noise_init(&axis->noise, pipeline.rate_dhz, left == 2);
    }
    begin_axis(axis);
    return true;
}

/* The filters go on from the old output, where there is one, the noise estimates too unless the rate is new. */
void pipeline_change(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g)
{
    bool cold = !pipeline.has_sample || rate_dhz != pipeline.rate_dhz;
    if (cold) {
        pipeline.true_dhz = rate_dhz;
        pipeline.calls_off = 0;
    }
    pipeline.new_kind = filter_kind;
    pipeline.rate_dhz = rate_dhz;
    pipeline.warm_rows = WARM_ROWS;
    pipeline.rail_high_lsb = (int16_t)(range_g * 256U - 1U);
    begin_all(cold);
}

void pipeline_start(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g)
{
    pipeline.has_sample = false;
    pipeline.stuck = 0;
    pipeline_change(filter_kind, rate_dhz, range_g);
}
