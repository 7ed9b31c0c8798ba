/* Parameters, start and probe of the bank: see auto.h. */
#include "auto_inside.h"

#define GATE_MIN_SIGMA_Q8 256
#define GATE_MAX_SIGMA_Q8 4096
#define NO_GATE_LSB_UQ8 0x7FFFFFFFU
#define MEMORY_MAX_MS 60000U
#define RATE_MAX_MIN_LSB_S 10
#define RATE_MAX_MAX_LSB_S 1000000

static const filter_parameter_t parameters[] FX_FLASH = {
    { "gate", "sigma", offsetof(auto_config_t, gate_sigma_q8), 2, 8, 1, 0, GATE_MIN_SIGMA_Q8, GATE_MAX_SIGMA_Q8 },
    { "r", "LSB2", offsetof(auto_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "slow", "ms", offsetof(auto_config_t, slow_ms), 2, 0, 0, 0, 1, MEMORY_MAX_MS },
    { "middle", "ms", offsetof(auto_config_t, middle_ms), 2, 0, 0, 0, 1, MEMORY_MAX_MS },
    { "fast", "ms", offsetof(auto_config_t, fast_ms), 2, 0, 0, 0, 1, MEMORY_MAX_MS },
    { "ratemax", "LSB/s", offsetof(auto_config_t, rate_max_lsb_s), 4, 0, 0, 0, RATE_MAX_MIN_LSB_S, RATE_MAX_MAX_LSB_S },
};

const filter_descriptor_t auto_descriptor FX_FLASH = { "auto", sizeof parameters / sizeof parameters[0], parameters };

/* So many samples in ms, at least so many ms. */
static uint16_t memory_ms(uint16_t rate_dhz, uint32_t samples, uint16_t least_ms)
{
    uint16_t divisor = (rate_dhz == 0U) ? 1U : rate_dhz;
    uint32_t ms = samples * 10000U / divisor;
    if (ms > MEMORY_MAX_MS) {
        return MEMORY_MAX_MS;
    }
    return (ms > least_ms) ? (uint16_t)ms : least_ms;
}

void auto_defaults(auto_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->gate_sigma_q8 = 1536;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->slow_ms = memory_ms(rate_dhz, 28, 500);
    config->middle_ms = memory_ms(rate_dhz, 11, 200);
    config->fast_ms = memory_ms(rate_dhz, 5, 80);
    config->rate_max_lsb_s = 800;
}

/*
 * 1/8 of two sigmas of the rate for noise of sigma 1: with t = k / (2 - k) the rate's variance is 2 t^3, so it is
 * sqrt(t) t / sqrt(8).
 */
static uint16_t still_of(uint16_t k_uq16)
{
    uint32_t t_uq16 = ((uint32_t)k_uq16 << 15) / (0x20000U - k_uq16) << 1; /* <= 3/7 */
    uint16_t root_uq16 = fx_isqrt32(t_uq16 << 16);
    return fx_high_u16(fx_high_u16(root_uq16, (uint16_t)t_uq16), 23170);
}

FX_ONCE void auto_configure(auto_t *f, const auto_config_t *config)
{
    filter_zero(f, sizeof *f);
    f->final_k_uq16[AUTO_SLOW] = filter_memory_k_uq16(config->slow_ms, config->rate_dhz, AUTO_K_MIN_UQ16);
    f->final_k_uq16[AUTO_MIDDLE] = filter_memory_k_uq16(config->middle_ms, config->rate_dhz, AUTO_K_MIN_UQ16);
    f->final_k_uq16[AUTO_FAST] = filter_memory_k_uq16(config->fast_ms, config->rate_dhz, AUTO_K_MIN_UQ16);
    f->still_uq16 = still_of(f->final_k_uq16[AUTO_MIDDLE]);
    f->gate_sigma_q8 = config->gate_sigma_q8;
    fx_scaled_t per_sample = fx_scaled_div(fx_scaled(config->rate_max_lsb_s * 10U), fx_scaled(config->rate_dhz));
    uint32_t limit = fx_scaled_fixed(per_sample, 16);
    f->rate_max_lsb_q16 = (limit < (uint32_t)AUTO_X_MAX_LSB_Q16) ? limit : (uint32_t)AUTO_X_MAX_LSB_Q16;
    auto_set_noise(f, config->r_lsb2_q8);
    auto_restart(f);
}

static bool legal_memory(uint16_t ms)
{
    return ms != 0U && ms <= MEMORY_MAX_MS;
}

static bool legal(const auto_config_t *config)
{
    uint16_t gate = config->gate_sigma_q8;
    if (gate != 0U && (gate < GATE_MIN_SIGMA_Q8 || gate > GATE_MAX_SIGMA_Q8)) {
        return false;
    }
    return filter_common_legal(config->rate_dhz, config->r_lsb2_q8) && legal_memory(config->slow_ms) &&
           legal_memory(config->middle_ms) && legal_memory(config->fast_ms) &&
           config->rate_max_lsb_s >= RATE_MAX_MIN_LSB_S && config->rate_max_lsb_s <= RATE_MAX_MAX_LSB_S;
}

FX_ONCE bool auto_init(auto_t *f, const auto_config_t *config)
{
    if (!legal(config)) {
        return false;
    }
    auto_configure(f, config);
    return true;
}

/* Scores are kept: they are LSB^2, and forgotten after some eight samples anyway. */
void auto_set_noise(auto_t *f, uint32_t r_lsb2_q8)
{
    f->r_lsb2_q8 = filter_limited_r_lsb2_q8(r_lsb2_q8);
    f->eight_sigmas_lsb_uq8 = fx_isqrt32(f->r_lsb2_q8 << 14); /* <= 64763 */
    f->gate_lsb_uq8 = NO_GATE_LSB_UQ8;
    if (f->gate_sigma_q8 != 0U) {
        f->gate_lsb_uq8 = fx_product_u16(f->eight_sigmas_lsb_uq8, f->gate_sigma_q8) >> 11;
    }
}

FX_ONCE void auto_all_at(auto_t *f, int32_t x_lsb_q16, bool settled)
{
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        auto_member_t *m = &f->u.members[i];
        filter_zero(m, sizeof *m);
        m->x_lsb_q16 = x_lsb_q16;
        m->k_uq16 = settled ? f->final_k_uq16[i] : AUTO_K_START_UQ16;
    }
    f->collected = FILTER_WARM_UP_SAMPLES;
}

