/* Posterior probability of a normal sample, and the update by it: see mixture.h for the equations. */
#include "mixture.h"

#define ONE_UQ16 0x10000U
#define ONE_UQ24 0x1000000U
#define LN2_UQ16 45426U
#define HALF_LN2_UQ16 22713U
#define LEARNT_FROM_START 2U
#define LEARNT_FROM_MAX 1024U

const filter_parameter_t mixture_parameters[MIXTURE_PARAMETERS] FX_FLASH = {
    { "r", "LSB2", offsetof(mixture_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(mixture_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3,
      TWO_STATE_Q_MAX_LSB2_S3 },
    { "ratio", "", offsetof(mixture_config_t, ratio_uq8), 2, 8, 0, 0, MIXTURE_RATIO_MIN_Q8, MIXTURE_RATIO_MAX_Q8 },
    { "clean", "", offsetof(mixture_config_t, clean_uq16), 2, 16, 0, 0, MIXTURE_CLEAN_MIN_UQ16,
      MIXTURE_CLEAN_MAX_UQ16 },
};

/* Node i: 1 / (1 + e^(i/2)) less h^2/16 x second derivative, h = 1/2: half of how far the chord is above the curve. */
static const uint32_t rest_nodes_uq24[25] FX_FLASH = {
    8388608, 6318993, 4488271, 3035759, 1978931, 1257100, 784955, 484756, 297295, 181544, 110568, 67232, 40840,
    24794,   15047,   9129,    5538,    3360,    2038,    1236,   750,    455,    276,    167,    101,
};

/* Node i: log2(1 + i/8) - i/8. */
static const uint8_t log2_nodes_uq11[9] FX_FLASH = { 0, 92, 147, 173, 174, 155, 117, 65, 0 };

void mixture_defaults(mixture_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
    config->ratio_uq8 = MIXTURE_RATIO_DEFAULT_Q8;
    config->clean_uq16 = MIXTURE_CLEAN_DEFAULT_UQ16;
}

/* log2 of a number by its leading bits, plus a constant that differences lose. */
static uint16_t log2_uq9(fx_leading_t v)
{
    uint16_t linear_uq9 = (uint16_t)((uint16_t)(fx_mantissa(v) << 1) >> 7);
    uint8_t high = (uint8_t)(linear_uq9 >> 1);
    const uint8_t *node = &log2_nodes_uq11[high >> 5];
    uint8_t right = high & 31U;
    uint8_t left = (uint8_t)(32U - right);
    uint16_t bow_uq16 = (uint16_t)((uint16_t)(fx_flash_u8(node) * (uint16_t)left) +
                                   (uint16_t)(fx_flash_u8(node + 1) * (uint16_t)right));
    uint16_t whole_uq9 = (uint16_t)((uint16_t)(uint8_t)(62U - 2U * fx_places(v)) << 8);
    return (uint16_t)(whole_uq9 + linear_uq9 + ((uint16_t)(bow_uq16 + 64U) >> 7));
}

int16_t mixture_log_odds_q9(uint32_t q_uq24)
{
    uint16_t normal = log2_uq9(fx_leading(q_uq24));
    uint16_t outlier = log2_uq9(fx_leading(ONE_UQ24 - q_uq24));
    if (normal >= outlier) {
        uint16_t above_uq9 = (uint16_t)(normal - outlier);
        /*@ assert above_uq9 <= 16480; */ /* for make proof: the larger less the smaller, in the bound of both */
        return (int16_t)fx_high_u16(above_uq9, LN2_UQ16);
    }
    uint16_t below_uq9 = (uint16_t)(outlier - normal);
    /*@ assert below_uq9 <= 16480; */
    return (int16_t)(0 - (int16_t)fx_high_u16(below_uq9, LN2_UQ16));
}

mixture_posterior_t mixture_posterior(int16_t log_odds_q9)
{
    mixture_posterior_t posterior = { 0, log_odds_q9 < 0 };
    uint16_t size_uq9 = (uint16_t)((log_odds_q9 < 0) ? 0 - log_odds_q9 : log_odds_q9);
    if (size_uq9 < MIXTURE_TAIL_Q9) {
        const uint32_t *node = &rest_nodes_uq24[size_uq9 >> 8];
        uint32_t left = fx_flash_u32(node);
        uint16_t right_uq16 = (uint16_t)(size_uq9 << 8);
        posterior.rest_uq24 = left - fx_times_uq16(left - fx_flash_u32(node + 1), right_uq16);
    }
    return posterior;
}

static bool legal(const mixture_config_t *config)
{
    return two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3) &&
           (uint16_t)(config->ratio_uq8 - MIXTURE_RATIO_MIN_Q8) <= MIXTURE_RATIO_MAX_Q8 - MIXTURE_RATIO_MIN_Q8 &&
           (uint16_t)(config->clean_uq16 - MIXTURE_CLEAN_MIN_UQ16) <=
               MIXTURE_CLEAN_MAX_UQ16 - MIXTURE_CLEAN_MIN_UQ16; /* below the range is above it, modulo 2^16 */
}

static void forget(mixture_t *f)
{
    f->learnt_uq24 = (uint32_t)f->clean_uq16 << 8;
    f->log_odds_q9 = mixture_log_odds_q9(f->learnt_uq24);
    if (f->learnt_from != 0U) {
        f->learnt_from = LEARNT_FROM_START;
    }
}

void mixture_configure(mixture_t *f, const mixture_config_t *config, bool learning)
{
    two_state_wide_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3);
    f->span_uq16 = fx_mul_u16(config->ratio_uq8, config->ratio_uq8) - ONE_UQ16;
    f->span = fx_leading(f->span_uq16);
    f->clean_uq16 = config->clean_uq16;
    f->learnt_from = learning ? LEARNT_FROM_START : 0U;
    forget(f);
}

