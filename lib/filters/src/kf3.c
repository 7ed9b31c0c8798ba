/*
 * kf3: three-state Kalman filter (position, rate, acceleration), driven by white jerk: the model of order m = 2 of
 * paper 001, equation 1, its "second-order Kalman filter". No lag under constant acceleration, at the cost of noise;
 * every outlier passes with the full gain: a yardstick. With P divided by R, everything per sample and r the
 * innovation, the recursion is
 *
 *   predict  P33 += q33; a stays; v += a; x += v                                         q33 = q T^5 / R
 *   update   g = 1 / (P11 + 1); w1 = 1 - g; w2 = P12 g; w3 = P13 g; (x, v, a) += (w1, w2, w3) r
 *            P22 -= w2 P12; P23 -= w2 P13; P33 -= w3 P13; P12 = w2; P13 = w3; P11 = w1
 *
 * v and a are backward differences: on x = a n^2 / 2 the rate is that of half a sample ago. Acceleration is a random
 * walk (Singer's correlation is 1): with less, the lag under constant acceleration, which the filter is meant to avoid,
 * would return. In the steady state (test_kf3_reference; paper 001's sigma of 0.45 m without lag is that of gain 0.856)
 *
 *   q33      w1       variance / R   overshoot of a step
 *   1        0.8712   0.825          11 %
 *   2^-8     0.5490   0.489          21 %
 *   1e-5     0.2545   0.218          27 %   default at 100 Hz
 *   2^-32    0.0484   0.041          30 %
 *
 * where kf would lag by (1 - w1) / w2 accelerations per sample^2. At equal noise kf answers steps and fast sines
 * better.
 *
 * In a long gap P is predicted until P11 reaches 4 R (11 samples at 100 Hz) or another element 1. Then P stays as it is
 * and the acceleration is ignored, so the estimate continues along a straight line; at the bound of the format it
 * stops, and comes back from there within 117 samples at 100 Hz.
 *
 * Scaling:
 *   x, v, a      Q15.16, a in sixteenths when fine (Q11.20); each within 4608 by a clamp after the prediction (x, v)
 *                and after the update (v, a); the update moves x towards a sample within 4096, so |r| <= 8704 LSB <
 *                2^30 / 2^16 and no sum overflows
 *   P / R        UQ4.28, see grow_covariance; below 1 after each update, so that the next step can predict it
 *   g, w1        UQ0.16 within 1.75 counts of 1 / S; w2, w3 UQ0.24; P rounded to half a count of 2^-28 per product
 *   r            magnitude rounded down to 2^-8 LSB; the steps of x, v and a rounded half away from zero to 2^-16
 */
#include "kalman.h"

LAW_KEEPS_FROM(filter_kf3_t, q33_uq28);

/*
 * From this rate on the acceleration is counted in sixteenths of an LSB per sample^2, because q33 falls with the fifth
 * power of the rate. q33 is limited to 2^-24..1 below this rate (gain 0.118..0.871) and to 2^-32..2^-11 from it on
 * (gain 0.048..0.430).
 */
#define FINE_FROM_DHZ 1000U
#define ONE_UQ28 0x10000000U
#define Q33_MIN_UQ28 16U
/* Largest q33 when fine: with more, P33, counted 256 times, would not settle below 1. */
#define Q33_MAX_FINE_UQ28 0x2000000U
#define P22_START_MAX_UQ28 0x8000000U

LAW_PARAMETER(q, "q\0LSB2/s5", 0, 0, 1, 1000000000, 300000);
static const filter_parameter_t *const parameters[] IN_FLASH = { &filter_parameter_r, &q };

