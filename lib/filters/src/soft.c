/* Kalman filter with a soft gate and consistency re-acquisition around the core of two_state.h. */
#include "soft.h"

#define SOFT_DEFAULT_SIGMA_Q8 512U

static const filter_parameter_t parameters[] FX_FLASH = {
    { "r", "LSB2", offsetof(soft_config_t, r_lsb2_q8), 4, 8, 0, 0, FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8 },
    { "q", "LSB2/s3", offsetof(soft_config_t, q_lsb2_s3), 4, 0, 0, 0, TWO_STATE_Q_MIN_LSB2_S3,
      TWO_STATE_Q_MAX_LSB2_S3 },
    { "softgate", "sigma", offsetof(soft_config_t, soft_sigma_q8), 2, 8, 1, 0, TWO_STATE_GATE_MIN_SIGMA_Q8,
      TWO_STATE_GATE_MAX_SIGMA_Q8 },
    { "gate", "sigma", offsetof(soft_config_t, gate_sigma_q8), 2, 8, 1, 0, TWO_STATE_GATE_MIN_SIGMA_Q8,
      TWO_STATE_GATE_MAX_SIGMA_Q8 },
    { "reacquire", "samples", offsetof(soft_config_t, reacquire_samples), 2, 0, 1, 0, REACQUIRE_SAMPLES_MIN,
      REACQUIRE_SAMPLES_MAX },
    { "ratemax", "LSB/s", offsetof(soft_config_t, rate_max_lsb_s), 4, 0, 0, 0, REACQUIRE_RATE_MAX_MIN_LSB_S,
      REACQUIRE_RATE_MAX_MAX_LSB_S },
};

const filter_descriptor_t soft_descriptor FX_FLASH = { "soft", sizeof parameters / sizeof parameters[0], parameters };

void soft_defaults(soft_config_t *config, uint16_t rate_dhz)
{
    config->rate_dhz = rate_dhz;
    config->r_lsb2_q8 = filter_default_r_lsb2_q8(rate_dhz);
    config->q_lsb2_s3 = TWO_STATE_Q_DEFAULT_LSB2_S3;
    config->soft_sigma_q8 = SOFT_DEFAULT_SIGMA_Q8;
    config->gate_sigma_q8 = TWO_STATE_GATE_DEFAULT_SIGMA_Q8;
    config->reacquire_samples = REACQUIRE_SAMPLES_DEFAULT;
    config->rate_max_lsb_s = REACQUIRE_RATE_MAX_DEFAULT_LSB_S;
}

/*
 * (softgate / gate)^2, at most 65535 / 65536, so that with a gate inside the soft gate all that lies beyond the latter
 * is flagged; 0 without a gate: nothing is.
 */
static uint16_t flagged_share_uq16(uint16_t soft_sigma_q8, uint16_t gate_sigma_q8)
{
    if (gate_sigma_q8 == 0U) {
        return 0;
    }
    fx_scaled_t ratio = fx_scaled_div(fx_scaled(soft_sigma_q8), fx_scaled(gate_sigma_q8));
    uint32_t share = fx_scaled_fixed(fx_scaled_mul(ratio, ratio), 16);
    return (share > 0xFFFFU) ? 0xFFFFU : (uint16_t)share;
}

void soft_configure(soft_t *f, const soft_config_t *config)
{
    two_state_init(&f->core, config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3, config->rate_max_lsb_s);
    reacquire_init(&f->again, config->reacquire_samples);
    f->soft_sigma_q8 = config->soft_sigma_q8;
    f->share_uq16 = flagged_share_uq16(config->soft_sigma_q8, config->gate_sigma_q8);
    soft_set_noise(f, config->r_lsb2_q8);
}

bool soft_together(const soft_config_t *config)
{
    return reacquire_steps_legal(config->reacquire_samples);
}

bool soft_init(soft_t *f, const soft_config_t *config)
{
    if (!two_state_legal(config->rate_dhz, config->r_lsb2_q8, config->q_lsb2_s3) ||
        !two_state_gate_legal(config->soft_sigma_q8) || !two_state_gate_legal(config->gate_sigma_q8) ||
        !reacquire_legal(config->reacquire_samples, config->rate_max_lsb_s)) {
        return false;
    }
    soft_configure(f, config);
    return true;
}

