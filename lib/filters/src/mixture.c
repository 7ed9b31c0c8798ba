/*
 * pbf, shrf, af: one law of paper 002 with three presets. A sample is normal (variance R) with probability q, otherwise
 * an outlier (variance N^2 R), and is weighted by the probability p that it is normal, given those before (equations
 * (10)-(13), (25)-(30) with (29) corrected):
 *
 *   t = u^2 / (R S); b = 1 - S / S_N, S_N = P11 + N^2
 *   L = ln(q / (1 - q)) + 1/2 ln(S_N / S) - 1/2 b t;  p = 1 / (1 + e^-L)
 *   pbf, af   loss = b (1 - p), back = loss (1 + p b t)     both states of the channel, moments matched (GPB1)
 *   shrf      loss = 1 - p,     back = loss (1 + p t)       an outlier is not used at all
 *
 * with loss and back of wide.h. af learns q: q += (p - q) / n, n = 3, 4 .. 1024; reset clears it, restart does not. pbf
 * and shrf can expect outliers in runs, a Markov chain with the same share of outliers (equation (11)): q of the next
 * sample is 1 - stay + p (clean + stay - 1) / clean, where stay is the probability that an outlier follows an outlier.
 * There is no lock-out: an outlier moves the estimate of pbf a little, and raises P in proportion to how unexpected the
 * sample is. If P is at the end of its range (32,768 R) and the sample is still certainly an outlier, shrf restarts
 * from it (FILTER_REACQUIRED). FILTER_GATED means that the sample is more likely an outlier than not; its gain is
 * small, with shrf possibly 0. Parameters r, q, ratio (N), clean (q: at least one half, or a sample on the prediction
 * would count as an outlier; af starts from it), stay (0: outliers are independent; otherwise at least 1 - clean, and
 * below N / (N + 1), so that a sample on the prediction counts as normal after an outlier too while P11 is small; up to
 * 500 Hz, because a logarithm per sample costs 500 cycles more than the law declares).
 */
#include "mixture.h"

#include "wide.h"

#define ONE_UQ16 0x10000U
#define ONE_UQ24 0x1000000U
#define LN2_UQ16 45426U
#define HALF_LN2_UQ16 22713U
#define LEARNT_FROM_START 2U
#define LEARNT_FROM_MAX 1024U

#define CLEAN_MIN_UQ16 32768
#define CLEAN_MAX_UQ16 65470

LAW_PARAMETER(ratio, "ratio\0", 8, 0, 512, 25600, 5120);
LAW_PARAMETER(clean, "clean\0", 16, 0, CLEAN_MIN_UQ16, CLEAN_MAX_UQ16, 55706);
LAW_PARAMETER(stay, "stay\0", 16, 1, ONE_UQ16 - CLEAN_MAX_UQ16, 64880, 0);
/* af does not have the last one. */
static const filter_parameter_t *const parameters[] IN_FLASH = { &filter_parameter_r, &filter_parameter_q, &ratio,
                                                                 &clean, &stay };

/* 0.1 Hz */
#define CHAIN_RATE_MAX_DHZ 5000U

static bool together(const filter_config_t *config)
{
    uint32_t stay_uq16 = (uint32_t)config->value[MIXTURE_STAY_UQ16];
    uint32_t ratio_uq8 = (uint32_t)config->value[MIXTURE_RATIO_UQ8];
    return stay_uq16 == 0U || (config->rate_dhz <= CHAIN_RATE_MAX_DHZ &&
                               stay_uq16 + (uint32_t)config->value[MIXTURE_CLEAN_UQ16] >= ONE_UQ16 &&
                               stay_uq16 * (ratio_uq8 + 256U) < ratio_uq8 << 16);
}

/*
 * Node i: 1 / (1 + e^(i/2)) less h^2/16 x second derivative, h = 1/2: half of the distance of the chord above the
 * curve.
 */
static const uint32_t rest_nodes_uq24[25] IN_FLASH = {
    8388608, 6318993, 4488271, 3035759, 1978931, 1257100, 784955, 484756, 297295, 181544, 110568, 67232, 40840,
    24794,   15047,   9129,    5538,    3360,    2038,    1236,   750,    455,    276,    167,    101,
};

