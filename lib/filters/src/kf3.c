/* Three-state Kalman filter: see kf3.h for the equations. */
#include "kf3.h"

/* Power density of the white jerk it ships with. */
#define Q_DEFAULT_LSB2_S5 300000U
/* Largest drive when fine: with more P33, counted 256 times, would not settle below 1. */
#define Q33_MAX_FINE_UQ28 0x2000000U
/* After so many equal samples P is within a few per cent of where it settles, for gains above 0.1. */
#define SETTLE_STEPS 64U

#define ONE_UQ28 0x10000000U
#define P22_START_MAX_UQ28 0x8000000U
#define X_MAX_LSB_Q16 ((int32_t)FILTER_X_MAX_LSB * 65536)

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(kf3_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s5", offsetof(kf3_config_t, q_lsb2_s5), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3, TWO_STATE_Q_MAX_LSB2_S3 },
};

const filter_descriptor_t kf3_descriptor FX_FLASH = { "kf3", sizeof parameters / sizeof parameters[0], parameters };

void kf3_defaults(kf3_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s5 = Q_DEFAULT_LSB2_S5;
}

/* Acceleration unknown; rate and acceleration no more uncertain than that P stays below 1 from the first update on. */
static void start_acceleration(kf3_t *f)
{
    uint32_t p22 = f->core.p22_start_uq28;
    p22 = (p22 < P22_START_MAX_UQ28) ? p22 : P22_START_MAX_UQ28;
    f->core.u.p.p22_uq28 = p22;
    f->acceleration_q16 = 0;
    f->p13_uq28 = 0;
    f->p23_uq28 = 0;
    f->p33_uq28 = fx_sixteenth(p22);
}

void kf3_configure(kf3_t *f, const kf3_config_t *config)
{
    two_state_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s5, 0);
    f->fine = config->rate_dhz >= KF3_FINE_FROM_DHZ;
    fx_scaled_t period_s = fx_scaled_div(fx_scaled(10), fx_scaled(config->rate_dhz));
    fx_scaled_t drive_lsb2 = fx_scaled_mul(f->core.drive_lsb2, fx_scaled_mul(period_s, period_s)); /* q T^5 */
    if (f->fine) {
        drive_lsb2.exponent = (int8_t)(drive_lsb2.exponent + 8);
    }
    f->core.drive_lsb2 = drive_lsb2;
    f->acceleration_q16 = 0;
    f->p13_uq28 = 0;
    f->p23_uq28 = 0;
    f->p33_uq28 = 0;
    kf3_set_noise(f, config->r_lsb2_q8);
}

bool kf3_init(kf3_t *f, const kf3_config_t *config)
{
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s5)) {
        return false;
    }
    kf3_configure(f, config);
    return true;
}

void kf3_set_noise(kf3_t *f, uint32_t r_lsb2_q8)
{
    two_state_set_noise(&f->core, r_lsb2_q8);
    if (f->fine && f->core.q22_uq28 > Q33_MAX_FINE_UQ28) {
        f->core.q22_uq28 = Q33_MAX_FINE_UQ28;
    }
}

/* A state limited to the bound of the format; the flag tells. */
FX_NOINLINE int32_t limited(kf3_t *f, int32_t v_q16)
{
    if (fx_abs32(v_q16) > (uint32_t)X_MAX_LSB_Q16) {
        f->core.flags = FILTER_SATURATED;
        return (v_q16 < 0) ? -X_MAX_LSB_Q16 : X_MAX_LSB_Q16;
    }
    return v_q16;
}

/* In the unit of the acceleration to that of the rate. */
FX_NOINLINE uint32_t to_rate(const kf3_t *f, uint32_t v)
{
    return f->fine ? fx_sixteenth(v) : v;
}

FX_INLINE bool one_or_more(uint32_t p_uq28)
{
    return (uint8_t)(p_uq28 >> 24) >= 0x10U;
}

/* True when an element of P other than P11 is 1 or more. */
static bool reaches_one(const kf3_t *f)
{
    return one_or_more(f->core.u.p.p12_uq28) || one_or_more(f->core.u.p.p22_uq28) || one_or_more(f->p13_uq28) ||
           one_or_more(f->p23_uq28) || one_or_more(f->p33_uq28);
}

/*
 * P / R one sample on: P33 < 2, P23 < 3, P22 < 5, P12 < 2 + 5, P13 < 4, P11 < 4 + 2 + 7 afterwards. False when P11 or
 * another element is at the end of its range: P stays.
 */
