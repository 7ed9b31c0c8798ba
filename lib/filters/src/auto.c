/*
 * auto: three fading-memory filters side by side on the same samples. The estimate is that of the member that has
 * predicted best recently: paper 004's rule, prediction against measurement, within one sensor.
 *
 *   x_e = x + v,  u = z - x_e,  x = x_e + (2 k - k^2) u,  v = v + k^2 u      k = 2 / memory in samples
 *
 * with a slow, a middle and a fast memory. Each member refuses a sample beyond its gate (the slow one, which lags in
 * motion, has twice the gate of the others). Five refused samples in a row on the same side restart it there, at rest,
 * with a memory that grows by half a sample per sample up to its own.
 *
 * Each innovation is formed before its member is updated, for refused samples too. The score of a member is the
 * exponential mean over eight samples of min(u^2, 64 R), so that an outlier, which hits all members alike, cannot
 * decide alone. The member with the lowest score is chosen, for the current sample already, if its score is lower than
 * that of the one in force by more than a thirty-second; FILTER_SWITCHED reports it. Missing samples leave the scores
 * unchanged.
 *
 * Through missing samples each member coasts at its rate, and the estimate is that of the middle one: its rate is quiet
 * enough for a gap at rest and quick enough for one in motion (fade: set to 0 where it may be noise). Parameters gate
 * (in sigmas of a sample; 0: none), r, slow, middle, fast (memories, each limited to 3.3..512 samples, in any order),
 * ratemax.
 *
 * Scaling:
 *   x, rate  Q15.16; |x| <= 4608 LSB by a clamp after the prediction (the update moves x towards a sample within 4096),
 *            |rate| <= rate_max <= 4608 LSB per sample by a clamp after the update; so |u| <= 8704 LSB < 2^30 / 2^16,
 *            and rate + k^2 u <= 4608 + 0.36 x 8704 < 2^15 LSB
 *   k        UQ0.16, 1/256..0.6; gains 2 k - k^2 <= 0.84 in UQ0.16 and k^2 in UQ0.24, each rounded down
 *   u        magnitude rounded down to 2^-8 LSB, products half away from zero to 2^-16: a member settles where
 *            k^2 u is below 2^-17 LSB, within 0.005 LSB with a memory of 50 samples, 0.3 with 400, 0.5 with 512
 *   score    UQ24.8, eight times the mean: s + l - s / 8 with l <= (8 x 31.63)^2 = 64 R <= 64,000 LSB^2, so
 *            s <= 8 l + 7 counts < 2^27; rounded down by less than a count per sample
 *   gate     UQ24.8, absolute error 2^-8 LSB, relative 2^-11: 16 x 2 sigmas of 31.63 LSB are 1,012 LSB
 */
#include "tracker.h"

LAW_KEEPS_FROM(filter_auto_t, eight_sigmas_lsb_uq8);

/* k = 2 / 512: with a longer memory the rate would round to zero. */
#define K_MIN_UQ16 256U
/* The median of five samples is worth a memory of about four. */
#define K_START_UQ16 32768U
/* A member with a memory shorter than eight samples takes every sample until its memory has grown to its own. */
#define K_OPEN_UQ16 16384U
#define NO_GATE_LSB_UQ8 0x7FFFFFFFU
/* Refused samples in a row on one side that restart a member. */
#define RESTART_SAMPLES 5

LAW_PARAMETER(gate, "gate\0sigma", 8, 1, 256, 4096, 1536);
LAW_PARAMETER(slow, "slow\0ms", 0, 0, 1, 60000, 0);
LAW_PARAMETER(middling, "middle\0ms", 0, 0, 1, 60000, 0);
LAW_PARAMETER(fast, "fast\0ms", 0, 0, 1, 60000, 0);
static const filter_parameter_t *const parameters[] IN_FLASH = { &gate, &filter_parameter_r,      &slow, &middling,
                                                                 &fast, &filter_parameter_ratemax };

/* A number of samples in ms, at least least_ms. */
static uint16_t memory_ms(uint16_t rate_dhz, uint32_t samples, uint16_t least_ms)
{
    uint32_t ms = samples * 10000U / rate_dhz;
    if (ms > 60000U) {
        return 60000U;
    }
    return (ms > least_ms) ? (uint16_t)ms : least_ms;
}

static void standard(filter_config_t *config)
{
    config->value[AUTO_SLOW_MS] = memory_ms(config->rate_dhz, 28, 500);
    config->value[AUTO_MIDDLE_MS] = memory_ms(config->rate_dhz, 11, 200);
    config->value[AUTO_FAST_MS] = memory_ms(config->rate_dhz, 5, 80);
}

/*
 * 1/8 of two sigmas of the rate for noise of sigma 1: with t = k / (2 - k) the variance of the rate is 2 t^3, so it is
 * sqrt(t) t / sqrt(8).
 */
