#include "support/envelope.h"

#include <math.h>
#include <string.h>

#define P11_END 32768.0
#define Q22_MIN 5.96e-8 /* kalman.h: 4 / 2^26 */
#define GATE_SIGMA 3.0
#define S_MAX_PER_R 9.0

double noise_gain_of(double w1)
{
    if (w1 <= 0.0) {
        return 0.0;
    }
    double w2 = w1 * w1 / (2.0 - w1);
    return (2.0 * w1 * w1 + 2.0 * w2 - 3.0 * w1 * w2) / (w1 * (4.0 - 2.0 * w1 - w2));
}

double process_noise_per_r(uint16_t rate_dhz, double r_lsb2)
{
    double period_s = 10.0 / rate_dhz;
    return fmin(14.0, fmax(Q22_MIN, filter_parameter_q.standard * period_s * period_s * period_s / r_lsb2));
}

double time_constant_samples(uint16_t rate_dhz, double r_lsb2)
{
    return sqrt(2.0) / pow(process_noise_per_r(rate_dhz, r_lsb2), 0.25);
}

double longest_wait_samples(uint16_t rate_dhz, double r_lsb2)
{
    return cbrt(3.0 * P11_END / process_noise_per_r(rate_dhz, r_lsb2));
}

size_t band_window(filter_kind_t kind, uint16_t rate_dhz, double r_lsb2)
{
    envelope_facts_t facts = law_facts(kind).envelope;
    if (facts.forgets == 0.0) {
        return facts.forgets_samples;
    }
    double (*samples)(uint16_t, double) = facts.time_constant_samples;
    samples = (samples != NULL) ? samples : time_constant_samples;
    return (size_t)ceil(facts.forgets * samples(rate_dhz, r_lsb2 * facts.variance_ratio));
}

static uint32_t level_of(int16_t z_lsb)
{
    return (uint32_t)(filter_tracker_limited_z(z_lsb) - FILTER_Z_MIN_LSB);
}

void band_clear(band_t *b)
{
    memset(b, 0, sizeof *b);
}

static void take_out(band_t *b, uint32_t level)
{
    b->histogram[level]--;
    b->below -= level < b->median;
    b->start++;
    while (b->histogram[b->low] == 0) {
        b->low++;
    }
    while (b->histogram[b->high] == 0) {
        b->high--;
    }
}

/* below <= half < below + those at the median: of an even number the upper one of the middle. */
static void settle_median(band_t *b)
{
    size_t half = (b->end - b->start) / 2;
    while (b->below > half) {
        b->median--;
        b->below -= b->histogram[b->median];
    }
    while (b->below + b->histogram[b->median] <= half) {
        b->below += b->histogram[b->median];
        b->median++;
    }
}

void band_add(band_t *b, const int16_t *z_lsb, size_t window)
{
    uint32_t level = level_of(z_lsb[b->end]);
    if (b->start == b->end) {
        b->low = b->high = b->median = level;
    }
    b->histogram[level]++;
    b->below += level < b->median;
    b->low = level < b->low ? level : b->low;
    b->high = level > b->high ? level : b->high;
    b->end++;
    while (b->end - b->start > window) {
        take_out(b, level_of(z_lsb[b->start]));
    }
    settle_median(b);
}

double band_median_lsb(const band_t *b)
{
    return (double)b->median + FILTER_Z_MIN_LSB;
}

double band_outside_lsb(const band_t *b, double x_lsb)
{
    double low = (double)b->low + FILTER_Z_MIN_LSB;
    double high = (double)b->high + FILTER_Z_MIN_LSB;
    return fmax(0.0, fmax(low - x_lsb, x_lsb - high));
}

double band_spread_lsb(const band_t *b)
{
    return fmax((double)b->high - (double)b->median, (double)b->median - (double)b->low);
}

void hull_add(hull_t *h, int16_t z_lsb, double r_lsb2, uint32_t coasts)
{
    for (unsigned i = HULL_SAMPLES - 1; i > 0; i--) {
        h->z_lsb[i] = h->z_lsb[i - 1];
        h->r_lsb2[i] = h->r_lsb2[i - 1];
        h->coasts[i] = h->coasts[i - 1];
    }
    h->z_lsb[0] = filter_tracker_limited_z(z_lsb);
    h->r_lsb2[0] = r_lsb2;
    h->coasts[0] = coasts;
    h->filled += h->filled < HULL_SAMPLES;
}

double gate_reach_lsb(double r_lsb2)
{
    return GATE_SIGMA * sqrt(S_MAX_PER_R * r_lsb2);
}

double rate_max_lsb(uint16_t rate_dhz)
{
    return filter_parameter_ratemax.standard * 10.0 / rate_dhz;
}

bool hull_judge(const hull_t *h, uint16_t rate_dhz, double x_lsb, double *excess_lsb)
{
    double r_min = h->r_lsb2[0];
    double r_max = h->r_lsb2[0];
    double low = h->z_lsb[0];
    double high = h->z_lsb[0];
    double largest_step = 0.0;
    double steps = HULL_SAMPLES - 1.0;
    for (unsigned i = 1; i < HULL_SAMPLES; i++) {
        r_min = fmin(r_min, h->r_lsb2[i]);
        r_max = fmax(r_max, h->r_lsb2[i]);
        low = fmin(low, h->z_lsb[i]);
        high = fmax(high, h->z_lsb[i]);
        largest_step = fmax(largest_step, fabs((double)(h->z_lsb[i] - h->z_lsb[i - 1])));
        steps += h->coasts[i - 1];
    }
    double agree_lsb = 3.0 * sqrt(2.0 * r_min) + rate_max_lsb(rate_dhz) - 1.0; /* kalman.c rounds down */
    double bound_lsb = gate_reach_lsb(r_max) + steps * rate_max_lsb(rate_dhz);
    *excess_lsb = bound_lsb - fmax(0.0, fmax(low - x_lsb, x_lsb - high));
    return h->filled == HULL_SAMPLES && largest_step <= agree_lsb;
}
