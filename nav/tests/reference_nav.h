/*
 * Double references (Eigen) of nav/lib's covariance, written from the matrix equations of paper 003 in its own order of
 * states, [mu, dv, dr, dc]: its square root by QR (3.20)-(3.26), the conventional form (3.9)-(3.11), and Joseph's.
 * Plain C interface.
 */
#ifndef REFERENCE_NAV_H
#define REFERENCE_NAV_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    REFERENCE_NAV_ROOT,
    REFERENCE_NAV_CONVENTIONAL,
    REFERENCE_NAV_JOSEPH,
    REFERENCE_NAV_FORMS
} reference_nav_form_t;

/* Which of the misprints is left in. */
enum { PRINTED_PHI = 1, PRINTED_ROWS = 2, PRINTED_TAU = 4 };

typedef struct {
    int form, states, printed;
    double matrix[144]; /* m or P, row-major */
    double tau[9];
} reference_nav_t;

/* sigma: attitude, velocity, position, drift. */
void reference_nav_start(reference_nav_t *f, int form, int states, const double sigma[4], const double mag[3],
                         int printed);

/* (3.41), q: 1 sigma per step of attitude, velocity, position, drift. dcm: body to NED, row-major. */
void reference_nav_time(reference_nav_t *f, double step_s, const double force[3], const double dcm[9],
                        const double q[4]);

/*
 * One epoch of what is there: z (measured less computed) of the field (2), velocity (3), position (3), height (1), in
 * this order; y: 1 sigma of the four. x: the correction, in the order attitude, velocity, position, drift.
 */
void reference_nav_measure(reference_nav_t *f, bool field, bool gps, bool down, const double *z, const double y[4],
                           double *x);

/* Diagonal of P in nav/lib's order: position, velocity, attitude, drift. */
void reference_nav_variances(const reference_nav_t *f, double *variance);

/* tau (3.34), row-major; as printed: with 1 + mag1 for any length of mag. */
void reference_nav_tau(double tau[9], const double mag[3], bool printed);

#ifdef __cplusplus
}
#endif
#endif
