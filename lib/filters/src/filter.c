/*
 * The tracker: what all filters have in common. See filter.h; the functions that laws are built from are in tracker.c.
 */
#include "filter.h"

#include "tracker.h"

/*
 * Steps from filter_kalman_near until a covariance is close to where it settles. Least accurate at the smallest process
 * noise, of which the start has one digit.
 */
#define SETTLE_STEPS 16U

/* 25 ms are 1/400 of the rate in 0.1 Hz. */
#define QUARTER_DHZ 400U
#define HOLD_QUARTERS (FILTER_HOLD_MS / 25)

filter_answer_t filter_init(filter_t *f, const filter_law_t *law, const filter_config_t *config)
{
    filter_answer_t answer = filter_judge(law, config);
    if (answer == FILTER_ACCEPTED) {
        filter_tracker_clear(f, sizeof *f);
        f->law = law;
        f->rate_dhz = config->rate_dhz;
        LAW_OF(f, set_up)(f, config);
        filter_restart(f);
    }
    return answer;
}

void filter_set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    LAW_OF(f, set_noise)(f, filter_tracker_limited_r(r_lsb2_q8));
}

bool filter_limited(const filter_t *f)
{
    return f->q_limited;
}

uint32_t filter_own_noise_lsb2_q8(const filter_t *f)
{
    uint32_t (*own)(const filter_t *) = LAW_OF(f, own_noise);
    return (own == NULL) ? 0U : own(f);
}

static uint8_t traits(const filter_t *f)
{
    return flash_u8(&f->law->traits);
}

/* Starts running from x at rest, with the law's initial state. */
static void start(filter_t *f, bool settled)
{
    f->collected = FILTER_RUNNING;
    LAW_OF(f, start)(f, settled);
}

void filter_reset(filter_t *f, int16_t z0_lsb)
{
    int16_t z0 = filter_tracker_limited_z(z0_lsb);
    filter_restart(f);
    f->previous_lsb = z0;
    f->x_lsb_q16 = (int32_t)z0 * 65536;
    start(f, true);
    if ((traits(f) & LAW_COVARIANCE) != 0U) {
        for (uint8_t step = SETTLE_STEPS; step != 0U; step--) {
            LAW_OF(f, step)(f, z0, STEP_SETTLE);
        }
    }
    f->flags = 0;
}

/* One sample of the start: the running median of the samples so far, or, as published, the first sample. */
static void collect(filter_t *f, int16_t z_lsb)
{
    uint8_t count = f->collected;
    int16_t *at = &f->own.start.ascending_lsb[count];
    for (; at != f->own.start.ascending_lsb && at[-1] > z_lsb; at--) {
        at[0] = at[-1];
    }
    *at = z_lsb;
    f->collected = ++count;
    f->x_lsb_q16 = filter_tracker_median_q16(f->own.start.ascending_lsb, count);
    f->flags |= FILTER_WARMING_UP;
    if (count == FILTER_RUNNING || (traits(f) & LAW_FIRST_SAMPLE) != 0U) {
        start(f, false);
    }
}

int32_t filter_update(filter_t *f, int16_t z_lsb)
{
    uint8_t flags = 0;
    if ((uint16_t)((uint16_t)z_lsb - (uint16_t)FILTER_Z_MIN_LSB) > (uint16_t)(FILTER_Z_MAX_LSB - FILTER_Z_MIN_LSB)) {
        z_lsb = filter_tracker_limited_z(z_lsb);
        flags = FILTER_SATURATED;
    }
    f->flags = flags;
    f->quarters = 0;
    if (f->collected != FILTER_RUNNING) {
        collect(f, z_lsb);
    } else {
        LAW_OF(f, step)(f, z_lsb, STEP_SAMPLE);
    }
    f->previous_lsb = z_lsb;
    return f->x_lsb_q16;
}

/*
 * Multiples of 25 ms since the previous prediction. Step n uses the rate in force at its middle, (n - 1/2) periods
 * after the last sample.
 */
static uint8_t quarters_passed(filter_t *f, bool first)
{
    uint16_t part_dhz = first ? QUARTER_DHZ / 2U : (uint16_t)(f->quarter_dhz + QUARTER_DHZ);
    uint8_t passed = 0;
    for (; part_dhz >= f->rate_dhz; passed++) {
        part_dhz = (uint16_t)(part_dhz - f->rate_dhz);
    }
    f->quarter_dhz = part_dhz;
    return passed;
}

int32_t filter_missing(filter_t *f)
{
    bool first = (f->flags & FILTER_COASTED) == 0U;
    f->broken = true;
    f->flags = FILTER_COASTED;
    if (f->collected != FILTER_RUNNING) {
        f->flags = FILTER_COASTED | FILTER_WARMING_UP;
        return f->x_lsb_q16;
    }
    uint8_t passed = quarters_passed(f, first);
    f->quarters = (uint8_t)(f->quarters + passed);
    if (f->quarters >= HOLD_QUARTERS) {
        f->quarters = HOLD_QUARTERS;
    } else {
        if (first) {
            filter_tracker_fade(f, true);
        }
        for (; passed != 0U; passed--) {
            filter_tracker_damp(f);
        }
        LAW_OF(f, step)(f, 0, STEP_MISSING);
    }
    filter_tracker_nothing(f);
    return f->x_lsb_q16;
}

void filter_restart(filter_t *f)
{
    f->rate_lsb = 0;
    filter_tracker_nothing(f);
    f->collected = 0;
    f->quarters = 0;
    f->broken = false;
    f->flags = FILTER_WARMING_UP;
}

#ifndef FILTER_WITHOUT_PROBE
void filter_probe(const filter_t *f, filter_probe_t *out)
{
    out->x_lsb_q16 = f->x_lsb_q16;
    out->rate_lsb_q16 = 0;
    if ((f->flags & FILTER_WARMING_UP) == 0U) {
        out->rate_lsb_q16 = (traits(f) & LAW_FINE_RATE) != 0U ? f->rate_lsb >> 8 : f->rate_lsb;
    }
    out->innovation_lsb_q16 = f->negative ? -(int32_t)f->size_lsb_uq16 : (int32_t)f->size_lsb_uq16;
    out->gate_lsb2_q8 = UINT32_MAX;
    out->gain_uq16 = f->gain_uq16;
    out->flags = f->flags;
    LAW_OF(f, report)(f, out);
}
#endif