/* Node i: log2(1 + i/8) - i/8. */
static const uint8_t log2_nodes_uq11[9] IN_FLASH = { 0, 92, 147, 173, 174, 155, 117, 65, 0 };

/* log2 from the leading bits, plus a constant that cancels in differences. */
static uint16_t log2_uq9(fx_leading_t v)
{
    uint16_t linear_uq9 = (uint16_t)((uint16_t)(fx_mantissa(v) << 1) >> 7);
    uint8_t high = (uint8_t)(linear_uq9 >> 1);
    const uint8_t *node = &log2_nodes_uq11[high >> 5];
    uint8_t right = high & 31U;
    uint8_t left = (uint8_t)(32U - right);
    uint16_t bow_uq16 = (uint16_t)((uint16_t)(flash_u8(node) * (uint16_t)left) +
                                   (uint16_t)(flash_u8(node + 1) * (uint16_t)right));
    uint16_t whole_uq9 = (uint16_t)((uint16_t)(uint8_t)(62U - 2U * fx_places(v)) << 8);
    return (uint16_t)(whole_uq9 + linear_uq9 + ((uint16_t)(bow_uq16 + 64U) >> 7));
}

int16_t filter_mixture_log_odds_q9(uint32_t q_uq24)
{
    uint16_t normal = log2_uq9(filter_fx_leading(q_uq24));
    uint16_t outlier = log2_uq9(filter_fx_leading(ONE_UQ24 - q_uq24));
    if (normal >= outlier) {
        uint16_t above_uq9 = (uint16_t)(normal - outlier);
        /*@ assert above_uq9 <= 16480; */ /* for make proof: the larger less the smaller, within the bound of both */
        return (int16_t)filter_fx_high_u16(above_uq9, LN2_UQ16);
    }
    uint16_t below_uq9 = (uint16_t)(outlier - normal);
    /*@ assert below_uq9 <= 16480; */
    return (int16_t)(0 - (int16_t)filter_fx_high_u16(below_uq9, LN2_UQ16));
}

mixture_posterior_t filter_mixture_posterior(int16_t log_odds_q9)
{
    mixture_posterior_t posterior = { 0, log_odds_q9 < 0 };
    uint16_t size_uq9 = (uint16_t)((log_odds_q9 < 0) ? 0 - log_odds_q9 : log_odds_q9);
    if (size_uq9 < MIXTURE_TAIL_Q9) {
        const uint32_t *node = &rest_nodes_uq24[size_uq9 >> 8];
        uint32_t left = flash_u32(node);
        uint16_t right_uq16 = (uint16_t)(size_uq9 << 8);
        posterior.rest_uq24 = left - filter_fx_mul_uq16(left - flash_u32(node + 1), right_uq16);
    }
    return posterior;
}

/* Sets q for the following samples, kept away from 0 and 1. */
static void believe(filter_mixture_t *m, uint32_t q_uq24)
{
    if (q_uq24 < MIXTURE_MARGIN_UQ24) {
        q_uq24 = MIXTURE_MARGIN_UQ24;
    } else if (q_uq24 > ONE_UQ24 - MIXTURE_MARGIN_UQ24) {
        q_uq24 = ONE_UQ24 - MIXTURE_MARGIN_UQ24;
    }
    m->normal_uq24 = q_uq24;
    m->log_odds_q9 = filter_mixture_log_odds_q9(q_uq24);
}

/* q as configured; drops what was learnt. */
static void forget(filter_mixture_t *m)
{
    believe(m, (uint32_t)m->clean_uq16 << 8);
    if (m->learnt_from != 0U) {
        m->learnt_from = LEARNT_FROM_START;
    }
}

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_mixture_t *m = &f->own.mixture;
    uint16_t ratio_uq8 = (uint16_t)config->value[MIXTURE_RATIO_UQ8];
    m->span_uq16 = fx_product_u16(ratio_uq8, ratio_uq8) - ONE_UQ16;
    m->clean_uq16 = (uint16_t)config->value[MIXTURE_CLEAN_UQ16];
    forget(m);
    filter_wide_set_up(f, config);
}