static void set_up(filter_t *f, const filter_config_t *config)
{
    filter_kf3_t *k = &f->own.kf3;
    fx_scaled_t period_s = filter_fx_scaled_div(filter_fx_scaled(10), filter_fx_scaled(config->rate_dhz));
    filter_kalman_scales(config, &k->drive_lsb2, &k->start_lsb2);
    k->fine = config->rate_dhz >= FINE_FROM_DHZ;
    k->drive_lsb2 = filter_fx_scaled_mul(k->drive_lsb2, filter_fx_scaled_mul(period_s, period_s)); /* q T^5 */
    if (k->fine) {
        k->drive_lsb2.exponent = (int8_t)(k->drive_lsb2.exponent + 8);
    }
    f->rate_max_lsb = (uint32_t)TRACKER_X_MAX_LSB_Q16;
    filter_set_noise(f, (uint32_t)config->value[KALMAN_R]);
}

static void set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    filter_kf3_t *k = &f->own.kf3;
    k->r_lsb2_q8 = r_lsb2_q8;
    fx_scaled_t r_lsb2 = filter_kalman_scaled_r(r_lsb2_q8);
    uint32_t most = k->fine ? Q33_MAX_FINE_UQ28 : ONE_UQ28;
    k->q33_uq28 = filter_kalman_per_r(k->drive_lsb2, r_lsb2, 28, Q33_MIN_UQ28, most);
    f->q_limited = k->q33_uq28 == Q33_MIN_UQ28 || k->q33_uq28 == most;
    k->p22_start_uq28 = filter_kalman_per_r(k->start_lsb2, r_lsb2, 28, k->q33_uq28, P22_START_MAX_UQ28);
}

/* Cube root of sqrt q, at most 511/1024: UQ0.10. */
static uint16_t sixth_root_uq10(const filter_kf3_t *k)
{
    uint32_t root_uq14 = filter_fx_isqrt32(k->q33_uq28);
    uint32_t cube_uq30 = k->fine ? root_uq14 << 12 : root_uq14 << 16;
    uint16_t w = 0;
    for (uint16_t bit = 256; bit != 0U; bit >>= 1) {
        uint32_t next = (uint32_t)w | bit;
        if (next * next * next <= cube_uq30) {
            w = (uint16_t)next;
        }
    }
    return w;
}

/* Near where P settles: for small q at 2w, 2w^2, w^3; 3w^3, 2w^4; 2w^5 with w = q^(1/6). */
static void start_near(filter_kf3_t *k)
{
    uint32_t w = sixth_root_uq10(k);
    uint32_t w3_uq28 = (w * w * w) >> 2;
    uint32_t w4_uq28 = ((w3_uq28 >> 4) * w) >> 6;
    k->p.p11 = w << 19;
    k->p.p12 = (w * w) << 9;
    k->p13_uq28 = w3_uq28;
    k->p.p22 = 3U * w3_uq28;
    k->p23_uq28 = 2U * w4_uq28;
    k->p33_uq28 = (((w4_uq28 >> 4) * w) >> 6) * 2U;
    if (k->fine) {
        k->p13_uq28 <<= 4;
        k->p23_uq28 <<= 4;
        k->p33_uq28 <<= 8;
    }
}

/* Acceleration unknown. Rate and acceleration are only so uncertain that P stays below 1 from the first update on. */
static void start(filter_t *f, bool settled)
{
    filter_kf3_t *k = &f->own.kf3;
    uint32_t p22 = k->p22_start_uq28;
    k->p.p11 = ONE_UQ28;
    k->p.p12 = 0;
    k->p.p22 = p22;
    k->acceleration_q16 = 0;
    k->p13_uq28 = 0;
    k->p23_uq28 = 0;
    k->p33_uq28 = fx_sixteenth(p22);
    if (settled) {
        start_near(k);
    }
}

/* A state limited to the bound of the format; sets the flag. */
static int32_t limited(filter_t *f, int32_t v_q16)
{
    if (filter_fx_abs32(v_q16) > (uint32_t)TRACKER_X_MAX_LSB_Q16) {
        f->flags |= FILTER_SATURATED;
        return (v_q16 < 0) ? -TRACKER_X_MAX_LSB_Q16 : TRACKER_X_MAX_LSB_Q16;
    }
    return v_q16;
}