bool mixture_init(mixture_t *f, const mixture_config_t *config, bool learning)
{
    if (!legal(config)) {
        return false;
    }
    mixture_configure(f, config, learning);
    return true;
}

void mixture_reset(mixture_t *f, int16_t z0_lsb)
{
    forget(f);
    two_state_wide_reset(&f->core, z0_lsb);
}

bool mixture_reset_step(mixture_t *f, int16_t z0_lsb, uint8_t step)
{
    if (step == 0U) {
        forget(f);
    }
    return two_state_wide_reset_step(&f->core, z0_lsb, step);
}

/* p into the mean of those before: q += (p - q) / n. */
static void learn(mixture_t *f, mixture_posterior_t posterior)
{
    if (f->learnt_from < LEARNT_FROM_MAX) {
        f->learnt_from++;
    }
    fx_leading_t n = fx_leading(f->learnt_from); /* 1..2 x 2^(31 - places) */
    uint32_t p = posterior.outlier ? posterior.rest_uq24 : ONE_UQ24 - posterior.rest_uq24;
    uint32_t q = f->learnt_uq24;
    bool rises = p >= q;
    uint32_t part = fx_shifted_right(fx_times_uq16(rises ? p - q : q - p, fx_inverse_uq16(n)),
                                     (uint8_t)(31U - fx_places(n)));
    q = rises ? q + part : q - part; /* a mean of p and q: within 0..1 */
    if (q < MIXTURE_LEARNT_MARGIN_UQ24) {
        q = MIXTURE_LEARNT_MARGIN_UQ24;
    } else if (q > ONE_UQ24 - MIXTURE_LEARNT_MARGIN_UQ24) {
        q = ONE_UQ24 - MIXTURE_LEARNT_MARGIN_UQ24;
    }
    f->learnt_uq24 = q;
    f->log_odds_q9 = mixture_log_odds_q9(q);
}

/* What a sample's distance says about it. */
typedef struct {
    uint16_t t_uq8;  /* r^2 / (R S) */
    uint16_t b_uq16; /* 1 - S / S_N */
    uint16_t tb_uq8; /* their product */
    mixture_posterior_t p;
} evidence_t;

