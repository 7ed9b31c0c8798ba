/*
 * Double references of synth_plus: the filter itself from its equation, what it is said to contain (alpha-beta, the
 * steady Kalman filter of a Singer acceleration, from its Riccati equation), and its closed loop's poles and variance
 * as matrices (Eigen); plain C interface.
 */
#ifndef REFERENCE_SYNTH_PLUS_H
#define REFERENCE_SYNTH_PLUS_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    double a1, b0, b1, b2;
} reference_taps_t;

typedef struct {
    double x[3]; /* newest first */
    double u[2];
} reference_plus_t;

double reference_plus_step(reference_plus_t *f, const reference_taps_t *taps, double z);

/* Largest magnitude of a pole. */
double reference_plus_radius(const reference_taps_t *taps);

/* Stationary variance of the estimate for white noise of variance 1, from the discrete Lyapunov equation. */
double reference_plus_noise_gain(const reference_taps_t *taps);

/* 2^-17 LSB for each rounding: of b0's product, and of n in x_e. */
double reference_plus_rounding_lsb(const reference_taps_t *taps, int n);

/* Position and rate with gains alpha and beta. */
double reference_alpha_beta_step(double state[2], double alpha, double beta, double z);

/*
 * Steady gains of x' = x + v, v' = v + a, a' = rho a + w, Var w = lambda, R = 1, from the Riccati recursion, and the
 * filter with them in its own three states.
 */
void reference_singer_gains(double rho, double lambda, double k[3]);
double reference_singer_step(double state[3], double rho, const double k[3], double z);

/* The taps of synth_plus that are that filter. */
reference_taps_t reference_singer_taps(double rho, const double k[3]);

/* Variance of the estimate's error when that filter, made for rho and lambda, follows a process with its own. */
double reference_singer_error(double rho, const double k[3], double true_rho, double true_lambda);

/* Steady gains of the model of kf, kalman.h: white acceleration drives the rate, q T^3 / R = drive. */
void reference_white_gains(double drive, double k[2]);

/* End point of the line of least squares through n samples, the newest last (QR). */
double reference_line_end(const double *z, int n);

#ifdef __cplusplus
}
#endif
#endif
