/* Parameters, start and probe of the guarded adaptive filter: see adaptive.h. */
#include "adaptive_scale.h"
#include "filter_common.h"

#define GUARD_MIN_SIGMA_Q8 256
#define GUARD_MAX_SIGMA_Q8 4096
#define MEMORY_MAX_MS 60000U
#define SLOW_MIN_MS 10U
#define CONFIRM_MAX_MS 10000U
#define CONFIRM_LEAST 3U
#define RATE_MAX_MIN_LSB_S 10
#define RATE_MAX_MAX_LSB_S 1000000

static const filter_parameter_t parameters[] FX_FLASH = {
    { "guard", "sigma", offsetof(adaptive_config_t, guard_sigma_q8), 2, 8, 1, 0, GUARD_MIN_SIGMA_Q8,
      GUARD_MAX_SIGMA_Q8 },
    { "r", "LSB2", offsetof(adaptive_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "identify", "", offsetof(adaptive_config_t, identify), 2, 0, 0, 0, 0, 1 },
    { "slow", "ms", offsetof(adaptive_config_t, slow_ms), 2, 0, 0, 0, SLOW_MIN_MS, MEMORY_MAX_MS },
    { "fast", "ms", offsetof(adaptive_config_t, fast_ms), 2, 0, 0, 0, 1, MEMORY_MAX_MS },
    { "confirm", "ms", offsetof(adaptive_config_t, confirm_ms), 2, 0, 0, 0, 0, CONFIRM_MAX_MS },
    { "ratemax", "LSB/s", offsetof(adaptive_config_t, rate_max_lsb_s), 4, 0, 0, 0, RATE_MAX_MIN_LSB_S,
      RATE_MAX_MAX_LSB_S },
};

const filter_descriptor_t adaptive_descriptor FX_FLASH = { "adaptive", sizeof parameters / sizeof parameters[0],
                                                           parameters };

/*
 * One rule for all rates. Shortest memory: 80 ms, a quick turn of the hand, and two samples, without which no line
 * is known. Slowest: half a second and at least 20 samples. The gate is 3 sigma below 20 Hz, where a motion is a
 * few samples long and outliers among them cost most, and 4.5 from there on: more than what hands do between samples.
 */
void adaptive_defaults(adaptive_config_t *config, uint16_t rate_dhz)
{
    uint16_t divisor = (rate_dhz == 0U) ? 1U : rate_dhz;
    config->rate_dhz = rate_dhz;
    config->guard_sigma_q8 = (uint16_t)((rate_dhz < 200U) ? 768U : 1152U);
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->identify = 1;
    config->slow_ms = (uint16_t)((divisor < 400U) ? 200000U / divisor : 500U);
    config->fast_ms = (uint16_t)(80U + 20000U / divisor);
    config->confirm_ms = 120;
    config->rate_max_lsb_s = 800;
}

static bool legal_times(const adaptive_config_t *config)
{
    return config->slow_ms >= SLOW_MIN_MS && config->slow_ms <= MEMORY_MAX_MS && config->fast_ms != 0U &&
           config->fast_ms <= MEMORY_MAX_MS && config->confirm_ms <= CONFIRM_MAX_MS;
}

static bool legal(const adaptive_config_t *config)
{
    uint16_t guard = config->guard_sigma_q8;
    if (guard != 0U && (guard < GUARD_MIN_SIGMA_Q8 || guard > GUARD_MAX_SIGMA_Q8)) {
        return false;
    }
    return filter_common_legal(config->rate_dhz, config->r_lsb2_q8) && legal_times(config) && config->identify <= 1U &&
           config->rate_max_lsb_s >= RATE_MAX_MIN_LSB_S && config->rate_max_lsb_s <= RATE_MAX_MAX_LSB_S;
}

/* Shares and thresholds that follow from the shortest memory. */
static void set_memory(adaptive_t *f, const adaptive_config_t *config)
{
    f->slow_uq16 = filter_memory_k_uq16(config->slow_ms, config->rate_dhz, K_MIN_UQ16);
    f->fast_uq16 = filter_memory_k_uq16(config->fast_ms, config->rate_dhz, K_MIN_UQ16);
    if (f->fast_uq16 < f->slow_uq16) {
        f->fast_uq16 = f->slow_uq16;
    }
    f->share_uq16 = fx_high_u16(f->fast_uq16, 26214); /* 0.4 */
    /* sigma of the mean, sqrt(share / (2 - share)), times 2.15 */
    uint32_t ratio_uq32 = ((uint32_t)f->share_uq16 << 15) / (0x20000U - f->share_uq16) << 17;
    f->manoeuvre_uq16 = (uint16_t)((275U * (uint32_t)fx_isqrt32(ratio_uq32)) >> 7); /* <= 0.8 */
}

/* Limits that are times and rates. */
static void set_limits(adaptive_t *f, const adaptive_config_t *config)
{
    uint32_t confirm = (uint32_t)config->confirm_ms * config->rate_dhz / 10000U; /* <= 40000 */
    f->confirm = (confirm < CONFIRM_LEAST) ? CONFIRM_LEAST : (uint16_t)confirm;
    fx_scaled_t per_sample = fx_scaled_div(fx_scaled(config->rate_max_lsb_s * 10U), fx_scaled(config->rate_dhz));
    uint32_t limit = fx_scaled_fixed(per_sample, 24);
    f->rate_max_lsb_q24 = (limit < (uint32_t)RATE_LIMIT_LSB_Q24) ? (int32_t)limit : RATE_LIMIT_LSB_Q24;
    f->jump_lsb_uq8 = (uint16_t)(f->rate_max_lsb_q24 >> 19); /* an eighth */
    f->weight_uq16 = WEIGHT_START_UQ16;
    f->terms = 2;
    f->stage = 1;
    f->last_uq16 = WEIGHT_LAST_MAX_UQ16; /* 64 terms, from 256 Hz on 5 s and at most 1024 terms */
    for (uint16_t rate = config->rate_dhz; rate >= 256U && f->last_uq16 > WEIGHT_LAST_MIN_UQ16; rate >>= 1) {
        f->last_uq16 >>= 1;
    }
}

FX_ONCE void adaptive_configure(adaptive_t *f, const adaptive_config_t *config)
{
    filter_zero(f, sizeof *f);
    f->flags = FILTER_WARMING_UP;
    f->guarded = config->guard_sigma_q8 != 0U;
    f->gate_sigma_q8 = f->guarded ? config->guard_sigma_q8 : UNGUARDED_SIGMA_Q8;
    f->identify = config->identify != 0U;
    f->third = f->identify ? 1U : 0U;
    f->by_turns = (f->identify && f->guarded) ? 1U : 0U;
    set_memory(f, config);
    set_limits(f, config);
    adaptive_set_noise(f, config->r_lsb2_q8);
}

FX_ONCE bool adaptive_init(adaptive_t *f, const adaptive_config_t *config)
{
    if (!legal(config)) {
        return false;
    }
    adaptive_configure(f, config);
    return true;
}

void adaptive_set_noise(adaptive_t *f, uint32_t r_lsb2_q8)
{
    if (f->identify && (f->terms != 2U || f->weight_uq16 != WEIGHT_START_UQ16)) {
        return;
    }
    uint16_t sigma_q10 = fx_isqrt32(filter_limited_r_lsb2_q8(r_lsb2_q8) << 12);
    sigma_q10 = (sigma_q10 < 110U) ? 110U : sigma_q10; /* as the least R has: the proof knows no roots */
    f->third_lsb_uq24 = fx_product_u16(sigma_q10, THIRD_OF_SIGMA_Q8) << 6; /* within what identify keeps */
    f->scatter_lsb_uq24 = (uint32_t)sigma_q10 << 14;
}

/* What the samples so far told, but for the noise. */
FX_NOINLINE void forget(adaptive_t *f)
{
    f->rate_lsb_q24 = 0;
    f->mean_lsb_q24 = 0;
    f->u.run.size_lsb_uq16 = 0;
    f->filled = 0;
    f->run = 0;
    f->below = false;
    f->verdict = UNUSED;
    f->u.run.gate_lsb_uq16 = 0;
    f->u.run.before_lsb_q16 = 0;
}

bool adaptive_reset_step(adaptive_t *f, int16_t z0_lsb, uint8_t step)
{
    (void)step;
    adaptive_reset(f, z0_lsb);
    return false;
}

FX_ONCE void adaptive_reset(adaptive_t *f, int16_t z0_lsb)
{
    int16_t z0 = filter_limited_z(z0_lsb);
    f->x_lsb_q16 = (int32_t)z0 * 65536;
    f->k_uq32 = (uint32_t)f->slow_uq16 << 16;
    forget(f);
    f->collected = FILTER_WARM_UP_SAMPLES;
    f->flags = 0;
}

/* Towards `below` or away from it: rounded down, within its bound. */
void adaptive_damp(adaptive_t *f)
{
    f->rate_lsb_q24 >>= 1;
}

/* As after a gap: with no sample before it nothing agrees with the next one, and no difference is taken over it. */
void adaptive_hold(adaptive_t *f)
{
    f->run = 0;
    f->filled = 0;
}

/* The innovation, its gate and the sample before lie where those of the start will be: 0 each. */
void adaptive_restart(adaptive_t *f)
{
    forget(f);
    f->collected = 0;
    f->flags = FILTER_WARMING_UP;
}

uint32_t adaptive_r_lsb2_q8(const adaptive_t *f)
{
    uint16_t sigma_uq8 = fx_high_u16((uint16_t)(f->third_lsb_uq24 >> 16), SIGMA_OF_THIRD_UQ16);
    return filter_limited_r_lsb2_q8(fx_product_u16(sigma_uq8, sigma_uq8) >> 8);
}

/* R times the noise gain of the fading memory with this k, k (10 - 14 k + 5 k^2) / (2 - k)^3. */
static uint32_t variance_lsb2_q8(const adaptive_t *f)
{
    uint16_t k = (uint16_t)(f->k_uq32 >> 16);
    uint32_t numerator = 655360U - 14U * (uint32_t)k + 5U * (uint32_t)fx_high_u16(k, k);
    fx_scaled_t inverse = fx_scaled_div(fx_scaled(k), fx_scaled(0x20000U - k));
    fx_scaled_t square = fx_scaled_div(fx_scaled_div(fx_scaled(numerator), fx_scaled(0x20000U - k)),
                                       fx_scaled(0x20000U - k));
    fx_scaled_t p = fx_scaled_mul(fx_scaled_mul(inverse, square), fx_scaled(adaptive_r_lsb2_q8(f)));
    return fx_scaled_fixed(p, 16);
}

/* Of the last update; 0 when nothing was taken. */
static uint16_t gain_uq16(const adaptive_t *f)
{
    if ((f->flags & FILTER_COASTED) != 0U || f->verdict == (uint8_t)UNUSED) {
        return 0;
    }
    uint16_t k = (uint16_t)(f->k_uq32 >> 16);
    return (uint16_t)(2U * k - fx_high_u16(k, k));
}

void adaptive_probe(const adaptive_t *f, filter_probe_t *out)
{
    bool running = (f->flags & FILTER_WARMING_UP) == 0U;
    out->x_lsb_q16 = f->x_lsb_q16;
    out->rate_lsb_q16 = running ? adaptive_rate_lsb_q16(f) : 0;
    int32_t size = running ? (int32_t)f->u.run.size_lsb_uq16 : 0;
    out->innovation_lsb_q16 = f->below ? -size : size;
    out->p_lsb2_q8 = running ? variance_lsb2_q8(f) : adaptive_r_lsb2_q8(f);
    out->gate_lsb2_q8 = UINT32_MAX;
    if (f->guarded && running && f->u.run.gate_lsb_uq16 != 0U) {
        uint16_t gate_uq4 = (uint16_t)(f->u.run.gate_lsb_uq16 >> 12); /* <= 4000 LSB */
        out->gate_lsb2_q8 = fx_product_u16(gate_uq4, gate_uq4);
    }
    out->gain_uq16 = running ? gain_uq16(f) : 0U;
    out->flags = f->flags;
}
