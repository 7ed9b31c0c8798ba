#include "support_chain.h"
#include "support_filters.h"

#include <string.h>

const char *median_init(median_t *m, unsigned window)
{
    if (window % 2U == 0U) {
        return "median: an even window has no middle sample, take 3, 5, 7 or 9";
    }
    if (window < 3U || window > MEDIAN_WINDOW_MAX) {
        return "median: the window is outside 3..9";
    }
    memset(m, 0, sizeof *m);
    m->window = (uint8_t)window;
    return NULL;
}

int16_t median_update(median_t *m, int16_t z_lsb)
{
    memmove(m->seen_lsb + 1, m->seen_lsb, sizeof m->seen_lsb - sizeof m->seen_lsb[0]);
    m->seen_lsb[0] = z_lsb;
    m->filled = m->filled < m->window ? (uint8_t)(m->filled + 1U) : m->window;
    int16_t ascending[MEDIAN_WINDOW_MAX] = { 0 };
    for (uint8_t i = 0; i < m->filled; i++) {
        uint8_t at = i;
        for (; at > 0 && ascending[at - 1] > m->seen_lsb[i]; at--) {
            ascending[at] = ascending[at - 1];
        }
        ascending[at] = m->seen_lsb[i];
    }
    return ascending[m->filled / 2];
}

bool chain_begin(chain_t *chain, filter_kind_t kind, uint16_t rate_dhz, uint8_t range_g, int axis)
{
    memset(chain, 0, sizeof *chain);
    noise_init(&chain->path.noise, rate_dhz, axis == 2);
    if (!init_default(&chain->path.filter, kind, rate_dhz)) {
        return false;
    }
    filter_set_noise(&chain->path.filter, noise_r_lsb2_q8(&chain->path.noise));
    chain->rate_dhz = rate_dhz;
    chain->period_us = 10000000U / rate_dhz;
    chain->rail_high_lsb = (int16_t)(range_g * 256 - 1);
    return true;
}

static void coast_over_gap(chain_t *chain, uint64_t t_us)
{
    chain->coasts = 0;
    if (!chain->has_sample) {
        return;
    }
    for (; t_us - chain->last_us >= chain->period_us + (chain->period_us >> 1); chain->last_us += chain->period_us) {
        tilt_axis_missing(&chain->path);
        chain->x_lsb_q16 = chain->path.filter.x_lsb_q16;
        if (chain->path.away != 0) {
            return;
        }
        chain->coasts++;
    }
}

/* tilt_axis_update with the median of the samples in place of the sample, where there is one. */
static uint8_t take_median(chain_t *chain, int16_t lsb)
{
    int16_t z_lsb = median_update(&chain->median, lsb);
    if (chain->clipped && chain->path.away != 0) {
        return FILTER_GATED;
    }
    uint8_t flags = chain->clipped ? 0 : tilt_axis_hear(&chain->path, lsb, true);
    if (flags == FILTER_GATED) {
        return flags;
    }
    (void)filter_update(&chain->path.filter, z_lsb);
    return flags;
}

int32_t chain_sample(chain_t *chain, uint64_t t_us, int16_t lsb)
{
    coast_over_gap(chain, t_us);
    chain->last_us = t_us;
    chain->has_sample = true;
    bool held = chain->path.away != 0;
    chain->clipped = tilt_axis_at_rail(lsb, chain->rail_high_lsb);
    uint8_t flags = chain->median.window != 0U ? take_median(chain, lsb)
                                               : tilt_axis_update(&chain->path, lsb, chain->rail_high_lsb, true);
    chain->waits = chain->path.away != 0;
    chain->begun = held && (flags & FILTER_REACQUIRED) != 0;
    chain->x_lsb_q16 = chain->path.filter.x_lsb_q16;
    return chain->x_lsb_q16;
}

double chain_r_lsb2(const chain_t *chain)
{
    return noise_r_lsb2_q8(&chain->path.noise) / 256.0;
}
