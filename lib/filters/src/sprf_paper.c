/*
 * sprf_paper: the binary-gated filter of paper 002, (34), as published: it LOCKS OUT. Included for comparison; use
 * sprf.
 *
 * A sample further from the prediction than gate x sigma (of the innovation; 2 as published, with Xi read as an RMS) is
 * refused: predict only. There is no re-acquisition and no robust start. The first sample is always used (x = z, P11 =
 * R: what an update from an unbounded P(0) leaves). An outlier there makes every good sample after it an outlier, and
 * so does a step, until P has grown to it: a step of n sigma waits for P11 = n^2 / 4 R. Only at the end of P's range
 * (32,768 R, 362 sigma; from rest after 273 samples at 100 Hz with the defaults, 1,034 with the paper's R and q) is the
 * next sample used (FILTER_REACQUIRED), because P cannot grow further. Parameters r, q, gate (which cannot be switched
 * off). Equations and scaling: wide.h.
 */
#include "wide.h"

LAW_PARAMETER(gate, "gate\0sigma", 8, 0, KALMAN_GATE_MIN_SIGMA_Q8, KALMAN_GATE_MAX_SIGMA_Q8, 512);
static const filter_parameter_t *const parameters[] IN_FLASH = { &filter_parameter_r, &filter_parameter_q, &gate };

/* The squared gate is kept below the saturated distance: 16 sigma become 15.9998. */
static void set_up(filter_t *f, const filter_config_t *config)
{
    uint16_t sigma_q8 = (uint16_t)config->value[SPRF_PAPER_GATE_SIGMA_Q8];
    uint32_t gate2_uq8 = fx_product_u16(sigma_q8, sigma_q8) >> 8;
    f->own.wide.gate2_uq8 = (gate2_uq8 >= UINT16_MAX) ? UINT16_MAX - 1U : (uint16_t)gate2_uq8;
    filter_wide_set_up(f, config);
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    bool grows = filter_wide_predict(f, z_lsb);
    if (what == STEP_MISSING) {
        return;
    }
    if (filter_wide_distance_uq8(f) <= f->own.wide.gate2_uq8) {
        filter_wide_correct(f, 0, 0);
    } else {
        filter_wide_refuse(f, grows);
    }
}

const filter_law_t filter_law_sprf_paper IN_FLASH = { .parameter_count = 3,
                                                      .traits = LAW_COVARIANCE | LAW_FIRST_SAMPLE | LAW_GATED,
                                                      .worst_cycles = 2250,
                                                      .parameters = parameters,
                                                      .set_up = set_up,
                                                      .set_noise = filter_wide_set_noise,
                                                      .start = filter_wide_start,
                                                      .step = step,
                                                      .report = LAW_REPORT(filter_wide_report),
                                                      .name = "sprf_paper" };