bool auto_reset_step(auto_t *f, int16_t z0_lsb, uint8_t step)
{
    (void)step;
    auto_reset(f, z0_lsb);
    return false;
}

/* At rest the slow member predicts best. */
void auto_reset(auto_t *f, int16_t z0_lsb)
{
    auto_restart(f);
    auto_all_at(f, (int32_t)filter_limited_z(z0_lsb) * 65536, true);
    f->flags = 0;
    f->chosen = AUTO_SLOW;
    f->shown = AUTO_SLOW;
}

void auto_restart(auto_t *f)
{
    filter_zero(&f->u, sizeof f->u);
    f->innovation_lsb_q16 = 0;
    f->gain_uq16 = 0;
    f->collected = 0;
    f->chosen = AUTO_MIDDLE;
    f->shown = AUTO_MIDDLE;
    f->flags = FILTER_WARMING_UP;
}

FX_ONCE int32_t auto_estimate(const auto_t *f)
{
    if (!auto_warming_up(f)) {
        return f->u.members[f->shown].x_lsb_q16;
    }
    return (f->collected == 0U) ? 0 : filter_warm_up_median_q16(f->u.start_lsb, f->collected);
}

uint8_t auto_flags(const auto_t *f)
{
    return f->flags;
}

/* Of the fading memory, per R: k (10 - 14 k + 5 k^2) / (2 - k)^3. */
static uint32_t variance_lsb2_q8(const auto_t *f)
{
    uint16_t k = f->u.members[f->shown].k_uq16;
    uint32_t bracket_uq16 = 655360U - 14U * (uint32_t)k + 5U * (uint32_t)fx_high_u16(k, k);
    fx_scaled_t below = fx_scaled(0x20000U - k);
    fx_scaled_t v = fx_scaled_mul(fx_scaled(f->r_lsb2_q8), fx_scaled(k));
    v = fx_scaled_div(fx_scaled_mul(v, fx_scaled(bracket_uq16)), fx_scaled_mul(below, fx_scaled_mul(below, below)));
    v.exponent = (int8_t)(v.exponent + 16);
    return fx_scaled_fixed(v, 0);
}

void auto_probe(const auto_t *f, filter_probe_t *out)
{
    bool running = (f->flags & FILTER_WARMING_UP) == 0U;
    out->x_lsb_q16 = auto_estimate(f);
    out->rate_lsb_q16 = running ? f->u.members[f->shown].rate_lsb_q16 : 0;
    out->innovation_lsb_q16 = f->innovation_lsb_q16;
    out->p_lsb2_q8 = running ? variance_lsb2_q8(f) : f->r_lsb2_q8;
    out->gate_lsb2_q8 = UINT32_MAX;
    out->gain_uq16 = f->gain_uq16;
    out->flags = f->flags;
}
