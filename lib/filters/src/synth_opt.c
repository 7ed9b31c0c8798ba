/* The synthesised filter with a schedule of gains: see synth_opt.h for the equations. */
#include "synth_opt.h"

#include "filter_common.h"
#include "fx.h"
#include "synth_opt_table.h"

#define P0_MIN_LSB2_Q8 3U
#define P0_MAX_LSB2_Q8 25600000U

/* 11/13 in the limit of variant U, where its errors are taken as uncorrelated; with the closed loop's it is this. */
#define U_NOISE_GAIN_UQ16 52818U

static const filter_parameter_t synth_opt_parameters[] FX_FLASH = {
    { "u", "", offsetof(synth_opt_config_t, variant_u), 2, 0, 0, 0, 0, 1 },
    { "p0", "LSB2", offsetof(synth_opt_config_t, p0_lsb2_q8), 4, 8, 0, 0, P0_MIN_LSB2_Q8, P0_MAX_LSB2_Q8 },
    { "r", "LSB2", offsetof(synth_opt_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
};

const filter_descriptor_t synth_opt_descriptor FX_FLASH = {
    "synth_opt", sizeof synth_opt_parameters / sizeof synth_opt_parameters[0], synth_opt_parameters
};

void synth_opt_defaults(synth_opt_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->variant_u = 0;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    uint32_t distance_lsb_q4 = 64000U / rate_dhz; /* 2 x 200 LSB/s x T, rounded down: <= 1280 */
    config->p0_lsb2_q8 = distance_lsb_q4 * distance_lsb_q4 + 1U + (config->r_lsb2_q8 * 19U) / 64U;
}

void synth_opt_configure(synth_opt_t *f, const synth_opt_config_t *config)
{
    synth_begin(&f->core, sizeof *f);
    f->variant_u = config->variant_u != 0U;
    f->p0_lsb2_q8 = config->p0_lsb2_q8;
    synth_opt_set_noise(f, config->r_lsb2_q8);
}

FX_ONCE bool synth_opt_init(synth_opt_t *f, const synth_opt_config_t *config)
{
    if (!filter_common_legal(config->rate_dhz, config->r_lsb2_q8) || config->variant_u > 1U ||
        config->p0_lsb2_q8 < P0_MIN_LSB2_Q8 || config->p0_lsb2_q8 > P0_MAX_LSB2_Q8) {
        return false;
    }
    synth_opt_configure(f, config);
    return true;
}

/*
 * The class whose ratio is nearest to P0 / R on a logarithmic scale: the border between 4^i and 4^(i + 1) is 2 x 4^i.
 * Once the schedule runs R changes nothing.
 */
void synth_opt_set_noise(synth_opt_t *f, uint32_t r_lsb2_q8)
{
    synth_take_noise(&f->core, r_lsb2_q8);
    if (f->core.collected < FILTER_WARM_UP_SAMPLES) {
        uint32_t border_lsb2_q8 = f->core.r_lsb2_q8 << 1; /* at most 2^1 x 4^4 x 256000 < 2^32 below */
        f->ratio_class = 0;
        while (f->ratio_class < (uint8_t)(SYNTH_OPT_CLASSES - 1) && f->p0_lsb2_q8 > border_lsb2_q8) {
            border_lsb2_q8 <<= 2;
            f->ratio_class++;
        }
    }
}

bool synth_opt_reset_step(synth_opt_t *f, int16_t z0_lsb, uint8_t step)
{
    (void)step;
    synth_opt_reset(f, z0_lsb);
    return false;
}

FX_ONCE void synth_opt_reset(synth_opt_t *f, int16_t z0_lsb)
{
    synth_at_rest(&f->core, z0_lsb);
}

/* Place of the next step's gains in the tables: of its class, of all classes, or the limit. */
FX_INLINE uint8_t place(const synth_opt_t *f)
{
    uint8_t steps = (uint8_t)(f->core.collected - FILTER_WARM_UP_SAMPLES);
    if (steps < (uint8_t)SYNTH_OPT_OWN_STEPS) {
        return (uint8_t)((uint16_t)f->ratio_class * SYNTH_OPT_OWN_STEPS + steps);
    }
    if (steps > (uint8_t)SYNTH_OPT_STEPS) {
        steps = (uint8_t)SYNTH_OPT_STEPS;
    }
    return (uint8_t)(steps + (uint8_t)SYNTH_OPT_COMMON);
}

/* The estimates moved on; the exact schedule's a1 is 0. */
FX_NOINLINE void move_on(synth_opt_t *f, uint8_t at)
{
    int32_t curvature_q16 = 0;
    if (f->variant_u) {
        uint16_t a1_uq16 = fx_flash_u16(&u_a1_uq16[at]);
        curvature_q16 = synth_scaled(synth_bend(&f->core, false), a1_uq16);
    }
    synth_extrapolate(&f->core, curvature_q16);
}

/* One sample on. */
FX_NOINLINE int32_t synth_opt_step(synth_opt_t *f, int16_t z_lsb)
{
    uint8_t at = place(f);
    f->core.flags = 0;
    f->core.gain_uq16 = fx_flash_u16(f->variant_u ? &u_b0_uq16[at] : &exact_b0_uq16[at]);
    move_on(f, at);
    if (f->core.collected < (uint8_t)(FILTER_WARM_UP_SAMPLES + SYNTH_OPT_STEPS - 1)) {
        f->core.collected++;
    } else {
        f->core.collected = SYNTH_STEADY;
    }
    return synth_correct(&f->core, z_lsb);
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x        Q15.16; |x_e| <= 4608 LSB by a clamp; the update moves x_e towards a sample within 4096, so |x| <= 4608
 *            and the bound is inductive; |z - x_e| <= 8704 LSB < 2^30 / 2^16
 *   a1, b0   UQ0.16 magnitudes of the table, within 2^-17 of the schedule's for its class of P0 / R. With the class's
 *            ratio off by up to a factor 2 the variance is at most 15 % above the optimum of the exact schedule in one
 *            sample of the start and 2.3 % in its mean (P0 >= R / 2; below R the first gain is the clamp, 1/2)
 *   rounding each product half away from zero to 2^-16 LSB; |x - reference| <= (1 + |1 - b0|) 2^-17 sum |g|, g the
 *            error's impulse response; for any gains within the clamps sum |g| < 25 (test_synth_opt_reference.c)
 *   cost     docs/benchmarks.md
 */
int32_t synth_opt_update(synth_opt_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (f->core.collected >= FILTER_WARM_UP_SAMPLES) {
        return synth_opt_step(f, z);
    }
    return synth_warm_up(&f->core, z, NULL);
}

/* The schedule goes by samples seen: it waits. */
int32_t synth_opt_coast(synth_opt_t *f)
{
    if (synth_coasts(&f->core)) {
        move_on(f, place(f));
        return f->core.u.run.x_lsb_q16[0];
    }
    return synth_estimate(&f->core);
}

void synth_opt_damp(synth_opt_t *f)
{
    synth_core_damp(&f->core);
}

void synth_opt_gap(synth_opt_t *f)
{
    synth_core_gap(&f->core);
}

/* Takes every sample as it is: nothing to be held back. */
void synth_opt_hold(synth_opt_t *f)
{
    (void)f;
}

void synth_opt_restart(synth_opt_t *f)
{
    synth_core_restart(&f->core);
}

uint8_t synth_opt_flags(const synth_opt_t *f)
{
    return f->core.flags;
}

/*
 * The variance is that of one sample while warming up, then what the schedule takes it for, R b0 (more than the true
 * one where b0 was clamped), and behind it the noise gain of the limit.
 */
void synth_opt_probe(const synth_opt_t *f, filter_probe_t *out)
{
    synth_probe_core(&f->core, out);
    if (f->core.collected > FILTER_WARM_UP_SAMPLES) {
        uint8_t at = (uint8_t)((uint8_t)SYNTH_OPT_COMMON + (uint8_t)SYNTH_OPT_STEPS);
        uint16_t noise_gain_uq16 = f->variant_u ? (uint16_t)U_NOISE_GAIN_UQ16 : fx_flash_u16(&exact_b0_uq16[at]);
        if (f->core.collected != SYNTH_STEADY && f->core.gain_uq16 != 0U) {
            noise_gain_uq16 = f->core.gain_uq16;
        }
        out->p_lsb2_q8 = synth_variance_lsb2_q8(&f->core, noise_gain_uq16);
    }
}
