/*
 * The noise estimator of lib/filters in theory: what its limited terms have as their mean, and what that makes of it.
 */
#ifndef REFERENCE_NOISE_H
#define REFERENCE_NOISE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What is measured, LSB; white noise of this variance, rounding with it; share of bad reads, beyond all limits. */
typedef struct {
    const double *truth_lsb;
    int samples;
    uint16_t rate_dhz;
    double variance_lsb2, bad;
} reference_noise_t;

/*
 * In variances: what the estimate were if each term were what is expected of it, from the floor and with the weights
 * that noise.h tells; the last of these; how much of an error the next terms make again; and by how much a fluctuation
 * (a variance of 1) lowers the estimate, because the limited mean is concave: half of its second derivative over 1 -
 * the first.
 */
typedef struct {
    double estimate, weight, again, bent;
} reference_noise_estimate_t;

/* After all of the samples, 65 terms or more. */
reference_noise_estimate_t reference_noise_estimate(const reference_noise_t *of);

#ifdef __cplusplus
}
#endif
#endif
