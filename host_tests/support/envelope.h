/*
 * Where an estimate may be, given the raw samples: what shows that a filter did not diverge. Four rules.
 *
 * Band, kf, kf3, lrf, synth, synth_opt, synth_plus, pbf, af: |x - m| <= 1.1 gain_sum D + 1 LSB, m the median and D the
 * largest distance from it of the last W raw samples. A linear estimate is sum h_k z with sum h_k = 1, hence no further
 * from any m than D sum |h_k|, plus what the samples before W leave. For the two-state filters sum |h| is 1.434 at most
 * (limit of small gains, 1 for a gain of 1; steady gains of this model have w2 = w1^2 / (2 - w1)), for synth at (0,
 * 0.3) 2.277, for kf3 1.828 at its smallest gain. pbf and af go between kf and a kf made for the R of outliers, 400 R:
 * in the one samples within D drive the rate to at most D sum |h_rate|, in the other that rate carries x off before it
 * is corrected; together 1.434 + 1.945. A test repeats these sums. The tenth is for R, and with it the gain, changing.
 * Missing samples make the gain of a two-state filter larger and the sum smaller; that of synth stays and kf3 goes on
 * along a parabola, so they are judged where none of the W is missing. W is the time to forget: 10 time constants for
 * the linear ones (e^-10 of 8,704 LSB is 0.4 LSB), and for pbf and af the time in which they are to be back after any
 * step, 800 samples in the system of paper 002, where a time constant is 14.7 samples. It is sqrt(2) / q22^(1/4)
 * samples, q22 = q T^3 / R limited as in kalman.c, R the largest so far; of kf3 2 / q33^(1/6) samples, q33 = q T^5 /
 * R limited as in kf3.c: small gains make a Butterworth filter of third order.
 *
 * Hull, sprf and soft: whenever the last five raw samples agree, none at the rail (steps <= 3 sqrt(2 R) + ratemax, as
 * in kalman.h), one of them was within the gate or all five were refused and the filter restarted on one of them.
 * Within the gate of 3 sigma is within 9 sqrt(R), because S < 9 R (kalman.h); from there the estimate moves towards
 * samples, or by the limited rate per sample missing or refused. So x is no further from the hull of the five than 9
 * sqrt(R) + (4 + missing) ratemax, R the largest among the five.
 *
 * Run, sprf and soft: where the samples do not agree it may go on by its rate, and no faster: with n samples refused or
 * missing since the last that was within the gate or restarted it, and that one among the last W, |x - m| <= D +
 * 9 sqrt(R) + n ratemax, R the largest so far. W is 200 samples in the system of paper 002. Of the refused ones sprf
 * counts 6 at most, however many there were, because the sixth stops its rate (sprf.c); soft takes a part of each,
 * which makes a new rate.
 *
 * Wait, shrf: it does not use what it takes for an outlier and has no limit of its rate, so it may go anywhere within
 * its range; but P / R grows as q22 n^3 / 3 meanwhile and ends at 32,768, where the next sample is taken. So no more
 * than (3 x 32768 / q22)^(1/3) samples in a row are taken for outliers, q22 by the largest R so far.
 *
 * sprf_paper locks out, as printed: no rule holds, what it does is reported.
 */
#ifndef SUPPORT_ENVELOPE_H
#define SUPPORT_ENVELOPE_H

#include "support/chain.h"
#include "support/filters.h"

#define BAND_MARGIN_LSB 1.0
#define BAND_GAIN_ALLOWANCE 1.1
#define RATE_HELD_SAMPLES 6U

/* Gain of white noise, sum h^2, of the two-state filter whose steady gain is w1; it is 3/4 w1 for small gains. */
double noise_gain_of(double w1);

/* q T^3 / R at the default q, limited. */
double process_noise_per_r(uint16_t rate_dhz, double r_lsb2);

/* Largest number of samples in a row that shrf may take for outliers. */
double longest_wait_samples(uint16_t rate_dhz, double r_lsb2);

/* Samples of one time constant of a two-state filter at the default q. */
double time_constant_samples(uint16_t rate_dhz, double r_lsb2);

/* W for a filter on a sensor of this rate, when R has been this large. */
size_t band_window(filter_kind_t kind, uint16_t rate_dhz, double r_lsb2);

/* Sliding median and extremes of one axis of a stream. */
#define LEVELS 8192U
typedef struct {
    uint32_t histogram[LEVELS];
    size_t start, end;          /* samples within: start..end - 1 */
    size_t below;               /* of them, those below the median */
    uint32_t median, low, high; /* as levels 0..8191 */
} band_t;

void band_clear(band_t *b);

/* z[b->end] in, and the oldest ones out until `window` are left. */
void band_add(band_t *b, const int16_t *z_lsb, size_t window);

double band_median_lsb(const band_t *b);

/* How far x lies outside the range of the samples within, LSB; 0 inside. */
double band_outside_lsb(const band_t *b, double x_lsb);

/* Largest distance of a sample within from the median, LSB. */
double band_spread_lsb(const band_t *b);

/* The last five samples for the hull's rule. */
#define HULL_SAMPLES 5U
typedef struct {
    int16_t z_lsb[HULL_SAMPLES]; /* newest first */
    double r_lsb2[HULL_SAMPLES];
    uint32_t coasts[HULL_SAMPLES];
    unsigned filled;
} hull_t;

void hull_add(hull_t *h, int16_t z_lsb, double r_lsb2, uint32_t coasts);

/* Largest distance of the estimate from a sample within the gate, and of two estimates one sample apart without one. */
double gate_reach_lsb(double r_lsb2);
double rate_max_lsb(uint16_t rate_dhz);

/*
 * True when the five agree; *excess_lsb is how far x may be from their hull less how far it is: negative breaks the
 * rule.
 */
bool hull_judge(const hull_t *h, uint16_t rate_dhz, double x_lsb, double *excess_lsb);

#endif