static uint16_t still_of(uint16_t k_uq16)
{
    uint32_t t_uq16 = ((uint32_t)k_uq16 << 15) / (0x20000U - k_uq16) << 1; /* <= 3/7 */
    uint16_t root_uq16 = filter_fx_isqrt32(t_uq16 << 16);
    return filter_fx_high_u16(filter_fx_high_u16(root_uq16, (uint16_t)t_uq16), 23170);
}

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_auto_t *b = &f->own.bank;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        b->final_k_uq16[i] = filter_tracker_memory_k_uq16((uint16_t)config->value[AUTO_SLOW_MS + i], config->rate_dhz,
                                                          K_MIN_UQ16);
    }
    b->still_uq16 = still_of(b->final_k_uq16[AUTO_MIDDLE]);
    b->gate_sigma_q8 = (uint16_t)config->value[AUTO_GATE_SIGMA_Q8];
    filter_tracker_limit_rate(f, (uint32_t)config->value[AUTO_RATE_MAX_LSB_S], 16);
    filter_set_noise(f, (uint32_t)config->value[AUTO_R_LSB2_Q8]);
}

/* Scores are kept: they are in LSB^2, and forgotten after about eight samples anyway. */
static void set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    f->own.bank.eight_sigmas_lsb_uq8 = filter_fx_isqrt32(r_lsb2_q8 << 14); /* <= 64763 */
}

/* All members at rest, with the memory of the start or, if settled, their own: at rest the slow one predicts best. */
static void start(filter_t *f, bool settled)
{
    filter_auto_t *b = &f->own.bank;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        filter_member_t member = { f->x_lsb_q16, 0, 0, settled ? b->final_k_uq16[i] : K_START_UQ16, 0 };
        b->members[i] = member;
    }
    b->chosen = settled ? AUTO_SLOW : AUTO_MIDDLE;
    b->shown = b->chosen;
}

static int32_t within_rate(filter_t *f, int32_t rate_lsb_q16)
{
    if (filter_fx_abs32(rate_lsb_q16) > f->rate_max_lsb) {
        rate_lsb_q16 = (rate_lsb_q16 < 0) ? -(int32_t)f->rate_max_lsb : (int32_t)f->rate_max_lsb;
        f->flags |= FILTER_SATURATED;
    }
    return rate_lsb_q16;
}

/* Predicts one sample ahead. */
static void predict_member(filter_t *f, filter_member_t *m)
{
    m->x_lsb_q16 = tracker_bounded(f, m->x_lsb_q16 + m->rate_lsb_q16);
}

/* Result of one member's update. */
typedef struct {
    int32_t innovation_lsb_q16;
    uint16_t gain_uq16;
    uint8_t flags;
} answer_t;

/*
 * A sample beyond the gate: extends the run on its side; the last of a run restarts the member at it. Returns the flag.
 */
static uint8_t refused(filter_member_t *m, bool below, int16_t z_lsb)
{
    int8_t run = m->refused;
    if (below) {
        run = (int8_t)((run < 0) ? run - 1 : -1);
    } else {
        run = (int8_t)((run > 0) ? run + 1 : 1);
    }
    m->refused = run;
    if (run < RESTART_SAMPLES && run > -RESTART_SAMPLES) {
        return FILTER_GATED;
    }
    m->x_lsb_q16 = (int32_t)z_lsb * 65536;
    m->rate_lsb_q16 = 0;
    m->k_uq16 = TRACKER_K_MAX_UQ16;
    m->refused = 0;
    return FILTER_REACQUIRED;
}

/* Corrects a member: gains, memory longer by half a sample, state moved by the innovation. Returns the gain. */
static uint16_t correct(filter_t *f, filter_member_t *m, uint16_t final_k, uint32_t size_lsb_uq8, bool below)
{
    uint16_t k = m->k_uq16;
    uint32_t square_uq32 = fx_product_u16(k, k);
    uint16_t square_uq16 = (uint16_t)(square_uq32 >> 16);
    uint16_t gain_uq16 = (uint16_t)(k + (uint16_t)(k - square_uq16)); /* <= 0.84 */
    if (k > final_k) {
        k = (uint16_t)(k - (square_uq16 >> 2) - 1U);
        m->k_uq16 = (k > final_k) ? k : final_k;
    }
    int32_t x_step = (int32_t)filter_fx_mul24_uq16(size_lsb_uq8, gain_uq16);
    m->x_lsb_q16 += below ? -x_step : x_step;
    int32_t rate_step = (int32_t)filter_fx_mul24_uq24(size_lsb_uq8, square_uq32 >> 8);
    m->rate_lsb_q16 = within_rate(f, m->rate_lsb_q16 + (below ? -rate_step : rate_step));
    return gain_uq16;
}

