/*
 * adaptive in double: one step of the same structure with the bound of what fixed point may differ by, and the fading
 * memory's theory.
 */
#ifndef REFERENCE_ADAPTIVE_H
#define REFERENCE_ADAPTIVE_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What has a continuous value, LSB and per sample, signed; or its largest difference. */
typedef struct {
    double x, rate, mean, k, scatter;
} reference_adaptive_value_t;

typedef enum { VERDICT_UNUSED, VERDICT_WITHIN, VERDICT_OUTLIER, VERDICT_MOTION, VERDICT_JUMP } reference_verdict_t;

typedef struct {
    double sigmas, manoeuvre, slow, fast, share, rate_max;
    int confirm;
    bool guarded, identify;
    reference_adaptive_value_t now;
    double before; /* the sample before */
    bool broken;   /* one was missing since */
    int side, run, samples, terms, strays;
    reference_verdict_t verdict;
} reference_adaptive_t;

/* Parameters are set by the caller; the rest as behind the start, whose last sample is z. */
void reference_adaptive_begin(reference_adaptive_t *f, double z);

/*
 * One sample. bound: how far a fixed-point step from the same state may end from this one. False when a decision hangs
 * on less than what fixed point rounds: then nothing can be compared.
 */
bool reference_adaptive_step(reference_adaptive_t *f, double z, reference_adaptive_value_t *bound);
void reference_adaptive_coast(reference_adaptive_t *f);

/*
 * At rest, with the memory's k, in white noise of sigma 1: what the scatter settles at. The innovations less their mean
 * are Gaussian, their variance by the Lyapunov equation; the scatter is where the limited terms have the mean that is
 * expected of them. bad: share of samples far beyond their limit, of which nothing is taken.
 */
double reference_adaptive_scatter(double k, double share, double bad, bool guarded);

/* Fading memory with k: noise gain of the estimate and of the prediction, by the Lyapunov equation. */
double reference_fading_noise_gain(double k);
double reference_fading_prediction_gain(double k);

/* Weight of the sample n steps old in the end of the least squares line whose errors' squares weigh by theta^n. */
double reference_fading_line_weight(double theta, int n);
/* The same weight in the recursive filter with alpha = 2 k - k^2, beta = k^2. */
double reference_fading_impulse(double k, int n);

#ifdef __cplusplus
}
#endif
#endif