static void chain_set_up(filter_t *f, const filter_config_t *config)
{
    filter_mixture_t *m = &f->own.mixture;
    uint32_t clean_uq16 = (uint32_t)config->value[MIXTURE_CLEAN_UQ16];
    uint32_t stay_uq16 = (uint32_t)config->value[MIXTURE_STAY_UQ16];
    uint32_t sum_uq16 = clean_uq16 + stay_uq16;
    if (stay_uq16 != 0U) {
        m->leave_uq16 = (uint16_t)(ONE_UQ16 - stay_uq16);
        if (sum_uq16 > ONE_UQ16) { /* (clean + stay - 1) / clean, within 2^-14 of it */
            fx_scaled_t turn = filter_fx_scaled_div(filter_fx_scaled(sum_uq16 - ONE_UQ16),
                                                    filter_fx_scaled(clean_uq16));
            uint32_t turn_uq16 = filter_fx_scaled_fixed(turn, 16);
            m->turn_uq16 = (turn_uq16 > UINT16_MAX) ? UINT16_MAX : (uint16_t)turn_uq16;
        }
    }
    set_up(f, config);
}

static void af_set_up(filter_t *f, const filter_config_t *config)
{
    f->own.mixture.learnt_from = LEARNT_FROM_START;
    set_up(f, config);
}

/* af has no opinion before its first sample: one half. */
static void af_standard(filter_config_t *config)
{
    config->value[MIXTURE_CLEAN_UQ16] = CLEAN_MIN_UQ16;
}

static void start(filter_t *f, bool settled)
{
    if (settled || f->own.mixture.leave_uq16 != 0U) { /* a chain restarts; what was learnt is kept */
        forget(&f->own.mixture);
    }
    filter_wide_start(f, settled);
}

static uint32_t normal_uq24(mixture_posterior_t posterior)
{
    return posterior.outlier ? posterior.rest_uq24 : ONE_UQ24 - posterior.rest_uq24;
}

/* The chain: q of the next sample from the probability that this one, or a missing one, is normal. */
static void expect_next(filter_mixture_t *m, uint32_t p_uq24)
{
    believe(m, ((uint32_t)m->leave_uq16 << 8) + filter_fx_mul_uq16(p_uq24, m->turn_uq16));
}

/* Averages p into the mean of those before: q += (p - q) / n. */
static void learn(filter_mixture_t *m, uint32_t p)
{
    if (m->learnt_from < LEARNT_FROM_MAX) {
        m->learnt_from++;
    }
    fx_leading_t n = filter_fx_leading(m->learnt_from); /* 1..2 x 2^(31 - places) */
    uint32_t q = m->normal_uq24;
    bool rises = p >= q;
    uint32_t part = filter_fx_shift_right(filter_fx_mul_uq16(rises ? p - q : q - p, filter_fx_inverse_uq16(n)),
                                          (uint8_t)(31U - fx_places(n)));
    believe(m, rises ? q + part : q - part); /* a mean of p and q: within 0..1 */
}

/* What the distance of a sample says about it. */
typedef struct {
    uint16_t t_uq8;  /* r^2 / (R S) */
    uint16_t b_uq16; /* 1 - S / S_N */
    uint16_t tb_uq8; /* their product */
    mixture_posterior_t p;
} evidence_t;

static evidence_t weigh(const filter_t *f)
{
    const filter_mixture_t *m = &f->own.mixture;
    evidence_t e;
    fx_leading_t span = filter_fx_leading(m->span_uq16);
    fx_leading_t outlier = filter_fx_leading(m->core.p.p11 + ONE_UQ16 + m->span_uq16); /* S_N < 33,033 + 10,000 */
    /* (N^2 - 1) / S_N < 1: its leading bits are at most those of S_N, and the quotient of mantissas less than 2 */
    uint16_t share_uq15 = filter_fx_high_u16(fx_mantissa(span), filter_fx_inverse_uq16(outlier));
    uint32_t share_uq16 = filter_fx_shift_right((uint32_t)share_uq15 << 1,
                                                (uint8_t)(fx_places(span) - fx_places(outlier)));
    e.b_uq16 = (share_uq16 > UINT16_MAX) ? UINT16_MAX : (uint16_t)share_uq16;
    e.t_uq8 = filter_wide_distance_uq8(f);
    e.tb_uq8 = filter_fx_high_u16(e.t_uq8, e.b_uq16);
    /* half of tb in Q9 is the same number as tb in Q8 */
    uint16_t half_uq9 = (e.tb_uq8 > 0x4000U) ? 0x4000U : e.tb_uq8;
    uint16_t spread_uq9 = filter_fx_high_u16((uint16_t)(log2_uq9(outlier) - log2_uq9(m->core.variance)), HALF_LN2_UQ16);
    /*@ assert spread_uq9 <= 5712; */ /* for make proof: S <= S_N, log2 in UQ.9 < 16480 */
    e.p = filter_mixture_posterior((int16_t)(m->log_odds_q9 + (int16_t)spread_uq9 - (int16_t)half_uq9));
    return e;
}

