/*
 * sprf: kf with a binary gate, made safe against lock-out.
 *
 * A sample further from the prediction than gate x sigma (of the innovation) is refused: predict only. Refused samples
 * whose raw values agree re-acquire: position and rate restart from them. If nothing agrees for long, the rate is set
 * to 0 and the estimate holds. Paper 002, rule (34) with u^2 <= gate^2 S, plus what its start and a step require: the
 * running-median start and consistency re-acquisition. Parameters r, q, gate, reacquire, ratemax. Equations and
 * scaling: kalman.h.
 */
#include "kalman.h"

/* Refused samples for which the rate is still trusted; the next one sets it to 0. */
#define RATE_HELD_SAMPLES 5U

static const filter_parameter_t *const parameters[] IN_FLASH = { &filter_parameter_r, &filter_parameter_q,
                                                                 &filter_parameter_gate, &filter_parameter_reacquire,
                                                                 &filter_parameter_ratemax };

static void standard(filter_config_t *config)
{
    if (config->rate_dhz <= KALMAN_SHORT_RUN_DHZ) {
        config->value[SPRF_REACQUIRE_SAMPLES] = KALMAN_SHORT_RUN;
    }
}

static bool together(const filter_config_t *config)
{
    return filter_kalman_run_legal(config->value[SPRF_REACQUIRE_SAMPLES]);
}

LAW_ASSERT((int)SPRF_GATE_SIGMA_Q8 == (int)KALMAN_GATE && (int)SPRF_RATE_MAX_LSB_S == (int)SPRF_REACQUIRE_SAMPLES + 1,
           "where filter_kalman_set_up_gated looks");

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_kalman_set_up_gated(f, config, SPRF_REACQUIRE_SAMPLES);
}

/*
 * The rate describes a motion that has not been observed since the last accepted sample. If nothing agrees for long, as
 * on a shaking frame, the filter would drift off with it. Without re-acquisition it does, as published.
 */
static void forget_rate(filter_t *f)
{
    filter_kalman_t *k = &f->own.kalman;
    if (k->run == 0U) { /* first refused sample since one was accepted */
        k->refused = 0;
    }
    if (k->refused < RATE_HELD_SAMPLES) {
        k->refused++;
    } else if (k->steps != 0U) {
        f->rate_lsb = 0;
    }
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    if (filter_kalman_step(f, z_lsb, what)) {
        f->own.kalman.run = 0;
    } else if (what != STEP_MISSING) {
        f->flags |= FILTER_GATED;
        f->gain_uq16 = 0;
        forget_rate(f);
        (void)filter_kalman_refused(f, z_lsb);
    }
}

const filter_law_t filter_law_sprf IN_FLASH = { .parameter_count = 5,
                                                .traits = LAW_COVARIANCE | LAW_GATED,
                                                .worst_cycles = 1230,
                                                .parameters = parameters,
                                                .standard = standard,
                                                .together = together,
                                                .set_up = set_up,
                                                .set_noise = filter_kalman_set_noise_gated,
                                                .start = filter_kalman_start,
                                                .step = step,
                                                .report = LAW_REPORT(filter_kalman_report),
                                                .name = "sprf" };