static bool grow_covariance(kf3_t *f)
{
    two_state_t *s = &f->core;
    if ((uint8_t)(s->u.p.p11_uq28 >> 24) >= 0x40U || reaches_one(f)) {
        return false;
    }
    uint32_t p33 = f->p33_uq28 + s->q22_uq28;
    f->p33_uq28 = p33;
    FX_FENCE();
    uint32_t twice_p23 = f->p23_uq28;
    uint32_t p23 = twice_p23 + to_rate(f, p33);
    f->p23_uq28 = p23;
    twice_p23 += p23;
    FX_FENCE();
    s->u.p.p22_uq28 += to_rate(f, twice_p23);
    FX_FENCE();
    uint32_t p12 = s->u.p.p12_uq28 + to_rate(f, f->p13_uq28);
    FX_FENCE();
    f->p13_uq28 += f->p23_uq28;
    FX_FENCE();
    uint32_t sum = p12 + s->u.p.p22_uq28;
    s->u.p.p12_uq28 = sum;
    FX_FENCE();
    s->u.p.p11_uq28 += p12 + sum;
    return true;
}

/* State and P one sample on. What has run to the bound of the format stands still there. */
FX_NOINLINE void predict(kf3_t *f)
{
    if (!grow_covariance(f)) {
        f->acceleration_q16 = 0;
    }
    int32_t acceleration = (int32_t)to_rate(f, fx_abs32(f->acceleration_q16));
    int32_t rate = f->core.rate_lsb_q16;
    rate = limited(f, (f->acceleration_q16 < 0) ? rate - acceleration : rate + acceleration);
    f->core.x_lsb_q16 = limited(f, f->core.x_lsb_q16 + rate);
    if (f->core.flags != 0U) {
        rate = 0;
        f->acceleration_q16 = 0;
    }
    f->core.rate_lsb_q16 = rate;
}

/* An element of P less a gain times the column's element, at least 0. */
FX_NOINLINE uint32_t less(uint32_t p_uq28, uint32_t column_uq28, uint32_t gain_uq24)
{
    int32_t left_q28 = (int32_t)p_uq28 - (int32_t)fx_mul_uq24(column_uq28, gain_uq24); /* < 5 less < 7: fits */
    return (left_q28 < 0) ? 0U : (uint32_t)left_q28;
}

/* A state and its gain times the innovation: by the magnitude, so that rounding is the same for both signs. */
FX_NOINLINE int32_t moved(const kf3_t *f, int32_t v_q16, uint32_t gain_uq24)
{
    int32_t step = (int32_t)fx_mul24_uq24(f->core.size_lsb_uq8, gain_uq24); /* < 8704 LSB */
    return f->core.negative ? v_q16 - step : v_q16 + step;
}

/* A gain UQ4.28 as UQ0.24, below 1: only right after a gap or a start is it more. */
FX_NOINLINE uint32_t below_one_uq24(uint32_t gain_uq28)
{
    uint32_t gain_uq24 = fx_sixteenth(gain_uq28);
    return (gain_uq24 > 0xFFFFFFU) ? 0xFFFFFFU : gain_uq24;
}

FX_NOINLINE void to_sixteenth(uint32_t *p)
{
    *p = fx_shifted_right(*p, 4);
}

/* What is no longer below 1 brings all of P down: a sixteenth of a covariance is one, and can be predicted. */
static void keep_predictable(kf3_t *f)
{
    if (reaches_one(f)) {
        to_sixteenth(&f->core.u.p.p11_uq28);
        to_sixteenth(&f->core.u.p.p12_uq28);
        to_sixteenth(&f->core.u.p.p22_uq28);
        to_sixteenth(&f->p13_uq28);
        to_sixteenth(&f->p23_uq28);
        to_sixteenth(&f->p33_uq28);
    }
}

