/* Strapdown: quaternion, velocity and position from rates and forces, and their correction. */
#ifndef NAV_INS_H
#define NAV_INS_H

#include "nav.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Body to NED, row-major. */
void nav_ins_dcm(nav_real_t dcm[9], const nav_real_t quaternion[4]);

/*
 * One step of step_s seconds with the means of rate (drift subtracted) and force. dcm: of the attitude before the step.
 * Returns the force in NED. The force is rotated by half the step's rotation, velocity and position use its mean, the
 * quaternion is of third order: it errs by |rate step|^5 / 480 rad per step, and its length needs nav_ins_unit.
 */
void nav_ins_step(nav_state_t *state, nav_real_t force_ned_mps2[3], const nav_real_t dcm[9],
                  const nav_real_t rate_rps[3], const nav_real_t force_mps2[3], nav_real_t gravity_mps2,
                  nav_real_t step_s);

/*
 * Normalises to length 1: close to it (1 % of the square) by one Newton step, from 1 + e to 1 - 3 e^2 / 2; otherwise by
 * the root.
 */
void nav_ins_unit(nav_real_t quaternion[4]);

/* Closed loop: r, v += x, C <- (I - [mu x]) C, drift += x (12 states). x in the order of the error state. */
void nav_ins_correct(nav_state_t *state, const nav_real_t x[NAV_STATES]);

#ifdef __cplusplus
}
#endif
#endif
