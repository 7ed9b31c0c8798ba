/* Three fading memories and the choice among them: see auto.h. */
#include "auto.h"

#include "filter_common.h"
#include "fx.h"

#define GATE_MIN_SIGMA_Q8 256
#define GATE_MAX_SIGMA_Q8 4096
#define NO_GATE_LSB_UQ8 0x7FFFFFFFU
#define MEMORY_MAX_MS 60000U
#define RATE_MAX_MIN_LSB_S 10
#define RATE_MAX_MAX_LSB_S 1000000
#define X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

/* k = 0.6, a memory of 3.3 samples, also behind a restart; k = 2 / 512: beyond it a rate would round to a standstill */
#define K_MAX_UQ16 39322U
#define K_MIN_UQ16 256U
/* The median of five samples is worth a memory of about four. */
#define K_START_UQ16 32768U
/* A member with a shorter memory than eight samples takes every sample until it has grown to its own. */
#define K_OPEN_UQ16 16384U

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

/* k = 2 / memory, limited. */
FX_NOINLINE uint16_t k_of(uint16_t ms, uint16_t rate_dhz)
{
    uint32_t k = 1310720000U / ((uint32_t)ms * rate_dhz);
    if (k > K_MAX_UQ16) {
        return K_MAX_UQ16;
    }
    return (k < K_MIN_UQ16) ? K_MIN_UQ16 : (uint16_t)k;
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
    f->final_k_uq16[AUTO_SLOW] = k_of(config->slow_ms, config->rate_dhz);
    f->final_k_uq16[AUTO_MIDDLE] = k_of(config->middle_ms, config->rate_dhz);
    f->final_k_uq16[AUTO_FAST] = k_of(config->fast_ms, config->rate_dhz);
    f->still_uq16 = still_of(f->final_k_uq16[AUTO_MIDDLE]);
    f->gate_sigma_q8 = config->gate_sigma_q8;
    fx_scaled_t per_sample = fx_scaled_div(fx_scaled(config->rate_max_lsb_s * 10U), fx_scaled(config->rate_dhz));
    uint32_t limit = fx_scaled_fixed(per_sample, 16);
    f->rate_max_lsb_q16 = (limit < (uint32_t)X_MAX_LSB_Q16) ? limit : (uint32_t)X_MAX_LSB_Q16;
    auto_set_noise(f, config->r_lsb2_q8);
    auto_restart(f);
}

