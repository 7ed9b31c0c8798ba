/*
 * synth_opt: the synthesised filter with parametric synthesis (Zimchuk and Shapar, paper 000, algorithm 22): a1 and b0
 * change from sample to sample by a schedule that depends on the variance of the start's error, P0, over R.
 *
 *   x_e = 2 x1 - x2 - a1(n) (x1 - 2 x2 + x3),   x = x_e + b0(n) (z - x_e),   b0 = Pe / (Pe + R)
 *
 * As printed the schedule is chaotic and its variance becomes negative, because (17)-(19) treat the variance of a
 * linear combination as a squared shift operator. Two schedules that work, computed off line by
 * tools/design/schedule.py:
 *
 *   exact  Pe = h S h' with the covariance S of the last three errors, a1 = its optimum: ends at (0, 2/3), P = 2/3 R
 *   U      a1 by the paper's (21), Pe as if the errors were uncorrelated, the closest working relative of (20):
 *          ends at (-1/6, 11/13); its own P = 11/13 R there, the true one is 0.8059 R
 *
 * both with a1 in [-1/3, 0] and b0 in [1/2, 1), where any switching is stable. The steady gains do not depend on R: a
 * changed R affects only the start. Not robust: every outlier passes with the gain b0. Parameters u (0: exact, 1:
 * variant U), p0, r (for start and probe), ratemax (as in synth).
 *
 * Scaling:
 *   a1, b0   UQ0.16 magnitudes of the table, within 2^-17 of the schedule's for its class of P0 / R. With the class's
 *            ratio off by up to a factor 2 the variance is at most 15 % above the optimum of the exact schedule in one
 *            sample of the start and 2.3 % in its mean (P0 >= R / 2; below R the first gain is the clamp, 1/2)
 *   rounding each product half away from zero to 2^-16 LSB; |x - reference| <= (1 + |1 - b0|) 2^-17 sum |g|, g the
 *            error's impulse response; for any gains within the clamps sum |g| < 25 (test_synth_opt_reference.c)
 */
#include "synth.h"
#include "synth_opt_table.h"

/* Index of the gains after the schedule. */
enum { LIMIT = (int)SYNTH_OPT_COMMON + (int)SYNTH_OPT_STEPS };

/* Variant U takes its errors as uncorrelated and arrives at 11/13; computed from the closed loop it is this. */
#define U_NOISE_GAIN_UQ16 52818U

LAW_PARAMETER(u, "u\0", 0, 0, 0, 1, 0);
LAW_PARAMETER(p0, "p0\0LSB2", 8, 0, 3, 25600000, 0);
static const filter_parameter_t *const parameters[] IN_FLASH = { &u, &p0, &filter_parameter_r,
                                                                 &filter_parameter_ratemax };

static void standard(filter_config_t *config)
{
    uint32_t distance_lsb_q4 = 64000U / config->rate_dhz; /* 2 x 200 LSB/s x T, rounded down: <= 1280 */
    config->value[SYNTH_OPT_P0_LSB2_Q8] = (int32_t)(distance_lsb_q4 * distance_lsb_q4 + 1U +
                                                    ((uint32_t)config->value[SYNTH_OPT_R_LSB2_Q8] * 19U) / 64U);
}

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_synth_t *s = &f->own.synth;
    s->of.scheduled.p0_lsb2_q8 = (uint32_t)config->value[SYNTH_OPT_P0_LSB2_Q8];
    s->b0_uq16 = flash_u16(&exact_b0_uq16[LIMIT]);
    if (config->value[SYNTH_OPT_VARIANT_U] != 0) {
        s->of.scheduled.variant_u = true;
        s->b0_uq16 = flash_u16(&u_b0_uq16[LIMIT]);
        s->a1_uq16 = flash_u16(&u_a1_uq16[LIMIT]);
        s->a1_negative = true;
    }
    filter_tracker_limit_rate(f, (uint32_t)config->value[SYNTH_OPT_RATE_MAX_LSB_S], 16);
    filter_set_noise(f, (uint32_t)config->value[SYNTH_OPT_R_LSB2_Q8]);
}

