/*
 * Double reference of the synthesised filter, written from paper 000 equation (7) as printed with its errata (estimates
 * fed back), in companion-matrix form (Eigen), not from the scalar code; plain C interface.
 */
#ifndef REFERENCE_SYNTH_H
#define REFERENCE_SYNTH_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    double a1;
    double b0;
    double x[3]; /* estimates, newest first */
    double extrapolated;
    double gain;             /* of the last step */
    int samples;             /* seen; 0: nothing yet */
    int least_squares_until; /* the gains of the least-squares line count up to this sample; 0: constant gains */
} reference_synth_t;

/* Constant gains from now on, all estimates equal. */
void reference_synth_at(reference_synth_t *f, double a1, double b0, double x0);

/* Starts empty: x(1) = z(1), x(2) = z(2), then a1 = 0 and b0(n) = max(b0, (4 n - 2) / (n (n + 1))) (notes 2.2). */
void reference_synth_least_squares(reference_synth_t *f, double a1, double b0);

/* One sample. */
double reference_synth_step(reference_synth_t *f, double z);

/* The library's start: at the median of five samples. */
void reference_synth_median(reference_synth_t *f, double a1, double b0, const double *five);

/* Largest magnitude of the closed loop's poles. */
double reference_synth_radius(double a1, double b0);

/* Stationary variance of the estimate for white noise of variance 1, from the discrete Lyapunov equation. */
double reference_synth_noise_gain(double a1, double b0);

/* Sum of the magnitudes with which one error of the estimate appears in all later ones. */
double reference_synth_error_sum(double a1, double b0);

#ifdef __cplusplus
}
#endif
#endif