/* From the unit of the acceleration to that of the rate. */
static uint32_t to_rate(const filter_kf3_t *k, uint32_t v)
{
    return k->fine ? fx_sixteenth(v) : v;
}

static bool one_or_more(uint32_t p_uq28)
{
    return (uint8_t)(p_uq28 >> 24) >= 0x10U;
}

/* Whether an element of P other than P11 is 1 or more. */
static bool reaches_one(const filter_kf3_t *k)
{
    return one_or_more(k->p.p12) || one_or_more(k->p.p22) || one_or_more(k->p13_uq28) || one_or_more(k->p23_uq28) ||
           one_or_more(k->p33_uq28);
}

/*
 * Predicts P / R: P33 < 2, P23 < 3, P22 < 5, P12 < 2 + 5, P13 < 4, P11 < 4 + 2 + 7 afterwards. False if P11 or another
 * element is at the end of its range; P then stays as it is.
 */
static bool grow_covariance(filter_kf3_t *k)
{
    if ((uint8_t)(k->p.p11 >> 24) >= 0x40U || reaches_one(k)) {
        return false;
    }
    uint32_t p33 = k->p33_uq28 + k->q33_uq28;
    k->p33_uq28 = p33;
    uint32_t twice_p23 = k->p23_uq28;
    uint32_t p23 = twice_p23 + to_rate(k, p33);
    k->p23_uq28 = p23;
    twice_p23 += p23;
    k->p.p22 += to_rate(k, twice_p23);
    uint32_t p12 = k->p.p12 + to_rate(k, k->p13_uq28);
    k->p13_uq28 += k->p23_uq28;
    uint32_t sum = p12 + k->p.p22;
    k->p.p12 = sum;
    k->p.p11 += p12 + sum;
    return true;
}

/* Predicts state and P. A state that reaches the bound of the format stops there. */
static void predict(filter_t *f)
{
    filter_kf3_t *k = &f->own.kf3;
    uint8_t flags = f->flags;
    f->flags = 0;
    if (!grow_covariance(k)) {
        k->acceleration_q16 = 0;
    }
    int32_t acceleration = (int32_t)to_rate(k, filter_fx_abs32(k->acceleration_q16));
    int32_t rate = f->rate_lsb;
    rate = limited(f, (k->acceleration_q16 < 0) ? rate - acceleration : rate + acceleration);
    f->x_lsb_q16 = limited(f, f->x_lsb_q16 + rate);
    if (f->flags != 0U) {
        rate = 0;
        k->acceleration_q16 = 0;
    }
    f->flags |= flags;
    f->rate_lsb = rate;
}

/* An element of P less a gain times the column's element, at least 0. */
static uint32_t less(uint32_t p_uq28, uint32_t column_uq28, uint32_t gain_uq24)
{
    int32_t left_q28 = (int32_t)p_uq28 - (int32_t)filter_fx_mul_uq24(column_uq28, gain_uq24); /* < 5 less < 7: fits */
    return (left_q28 < 0) ? 0U : (uint32_t)left_q28;
}

/* A state plus its gain times the innovation, by the magnitude, so that rounding is the same for both signs. */
static int32_t moved(const filter_t *f, int32_t v_q16, uint32_t gain_uq24)
{
    int32_t part_q16 = (int32_t)filter_fx_mul24_uq24(f->size_lsb_uq16 >> 8, gain_uq24); /* < 8704 LSB */
    return f->negative ? v_q16 - part_q16 : v_q16 + part_q16;
}

/* A gain from UQ4.28 to UQ0.24, limited to below 1: it is larger only right after a gap or a start. */
static uint32_t below_one_uq24(uint32_t gain_uq28)
{
    uint32_t gain_uq24 = fx_sixteenth(gain_uq28);
    return (gain_uq24 > 0xFFFFFFU) ? 0xFFFFFFU : gain_uq24;
}