/* Updates with p. False: certainly an outlier, and the rule does not use it. */
static bool apply(filter_t *f, const evidence_t *e, bool shortened)
{
    bool certain = e->p.rest_uq24 == 0U;
    uint16_t loss_uq16 = (uint16_t)((e->p.rest_uq24 + 128U) >> 8); /* 1 - p */
    uint32_t p_uq24 = ONE_UQ24 - e->p.rest_uq24;
    if (e->p.outlier) {
        if (certain && shortened) {
            return false;
        }
        p_uq24 = e->p.rest_uq24;
        loss_uq16 = (loss_uq16 == 0U) ? UINT16_MAX : (uint16_t)(0U - loss_uq16);
    }
    uint16_t t_uq8 = e->t_uq8;
    if (!shortened) {
        t_uq8 = e->tb_uq8;
        loss_uq16 = (certain && e->p.outlier) ? e->b_uq16 : filter_fx_high_u16(e->b_uq16, loss_uq16);
    }
    uint32_t back_uq16 = filter_fx_mul_uq16(filter_fx_mul_uq16(p_uq24, t_uq8), loss_uq16) + loss_uq16;
    filter_wide_correct(f, loss_uq16, (back_uq16 > WIDE_BACK_MAX_UQ16) ? WIDE_BACK_MAX_UQ16 : back_uq16);
    return true;
}

static void mixed(filter_t *f, int16_t z_lsb, uint8_t what, bool shortened)
{
    filter_mixture_t *m = &f->own.mixture;
    bool grows = filter_wide_predict(f, z_lsb);
    if (what == STEP_SETTLE) {
        filter_wide_correct(f, 0, 0);
    }
    if (what == STEP_MISSING && m->leave_uq16 != 0U) {
        expect_next(m, m->normal_uq24);
    }
    if (what != STEP_SAMPLE) {
        return;
    }
    evidence_t e = weigh(f);
    if (m->leave_uq16 != 0U) {
        expect_next(m, normal_uq24(e.p));
    } else if (m->learnt_from != 0U) {
        learn(m, normal_uq24(e.p));
    }
    if (!apply(f, &e, shortened)) {
        filter_wide_refuse(f, grows);
    } else if (e.p.outlier) {
        f->flags |= FILTER_GATED;
    }
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    mixed(f, z_lsb, what, false);
}

static void shortened_step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    mixed(f, z_lsb, what, true);
}

const filter_law_t filter_law_pbf IN_FLASH = { .parameter_count = 5,
                                               .traits = LAW_COVARIANCE | LAW_GATED,
                                               .worst_cycles = 3650,
                                               .parameters = parameters,
                                               .together = together,
                                               .set_up = chain_set_up,
                                               .set_noise = filter_wide_set_noise,
                                               .start = start,
                                               .step = step,
                                               .report = LAW_REPORT(filter_wide_report),
                                               .name = "pbf" };

const filter_law_t filter_law_shrf IN_FLASH = { .parameter_count = 5,
                                                .traits = LAW_COVARIANCE | LAW_GATED,
                                                .worst_cycles = 3650,
                                                .parameters = parameters,
                                                .together = together,
                                                .set_up = chain_set_up,
                                                .set_noise = filter_wide_set_noise,
                                                .start = start,
                                                .step = shortened_step,
                                                .report = LAW_REPORT(filter_wide_report),
                                                .name = "shrf" };

const filter_law_t filter_law_af IN_FLASH = { .parameter_count = 4,
                                              .traits = LAW_COVARIANCE | LAW_GATED,
                                              .worst_cycles = 4350,
                                              .parameters = parameters,
                                              .standard = af_standard,
                                              .set_up = af_set_up,
                                              .set_noise = filter_wide_set_noise,
                                              .start = start,
                                              .step = step,
                                              .report = LAW_REPORT(filter_wide_report),
                                              .name = "af" };