/*
 * The class whose ratio is nearest to P0 / R on a logarithmic scale: the border between 4^i and 4^(i + 1) is 2 x 4^i.
 * Once the schedule runs, R has no effect.
 */
static void set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_synth_take_noise(f, r_lsb2_q8);
    if (f->collected < FILTER_WARM_UP_SAMPLES) {
        uint32_t border_lsb2_q8 = r_lsb2_q8 << 1; /* at most 2^1 x 4^4 x 256000 < 2^32 below */
        uint8_t ratio_class = 0;
        while (ratio_class < (uint8_t)(SYNTH_OPT_CLASSES - 1) &&
               f->own.synth.of.scheduled.p0_lsb2_q8 > border_lsb2_q8) {
            border_lsb2_q8 <<= 2;
            ratio_class++;
        }
        f->own.synth.of.scheduled.ratio_class = ratio_class;
    }
}

/*
 * A step of the schedule, with its index in the tables: first those of the class, then the common ones. It pauses for
 * missing samples.
 */
static void scheduled_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    filter_synth_t *s = &f->own.synth;
    uint8_t steps = (uint8_t)(s->count - (uint8_t)SYNTH_FIRST_GAIN);
    uint8_t at = (uint8_t)(steps + (uint8_t)SYNTH_OPT_COMMON);
    if (steps < (uint8_t)SYNTH_OPT_OWN_STEPS) {
        at = (uint8_t)((uint8_t)((uint16_t)s->of.scheduled.ratio_class * SYNTH_OPT_OWN_STEPS) + steps);
    }
    bool variant_u = s->of.scheduled.variant_u;
    f->gain_uq16 = flash_u16(variant_u ? &u_b0_uq16[at] : &exact_b0_uq16[at]);
    if (what != STEP_MISSING) {
        s->count = (steps < (uint8_t)(SYNTH_OPT_STEPS - 1)) ? (uint8_t)(s->count + 1U) : (uint8_t)SYNTH_STEADY;
    }
    if (variant_u) {
        filter_synth_bent_step(f, z_lsb, what, flash_u16(&u_a1_uq16[at]));
    } else {
        filter_synth_step(f, z_lsb, what);
    }
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    if (f->own.synth.count == SYNTH_STEADY) {
        filter_synth_steady_step(f, z_lsb, what);
    } else {
        scheduled_step(f, z_lsb, what);
    }
    filter_tracker_turn(f, 0); /* within ratemax */
}

/*
 * Variance of one sample while warming up, then the one that the schedule assumes, R b0 (more than the true one where
 * b0 was clamped), and after the schedule the noise gain of the limit.
 */
static void report(const filter_t *f, filter_probe_t *out)
{
    const filter_synth_t *s = &f->own.synth;
    out->p_lsb2_q8 = s->r_lsb2_q8;
    if (f->collected == FILTER_RUNNING && s->count > (uint8_t)SYNTH_FIRST_GAIN) {
        uint16_t noise_gain_uq16 = s->of.scheduled.variant_u ? (uint16_t)U_NOISE_GAIN_UQ16 : s->b0_uq16;
        if (s->count != SYNTH_STEADY && f->gain_uq16 != 0U) {
            noise_gain_uq16 = f->gain_uq16;
        }
        out->p_lsb2_q8 = filter_synth_variance_lsb2_q8(f, noise_gain_uq16);
    }
}

const filter_law_t filter_law_synth_opt IN_FLASH = { .parameter_count = 4,
                                                     .worst_cycles = 745,
                                                     .parameters = parameters,
                                                     .standard = standard,
                                                     .set_up = set_up,
                                                     .set_noise = set_noise,
                                                     .start = filter_synth_start,
                                                     .step = step,
                                                     .fade = filter_synth_fade,
                                                     .report = LAW_REPORT(report),
                                                     .name = "synth_opt" };