static bool legal(const auto_config_t *config)
{
    uint16_t gate = config->gate_sigma_q8;
    if (gate != 0U && (gate < GATE_MIN_SIGMA_Q8 || gate > GATE_MAX_SIGMA_Q8)) {
        return false;
    }
    return filter_common_legal(config->rate_dhz, config->r_lsb2_q8) && config->slow_ms != 0U &&
           config->slow_ms <= MEMORY_MAX_MS && config->middle_ms != 0U && config->middle_ms <= MEMORY_MAX_MS &&
           config->fast_ms != 0U && config->fast_ms <= MEMORY_MAX_MS && config->rate_max_lsb_s >= RATE_MAX_MIN_LSB_S &&
           config->rate_max_lsb_s <= RATE_MAX_MAX_LSB_S;
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

/* All members at rest at a position, with a memory to begin with or their own. */
static void all_at(auto_t *f, int32_t x_lsb_q16, bool settled)
{
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        auto_member_t *m = &f->u.members[i];
        filter_zero(m, sizeof *m);
        m->x_lsb_q16 = x_lsb_q16;
        m->k_uq16 = settled ? f->final_k_uq16[i] : K_START_UQ16;
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
    all_at(f, (int32_t)filter_limited_z(z0_lsb) * 65536, true);
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

FX_INLINE bool warming_up(const auto_t *f)
{
    return f->collected < FILTER_WARM_UP_SAMPLES;
}

/* One sample of the warm-up. */
static int32_t warm_up(auto_t *f, int16_t z_lsb)
{
    filter_warm_up_insert(f->u.start_lsb, f->collected, z_lsb);
    f->collected++;
    int32_t median_q16 = filter_warm_up_median_q16(f->u.start_lsb, f->collected);
    if (!warming_up(f)) {
        all_at(f, median_q16, false);
    }
    f->flags = FILTER_WARMING_UP;
    return median_q16;
}

/* Estimate in force: the running median while warming up. */
FX_NOINLINE int32_t estimate(const auto_t *f)
{
    if (!warming_up(f)) {
        return f->u.members[f->shown].x_lsb_q16;
    }
    return (f->collected == 0U) ? 0 : filter_warm_up_median_q16(f->u.start_lsb, f->collected);
}

/* One sample on; x within its bound by the high word: 4608 LSB and a fraction count as 4608. */
FX_INLINE void predict(auto_t *f, auto_member_t *m)
{
    int32_t x = m->x_lsb_q16 + m->rate_lsb_q16;
    uint16_t whole_lsb = (uint16_t)((uint32_t)x >> 16);
    if ((uint16_t)(whole_lsb + FILTER_X_MAX_LSB) >= 2U * FILTER_X_MAX_LSB) {
        x = (x < 0) ? -X_MAX_LSB_Q16 : X_MAX_LSB_Q16;
        f->flags |= FILTER_SATURATED;
    }
    m->x_lsb_q16 = x;
}

/* What the update of one member told. */
typedef struct {
    int32_t innovation_lsb_q16;
    uint16_t gain_uq16;
    uint8_t flags;
} answer_t;

/* A sample beyond the gate: one more on its side; the last of a run restarts the member at it. Returns the flag. */
FX_NOINLINE uint8_t refused(auto_member_t *m, bool below, int16_t z_lsb)
{
    int8_t run = m->refused;
    if (below) {
        run = (int8_t)((run < 0) ? run - 1 : -1);
    } else {
        run = (int8_t)((run > 0) ? run + 1 : 1);
    }
    m->refused = run;
    if (run < AUTO_RESTART_SAMPLES && run > -AUTO_RESTART_SAMPLES) {
        return FILTER_GATED;
    }
    m->x_lsb_q16 = (int32_t)z_lsb * 65536;
    m->rate_lsb_q16 = 0;
    m->k_uq16 = K_MAX_UQ16;
    m->refused = 0;
    return FILTER_REACQUIRED;
}

/* The member's gains, its memory half a sample longer, its state moved by the innovation. Returns the gain. */
FX_INLINE uint16_t correct(auto_t *f, auto_member_t *m, uint16_t final_k, uint32_t size_lsb_uq8, bool below)
{
    uint16_t k = m->k_uq16;
    uint32_t square_uq32 = fx_mul_u16(k, k);
    uint16_t square_uq16 = (uint16_t)(square_uq32 >> 16);
    uint16_t gain_uq16 = (uint16_t)(k + (uint16_t)(k - square_uq16)); /* <= 0.84 */
    if (k > final_k) {
        k = (uint16_t)(k - (square_uq16 >> 2) - 1U);
        m->k_uq16 = (k > final_k) ? k : final_k;
    }
    FX_FENCE();
    int32_t x_step = (int32_t)fx_mul24_uq16(size_lsb_uq8, gain_uq16);
    m->x_lsb_q16 += below ? -x_step : x_step;
    FX_FENCE();
    int32_t rate_step = (int32_t)fx_mul24_uq24(size_lsb_uq8, square_uq32 >> 8);
    int32_t rate = m->rate_lsb_q16 + (below ? -rate_step : rate_step);
    if (fx_abs32(rate) > f->rate_max_lsb_q16) {
        rate = (rate < 0) ? -(int32_t)f->rate_max_lsb_q16 : (int32_t)f->rate_max_lsb_q16;
        f->flags |= FILTER_SATURATED;
    }
    m->rate_lsb_q16 = rate;
    return gain_uq16;
}

/* One member one sample on: its score by the innovation, then its state. */
FX_NOINLINE void step(auto_t *f, uint8_t i, int16_t z_lsb, answer_t *a)
{
    auto_member_t *m = &f->u.members[i];
    uint16_t final_k = f->final_k_uq16[i];
    predict(f, m);
    int32_t innovation = (int32_t)z_lsb * 65536 - m->x_lsb_q16;
    a->innovation_lsb_q16 = innovation;
    bool below = innovation < 0;
    uint32_t size_lsb_uq8 = fx_abs32(innovation) >> 8;
    FX_FENCE();
    uint16_t bounded = f->eight_sigmas_lsb_uq8;
    if (size_lsb_uq8 < bounded) {
        bounded = (uint16_t)size_lsb_uq8;
    }
    m->score_lsb2_uq8 += (fx_mul_u16(bounded, bounded) >> 8) - (m->score_lsb2_uq8 >> 3);
    FX_FENCE();
    uint32_t gate_lsb_uq8 = f->gate_lsb_uq8;
    if (i == (uint8_t)AUTO_SLOW) {
        gate_lsb_uq8 += gate_lsb_uq8;
    }
    bool open = m->k_uq16 > K_OPEN_UQ16 && m->k_uq16 > final_k;
    if (size_lsb_uq8 > gate_lsb_uq8 && !open) {
        a->flags = refused(m, below, z_lsb);
        a->gain_uq16 = 0;
        return;
    }
    m->refused = 0;
    a->flags = 0;
    a->gain_uq16 = correct(f, m, final_k, size_lsb_uq8, below);
}

/* The member with the least score, if it lies a thirty-second below that of the one in force. */
static void choose(auto_t *f)
{
    uint8_t best = 0;
    for (uint8_t i = 1; i < (uint8_t)AUTO_MEMBERS; i++) {
        if (f->u.members[i].score_lsb2_uq8 < f->u.members[best].score_lsb2_uq8) {
            best = i;
        }
    }
    uint32_t in_force = f->u.members[f->chosen].score_lsb2_uq8;
    if (f->u.members[best].score_lsb2_uq8 < in_force - (in_force >> 5)) {
        f->chosen = best;
        f->flags |= FILTER_SWITCHED;
    }
}

/*
 * Scaling:
 *   input    Q0, any int16, clamped to -4096..4095 LSB
 *   x, rate  Q15.16; |x| <= 4608 LSB by a clamp after the prediction (the update moves x towards a sample within 4096),
 *            |rate| <= rate_max <= 4608 LSB per sample by a clamp after the update; so |u| <= 8704 LSB < 2^30 / 2^16,
 *            and rate + k^2 u <= 4608 + 0.36 x 8704 < 2^15 LSB
 *   k        UQ0.16, 1/256..0.6; gains 2 k - k^2 <= 0.84 in UQ0.16 and k^2 in UQ0.24, each rounded down
 *   u        rounded down to 2^-8 LSB in magnitude, products half away from zero to 2^-16: a member settles where
 *            k^2 u is below 2^-17 LSB, within 0.005 LSB with a memory of 50 samples, 0.3 with 400, 0.5 with 512
 *   score    UQ24.8, eight times the mean: s + l - s / 8 with l <= (8 x 31.63)^2 = 64 R <= 64,000 LSB^2, so
 *            s <= 8 l + 7 counts < 2^27; rounded down by less than a count a sample
 *   gate     UQ24.8 within 2^-8 LSB and 2^-11 of itself: 16 x 2 sigmas of 31.63 LSB are 1,012 LSB
 *   cost     docs/benchmarks.md
 */
int32_t auto_update(auto_t *f, int16_t z_lsb)
{
    int16_t z = filter_limited_z(z_lsb);
    if (warming_up(f)) {
        return warm_up(f, z);
    }
    answer_t answers[AUTO_MEMBERS];
    f->flags = 0;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        step(f, i, z, &answers[i]);
    }
    choose(f);
    f->shown = f->chosen;
    const answer_t *a = &answers[f->shown];
    f->innovation_lsb_q16 = a->innovation_lsb_q16;
    f->gain_uq16 = a->gain_uq16;
    f->flags |= a->flags;
    return f->u.members[f->shown].x_lsb_q16;
}

int32_t auto_coast(auto_t *f)
{
    if (warming_up(f)) {
        f->flags = FILTER_WARMING_UP | FILTER_COASTED;
        return estimate(f);
    }
    f->flags = FILTER_COASTED;
    f->innovation_lsb_q16 = 0;
    f->gain_uq16 = 0;
    f->shown = AUTO_MIDDLE;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        predict(f, &f->u.members[i]);
    }
    return f->u.members[AUTO_MIDDLE].x_lsb_q16;
}

