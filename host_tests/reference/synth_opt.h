/*
 * Double reference of parametric synthesis (paper 000, equations 20 to 22 made to work), written with matrices (Eigen)
 * from the covariance of the last three errors, not from the design tool's scalars; plain C interface.
 */
#ifndef REFERENCE_SYNTH_OPT_H
#define REFERENCE_SYNTH_OPT_H

#ifdef __cplusplus
extern "C" {
#endif

/* The covariance of the last three errors (3 x 3, row by row, per R; updated). Returns the variance of the newest. */
double reference_given_step(double s[9], double a1, double b0);

/* x_e and x from the last three estimates (updated) with gains given. */
double reference_opt_filter(double x[3], double a1, double b0, double z);

/*
 * Largest factor by which F(a1, b0) stretches the norm e' P e, P the certificate of switching safety within the clamps,
 * and sqrt(P11 inv(P)11), what the norm gives away. 0 when P is not positive definite.
 */
double reference_stretch(double a1, double b0);
double reference_norm_loss(void);

/* Largest magnitude of an eigenvalue of the product of n closed loops, the first applied first. */
double reference_product_radius(const double *a1, const double *b0, int n);

#ifdef __cplusplus
}
#endif
#endif
