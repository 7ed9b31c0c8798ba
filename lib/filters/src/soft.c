/*
 * soft: kf that weights a sample less the further off it is, but never by zero.
 *
 * The update uses S_eff = max(S, u^2 / softgate^2) for the variance S of the innovation u (Chang 2014, scaled
 * innovation variance). Within softgate sigmas it is kf bit for bit. Beyond them its step, P11 softgate^2 R / |u|,
 * falls with 1 / |u| but never to zero, so it cannot be locked out even without re-acquisition: it then comes back from
 * one end of the range to the other within 3,742 samples at 100 Hz, R from 0.01 to 1000 LSB^2, and within 290,000 at
 * 800 Hz and R = 3 (P stops growing at 4 R, which makes it slower than in double). Samples beyond `gate` sigmas that
 * agree among themselves re-acquire as in sprf. Parameters r, q, softgate, gate, reacquire, ratemax; softgate 0: kf,
 * gate 0: none.
 *
 * FILTER_GATED means that the sample is beyond the gate (where sprf with that gate would refuse it) and beyond
 * softgate. It was used in part, so unlike in sprf the gain is not 0. gate_lsb2_q8 of the probe is the squared
 * innovation above which the weight falls, softgate^2 S.
 *
 * Scaling: within the soft gate as kalman.h. Beyond it
 *   m        UQ0.24, from u rounded down to 2^-8 LSB and gate_lsb2_uq6 (softgate^2 R, 1/64 LSB^2); absolute error
 *            2^-20, relative 2^-13
 *   w1, w2   UQ0.24, <= 1, from P11 in UQ8.16 and P12 in UQ6.18; P11 and P12 times 1 - w1 - 2^-16, rounded, so they
 *            fall; P22 less P12 w2 (w2 rounded down to 2^-16), not below 0
 *   steps    of x rounded up, of the rate down to 2^-16; both below |u| + 2^-16 LSB (x: w1 < 52/53), so x stays between
 *            prediction and sample and the bounds of kalman.h hold
 *   gate     where S / S_eff is (softgate / gate)^2 within 2^-15
 */
#include "kalman.h"

LAW_PARAMETER(softgate, "softgate\0sigma", 8, 1, KALMAN_GATE_MIN_SIGMA_Q8, KALMAN_GATE_MAX_SIGMA_Q8, 512);
static const filter_parameter_t *const parameters[] IN_FLASH = {
    &filter_parameter_r,    &filter_parameter_q,         &softgate,
    &filter_parameter_gate, &filter_parameter_reacquire, &filter_parameter_ratemax
};

static void standard(filter_config_t *config)
{
    if (config->rate_dhz <= KALMAN_SHORT_RUN_DHZ) {
        config->value[SOFT_REACQUIRE_SAMPLES] = KALMAN_SHORT_RUN;
    }
}

static bool together(const filter_config_t *config)
{
    return filter_kalman_run_legal(config->value[SOFT_REACQUIRE_SAMPLES]);
}

/*
 * (softgate / gate)^2, at most 65535 / 65536, so that with a gate inside the soft gate everything beyond the latter is
 * flagged; 0 without a gate: nothing is.
 */
static uint16_t flagged_share_uq16(int32_t soft_sigma_q8, int32_t gate_sigma_q8)
{
    if (gate_sigma_q8 == 0) {
        return 0;
    }
    fx_scaled_t ratio = filter_fx_scaled_div(filter_fx_scaled((uint32_t)soft_sigma_q8),
                                             filter_fx_scaled((uint32_t)gate_sigma_q8));
    uint32_t share = filter_fx_scaled_fixed(filter_fx_scaled_mul(ratio, ratio), 16);
    return (share > 0xFFFFU) ? 0xFFFFU : (uint16_t)share;
}

LAW_ASSERT((int)SOFT_SOFT_SIGMA_Q8 == (int)KALMAN_GATE && (int)SOFT_RATE_MAX_LSB_S == (int)SOFT_REACQUIRE_SAMPLES + 1,
           "where filter_kalman_set_up_gated looks");

static void set_up(filter_t *f, const filter_config_t *config)
{
    f->own.kalman.of.gated.share_uq16 = flagged_share_uq16(config->value[SOFT_SOFT_SIGMA_Q8],
                                                           config->value[SOFT_GATE_SIGMA_Q8]);
    filter_kalman_set_up_gated(f, config, SOFT_REACQUIRE_SAMPLES);
}

/* Smallest weight of a sample. */
#define LEAST_UQ24 16U

/* From K / m'^2 to m, see below: shifted by 16 - 2 b places, b = 4..20. */
static uint32_t placed(uint32_t weight, uint8_t b)
{
    for (; b >= 11U; b = (uint8_t)(b - 4U)) {
        weight >>= 8;
    }
    if (b > 8U) { /* 9 or 10 */
        weight = kalman_quarter(weight);
        if (b > 9U) {
            weight = kalman_quarter(weight);
        }
    }
    for (; b < 8U; b++) {
        weight = kalman_fourfold(weight);
    }
    return weight;
}

/*
 * m = softgate^2 R / u^2, so below 1 / S: UQ0.24, and at least 2^-20, so that the furthest sample counts too. With |u|
 * = m' 2^(b + 1) LSB/256, 1 <= m' < 2, and K = 64 softgate^2 R, K / m'^2 in UQ.16 is 2^(2 b - 16) times as many counts.
 * u^2 > K / 64 >= 1/64 LSB^2 gives b >= 4; the coarse K is 256 times as large, and u^2 >= 1024 LSB^2 gives b >= 12.
 */
