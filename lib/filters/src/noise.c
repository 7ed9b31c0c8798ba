/* Winsorised variance of the smaller of two second differences; see noise.h. */
#include "noise.h"

#include "fx.h"
#include "tracker.h"

/*
 * With a, b independent standard normal and m = min(a^2, b^2), the factor w solves w = E min(m, c w). A second
 * difference has 6 times the variance of a sample, so m / 6w limited to c times the variance has the variance as its
 * mean. E min(m, L) is the integral of erfc(sqrt(t / 2))^2 over 0..L (a test repeats it). c = 3: 1 / 6w = 0.62428. c =
 * 4.5 for the first terms, when the estimate may have to climb from the floor: 1 / 6w = 0.51451.
 */
#define UNBIAS_UQ16 40913U
#define UNBIAS_OPENING_UQ16 33719U
#define OPENING_TERMS 64U

/*
 * From this output data rate on, every second sample is used: at lower rates motion would curve too much within four
 * samples.
 */
#define SPACED_MIN_DHZ 700U

#define HISTORY 5U

/* 1000 LSB^2 / 1.5 */
#define MEAN_MAX_LSB2_Q16 43690667U

/* 1.5 times a variance: Q16 to Q8. */
static uint32_t r_of(uint32_t mean_lsb2_q16)
{
    return (mean_lsb2_q16 + (mean_lsb2_q16 >> 1) + 128U) >> 8;
}

void filter_noise_init(noise_t *n, uint16_t rate_dhz, bool noisy_axis)
{
    /* 0.02 LSB^2 / Hz in Q16 per 0.1 Hz: 131.07; times 1.7 */
    uint16_t each_q16 = noisy_axis ? 223U : 131U;
    filter_tracker_clear(n, sizeof *n);
    n->floor_lsb2_q16 = (uint32_t)rate_dhz * each_q16;
    n->mean_lsb2_q16 = n->floor_lsb2_q16;
    n->r_lsb2_q8 = r_of(n->floor_lsb2_q16);
    n->spaced = rate_dhz >= SPACED_MIN_DHZ;
}

void filter_noise_gap(noise_t *n)
{
    n->filled = 0;
}

/*
 * |a - 2 b + c| of samples within the sensor's range, limited to 255: the largest that matters is sqrt(667 x 4.5 x 6) =
 * 134.
 */
static MACHINE_APART uint8_t bend_lsb(int16_t a, int16_t b, int16_t c)
{
    int16_t bend = (int16_t)(a - b - b + c); /* <= 4 x 4096 */
    uint16_t size = (uint16_t)((bend < 0) ? -bend : bend);
    return (size > 255U) ? 255U : (uint8_t)size;
}

/* The smaller of two second differences that share no sample. */
static uint8_t smaller_bend_lsb(const noise_t *n, int16_t z_lsb)
{
    const int16_t *old = n->history_lsb;
    uint8_t one;
    uint8_t other;
    if (n->spaced) {
        one = bend_lsb(z_lsb, old[1], old[3]);
        other = bend_lsb(old[0], old[2], old[4]);
    } else {
        one = bend_lsb(z_lsb, old[0], old[1]);
        other = bend_lsb(old[2], old[3], old[4]);
    }
    return (one < other) ? one : other;
}

/* The variance that a difference corresponds to, limited; Q16. */
static uint32_t term_lsb2_q16(const noise_t *n, uint8_t bend)
{
    bool opening = n->terms < OPENING_TERMS;
    uint32_t term = fx_product_u16((uint16_t)((uint16_t)bend * bend), opening ? UNBIAS_OPENING_UQ16 : UNBIAS_UQ16);
    uint32_t limit = n->mean_lsb2_q16 + n->mean_lsb2_q16;
    limit += opening ? limit + (limit >> 2) : n->mean_lsb2_q16;
    return (term < limit) ? term : limit;
}

/*
 * difference / window, rounded. The window is about half of the number of terms seen, and 256 when the count is full.
 */
static int32_t share(int32_t difference, uint8_t terms)
{
    if (terms == UINT8_MAX) {
        return (difference + 128) >> 8;
    }
    /* one place at a time, the last one rounds: same as adding half of the window first, in less code */
    for (uint8_t left = terms; left > 3U; left >>= 1) {
        difference >>= 1;
    }
    return (difference + 1) >> 1;
}

/* Adds a term to the mean. The floor keeps the limit of the next term open, the ceiling is the largest R. */
static void average(noise_t *n, uint32_t term_q16)
{
    int32_t mean = (int32_t)n->mean_lsb2_q16;
    mean += share((int32_t)term_q16 - mean, n->terms); /* all < 2^28 */
    if (mean < (int32_t)n->floor_lsb2_q16) {
        mean = (int32_t)n->floor_lsb2_q16;
    }
    n->mean_lsb2_q16 = ((uint32_t)mean > MEAN_MAX_LSB2_Q16) ? MEAN_MAX_LSB2_Q16 : (uint32_t)mean;
    if (n->terms != UINT8_MAX) {
        n->terms++;
    }
}

/* R in force follows the estimate when the two differ by more than an eighth. */
static bool follow(noise_t *n)
{
    uint32_t r_q8 = r_of(n->mean_lsb2_q16);
    if (filter_fx_abs32((int32_t)r_q8 - (int32_t)n->r_lsb2_q8) <= n->r_lsb2_q8 >> 3) {
        return false;
    }
    n->r_lsb2_q8 = r_q8;
    return true;
}

/* Uses a pointer: with indices the loop would be unrolled, 60 bytes more. */
static void remember(noise_t *n, int16_t z_lsb)
{
    int16_t *at = &n->history_lsb[HISTORY - 1U];
    for (uint8_t left = HISTORY - 1U; left != 0U; left--, at--) {
        at[0] = at[-1];
    }
    at[0] = z_lsb;
}

bool filter_noise_update(noise_t *n, int16_t z_lsb)
{
    int16_t z = filter_tracker_limited_z(z_lsb);
    bool changed = false;
    if (n->filled < HISTORY) {
        n->filled++;
    } else {
        average(n, term_lsb2_q16(n, smaller_bend_lsb(n, z)));
        changed = follow(n);
    }
    remember(n, z);
    return changed;
}

uint32_t filter_noise_r_lsb2_q8(const noise_t *n)
{
    return n->r_lsb2_q8;
}
