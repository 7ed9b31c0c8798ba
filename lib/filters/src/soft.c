/*
 * soft: kf that trusts a sample the less the further off it is, and no sample not at all.
 *
 * The update takes S_eff = max(S, u^2 / softgate^2) for the variance S of the innovation u (Chang 2014, scaled
 * innovation variance): within softgate sigmas it is kf bit for bit, beyond them its step falls with 1 / |u| but is
 * never zero, so it cannot be locked out even without re-acquisition. Samples beyond `gate` sigmas that agree among
 * themselves re-acquire as in sprf. Parameters r, q, softgate, gate, reacquire, ratemax; softgate 0: kf, gate 0: none.
 *
 * FILTER_GATED means that the sample lies beyond the gate (as far out as sprf with that gate would refuse it) and
 * beyond softgate: it was taken in part only, so unlike in sprf the gain is not 0. gate_lsb2_q8 of the probe is the
 * limit of the squared innovation above which the weight falls, softgate^2 S.
 *
 * Scaling: within the soft gate as kalman.h. Beyond it
 *   m        UQ0.20, of u rounded down to 2^-8 LSB and gate_lsb2_uq4 (softgate^2 R, 1/16 LSB^2), within 2^-18
 *   w1, w2   UQ0.24, <= 1, from P11 and P12 in UQ4.20; P11 and P12 times 1 - w1 - 2^-16 rounded to 2^-28, so they fall;
 *            P22 less P12 w2 (w2 rounded down to 2^-16), not below 0
 *   steps    of x rounded up, of the rate down to 2^-16; both below |u| + 2^-16 LSB (x: w1 < 8/9), so x stays between
 *            prediction and sample and the bounds of kalman.h hold
 *   gate     where S / S_eff is (softgate / gate)^2 within 2^-15
 */
#include "kalman.h"

LAW_PARAMETER(softgate, "softgate\0sigma", 8, 1, KALMAN_GATE_MIN_SIGMA_Q8, KALMAN_GATE_MAX_SIGMA_Q8, 512);
static const filter_parameter_t *const parameters[] FX_FLASH = {
    &filter_parameter_r,    &filter_parameter_q,         &softgate,
    &filter_parameter_gate, &filter_parameter_reacquire, &filter_parameter_ratemax
};

static bool together(const filter_config_t *config)
{
    return filter_kalman_run_legal(config->value[SOFT_REACQUIRE_SAMPLES]);
}

/*
 * (softgate / gate)^2, at most 65535 / 65536, so that with a gate inside the soft gate all that lies beyond the latter
 * is flagged; 0 without a gate: nothing is.
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

static void set_up(filter_t *f, const filter_config_t *config)
{
    int32_t samples = config->value[SOFT_REACQUIRE_SAMPLES];
    f->own.kalman.of.gated.gate_sigma_q8 = (uint16_t)config->value[SOFT_SOFT_SIGMA_Q8];
    f->own.kalman.of.gated.share_uq16 = flagged_share_uq16(config->value[SOFT_SOFT_SIGMA_Q8],
                                                           config->value[SOFT_GATE_SIGMA_Q8]);
    f->own.kalman.steps = (uint8_t)((samples == 0) ? 0 : samples - 1);
    filter_kalman_set_up(f, config, (uint32_t)config->value[SOFT_RATE_MAX_LSB_S]);
}

static void set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kalman_set_variance(f, r_lsb2_q8);
    filter_kalman_set_gate(f, f->own.kalman.of.gated.gate_sigma_q8);
}

/* One place in line each: told two the compiler makes a loop of them on AVR. */
FX_INLINE uint32_t quarter(uint32_t v)
{
    v >>= 1;
    FX_FENCE_OF(v);
    return v >> 1;
}

FX_INLINE uint32_t fourfold(uint32_t v)
{
    v <<= 1;
    FX_FENCE_OF(v);
    return v << 1;
}

/* K / m'^2 to m, see below: shifted by 16 - 2 b places, b = 6..22. */
FX_INLINE uint32_t placed(uint32_t weight, uint8_t b)
{
    for (; b >= 11U; b = (uint8_t)(b - 4U)) {
        weight >>= 8;
    }
    if (b > 8U) { /* 9 or 10 */
        weight = quarter(weight);
        if (b > 9U) {
            weight = quarter(weight);
        }
    }
    for (; b < 8U; b++) {
        weight = fourfold(weight);
    }
    return weight;
}

/*
 * m = softgate^2 R / u^2, so below 1 / S: UQ0.20, within 2^-18, and never 0, so the furthest sample counts too. With
 * |u| = m' 2^b LSB/256, 1 <= m' < 2, and K = 16 softgate^2 R it is K / m'^2 x 2^(16 - 2 b) counts. u^2 > K / 16 >= 1/16
 * LSB^2 makes b >= 6; the coarse K is 256 times as large, and u^2 >= 4096 LSB^2 makes b >= 14.
 */