void soft_set_noise(soft_t *f, uint32_t r_lsb2_q8)
{
    two_state_set_noise(&f->core, r_lsb2_q8);
    two_state_set_gate(&f->core, f->soft_sigma_q8);
    reacquire_set_noise(&f->again, &f->core);
}

void soft_reset(soft_t *f, int16_t z0_lsb)
{
    reacquire_reset(&f->again, two_state_reset(&f->core, z0_lsb));
}

bool soft_reset_step(soft_t *f, int16_t z0_lsb, uint8_t step)
{
    reacquire_reset(&f->again, filter_clamp_z(z0_lsb));
    return two_state_reset_step(&f->core, z0_lsb, step);
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
 * m = softgate^2 R / r^2, so below 1 / S: UQ0.20, within 2^-18, and never 0, so the furthest sample counts too. With
 * |r| = m' 2^b LSB/256, 1 <= m' < 2, and K = 16 softgate^2 R it is K / m'^2 x 2^(16 - 2 b) counts. r^2 > K / 16 >= 1/16
 * LSB^2 makes b >= 6; the coarse K is 256 times as large, and r^2 >= 4096 LSB^2 makes b >= 14.
 */
FX_INLINE uint32_t weight_uq20(const two_state_t *s)
{
    uint32_t size = s->size_lsb_uq8;
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
    FX_FENCE();
    uint32_t weight = fx_mul_u16(s->gate_lsb2_uq4, fx_mul16_uq16(inverse, inverse));
    if (s->coarse) {
        b = (uint8_t)(b - 4U);
    }
    return placed(weight, b) | 1U;
}

/* |r| w in LSB, Q16, rounded down; |r| to whole LSB from 256 LSB on. */
FX_INLINE int32_t part_of_innovation(const two_state_t *s, uint32_t w_uq24)
{
    bool far = (uint8_t)(s->size_lsb_uq8 >> 16) != 0U;
    uint16_t size = far ? (uint16_t)(s->size_lsb_uq8 >> 8) : (uint16_t)s->size_lsb_uq8;
    uint32_t product = fx_mul24_uq16(w_uq24, size);
    return far ? (int32_t)product : (int32_t)(product >> 8);
}

/* At most 1: so small that the steps stay below |r|. */
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

/* The rate moved by so much in the direction of the innovation; it can leave its range on that side only. */
FX_INLINE void move_rate(two_state_t *s, int32_t step_lsb_q16)
{
    int32_t rate = s->rate_lsb_q16;
    int32_t limit = (int32_t)s->rate_max_lsb_q16;
    bool beyond;
    if (s->negative) {
        rate -= step_lsb_q16;
        limit = -limit;
        /*@ assert rate < -301989888 || -301989888 <= rate; */ /* for make proof, as in two_state.c */
        beyond = rate < limit;
    } else {
        rate += step_lsb_q16;
        /*@ assert rate <= 301989888 || 301989888 < rate; */
        beyond = rate > limit;
    }
    if (beyond) {
        rate = limit;
        s->flags |= FILTER_SATURATED;
    }
    s->rate_lsb_q16 = rate;
}

/* x and P11 with the gain w1 = P11 m. x moves by a count more than w1 r, so that no sample is without effect. */
FX_INLINE void update_x(two_state_t *s, uint32_t w1_uq24)
{
    int32_t x_step = part_of_innovation(s, w1_uq24) + 1;
    if (s->negative) {
        s->x_lsb_q16 -= x_step;
    } else {
        s->x_lsb_q16 += x_step;
    }
    FX_FENCE();
    s->u.p.p11_uq28 = fx_mul24_uq16(s->u.p.p11_uq28 >> 8, (uint16_t)~s->gain_uq16);
}

/* Rate, P12 and P22 with w2 = P12 m. */
FX_INLINE void update_rate(two_state_t *s, uint32_t m_uq20)
{
    uint32_t p12_uq20 = s->u.p.p12_uq28 >> 8;
    s->u.p.p12_uq28 = fx_mul24_uq16(p12_uq20, (uint16_t)~s->gain_uq16);
    FX_FENCE();
    uint32_t w2_uq24 = limited_uq24(fx_mul24_uq24(p12_uq20, m_uq20));
    uint16_t w2_uq16 = (uint16_t)(w2_uq24 >> 8);
    int32_t p22_q28 = (int32_t)s->u.p.p22_uq28 - (int32_t)fx_mul24_uq16(p12_uq20, w2_uq16); /* < 3 less < 4: fits */
    s->u.p.p22_uq28 = (p22_q28 < 0) ? 0U : (uint32_t)p22_q28;
    FX_FENCE();
    move_rate(s, part_of_innovation(s, w2_uq24));
}

/*
 * A sample beyond the soft gate, predicted over by the core. Its share S / S_eff = S m = m + w1 tells whether it lies
 * beyond the gate: r^2 > gate^2 S where S m < (softgate / gate)^2.
 */
FX_NOINLINE void take_part(soft_t *f, int16_t z_lsb)
{
    two_state_t *s = &f->core;
    uint32_t m_uq20 = weight_uq20(s);
    FX_FENCE();
    uint32_t w1_uq24 = limited_uq24(fx_mul24_uq24(s->u.p.p11_uq28 >> 8, m_uq20));
    s->gain_uq16 = (uint16_t)(w1_uq24 >> 8);
    FX_FENCE();
    uint16_t weight = weight_uq16(m_uq20);
    uint16_t share_uq16 = (uint16_t)(weight + s->gain_uq16);
    if (share_uq16 >= weight && share_uq16 < f->share_uq16) { /* rounding may carry the sum of a share of 1 past it */
        if (reacquire_refused(&f->again, s, z_lsb)) {
            return;
        }
    } else {
        f->again.run = 0;
        s->flags = (uint8_t)(s->flags & ~FILTER_GATED);
    }
    FX_FENCE();
    update_x(s, w1_uq24);
    FX_FENCE();
    update_rate(s, m_uq20);
}

/*
 * Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; within the soft gate formats,
 * bounds and rounding errors as two_state_step. Beyond it
 *   m        UQ0.20, of r rounded down to 2^-8 LSB and gate_lsb2_uq4 (softgate^2 R, 1/16 LSB^2), within 2^-18
 *   w1, w2   UQ0.24, <= 1, from P11 and P12 in UQ4.20; P11 and P12 times 1 - w1 - 2^-16 rounded to 2^-28, so they fall;
 *            P22 less P12 w2 (w2 rounded down to 2^-16), not below 0
 *   steps    of x rounded up, of the rate down to 2^-16; both below |r| + 2^-16 LSB (x: w1 < 8/9), so x stays between
 *            prediction and sample and the bounds of two_state_step hold
 *   gate     where S / S_eff is (softgate / gate)^2 within 2^-15
 * Cost: docs/benchmarks.md.
 */
int32_t soft_update(soft_t *f, int16_t z_lsb)
{
    int16_t z = filter_clamp_z(z_lsb);
    if (two_state_warming_up(&f->core)) {
        two_state_warm_up(&f->core, z);
    } else if (two_state_step(&f->core, z, true)) {
        f->again.run = 0;
    } else {
        take_part(f, z);
    }
    f->again.previous_lsb = z;
    return f->core.x_lsb_q16;
}

int32_t soft_coast(soft_t *f)
{
    f->again.broken = true;
    return two_state_coast(&f->core);
}

void soft_damp(soft_t *f)
{
    two_state_damp(&f->core);
}

void soft_hold(soft_t *f)
{
    reacquire_hold(&f->again);
}

void soft_restart(soft_t *f)
{
    two_state_restart(&f->core);
    f->again.run = 0;
}

uint8_t soft_flags(const soft_t *f)
{
    return f->core.flags;
}

/* A gain too small for its 16 bits is told as 2^-16: only refused samples have none, and soft refuses none. */
void soft_probe(const soft_t *f, filter_probe_t *out)
{
    two_state_probe(&f->core, out);
    if (out->gain_uq16 == 0U && (out->flags & FILTER_GATED) != 0U) {
        out->gain_uq16 = 1;
    }
}