/* One step of one member: its score from the innovation, then its state. */
static void step_member(filter_t *f, uint8_t i, int16_t z_lsb, uint32_t gate_lsb_uq8, answer_t *a)
{
    filter_auto_t *b = &f->own.bank;
    filter_member_t *m = &b->members[i];
    MACHINE_FENCE(m); /* otherwise computed from i at each use */
    uint16_t final_k = b->final_k_uq16[i];
    predict_member(f, m);
    int32_t innovation = (int32_t)z_lsb * 65536 - m->x_lsb_q16;
    a->innovation_lsb_q16 = innovation;
    bool below = innovation < 0;
    uint32_t size_lsb_uq8 = filter_fx_abs32(innovation) >> 8;
    uint16_t bounded = b->eight_sigmas_lsb_uq8;
    if (size_lsb_uq8 < bounded) {
        bounded = (uint16_t)size_lsb_uq8;
    }
    uint32_t square_lsb2_uq8 = fx_product_u16(bounded, bounded) >> 8;
    m->score_lsb2_uq8 = m->score_lsb2_uq8 - (m->score_lsb2_uq8 >> 3) + square_lsb2_uq8;
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

/* Chooses the member with the lowest score, if lower than that of the one in force by more than a thirty-second. */
static void choose(filter_t *f)
{
    filter_auto_t *b = &f->own.bank;
    uint8_t best = 0;
    for (uint8_t i = 1; i < (uint8_t)AUTO_MEMBERS; i++) {
        if (b->members[i].score_lsb2_uq8 < b->members[best].score_lsb2_uq8) {
            best = i;
        }
    }
    uint32_t in_force = b->members[b->chosen].score_lsb2_uq8;
    if (b->members[best].score_lsb2_uq8 < in_force - (in_force >> 5)) {
        b->chosen = best;
        f->flags |= FILTER_SWITCHED;
    }
}

/* Shows the estimate of a member. */
static void show(filter_t *f, uint8_t member)
{
    filter_auto_t *b = &f->own.bank;
    b->shown = member;
    f->x_lsb_q16 = b->members[member].x_lsb_q16;
    f->rate_lsb = b->members[member].rate_lsb_q16;
}

static uint32_t gate_of(const filter_auto_t *b)
{
    return (b->gate_sigma_q8 == 0U) ? NO_GATE_LSB_UQ8 : fx_product_u16(b->eight_sigmas_lsb_uq8, b->gate_sigma_q8) >> 11;
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    filter_auto_t *b = &f->own.bank;
    if (what == STEP_MISSING) {
        for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
            predict_member(f, &b->members[i]);
        }
        show(f, AUTO_MIDDLE);
        return;
    }
    answer_t answers[AUTO_MEMBERS];
    uint32_t gate_lsb_uq8 = gate_of(b);
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        step_member(f, i, z_lsb, gate_lsb_uq8, &answers[i]);
    }
    choose(f);
    const answer_t *a = &answers[b->chosen];
    f->negative = a->innovation_lsb_q16 < 0;
    f->size_lsb_uq16 = filter_fx_abs32(a->innovation_lsb_q16);
    f->gain_uq16 = a->gain_uq16;
    f->flags |= a->flags;
    show(f, b->chosen);
}

/*
 * In a gap the middle member's rate is kept if it exceeds two of its sigmas, eight while its memory is still growing.
 */
static void fade(filter_t *f, bool first)
{
    filter_auto_t *b = &f->own.bank;
    filter_member_t *m = &b->members[AUTO_MIDDLE];
    if (!first) {
        for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
            b->members[i].rate_lsb_q16 >>= 1;
        }
        return;
    }
    uint32_t still_lsb_q16 = fx_product_u16(b->eight_sigmas_lsb_uq8, b->still_uq16) >> 8;
    if (m->k_uq16 > b->final_k_uq16[AUTO_MIDDLE]) {
        still_lsb_q16 <<= 2;
    }
    if (filter_fx_abs32(m->rate_lsb_q16) <= still_lsb_q16) {
        m->rate_lsb_q16 = 0;
    }
}

static void report(const filter_t *f, filter_probe_t *out)
{
    const filter_auto_t *b = &f->own.bank;
    uint16_t sigmas = b->eight_sigmas_lsb_uq8;
    out->p_lsb2_q8 = (fx_product_u16(sigmas, sigmas) + 0x3FFFU) >> 14;
    if (f->collected == FILTER_RUNNING) {
        out->p_lsb2_q8 = filter_tracker_fading_variance(out->p_lsb2_q8, b->members[b->shown].k_uq16);
    }
}

const filter_law_t filter_law_auto IN_FLASH = { .parameter_count = 6,
                                                .traits = LAW_GATED,
                                                .worst_cycles = 2690,
                                                .parameters = parameters,
                                                .standard = standard,
                                                .set_up = set_up,
                                                .set_noise = set_noise,
                                                .start = start,
                                                .step = step,
                                                .fade = fade,
                                                .report = LAW_REPORT(report),
                                                .name = "auto" };