FX_INLINE uint32_t weight_uq20(const filter_t *f)
{
    uint32_t size = f->size_lsb_uq16 >> 8;
    uint8_t b = 23;
    if ((uint8_t)(size >> 16) == 0U) {
        size <<= 8;
        b = 15;
        if ((uint8_t)(size >> 16) == 0U) {
            size <<= 8;
            b = 7;
        }
    }
    while ((uint8_t)(size >> 16) < 0x20U) { /* three places in line cost as much as two in the loop below */
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
    uint32_t weight = fx_mul_u16(f->own.kalman.gate_lsb2_uq4, fx_mul16_uq16(inverse, inverse));
    if (f->own.kalman.coarse) {
        b = (uint8_t)(b - 4U);
    }
    return placed(weight, b) | 1U;
}

/* |u| w in LSB, Q16, rounded down; |u| to whole LSB from 256 LSB on. */
FX_INLINE int32_t part_of_innovation(const filter_t *f, uint32_t w_uq24)
{
    bool far = (uint8_t)(f->size_lsb_uq16 >> 24) != 0U;
    uint16_t size = far ? (uint16_t)(f->size_lsb_uq16 >> 16) : (uint16_t)(f->size_lsb_uq16 >> 8);
    uint32_t product = fx_mul24_uq16(w_uq24, size);
    return far ? (int32_t)product : (int32_t)(product >> 8);
}

/* At most 1: so small that the steps stay below |u|. */
FX_INLINE uint32_t limited_uq24(uint32_t w_uq24)
{
    return ((uint8_t)(w_uq24 >> 24) != 0U) ? 0xFFFFFFU : w_uq24;
}

/* m, which is below 1, from UQ0.20 to UQ0.16, rounded down; byte by byte, because a shift is a loop on AVR. */
FX_INLINE uint16_t weight_uq16(uint32_t m_uq20)
{
    uint16_t middle = (uint16_t)((uint8_t)(m_uq20 >> 8) * 16U);
    uint8_t low = (uint8_t)((uint8_t)middle | (uint8_t)((uint8_t)m_uq20 >> 4));
    uint8_t high = (uint8_t)((uint8_t)(middle >> 8) | (uint8_t)((uint8_t)(m_uq20 >> 16) * 16U));
    return (uint16_t)(((uint16_t)high << 8) | low);
}

/* x and P11 with the gain w1 = P11 m. x moves by a count more than w1 u, so that no sample is without effect. */
FX_INLINE void update_x(filter_t *f, uint32_t w1_uq24)
{
    tracker_move(f, part_of_innovation(f, w1_uq24) + 1);
    f->own.kalman.p.p11 = fx_mul24_uq16(f->own.kalman.p.p11 >> 8, (uint16_t)~f->gain_uq16);
}

/* Rate, P12 and P22 with w2 = P12 m. */
FX_INLINE void update_rate(filter_t *f, uint32_t m_uq20)
{
    filter_covariance_t *p = &f->own.kalman.p;
    uint32_t p12_uq20 = p->p12 >> 8;
    p->p12 = fx_mul24_uq16(p12_uq20, (uint16_t)~f->gain_uq16);
    uint32_t w2_uq24 = limited_uq24(fx_mul24_uq24(p12_uq20, m_uq20));
    uint16_t w2_uq16 = (uint16_t)(w2_uq24 >> 8);
    int32_t p22_q28 = (int32_t)p->p22 - (int32_t)fx_mul24_uq16(p12_uq20, w2_uq16); /* < 3 less < 4: fits */
    p->p22 = (p22_q28 < 0) ? 0U : (uint32_t)p22_q28;
    tracker_turn(f, part_of_innovation(f, w2_uq24));
}

/*
 * A sample beyond the soft gate. Its share S / S_eff = S m = m + w1 tells whether it lies beyond the gate: u^2 > gate^2
 * S where S m < (softgate / gate)^2.
 */
static void take_part(filter_t *f, int16_t z_lsb)
{
    filter_kalman_t *k = &f->own.kalman;
    uint32_t m_uq20 = weight_uq20(f);
    uint32_t w1_uq24 = limited_uq24(fx_mul24_uq24(k->p.p11 >> 8, m_uq20));
    f->gain_uq16 = (uint16_t)(w1_uq24 >> 8);
    uint16_t weight = weight_uq16(m_uq20);
    uint16_t share_uq16 = (uint16_t)(weight + f->gain_uq16);
    if (share_uq16 >= weight && share_uq16 < k->of.gated.share_uq16) { /* rounding may carry a share of 1 past it */
        f->flags |= FILTER_GATED;
        if (filter_kalman_refused(f, z_lsb)) {
            return;
        }
    } else {
        k->run = 0;
    }
    update_x(f, w1_uq24);
    update_rate(f, m_uq20);
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    if (filter_kalman_step(f, z_lsb, what)) {
        f->own.kalman.run = 0;
    } else if (what != STEP_MISSING) {
        take_part(f, z_lsb);
    }
}

/* A gain too small for its 16 bits is reported as 2^-16: only refused samples have none, and soft refuses none. */
static void report(const filter_t *f, filter_probe_t *out)
{
    filter_kalman_report(f, out);
    if (out->gain_uq16 == 0U && (out->flags & FILTER_GATED) != 0U) {
        out->gain_uq16 = 1;
    }
}

const filter_law_t filter_law_soft FX_FLASH = { .name = "soft",
                                                .parameter_count = 6,
                                                .traits = LAW_COVARIANCE | LAW_SETTLES | LAW_GATED,
                                                .worst_cycles = 1350,
                                                .parameters = parameters,
                                                .together = together,
                                                .set_up = set_up,
                                                .set_noise = set_noise,
                                                .start = filter_kalman_start,
                                                .step = step,
                                                .report = LAW_REPORT(report) };