static uint32_t weight_uq24(const filter_t *f)
{
    uint32_t size = f->size_lsb_uq16 >> 8;
    uint8_t b = 22;
    if ((uint8_t)(size >> 16) == 0U) {
        size <<= 8;
        b = 14;
        if ((uint8_t)(size >> 16) == 0U) {
            size <<= 8;
            b = 6;
        }
    }
    while ((uint8_t)(size >> 16) < 0x20U) { /* unrolled, three places cost as much as two in the loop below */
        size = fx_eightfold(size);
        b = (uint8_t)(b - 3U);
    }
    if ((size & 0x800000U) == 0U) {
        do {
            size <<= 1;
            b--;
        } while ((size & 0x800000U) == 0U);
    }
    uint16_t inverse = fx_inverse_m_uq16((uint8_t)(size >> 16) & 0x7FU, (uint16_t)size);
    uint32_t weight = fx_product_u16(f->own.kalman.gate_lsb2_uq6, filter_fx_mul16_uq16(inverse, inverse));
    if (f->own.kalman.coarse) {
        b = (uint8_t)(b - 4U);
    }
    return kalman_limited_uq24(placed(weight, b) | LEAST_UQ24);
}

/* |u| w in LSB, Q16, rounded down; |u| in whole LSB from 256 LSB on. */
static int32_t part_of_innovation(const filter_t *f, uint32_t w_uq24)
{
    bool far = (uint8_t)(f->size_lsb_uq16 >> 24) != 0U;
    uint16_t size = far ? (uint16_t)(f->size_lsb_uq16 >> 16) : (uint16_t)(f->size_lsb_uq16 >> 8);
    uint32_t product = filter_fx_mul24_uq16(w_uq24, size);
    return far ? (int32_t)product : (int32_t)(product >> 8);
}

/* x and P11 with the gain w1 = P11 m. x moves by one count more than w1 u, so that every sample has an effect. */
static void update_x(filter_t *f, uint32_t w1_uq24)
{
    filter_tracker_move(f, part_of_innovation(f, w1_uq24) + 1);
    f->own.kalman.p.p11 = filter_fx_mul24_uq16(f->own.kalman.p.p11 >> 8, (uint16_t)~f->gain_uq16);
}

/* Rate, P12 and P22 with w2 = P12 m. */
static void update_rate(filter_t *f, uint32_t m_uq24)
{
    filter_covariance_t *p = &f->own.kalman.p;
    uint32_t p12_uq18 = p->p12 >> 8;
    p->p12 = filter_fx_mul24_uq16(p12_uq18, (uint16_t)~f->gain_uq16);
    uint32_t w2_uq24 = kalman_limited_uq24(kalman_quarter(filter_fx_mul24_uq24(p12_uq18, m_uq24)));
    uint16_t w2_uq16 = (uint16_t)(w2_uq24 >> 8);
    uint32_t taken_uq26 = filter_fx_mul24_uq16(p12_uq18, w2_uq16);
    p->p22 = kalman_less(p->p22, taken_uq26);
    filter_tracker_turn(f, part_of_innovation(f, w2_uq24));
}

/*
 * A sample beyond the soft gate. Its share S / S_eff = S m = m + w1 shows whether it is beyond the gate: u^2 > gate^2 S
 * where S m < (softgate / gate)^2.
 */
static void take_part(filter_t *f, int16_t z_lsb)
{
    filter_kalman_t *k = &f->own.kalman;
    uint32_t m_uq24 = weight_uq24(f);
    uint32_t w1_uq24 = kalman_limited_uq24(filter_fx_mul24_uq24(k->p.p11 >> 8, m_uq24));
    f->gain_uq16 = (uint16_t)(w1_uq24 >> 8);
    uint16_t weight = (uint16_t)(m_uq24 >> 8);
    uint16_t share_uq16 = (uint16_t)(weight + f->gain_uq16);
    if (share_uq16 >= weight && share_uq16 < k->of.gated.share_uq16) { /* rounding may wrap a share of 1 */
        f->flags |= FILTER_GATED;
        if (filter_kalman_refused(f, z_lsb)) {
            return;
        }
    } else {
        k->run = 0;
    }
    update_x(f, w1_uq24);
    update_rate(f, m_uq24);
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    if (filter_kalman_step(f, z_lsb, what)) {
        f->own.kalman.run = 0;
    } else if (what != STEP_MISSING) {
        take_part(f, z_lsb);
    }
}

/* A gain too small for 16 bits is reported as 2^-16: 0 means refused, and soft refuses none. */
static void report(const filter_t *f, filter_probe_t *out)
{
    filter_kalman_report(f, out);
    if (out->gain_uq16 == 0U && (out->flags & FILTER_GATED) != 0U) {
        out->gain_uq16 = 1;
    }
}

const filter_law_t filter_law_soft IN_FLASH = { .parameter_count = 6,
                                                .traits = LAW_COVARIANCE | LAW_GATED,
                                                .worst_cycles = 1695,
                                                .parameters = parameters,
                                                .standard = standard,
                                                .together = together,
                                                .set_up = set_up,
                                                .set_noise = filter_kalman_set_noise_gated,
                                                .start = filter_kalman_start,
                                                .step = step,
                                                .report = LAW_REPORT(report),
                                                .name = "soft" };
