/*
 * Double references of paper 000's parametric synthesis: the schedules of (a1, b0) that algorithm (22) computes from P,
 * as printed and as its derivation allows to mend it, the exact covariance, and closed forms of the constant filter.
 * Plain C interface. Nothing here sees a measurement: the schedules are made of P and R alone.
 */
#ifndef REFERENCE_SYNTHESIS_H
#define REFERENCE_SYNTHESIS_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    SCHEDULE_PRINTED,              /* (20), (21), (13), (14) to the letter */
    SCHEDULE_SQUARE,               /* (20) with the lost square, (2 + a1)^2 P(n-1), and a1 from dPe/da1 = 0 of that */
    SCHEDULE_CORRECTED,            /* (19) expanded without the slip of sign, and a1 from dPe/da1 = 0 of that */
    SCHEDULE_UNCORRELATED,         /* U: a1 of (21) within [-1/3, 0], Pe of errors taken as uncorrelated */
    SCHEDULE_UNCORRELATED_OPTIMUM, /* the same Pe with the a1 within [-1/3, 0] that is best for it */
    SCHEDULE_COUNT
} reference_schedule_kind_t;

typedef struct {
    reference_schedule_kind_t kind;
    bool clamped; /* a1 within [-0.99, -0.01], Pe >= 0, b0 within [0.02, 1] and >= -a1 - 0.29 */
    double r;
    double p[5]; /* P(n-1) .. P(n-5) */
    double a1;   /* of the last step, as pe and b0 */
    double pe;
    double b0;
    double tangent[5]; /* a small change of p, of length 1, carried along */
    double stretch;    /* logarithm of what the last step made of the tangent's length */
} reference_schedule_t;

/* Before the first step. p: P(-1) .. P(-5). */
void reference_schedule_begin(reference_schedule_t *f, reference_schedule_kind_t kind, double r, const double p[5]);

/* One step; false when (21) divides by zero, which leaves everything as it was (the uncorrelated ones take a1 = 0). */
bool reference_schedule_step(reference_schedule_t *f);

/* True inside the region that paper 000 prints: 0 < b0 <= 1, -1 < a1 < 0, b0 > -a1 - 0.3. */
bool reference_printed_region(double a1, double b0);

/* What the errors' covariance really becomes: s = cov of errors n-1, n-2, n-3 (row-major) to that of n, n-1, n-2. */
void reference_covariance_step(double s[9], double a1, double b0, double r);

/* Variance of the extrapolation's error, h s h' with h of (7). */
double reference_covariance_pe(const double s[9], double a1);

/* The gains that minimise P(n) given the true covariance, a1 within [a1_min, a1_max]. */
typedef struct {
    double s[9];
    double r;
    double a1_min;
    double a1_max;
    double a1;
    double pe;
    double b0;
} reference_exact_t;

void reference_exact_begin(reference_exact_t *f, double r, double a1_min, double a1_max, const double s[9]);
void reference_exact_step(reference_exact_t *f);

/* Constant gains, steady state: variance of estimate and of extrapolation by R, error by second difference. */
double reference_closed_noise_gain(double a1, double b0);
double reference_closed_pe(double a1, double b0);
double reference_closed_lag(double a1, double b0);

/* Schur-Cohn for C(z) = z^3 - c (2 - a1) z^2 + c (1 - 2 a1) z + c a1, c = 1 - b0, any a1 and b0. */
bool reference_closed_stable(double a1, double b0);

/* The same for 0 < b0 <= 1, -1 < a1 <= 0: what is left of the conditions there. */
bool reference_closed_stable_region(double a1, double b0);

#ifdef __cplusplus
}
#endif
#endif
