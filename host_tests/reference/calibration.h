/* Calibration in double, from its definitions and by other methods than lib/tilt (Eigen); plain C interface. */
#ifndef REFERENCE_CALIBRATION_H
#define REFERENCE_CALIBRATION_H

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Turn by the smallest angle that takes the direction u to (0, 0, 1), by quaternion; row by row. u is not (0, 0, -1).
 */
void reference_smallest_turn(const double u[3], double m[9]);

/* The matrix tau (3.34) of paper 003 as printed, m = (m1, m2, m3): takes m / |m| to the first axis; row by row. */
void reference_tau(const double m[3], double tau[9]);

/* The mounting: the smallest turn, upside down after half a turn about x. */
void reference_mounting(const double level[3], double m[9]);

/* mounting x axes x diag(256 / scale) x (a - offset) by matrices. */
void reference_calibrated(const double offset[3], const double scale[3], const signed char axes[3],
                          const double level[3], const double a[3], double out[3]);

/* max |M M' - I| */
double reference_orthogonality(const double m[9]);

/* Offsets and scales for which six readings have length 1: Gauss-Newton on all six numbers from the true ones. */
void reference_six(const double readings[18], double offset[3], double scale[3]);

#ifdef __cplusplus
}
#endif
#endif
