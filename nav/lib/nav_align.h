/* The Earth's field as a direction: matrix tau (3.34) and what a magnetometer shows about the attitude (3.39). */
#ifndef NAV_ALIGN_H
#define NAV_ALIGN_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Rows 2 and 3 of tau for a field in NED: with row 1, the field's direction, an orthogonal matrix that rotates it to
 * (1, 0, 0). The field is normalised, so p of (3.34) is 1 (for any other p the printed 1 + mag1 must be p + mag1).
 * False: |field| is outside 1e-10..1e6, or it points more south than down (mag1 < -0.5: nowhere on Earth, and 1 + mag1
 * goes to 0 there).
 */
bool nav_align_tau(nav_real_t tau[2][3], const nav_real_t field[3]);

/* Normalises v to length 1. False, and v unchanged: its length is outside 1e-10..1e6. */
bool nav_align_unit(nav_real_t v[3]);

/* (3.39): innovations of the two rows for a measured direction (body axes), -gamma = m x tau C measured. */
void nav_align_innovation(nav_real_t innovation[2], const nav_real_t tau[2][3], const nav_real_t dcm[9],
                          const nav_real_t direction[3]);

#ifdef __cplusplus
}
#endif
#endif
