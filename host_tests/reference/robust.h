/*
 * The filters of paper 002 in double, written from its equations as matrices (Eigen) with the errata of
 * docs/papers-002.md applied, and the literal printed readings that these errata refute; plain C interface. (n) is the
 * paper's numbering.
 */
#ifndef REFERENCE_ROBUST_H
#define REFERENCE_ROBUST_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Which equation is taken as printed although the errata say otherwise. */
typedef enum {
    ROBUST_CORRECTED,
    ROBUST_PRINTED_15,   /* the grid: the weight from the mean of q1 after the sample */
    ROBUST_PRINTED_GRID, /* the grid: q_i = i / 50 */
    ROBUST_PRINTED_21,   /* two filters, each on its own prediction, never merged */
    ROBUST_PRINTED_24,   /* W1 = P H' R^-1 (I - H P(k/k-1) H') */
    ROBUST_PRINTED_25,   /* the transition applied to the prediction */
    ROBUST_PRINTED_26,   /* P p W1 H P in place of P - p W1 H P */
    ROBUST_PRINTED_27,   /* (29) without its last term */
    ROBUST_PRINTED_30,   /* densities about the estimate of the step before */
    ROBUST_PRINTED_33,   /* gate |r| <= 2 Xi1 with Xi1 a variance, as (31), (32) have it */
    ROBUST_PRINTED_34,   /* P (I - W1 H) */
    ROBUST_PRINTED_39,   /* estimate and P of the step before in place of the predicted ones */
    ROBUST_READING_COUNT
} robust_reading_t;

#define ROBUST_GRID 50
#define ROBUST_MEDIAN_MAX 9

/* x = (position, rate per second), z = position + phi v, v of variance r, phi = 1 with probability clean or ratio. */
typedef struct {
    int kind; /* which of reference/robust.cpp */
    robust_reading_t reading;
    double period_s;
    double r;
    double q[4];           /* process noise per sample, row-major */
    double clean;          /* q1, in (0, 1) */
    double ratio;          /* N > 1 */
    double stay;           /* (11): probability that an outlier follows an outlier; 0: they are independent */
    double gate_sigma;     /* of sprf and of what counts as refused in soft; >= 1 */
    double softgate_sigma; /* >= 1 */
    int reacquire;         /* sprf, soft: consistent refused samples that restart; 0: never */
    double agree;          /* they differ from one to the next by at most this */
    bool doubts;           /* as the library: half of the rate is left by a refused sample where P11 >= R */
    double rate_max;       /* of the estimate; 0: no limit */
    bool joint;            /* the gate decides for several components: robust_joint.h */
    int median_window;     /* odd: the estimate starts as the median of so many samples; 0: from x and p as given */
    double p22_start;      /* of the rate, after a median start */

    double x[2];
    double p[4];

    double innovation;
    double p_normal; /* posterior probability of phi = 1 */
    double q_mean;   /* of q1, before the sample */
    double q_count;
    double gain[2];
    bool gated;
    bool reacquired;
    bool outlier; /* clairvoyant: set before the step */
    bool joint_taken;
    bool joint_agrees; /* every component is near its last sample */
    int run;
    int refused; /* in a row */
    double first;
    double previous;
    int collected;
    double start_z[ROBUST_MEDIAN_MAX];
    double weight[ROBUST_GRID];
    double second_x[2]; /* (21) as printed: the filter of phi = N */
    double second_p[4];
} robust_reference_t;

/*
 * A filter by its name in the library, "af_grid" (as published, a distribution on 50 points) or "clairvoyant" (told
 * which samples are outliers: the bound); false: there is none of this name. Table 1, Q on the rate, gate 3 sigma (as
 * published: 2), soft gate 2 sigma, no re-acquisition, no median start.
 */
bool robust_reference_table1(robust_reference_t *f, const char *name);

/* NULL, or the name of the first parameter outside its legal range: r, q, clean, ratio, gate, softgate, median. */
const char *robust_reference_refused(const robust_reference_t *f);

/* One sample; the estimate of the position. */
double robust_reference_step(robust_reference_t *f, double z);

/* The filter's R: r, or the linear filter's [q1 (1 - N^2) + N^2] r. */
double robust_reference_r(const robust_reference_t *f);

/* P (row-major) after the update where the KF's or LRF's Riccati recursion comes to rest, and the gain there. */
void robust_reference_steady(const robust_reference_t *f, double *p, double *gain);

/* Variance of the position's error in the steady state when the constant gain meets white noise of variance r_true. */
double robust_reference_lyapunov(const robust_reference_t *f, const double *gain, double r_true);

#ifdef __cplusplus
}
#endif
#endif
