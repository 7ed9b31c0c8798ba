/* Consistency re-acquisition: see reacquire.h. */
#include "reacquire.h"

FX_ONCE bool reacquire_steps_legal(uint16_t samples)
{
    return samples == 0U || samples == 3U || samples == 5U || samples == 9U;
}

bool reacquire_legal(uint16_t samples, uint32_t rate_max_lsb_s)
{
    return reacquire_steps_legal(samples) && rate_max_lsb_s >= REACQUIRE_RATE_MAX_MIN_LSB_S &&
           rate_max_lsb_s <= REACQUIRE_RATE_MAX_MAX_LSB_S;
}

void reacquire_init(reacquire_t *a, uint16_t samples)
{
    a->steps = (samples == 0U) ? 0U : (uint8_t)(samples - 1U);
    a->first_lsb = 0;
    reacquire_reset(a, 0);
}

void reacquire_set_noise(reacquire_t *a, const two_state_t *s)
{
    uint32_t spread_q4 = fx_isqrt32(18U * s->r_lsb2_q8); /* 3 sqrt(2 R) */
    uint32_t motion_q4 = s->rate_max_lsb_q16 >> 12;
    uint32_t agree_lsb = (spread_q4 + motion_q4) >> 4;
    a->agree_lsb = (uint16_t)agree_lsb;
}

void reacquire_reset(reacquire_t *a, int16_t z0_lsb)
{
    a->previous_lsb = z0_lsb;
    a->run = 0;
    a->broken = false;
}

void reacquire_hold(reacquire_t *a)
{
    if (a->run > 1U) {
        a->run = 1;
    }
}

/* Position and rate from the ends of a run of L samples: variances R, R / (L-1), 2 R / (L-1)^2. */
FX_NOINLINE void restart(reacquire_t *a, two_state_t *s, int16_t z_lsb)
{
    two_state_start(s, (int32_t)z_lsb * 65536);
    if (!a->broken) {
        int32_t slope = (int32_t)(z_lsb - a->first_lsb) * 32768; /* over 2 samples; the factor holds 15 halvings */
        uint32_t p12 = 0x08000000U;                              /* 1/2, UQ4.28 */
        uint32_t p22 = 0x08000000U;                              /* 2/4 */
        for (uint8_t steps = a->steps; steps > 2U; steps >>= 1) {
            slope >>= 1;
            p12 >>= 1;
            p22 >>= 2;
        }
        s->rate_lsb_q16 = fx_clamp(slope, (int32_t)s->rate_max_lsb_q16);
        s->u.p.p12_uq28 = p12;
        s->u.p.p22_uq28 = p22 + s->q22_uq28;
    }
    s->flags = FILTER_REACQUIRED;
    a->run = 0;
}

bool reacquire_refused(reacquire_t *a, two_state_t *s, int16_t z_lsb)
{
    int16_t step = (int16_t)(z_lsb - a->previous_lsb);
    uint16_t distance = (uint16_t)((step < 0) ? -step : step);
    if (a->run == 0U || distance > a->agree_lsb) {
        a->run = 1;
        a->first_lsb = z_lsb;
        a->broken = false;
        return false;
    }
    if (a->steps == 0U) {
        return false;
    }
    if (a->run >= a->steps) {
        restart(a, s, z_lsb);
        return true;
    }
    a->run++;
    return false;
}
