/* The filters of the axes: chosen, begun, changed, told the sensor's true rate. */
#include "fx.h"
#include "parameters.h"
#include "pass.h"
#include "pipeline_state.h"

enum { CALLS_OFF = 5, STILL_LSB_Q2 = 18 }; /* pipeline_retime; 1 degree */

FX_NOINLINE void begin_work(work_t work, uint8_t axis)
{
    pipeline.work = (uint8_t)work;
    pipeline.axis = axis;
    pipeline.step = 0;
    pass.limit = PASS_CHANGING_US / HAL_LAP_US;
}

/*
 * Filters that go on from an output are changed one with each sample, so that a row waits for one of them: a Kalman
 * filter takes 6 ms to settle. Else, and where the noise is not known either, all at once: no sample comes meanwhile.
 */
static void change(bool new_noise)
{
    pipeline.new_noise = new_noise;
    pipeline.to_replace = 0;
    if (pipeline.has_sample && !new_noise) {
        pipeline.to_replace = AXES;
    } else {
        begin_work(WORK_CHANGE, 0);
    }
}

FX_ONCE void replace_axis(void)
{
    if (pipeline.to_replace != 0) {
        pipeline.new_noise = false;
        begin_work(WORK_REPLACE, --pipeline.to_replace);
    }
}

/* keep: the filters go on from the old output, the noise estimates too unless the rate is new. */
static void begin(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g, bool keep)
{
    bool cold = !keep || rate_dhz != pipeline.rate_dhz;
    if (cold) {
        pipeline.true_dhz = rate_dhz;
        pipeline.calls_off = 0;
    }
    pipeline.new_kind = filter_kind;
    pipeline.rate_dhz = rate_dhz;
    pipeline.has_sample = keep;
    pipeline.stuck = keep ? pipeline.stuck : 0;
    pipeline.warm_rows = WARM_ROWS;
    pipeline.rail_high_lsb = (int16_t)(range_g * 256U - 1U);
    change(cold);
}

FX_ONCE void pipeline_retime(uint32_t period_us)
{
    bool still = true;
    for (axis_t *axis = pipeline.axes; axis != pipeline.axes + AXES; axis++) {
        uint16_t now_lsb_q2 = (uint16_t)(axis->estimate_q8 >> 6);
        still = (uint16_t)(now_lsb_q2 - axis->looked_lsb_q2 + STILL_LSB_Q2) <= 2u * STILL_LSB_Q2 && still;
        axis->looked_lsb_q2 = now_lsb_q2;
    }
    uint16_t true_dhz = (uint16_t)(UINT32_C(10000000) / period_us);
    uint16_t near_dhz = (pipeline.true_dhz >> 7) + 1u;
    if ((uint16_t)(true_dhz - pipeline.true_dhz + near_dhz) <= (uint16_t)(2u * near_dhz)) {
        pipeline.calls_off = 0;
    } else if (pipeline.calls_off < CALLS_OFF) {
        pipeline.calls_off++;
    } else if (still) {
        pipeline.true_dhz = true_dhz;
        change(false);
    }
}

/* Initialised, then told its R, then settled where there is an output to go on from. True: that axis is done. */
FX_ONCE bool change_axis(void)
{
    enum { STEP_INIT, STEP_NOISE, STEP_RESET };
    axis_t *axis = axis_now();
    uint8_t step = pipeline.step++;
    if (step == STEP_INIT) {
        if (pipeline.new_noise) {
            noise_init(&axis->noise, pipeline.rate_dhz, pipeline.axis == 2);
        }
        parameters_start(&axis->filter, (filter_kind_t)pipeline.new_kind, pipeline.true_dhz);
        return false;
    }
    if (step == STEP_NOISE) {
        filter_set_noise(&axis->filter, axis_r_lsb2_q8(axis));
        if (pipeline.has_sample) {
            return false;
        }
        axis->away = 0;
        return true;
    }
    return !filter_reset_step(&axis->filter, estimate_lsb(axis), (uint8_t)(step - STEP_RESET));
}

FX_ONCE void change_step(void)
{
    if (!change_axis()) {
        return;
    }
    pipeline.step = 0;
    if (pipeline.work == WORK_REPLACE) {
        pipeline.work = WORK_SAMPLE;
        pipeline.axis = 0;
    } else if (++pipeline.axis == AXES) {
        pipeline.work = WORK_NONE;
    } else {
        return;
    }
    pass.limit = PASS_US / HAL_LAP_US;
}

void pipeline_start(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g)
{
    begin(filter_kind, rate_dhz, range_g, false);
}

void pipeline_change(uint8_t filter_kind, uint16_t rate_dhz, uint8_t range_g)
{
    begin(filter_kind, rate_dhz, range_g, pipeline.has_sample);
}
