/* Constants, start and probe of adaptive: see adaptive.c. */
#include "adaptive.h"

#define CONFIRM_LEAST 3U

static const filter_parameter_t guard FX_FLASH = { "guard", "sigma", 8, 1, 256, 4096, 1152 };
static const filter_parameter_t identify FX_FLASH = { "identify", "", 0, 0, 0, 1, 1 };
static const filter_parameter_t slow FX_FLASH = { "slow", "ms", 0, 0, 10, 60000, 500 };
static const filter_parameter_t fast FX_FLASH = { "fast", "ms", 0, 0, 1, 60000, 0 };
static const filter_parameter_t confirm FX_FLASH = { "confirm", "ms", 0, 0, 0, 10000, 120 };
static const filter_parameter_t *const parameters[] FX_FLASH = {
    &guard, &filter_parameter_r, &identify, &slow, &fast, &confirm, &filter_parameter_ratemax
};

/*
 * One rule for all rates. Shortest memory: 80 ms, a quick turn of the hand, and two samples, without which no line is
 * known. Slowest: half a second and at least 20 samples. The gate is 3 sigma below 20 Hz, where a motion is a few samples
 * long and outliers among them cost most, and 4.5 from there on: more than what hands do between samples.
 */
void adaptive_standard(filter_config_t *config)
{
    uint16_t rate_dhz = config->rate_dhz;
    if (rate_dhz < 200U) {
        config->value[ADAPTIVE_GUARD_SIGMA_Q8] = 768;
    }
    if (rate_dhz < 400U) {
        config->value[ADAPTIVE_SLOW_MS] = (int32_t)(200000U / rate_dhz);
    }
    config->value[ADAPTIVE_FAST_MS] = (int32_t)(80U + 20000U / rate_dhz);
}

/* Shares and thresholds that follow from the shortest memory. */
static void set_memory(filter_adaptive_t *a, const filter_config_t *config)
{
    uint16_t fast_uq16 = tracker_memory_k_uq16((uint16_t)config->value[ADAPTIVE_FAST_MS], config->rate_dhz, K_MIN_UQ16);
    a->slow_uq16 = tracker_memory_k_uq16((uint16_t)config->value[ADAPTIVE_SLOW_MS], config->rate_dhz, K_MIN_UQ16);
    if (fast_uq16 < a->slow_uq16) {
        fast_uq16 = a->slow_uq16;
    }
    a->fast_uq16 = fast_uq16;
    a->share_uq16 = fx_high_u16(fast_uq16, 26214); /* 0.4 */
    /* sigma of the mean, sqrt(share / (2 - share)), times 2.15 */
    uint32_t ratio_uq32 = ((uint32_t)a->share_uq16 << 15) / (0x20000U - a->share_uq16) << 17;
    a->manoeuvre_uq16 = (uint16_t)((275U * (uint32_t)fx_isqrt32(ratio_uq32)) >> 7); /* <= 0.8 */
}

/* 64 terms, from 256 Hz on 5 s and at most 1024 terms. */
static uint16_t last_weight_uq16(uint16_t rate_dhz)
{
    uint16_t weight_uq16 = WEIGHT_LAST_MAX_UQ16;
    for (; rate_dhz >= 256U && weight_uq16 > WEIGHT_LAST_MIN_UQ16; rate_dhz >>= 1) {
        weight_uq16 >>= 1;
    }
    return weight_uq16;
}

void adaptive_set_up(filter_t *f, const filter_config_t *config)
{
    filter_adaptive_t *a = &f->own.adaptive;
    a->guarded = config->value[ADAPTIVE_GUARD_SIGMA_Q8] != 0;
    a->gate_sigma_q8 = a->guarded ? (uint16_t)config->value[ADAPTIVE_GUARD_SIGMA_Q8] : UNGUARDED_SIGMA_Q8;
    a->identify = config->value[ADAPTIVE_IDENTIFY] != 0;
    a->third = a->identify ? 1U : 0U;
    a->by_turns = (a->identify && a->guarded) ? 1U : 0U;
    set_memory(a, config);
    uint32_t confirm_samples = (uint32_t)config->value[ADAPTIVE_CONFIRM_MS] * config->rate_dhz / 10000U; /* <= 40000 */
    a->confirm = (confirm_samples < CONFIRM_LEAST) ? CONFIRM_LEAST : (uint16_t)confirm_samples;
    a->weight_uq16 = WEIGHT_START_UQ16;
    a->terms = 2;
    a->stage = 1;
    a->last_uq16 = last_weight_uq16(config->rate_dhz);
    tracker_limit_rate(f, (uint32_t)config->value[ADAPTIVE_RATE_MAX_LSB_S], 24);
    filter_set_noise(f, (uint32_t)config->value[ADAPTIVE_R_LSB2_Q8]);
}

/* The start samples are learnt from too, unless one of them was missing. */
void adaptive_start(filter_t *f, bool settled)
{
    filter_adaptive_t *a = &f->own.adaptive;
    filter_start_t start = f->own.start;
    a->mean_lsb_q24 = 0;
    a->gate_lsb_uq16 = 0;
    a->run = 0;
    a->verdict = UNUSED;
    a->filled = 0;
    f->negative = false;
    a->k_uq32 = settled ? (uint32_t)a->slow_uq16 << 16 : K_START_UQ32;
    if (!settled && !f->broken) {
        for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
            adaptive_learn(f, start.seen_lsb[i]);
            f->previous_lsb = start.seen_lsb[i];
        }
    }
}

/* Of the last update; 0 when nothing was taken. */
static uint16_t gain_uq16(const filter_t *f)
{
    if ((f->flags & FILTER_COASTED) != 0U || f->own.adaptive.verdict == (uint8_t)UNUSED) {
        return 0;
    }
    uint16_t k = (uint16_t)(f->own.adaptive.k_uq32 >> 16);
    return (uint16_t)(2U * k - fx_high_u16(k, k));
}

void adaptive_report(const filter_t *f, filter_probe_t *out)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    out->p_lsb2_q8 = adaptive_r_lsb2_q8(f);
    if (f->collected != FILTER_RUNNING) {
        return;
    }
    out->p_lsb2_q8 = tracker_fading_variance(out->p_lsb2_q8, (uint16_t)(a->k_uq32 >> 16));
    out->gain_uq16 = gain_uq16(f);
    if (a->guarded && a->gate_lsb_uq16 != 0U) {
        uint16_t gate_uq4 = (uint16_t)(a->gate_lsb_uq16 >> 12); /* <= 4000 LSB */
        out->gate_lsb2_q8 = fx_product_u16(gate_uq4, gate_uq4);
    }
}

const filter_law_t filter_law_adaptive FX_FLASH = { .name = "adaptive",
                                                    .parameter_count = 7,
                                                    .traits = LAW_FINE_RATE | LAW_GATED,
                                                    .worst_cycles = 1410,
                                                    .parameters = parameters,
                                                    .standard = adaptive_standard,
                                                    .set_up = adaptive_set_up,
                                                    .set_noise = adaptive_set_noise,
                                                    .start = adaptive_start,
                                                    .step = adaptive_step,
                                                    .report = LAW_REPORT(adaptive_report) };
