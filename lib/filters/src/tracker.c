/* The tracker's functions that laws are built from: see tracker.h. */
#include "tracker.h"

void filter_tracker_clear(void *state, size_t size)
{
    uint8_t *at = (uint8_t *)state;
    for (; size != 0U; size--) {
        *at++ = 0;
    }
}

MACHINE_APART int16_t filter_tracker_limited_z(int16_t z_lsb)
{
    if (z_lsb > FILTER_Z_MAX_LSB) {
        return FILTER_Z_MAX_LSB;
    }
    return (int16_t)((z_lsb < FILTER_Z_MIN_LSB) ? FILTER_Z_MIN_LSB : z_lsb);
}

void filter_tracker_meet(filter_t *f, int16_t z_lsb)
{
    int32_t innovation = (int32_t)z_lsb * 65536 - f->x_lsb_q16;
    bool negative = false;
    if (innovation < 0) {
        innovation = -innovation;
        negative = true;
    }
    f->negative = negative;
    f->size_lsb_uq16 = (uint32_t)innovation;
}

void filter_tracker_nothing(filter_t *f)
{
    f->size_lsb_uq16 = 0;
    f->gain_uq16 = 0;
}

static int32_t towards_sample(const filter_t *f, int32_t step)
{
    return f->negative ? -step : step;
}

void filter_tracker_move(filter_t *f, int32_t step_lsb_q16)
{
    f->x_lsb_q16 += towards_sample(f, step_lsb_q16);
}

void filter_tracker_turn(filter_t *f, int32_t step_lsb)
{
    int32_t rate = f->rate_lsb + towards_sample(f, step_lsb);
    f->rate_lsb = fx_clamp(rate, (int32_t)f->rate_max_lsb);
    if (f->rate_lsb != rate) {
        f->flags |= FILTER_SATURATED;
    }
}

void filter_tracker_limit_rate(filter_t *f, uint32_t rate_max_lsb_s, uint8_t fraction_bits)
{
    uint32_t most = (fraction_bits == 16U) ? (uint32_t)TRACKER_X_MAX_LSB_Q16 : (uint32_t)127 << 24;
    f->rate_max_lsb = most;
    if (rate_max_lsb_s != 0U) {
        fx_scaled_t per_sample = filter_fx_scaled_div(filter_fx_scaled(rate_max_lsb_s * 10U),
                                                      filter_fx_scaled(f->rate_dhz));
        uint32_t limit = filter_fx_scaled_fixed(per_sample, fraction_bits);
        f->rate_max_lsb = (limit < most) ? limit : most;
    }
}

int32_t filter_tracker_median_q16(const int16_t *ascending_lsb, uint8_t count)
{
    int16_t high = ascending_lsb[count >> 1];
    int16_t low = ((count & 1U) != 0U) ? high : ascending_lsb[(count >> 1) - 1];
    return ((int32_t)(int16_t)(low + high) * 65536) >> 1; /* the factor 65536 makes it even: halving is exact */
}

MACHINE_APART uint32_t filter_tracker_limited_r(uint32_t r_lsb2_q8)
{
    if (r_lsb2_q8 < FILTER_R_MIN_LSB2_Q8) {
        return FILTER_R_MIN_LSB2_Q8;
    }
    return (r_lsb2_q8 > FILTER_R_MAX_LSB2_Q8) ? FILTER_R_MAX_LSB2_Q8 : r_lsb2_q8;
}

void filter_tracker_halve(uint32_t *p)
{
    *p >>= 1;
}

void filter_tracker_fade(filter_t *f, bool first)
{
    void (*own)(filter_t *, bool) = LAW_OF(f, fade);
    if (own != NULL) {
        own(f, first);
    }
}

void filter_tracker_damp(filter_t *f)
{
    f->rate_lsb >>= 1;
    if ((flash_u8(&f->law->traits) & LAW_COVARIANCE) != 0U) {
        filter_covariance_t *p = &f->own.kalman.p; /* P of (x, v / 2): stays a covariance within its bounds */
        filter_tracker_halve(&p->p12);
        filter_tracker_halve(&p->p22);
        filter_tracker_halve(&p->p22);
    }
    filter_tracker_fade(f, false);
}

MACHINE_APART uint16_t filter_tracker_memory_k_uq16(uint16_t memory_ms, uint16_t rate_dhz, uint16_t k_min_uq16)
{
    uint32_t k_uq16 = 1310720000U / ((uint32_t)memory_ms * rate_dhz);
    if (k_uq16 > TRACKER_K_MAX_UQ16) {
        return TRACKER_K_MAX_UQ16;
    }
    return (k_uq16 < k_min_uq16) ? k_min_uq16 : (uint16_t)k_uq16;
}

uint32_t filter_tracker_fading_variance(uint32_t r_lsb2_q8, uint16_t k_uq16)
{
    uint32_t bracket_uq16 = 655360U - 14U * (uint32_t)k_uq16 + 5U * (uint32_t)filter_fx_high_u16(k_uq16, k_uq16);
    fx_scaled_t below = filter_fx_scaled(0x20000U - k_uq16);
    fx_scaled_t v = filter_fx_scaled_mul(filter_fx_scaled(r_lsb2_q8), filter_fx_scaled(k_uq16));
    v = filter_fx_scaled_div(filter_fx_scaled_mul(v, filter_fx_scaled(bracket_uq16)),
                             filter_fx_scaled_mul(below, filter_fx_scaled_mul(below, below)));
    return filter_fx_scaled_fixed(v, 16);
}
