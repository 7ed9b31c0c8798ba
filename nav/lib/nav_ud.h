/*
 * Covariance of the navigation errors as P = U D U', U unit upper triangular, D diagonal.
 *
 * State order [dr, dv, mu, dc] makes Phi block upper triangular, so Phi U is again upper triangular with the same ones:
 * propagating P needs no factorisation (paper 003 (3.24)-(3.26) does one). Process noise is added by Agee and Turner's
 * rank-one update, a measurement by Bierman's. D never becomes negative: each D is formed from products, quotients and
 * sums of non-negative numbers.
 *
 * Packed by columns: U[i][j] at j (j + 1) / 2 + i, and D[j] in the place of U[j][j].
 */
#ifndef NAV_UD_H
#define NAV_UD_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    NAV_R0 = 0, /* position */
    NAV_V0 = 3, /* velocity */
    NAV_M0 = 6, /* attitude */
    NAV_C0 = 9  /* drift */
};

/* A scalar update. Arrays are reused: stack is what the AVR has least of. */
typedef struct {
    nav_real_t f[NAV_STATES];    /* the row h of H, 0 outside first .. end - 1; h U after nav_ud_look */
    nav_real_t gain[NAV_STATES]; /* D U' h' after nav_ud_look, K after nav_ud_update */
    nav_real_t variance;         /* of the innovation */
    uint8_t first, end;
} nav_ud_scalar_t;

/* P = diag(sigma^2): position, velocity, attitude, drift. */
void nav_ud_start(nav_real_t ud[NAV_PACKED], const nav_real_t sigma[4]);

/*
 * P <- Phi P Phi', Phi of (3.41) with F^2 dt^2 / 2: step_s seconds, specific force in NED, body to NED (row-major;
 * ignored with 9 states).
 */
void nav_ud_phi(nav_real_t ud[NAV_PACKED], nav_real_t step_s, const nav_real_t force_mps2[3], const nav_real_t dcm[9]);

/* P <- P + variance e_k e_k'. variance >= 0. */
void nav_ud_noise(nav_real_t ud[NAV_PACKED], uint8_t k, nav_real_t variance);

/* P <- P + variance a a', where a[k + 1] and beyond are 0. a is overwritten. */
void nav_ud_spread(nav_real_t ud[NAV_PACKED], nav_real_t a[NAV_STATES], uint8_t k, nav_real_t variance);

/* Evaluates this row with this measurement variance (> 0); P is not changed. */
void nav_ud_look(nav_ud_scalar_t *scalar, const nav_real_t ud[NAV_PACKED], nav_real_t variance);

/* P h' in rows begin .. end - 1 and 0 before, from the result of nav_ud_look, in place of f. */
void nav_ud_reach(nav_ud_scalar_t *scalar, const nav_real_t ud[NAV_PACKED], uint8_t begin, uint8_t end);

/* Updates P <- P - K S K', S the variance of the innovation. scalar->gain becomes K. `variance` as in nav_ud_look. */
void nav_ud_update(nav_real_t ud[NAV_PACKED], nav_ud_scalar_t *scalar, nav_real_t variance);

/* h x, with x in place of the gain. */
nav_real_t nav_ud_times(const nav_ud_scalar_t *scalar);

/* All of D >= 0. */
bool nav_ud_positive(const nav_real_t ud[NAV_PACKED]);

/* Diagonal of P. */
void nav_ud_variances(const nav_real_t ud[NAV_PACKED], nav_real_t variance[NAV_STATES]);

#ifdef __cplusplus
}
#endif
#endif