static void to_sixteenth(uint32_t *p)
{
    *p = filter_fx_shift_right(*p, 4);
}

/*
 * An element that is not below 1 scales down all of P: a sixteenth of a covariance is a covariance, and can be
 * predicted.
 */
static void keep_predictable(filter_kf3_t *k)
{
    if (reaches_one(k)) {
        to_sixteenth(&k->p.p11);
        to_sixteenth(&k->p.p12);
        to_sixteenth(&k->p.p22);
        to_sixteenth(&k->p13_uq28);
        to_sixteenth(&k->p23_uq28);
        to_sixteenth(&k->p33_uq28);
    }
}

static void correct(filter_t *f)
{
    filter_kf3_t *k = &f->own.kf3;
    fx_leading_t variance = filter_fx_leading(k->p.p11 + ONE_UQ28); /* 1 <= S < 14: places 3..0 */
    uint16_t g_uq16 = (uint16_t)filter_fx_shift_right(filter_fx_inverse_uq16(variance),
                                                      (uint8_t)(3U - fx_places(variance)));
    uint16_t w1_uq16 = (uint16_t)(0U - g_uq16);
    f->gain_uq16 = w1_uq16;
    k->p.p11 = fx_shift12(w1_uq16);
    f->x_lsb_q16 = moved(f, f->x_lsb_q16, (uint32_t)w1_uq16 << 8); /* towards the sample: within its bound */
    uint32_t p12 = k->p.p12;
    uint32_t w2_uq28 = filter_fx_mul_uq16(p12, g_uq16);
    k->p.p12 = w2_uq28;
    uint32_t gain_uq24 = below_one_uq24(w2_uq28);
    k->p.p22 = less(k->p.p22, p12, gain_uq24);
    uint32_t p13 = k->p13_uq28;
    k->p23_uq28 = less(k->p23_uq28, p13, gain_uq24);
    f->rate_lsb = limited(f, moved(f, f->rate_lsb, gain_uq24));
    uint32_t w3_uq28 = filter_fx_mul_uq16(p13, g_uq16);
    k->p13_uq28 = w3_uq28;
    gain_uq24 = below_one_uq24(w3_uq28);
    k->p33_uq28 = less(k->p33_uq28, p13, gain_uq24);
    k->acceleration_q16 = limited(f, moved(f, k->acceleration_q16, gain_uq24));
    keep_predictable(k);
}

static void step(filter_t *f, int16_t z_lsb, uint8_t what)
{
    predict(f);
    if (what != STEP_MISSING) {
        filter_tracker_meet(f, z_lsb);
        correct(f);
    }
}

static void fade(filter_t *f, bool first)
{
    filter_kf3_t *k = &f->own.kf3;
    if (!first) {
        k->acceleration_q16 >>= 1;
        k->p13_uq28 >>= 1;
        k->p23_uq28 >>= 2;
        k->p33_uq28 >>= 2;
    }
}

static void report(const filter_t *f, filter_probe_t *out)
{
    const filter_kf3_t *k = &f->own.kf3;
    uint32_t p11_uq28 = (f->collected == FILTER_RUNNING) ? k->p.p11 : ONE_UQ28;
    out->p_lsb2_q8 = (filter_fx_mul_uq24(p11_uq28, k->r_lsb2_q8) + 8U) >> 4;
}

const filter_law_t filter_law_kf3 IN_FLASH = { .parameter_count = 2,
                                               .traits = LAW_COVARIANCE,
                                               .worst_cycles = 2390,
                                               .parameters = parameters,
                                               .set_up = set_up,
                                               .set_noise = set_noise,
                                               .start = start,
                                               .step = step,
                                               .fade = fade,
                                               .report = LAW_REPORT(report),
                                               .name = "kf3" };
