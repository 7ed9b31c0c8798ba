/* One axis of the path from readings to tilt: see tilt_axis.h. */
#include "tilt_axis.h"

#include "fx.h"

enum { AWAY_SAMPLES = 2 }; /* in a row, away from the held value: not a bad reading */
enum { HOLD_QUARTERS = FILTER_HOLD_MS / 25 };

void tilt_axis_begin(tilt_axis_t *a, uint16_t rate_dhz, bool noisy_axis)
{
    a->away = 0;
    filter_noise_init(&a->noise, rate_dhz, noisy_axis);
    filter_set_noise(&a->filter, filter_noise_r_lsb2_q8(&a->noise));
}

int32_t tilt_axis_estimate_q8(const tilt_axis_t *a)
{
    return (a->filter.x_lsb_q16 + 128) >> 8;
}

MACHINE_APART int16_t tilt_axis_estimate_lsb(const tilt_axis_t *a)
{
    return (int16_t)((tilt_axis_estimate_q8(a) + 128) >> 8);
}

_Static_assert((int)TILT_GATED == (int)FILTER_GATED && (int)TILT_REACQUIRED == (int)FILTER_REACQUIRED, "same bits");

static uint8_t flags_of(const filter_t *f)
{
    uint8_t flags = f->flags & (FILTER_GATED | FILTER_REACQUIRED);
    if ((f->flags & FILTER_WARMING_UP) != 0U) {
        flags |= TILT_WARMING_UP;
    }
    return flags;
}

/* R is estimated once: with a law that identifies its own, the estimator does not run. */
static void estimate_noise(tilt_axis_t *a, int16_t lsb, bool own_r)
{
    if (a->filter.identifies) {
        filter_noise_gap(&a->noise);
    } else if (filter_noise_update(&a->noise, lsb) && !own_r) {
        filter_set_noise(&a->filter, filter_noise_r_lsb2_q8(&a->noise));
    }
}

/*
 * Within 2.8 sigmas of the estimate, using the R of the noise; that is 3.5 sigmas of a healthy sensor. R is the law's
 * if it has identified it, but not less than the separate estimate, which then is at its floor or where it last ran.
 */
static bool near_estimate(const tilt_axis_t *a, int16_t lsb)
{
    int16_t off_lsb = (int16_t)(lsb - tilt_axis_estimate_lsb(a));
    uint16_t size_lsb = (uint16_t)((off_lsb < 0) ? -off_lsb : off_lsb);
    uint32_t r_lsb2_q8 = filter_noise_r_lsb2_q8(&a->noise);
    uint32_t own_lsb2_q8 = filter_own_noise_lsb2_q8(&a->filter);
    if (own_lsb2_q8 > r_lsb2_q8) {
        r_lsb2_q8 = own_lsb2_q8;
    }
    return fx_product_u16(size_lsb, size_lsb) <= r_lsb2_q8 >> 5;
}

/* A sample after a hold. The filter does not get it as long as a->away is not 0. */
static uint8_t rejoin(tilt_axis_t *a, int16_t lsb)
{
    uint8_t flags = 0;
    if (!near_estimate(a, lsb)) {
        if (a->away++ < (uint8_t)AWAY_SAMPLES) {
            return TILT_GATED;
        }
        filter_restart(&a->filter);
        flags = TILT_REACQUIRED;
    }
    a->away = 0;
    return flags;
}

static MACHINE_APART void miss(tilt_axis_t *a)
{
    filter_noise_gap(&a->noise);
    (void)filter_missing(&a->filter);
    if (a->filter.quarters == (uint8_t)HOLD_QUARTERS) {
        a->away = 1;
    }
}

uint8_t tilt_axis_update(tilt_axis_t *a, int16_t lsb, int16_t rail_high_lsb, bool own_r)
{
    uint8_t flags = 0;
    if (tilt_at_rail(lsb, rail_high_lsb)) {
        miss(a);
        return (uint8_t)(TILT_CLIPPED | flags_of(&a->filter));
    }
    estimate_noise(a, lsb, own_r);
    if (a->away != 0U) {
        flags = rejoin(a, lsb);
    }
    if (a->away == 0U) {
        (void)filter_update(&a->filter, lsb);
        flags |= flags_of(&a->filter);
    }
    return flags;
}

uint8_t tilt_axis_missing(tilt_axis_t *a)
{
    miss(a);
    return (uint8_t)(TILT_COASTED | flags_of(&a->filter));
}
