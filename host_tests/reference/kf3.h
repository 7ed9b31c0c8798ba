/*
 * Double reference of kf3, written from the matrix equations (Eigen), not from the scalar code; plain C interface. The
 * same code runs the textbook model of paper 001's comparison.
 */
#ifndef REFERENCE_KF3_H
#define REFERENCE_KF3_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* x(n+1) = A x(n) + G w, Var w = q; z = x[0] + noise of variance r. Matrices row-major. */
typedef struct {
    double a[9];
    double g[3];
    double q;
    double r;
    bool ends; /* kf3's rules at the end of the range of P / R, and at that of x */
    double x[3];
    double p[9];
    double gain[3];
    double innovation;
} reference_kf3_t;

/* One sample; prediction only. */
void reference_kf3_step(reference_kf3_t *f, double z);
void reference_kf3_coast(reference_kf3_t *f);

/*
 * kf3 as the library defines it, running from x0: time in samples, a in the library's unit, R in LSB^2, P with P11 = R
 * and the library's spread of rate and acceleration.
 */
void reference_kf3_library(reference_kf3_t *f, double rate_hz, double r, double q, double x0);

/* The library's model at q33 = lambda with a in LSB per sample^2, R = 1, from P = 0; settled. */
void reference_kf3_settled(reference_kf3_t *f, double lambda);

/* Textbook: x += v T + a T^2 / 2, v += a T, an increment of a of variance q each sample, settled. */
void reference_kf3_textbook(reference_kf3_t *f, double period_s, double r, double q);

/* Variance of the estimate for white noise of variance 1 at the present gain: sum of the squares of its answer. */
double reference_kf3_noise_gain(const reference_kf3_t *f);

/* Largest magnitude of the closed loop's poles at the present gain. */
double reference_kf3_radius(const reference_kf3_t *f);

/* Smallest eigenvalue of a symmetric 3x3 matrix, row-major. */
double reference_kf3_least_eigenvalue(const double *matrix);

/*
 * First-order bounds at the present gain, M the closed loop: sum over n of |M^n| e |M^n|' for an error e (its
 * magnitudes) of P at each sample, and of |M^n| e for one of the state.
 */
void reference_kf3_covariance_error(const reference_kf3_t *f, const double *each, double *total);
void reference_kf3_state_error(const reference_kf3_t *f, const double *each, double *total);

#ifdef __cplusplus
}
#endif
#endif