static evidence_t weigh(const mixture_t *f)
{
    evidence_t e;
    fx_leading_t outlier = fx_leading(f->core.u.p.p11_uq16 + ONE_UQ16 + f->span_uq16); /* S_N < 33,033 + 10,000 */
    /* (N^2 - 1) / S_N < 1: its leading bits are at most those of S_N, and the quotient of mantissas less than 2 */
    uint16_t share_uq15 = fx_high_u16(fx_mantissa(f->span), fx_inverse_uq16(outlier));
    uint32_t share_uq16 = fx_shifted_right((uint32_t)share_uq15 << 1,
                                           (uint8_t)(fx_places(f->span) - fx_places(outlier)));
    e.b_uq16 = (share_uq16 > UINT16_MAX) ? UINT16_MAX : (uint16_t)share_uq16;
    e.t_uq8 = two_state_wide_distance_uq8(&f->core);
    e.tb_uq8 = fx_high_u16(e.t_uq8, e.b_uq16);
    /* half of tb in Q9 has the number of tb in Q8 */
    uint16_t half_uq9 = (e.tb_uq8 > 0x4000U) ? 0x4000U : e.tb_uq8;
    uint16_t spread_uq9 = fx_high_u16((uint16_t)(log2_uq9(outlier) - log2_uq9(f->core.variance)), HALF_LN2_UQ16);
    /*@ assert spread_uq9 <= 5712; */ /* for make proof: S <= S_N, log2 in UQ.9 < 16480 */
    e.p = mixture_posterior((int16_t)(f->log_odds_q9 + (int16_t)spread_uq9 - (int16_t)half_uq9));
    return e;
}

/* The update by p; false: an outlier beyond doubt that the rule does not use. */
static bool apply(mixture_t *f, const evidence_t *e, mixture_rule_t rule)
{
    bool certain = e->p.rest_uq24 == 0U;
    uint16_t loss_uq16 = (uint16_t)((e->p.rest_uq24 + 128U) >> 8); /* 1 - p */
    uint32_t p_uq24 = ONE_UQ24 - e->p.rest_uq24;
    if (e->p.outlier) {
        if (certain && rule == MIXTURE_SHORTENED) {
            return false;
        }
        p_uq24 = e->p.rest_uq24;
        loss_uq16 = (loss_uq16 == 0U) ? UINT16_MAX : (uint16_t)(0U - loss_uq16);
    }
    uint16_t t_uq8 = e->t_uq8;
    if (rule == MIXTURE_BAYES) {
        t_uq8 = e->tb_uq8;
        loss_uq16 = (certain && e->p.outlier) ? e->b_uq16 : fx_high_u16(e->b_uq16, loss_uq16);
    }
    uint32_t back_uq16 = fx_times_uq16(fx_times_uq16(p_uq24, t_uq8), loss_uq16) + loss_uq16;
    two_state_wide_update(&f->core, loss_uq16,
                          (back_uq16 > TWO_STATE_WIDE_BACK_MAX_UQ16) ? TWO_STATE_WIDE_BACK_MAX_UQ16 : back_uq16);
    return true;
}

/* One sample of a filter that runs. */
static void step(mixture_t *f, int16_t z_lsb, mixture_rule_t rule)
{
    bool grows = two_state_wide_predict(&f->core, z_lsb);
    evidence_t e = weigh(f);
    if (f->learnt_from != 0U) {
        learn(f, e.p);
    }
    if (!apply(f, &e, rule)) {
        two_state_wide_refuse(&f->core, grows);
    } else if (e.p.outlier) {
        f->core.flags |= FILTER_GATED;
    }
}

int32_t mixture_update(mixture_t *f, int16_t z_lsb, mixture_rule_t rule)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_wide_warming_up(&f->core)) {
        two_state_wide_warm_up(&f->core, z);
    } else {
        step(f, z, rule);
    }
    return f->core.x_lsb_q16;
}
