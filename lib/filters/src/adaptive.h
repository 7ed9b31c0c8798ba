/*
 * Internals of `adaptive` for its tests and its proof. The filter is described in adaptive.c. Internal to the library.
 */
#ifndef ADAPTIVE_H
#define ADAPTIVE_H

#include "tracker.h"

#ifdef __cplusplus
extern "C" {
#endif

/* k = 2 / 4096 */
#define ADAPTIVE_K_MIN_UQ16 32U
/* The median of five samples is worth a memory of about four. */
#define ADAPTIVE_K_START_UQ32 0x80000000U

/* Sigma of the innovations: 0.1 LSB, and 90, which keeps the threshold of their mean below 128 LSB. */
#define ADAPTIVE_SCATTER_MIN_UQ24 0x1A0000U
#define ADAPTIVE_SCATTER_MAX_UQ24 0x5A000000U

/*
 * Unguarded, innovations enter their mean limited to a gate of 4.5 sigma, as the guarded filter limits them to its own.
 */
#define ADAPTIVE_UNGUARDED_SIGMA_Q8 1152U

/*
 * Weight of a term in the scatter, which every second sample contributes: 1/8 for the first seven, then 1/16.
 * Unguarded, 1/32 for a term below its limit: the scale of the mean innovation is then steadier, and still grows as
 * fast where it is too small.
 */
#define ADAPTIVE_OPENING_TERMS 7U
#define ADAPTIVE_OPENING_UQ16 8192U
#define ADAPTIVE_WEIGHT_UQ16 4096U
#define ADAPTIVE_UNGUARDED_WEIGHT_UQ16 2048U

/*
 * Strays: each adds to a count (at most 255) what the same number of samples within the gate subtract again, so it
 * rises while more than one sample in 65 is a stray. Above one stray a `guard` of more than 3 sigma is replaced by
 * 2.25, half of the usual 4.5: of outliers with 20 times the noise one in eleven is then used whole instead of one in
 * six. After this many samples in a row on one side it is 9, twice the usual, so that a jump is followed until it is
 * accepted.
 */
#define ADAPTIVE_STRAY 64U
#define ADAPTIVE_CLOSE_SIGMA_Q8 768U
#define ADAPTIVE_TIGHT_SIGMA_Q8 576U
#define ADAPTIVE_WIDE_SIGMA_Q8 2304U
#define ADAPTIVE_TIGHT_RUN 4U

/* Fewest samples in a row on one side for a jump to be accepted. */
#define ADAPTIVE_CONFIRM_LEAST 3U

/* The guard's verdict on a sample; from MOTION on the memory is shortened. */
enum adaptive_verdict { ADAPTIVE_UNUSED, ADAPTIVE_WITHIN, ADAPTIVE_OUTLIER, ADAPTIVE_MOTION, ADAPTIVE_JUMP };

#ifdef __cplusplus
}
#endif
#endif