static void correct(kf3_t *f)
{
    two_state_t *s = &f->core;
    fx_leading_t variance = fx_leading(s->u.p.p11_uq28 + ONE_UQ28); /* 1 <= S < 14: places 3..0 */
    uint16_t g_uq16 = (uint16_t)fx_shifted_right(fx_inverse_uq16(variance), (uint8_t)(3U - fx_places(variance)));
    uint16_t w1_uq16 = (uint16_t)(0U - g_uq16);
    s->gain_uq16 = w1_uq16;
    s->u.p.p11_uq28 = fx_shift12(w1_uq16);
    s->x_lsb_q16 = moved(f, s->x_lsb_q16, (uint32_t)w1_uq16 << 8); /* towards the sample: within its bound */
    uint32_t p12 = s->u.p.p12_uq28;
    uint32_t w2_uq28 = fx_times_uq16(p12, g_uq16);
    s->u.p.p12_uq28 = w2_uq28;
    uint32_t gain_uq24 = below_one_uq24(w2_uq28);
    s->u.p.p22_uq28 = less(s->u.p.p22_uq28, p12, gain_uq24);
    uint32_t p13 = f->p13_uq28;
    f->p23_uq28 = less(f->p23_uq28, p13, gain_uq24);
    s->rate_lsb_q16 = limited(f, moved(f, s->rate_lsb_q16, gain_uq24));
    uint32_t w3_uq28 = fx_times_uq16(p13, g_uq16);
    f->p13_uq28 = w3_uq28;
    gain_uq24 = below_one_uq24(w3_uq28);
    f->p33_uq28 = less(f->p33_uq28, p13, gain_uq24);
    f->acceleration_q16 = limited(f, moved(f, f->acceleration_q16, gain_uq24));
    keep_predictable(f);
}

static void take(kf3_t *f, int16_t z_lsb)
{
    f->core.flags = 0;
    predict(f);
    int32_t innovation = (int32_t)z_lsb * 65536 - f->core.x_lsb_q16;
    f->core.negative = innovation < 0;
    f->core.size_lsb_uq8 = fx_abs32(innovation) >> 8;
    correct(f);
}

void kf3_reset(kf3_t *f, int16_t z0_lsb)
{
    int16_t z0 = filter_clamp_z(z0_lsb);
    two_state_start(&f->core, (int32_t)z0 * 65536);
    start_acceleration(f);
    for (uint8_t i = 0; i < SETTLE_STEPS; i++) {
        take(f, z0);
    }
}

bool kf3_reset_step(kf3_t *f, int16_t z0_lsb, uint8_t step)
{
    int16_t z0 = filter_clamp_z(z0_lsb);
    if (step == 0U) {
        two_state_start(&f->core, (int32_t)z0 * 65536);
        start_acceleration(f);
    } else {
        take(f, z0);
    }
    return step < SETTLE_STEPS;
}

/*
 * Scaling:
 *   input        Q0, any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB
 *   x, v, a      Q15.16, a in sixteenths when fine (Q11.20); each within 4608 by a clamp after the prediction (x, v)
 *                and after the update (v, a); the update moves x towards a sample within 4096, so |r| <= 8704 LSB <
 *                2^30 / 2^16 and no sum overflows
 *   P / R        UQ4.28, see grow_covariance; below 1 after each update, so that the next step predicts it
 *   g, w1        UQ0.16 within 1.75 counts of 1 / S; w2, w3 UQ0.24; P rounded to half a count of 2^-28 per product
 *   r            rounded down to 2^-8 LSB in magnitude; the steps of x, v and a rounded half away from zero to 2^-16
 *   cost         docs/benchmarks.md
 */
int32_t kf3_update(kf3_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_warming_up(&f->core)) {
        two_state_warm_up(&f->core, z);
        if (!two_state_warming_up(&f->core)) {
            start_acceleration(f);
        }
    } else {
        take(f, z);
    }
    return f->core.x_lsb_q16;
}

int32_t kf3_coast(kf3_t *f)
{
    if (two_state_warming_up(&f->core)) {
        f->core.flags = FILTER_WARMING_UP;
    } else {
        f->core.flags = 0;
        predict(f);
        f->core.size_lsb_uq8 = 0;
        f->core.gain_uq16 = 0;
    }
    f->core.flags |= FILTER_COASTED;
    return f->core.x_lsb_q16;
}

void kf3_damp(kf3_t *f)
{
    two_state_damp(&f->core);
    f->acceleration_q16 >>= 1;
    f->p13_uq28 >>= 1;
    f->p23_uq28 >>= 2;
    f->p33_uq28 >>= 2;
}

/* Takes every sample as it is: nothing to be held back. */
void kf3_hold(kf3_t *f)
{
    (void)f;
}

void kf3_restart(kf3_t *f)
{
    two_state_restart(&f->core);
}

uint8_t kf3_flags(const kf3_t *f)
{
    return f->core.flags;
}

void kf3_probe(const kf3_t *f, filter_probe_t *out)
{
    two_state_probe(&f->core, out);
}