/* Two sigmas of its rate, four times that while its memory grows. */
void auto_gap(auto_t *f)
{
    auto_member_t *m = &f->u.members[AUTO_MIDDLE];
    if (warming_up(f)) {
        return;
    }
    uint32_t still_lsb_q16 = fx_product_u16(f->eight_sigmas_lsb_uq8, f->still_uq16) >> 8;
    if (m->k_uq16 > f->final_k_uq16[AUTO_MIDDLE]) {
        still_lsb_q16 <<= 2;
    }
    if (fx_abs32(m->rate_lsb_q16) <= still_lsb_q16) {
        m->rate_lsb_q16 = 0;
    }
}

void auto_damp(auto_t *f)
{
    if (warming_up(f)) {
        return;
    }
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        f->u.members[i].rate_lsb_q16 >>= 1;
    }
}

void auto_hold(auto_t *f)
{
    if (warming_up(f)) {
        return;
    }
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        auto_member_t *m = &f->u.members[i];
        if (m->refused > 1) {
            m->refused = 1;
        } else if (m->refused < -1) {
            m->refused = -1;
        }
    }
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
    out->x_lsb_q16 = estimate(f);
    out->rate_lsb_q16 = running ? f->u.members[f->shown].rate_lsb_q16 : 0;
    out->innovation_lsb_q16 = f->innovation_lsb_q16;
    out->p_lsb2_q8 = running ? variance_lsb2_q8(f) : f->r_lsb2_q8;
    out->gate_lsb2_q8 = UINT32_MAX;
    out->gain_uq16 = f->gain_uq16;
    out->flags = f->flags;
}
