/*
 * kf3: its bounds, and what no descriptor tells (support/law_facts.h).
 *
 * It comes back as far wrong as a filter of two states, and its error obeys the recursion of its P: computed in double
 * for each gap, with P held where its range ends, the slowest is below 1/4 LSB from sample 90 on.
 */
#include "support/law_kf3.h"

#include "kalman.h"
#include "support/law_facts.h"

#define ONE_UQ28 0x10000000U /* kf3.c */

#ifndef __AVR__
#include <math.h>

double kf3_noise_gain_of(double w1, double w2, double w3)
{
    double beta = w2 + w3 / 2.0;
    double above = 2.0 * beta * (2.0 * w1 * w1 + 2.0 * beta - 3.0 * w1 * beta) - w1 * w3 * (4.0 - 2.0 * w1 - beta);
    return above / ((4.0 - 2.0 * w1 - beta) * (2.0 * w1 * beta + w1 * w3 - 2.0 * w3));
}

double kf3_time_constant_samples(uint16_t rate_dhz, double r_lsb2)
{
    filter_config_t config = filter_defaults(&filter_law_kf3, rate_dhz);
    bool fine = rate_dhz >= 1000U;
    double q33 = config.value[KF3_Q_LSB2_S5] * pow(10.0 / rate_dhz, 5.0) / r_lsb2;
    return 2.0 / pow(fmin(fine ? 0x1p-11 : 1.0, fmax(fine ? 0x1p-32 : 0x1p-24, q33)), 1.0 / 6.0);
}

static double noise_gain(const filter_t *f)
{
    const filter_kf3_t *k = &f->own.kf3;
    double w1 = f->gain_uq16 / 65536.0;
    return kf3_noise_gain_of(w1, k->p.p12 / 268435456.0, k->p13_uq28 / 268435456.0 / (k->fine ? 16.0 : 1.0));
}
#endif

/* kf3.c: P11 below 1 after an update; a prediction from P11 < 4 and the rest < 1 ends below 13, 7, 5, 4, 3 and 2. */
static bool kf3_covariance_broken(const filter_t *f)
{
    const filter_kf3_t *k = &f->own.kf3;
    uint32_t p11_end = (f->gain_uq16 != 0U) ? 1U : 13U;
    const uint32_t elements[] = { k->p.p11, k->p.p12, k->p.p22, k->p13_uq28, k->p23_uq28, k->p33_uq28 };
    const uint32_t ends[] = { p11_end, 7U, 5U, 4U, 3U, 2U };
    for (uint8_t i = 0; i < 6U; i++) {
        if (elements[i] >= ends[i] * ONE_UQ28) {
            return true;
        }
    }
    return false;
}

/* kf3.c: no gate; acceleration within the bound of the format, drive and R within their ranges. */
const char *broken_kf3(const filter_t *f)
{
    const filter_kf3_t *k = &f->own.kf3;
    if (gate_shows(f)) {
        return "flags of a gate";
    }
    uint32_t drive_end = k->fine ? ONE_UQ28 / 8U : ONE_UQ28;
    if (k->q33_uq28 < 16U || k->q33_uq28 > drive_end || r_broken(k->r_lsb2_q8, FILTER_R_MAX_LSB2_Q8)) {
        return "q33 or r";
    }
    if (!running(f)) {
        return NULL;
    }
    if (filter_fx_abs32(k->acceleration_q16) > X_MAX_Q16) {
        return "acceleration";
    }
    return kf3_covariance_broken(f) ? "P" : NULL;
}

law_facts_t law_facts_kf3(void)
{
    return (law_facts_t){ ENVELOPE(THREE_STATE_SUM, 1.0, LINEAR_FORGETS, 0, ENVELOPE_FIXED_GAIN, noise_gain,
                                   kf3_time_constant_samples) USUAL,
                          REFUSES, SETTLES_IN(90) };
}
