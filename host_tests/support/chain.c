#include "support/chain.h"
#include "support/filters.h"

#include <string.h>

/* As in silence.c and pipeline.c. */
enum { QUARTER_DHZ = 400, HOLD_QUARTERS = 4, AWAY_SAMPLES = 2 };

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
    filter_noise_init(&chain->noise, rate_dhz, axis == 2);
    if (!init_default(&chain->filter, kind, rate_dhz)) {
        return false;
    }
    filter_set_noise(&chain->filter, filter_noise_r_lsb2_q8(&chain->noise));
    chain->rate_dhz = rate_dhz;
    chain->period_us = 10000000U / rate_dhz;
    chain->rail_high_lsb = (int16_t)(range_g * 256 - 1);
    return true;
}

/* False: the filter holds. */
static bool miss(chain_t *chain)
{
    chain->x_lsb_q16 = filter_missing(&chain->filter);
    filter_noise_gap(&chain->noise);
    if (chain->filter.quarters >= HOLD_QUARTERS) {
        chain->away = 1;
        return false;
    }
    chain->coasts++;
    return true;
}

static void coast_over_gap(chain_t *chain, uint64_t t_us)
{
    chain->coasts = chain->clipped ? chain->coasts : 0;
    if (!chain->has_sample) {
        return;
    }
    for (; t_us - chain->last_us >= chain->period_us + (chain->period_us >> 1); chain->last_us += chain->period_us) {
        if (!miss(chain)) {
            return;
        }
    }
}

/* As in tilt_axis.c: what the law has found, not below the estimate beside it. */
static uint32_t r_lsb2_q8(const chain_t *chain)
{
    uint32_t own_lsb2_q8 = filter_own_noise_lsb2_q8(&chain->filter);
    uint32_t estimated_lsb2_q8 = filter_noise_r_lsb2_q8(&chain->noise);
    return own_lsb2_q8 > estimated_lsb2_q8 ? own_lsb2_q8 : estimated_lsb2_q8;
}

/* After a hold: pipeline.c, rejoins. */
static bool rejoins(chain_t *chain, int16_t lsb)
{
    int16_t off_lsb = (int16_t)(lsb - ((((chain->x_lsb_q16 + 128) >> 8) + 128) >> 8));
    if ((uint32_t)(off_lsb * off_lsb) > r_lsb2_q8(chain) >> 5) {
        if (chain->away++ < AWAY_SAMPLES) {
            return false;
        }
        filter_restart(&chain->filter);
        chain->begun = true;
    }
    chain->away = 0;
    return true;
}

int32_t chain_sample(chain_t *chain, uint64_t t_us, int16_t lsb)
{
    coast_over_gap(chain, t_us);
    chain->last_us = t_us;
    chain->has_sample = true;
    chain->begun = false;
    chain->clipped = lsb >= chain->rail_high_lsb || lsb <= -chain->rail_high_lsb - 1;
    if (chain->clipped) {
        (void)miss(chain);
        chain->waits = true;
        return chain->x_lsb_q16;
    }
    if (filter_own_noise_lsb2_q8(&chain->filter) != 0) {
        filter_noise_gap(&chain->noise);
    } else if (filter_noise_update(&chain->noise, lsb)) {
        filter_set_noise(&chain->filter, filter_noise_r_lsb2_q8(&chain->noise));
    }
    int16_t z_lsb = chain->median.window == 0U ? lsb : median_update(&chain->median, lsb);
    chain->waits = chain->away != 0 && !rejoins(chain, lsb);
    if (!chain->waits) {
        chain->x_lsb_q16 = filter_update(&chain->filter, z_lsb);
    }
    return chain->x_lsb_q16;
}

double chain_r_lsb2(const chain_t *chain)
{
    return r_lsb2_q8(chain) / 256.0;
}
