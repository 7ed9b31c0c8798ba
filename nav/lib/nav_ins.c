/* Strapdown INS in NED (paper 003, 3.3.4: no Earth rotation, no curvature). */
#include "nav_ins.h"
#include "nav_root.h"
#include "nav_ud.h"
#include "nav_vector.h"

#define HALF NAV_R(0.5)
#define THREE_HALVES NAV_R(1.5)
#define SIXTH NAV_R(0.16666666666666667)
#define NEAR_LOW NAV_R(0.99) /* a Newton step leaves an error of at most 4e-5 */
#define NEAR_HIGH NAV_R(1.01)
#define TURN_LARGE NAV_R(0.01) /* half the angle, squared: the error of the length is its square / 12 */

/* (w^2 - v.v) I + 2 v v' + 2 w [v x], and w^2 + v.v = 1. */
void nav_ins_dcm(nav_real_t dcm[9], const nav_real_t quaternion[4])
{
    nav_real_t twice[3];
    nav_real_t square[3];
    const nav_real_t *v = quaternion + 1;
    for (uint8_t i = 0; i < 3U; i++) {
        twice[i] = v[i] + v[i];
        square[i] = v[i] * twice[i];
    }
    uint8_t next = 1;
    uint8_t last = 2;
    for (uint8_t i = 0; i < 3U; i++) {
        nav_real_t both = v[i] * twice[next];
        nav_real_t turned = quaternion[0] * twice[last];
        dcm[4U * i] = 1 - (square[next] + square[last]);
        dcm[3U * i + next] = both - turned;
        dcm[3U * next + i] = both + turned;
        next = last;
        last = i;
    }
}

/* q <- q (w, v) for a rotation about body axes, or (w, v) q for one about NED axes. */
static void turn(nav_real_t quaternion[4], nav_real_t w, const nav_real_t v[3], bool in_body)
{
    nav_real_t *vector = quaternion + 1;
    nav_real_t scalar = quaternion[0];
    const nav_real_t old[3] = { vector[0], vector[1], vector[2] };
    quaternion[0] = w * scalar - nav_dot(v, old);
    for (uint8_t i = 0; i < 3U; i++) {
        vector[i] = w * old[i];
    }
    nav_add_scaled(vector, scalar, v);
    nav_add_cross(vector, in_body ? old : v, in_body ? v : old);
}

void nav_ins_unit(nav_real_t quaternion[4])
{
    nav_real_t square = quaternion[0] * quaternion[0] + nav_dot(quaternion + 1, quaternion + 1);
    nav_real_t factor = THREE_HALVES - HALF * square;
    if (!(square > NEAR_LOW && square < NEAR_HIGH)) {
        factor = 1 / nav_root(square);
    }
    for (uint8_t i = 0; i < 4U; i++) {
        quaternion[i] *= factor;
    }
}

void nav_ins_step(nav_state_t *state, nav_real_t force_ned_mps2[3], const nav_real_t dcm[9],
                  const nav_real_t rate_rps[3], const nav_real_t force_mps2[3], nav_real_t gravity_mps2,
                  nav_real_t step_s)
{
    nav_real_t half_step = HALF * step_s;
    nav_real_t half[3];
    nav_real_t force[3];
    for (uint8_t i = 0; i < 3U; i++) {
        half[i] = rate_rps[i] * half_step;
        force[i] = force_mps2[i];
    }
    nav_add_cross(force, half, force_mps2);
    for (uint8_t i = 0; i < 3U; i++) {
        nav_real_t acceleration = nav_dot(dcm + 3U * i, force);
        force_ned_mps2[i] = acceleration;
        if (i == 2U) {
            acceleration += gravity_mps2;
        }
        nav_real_t before = state->velocity_mps[i];
        nav_real_t behind = before + acceleration * step_s;
        state->position_m[i] += half_step * (before + behind);
        state->velocity_mps[i] = behind;
    }
    nav_real_t square = nav_dot(half, half);
    nav_real_t sine = 1 - SIXTH * square;
    for (uint8_t i = 0; i < 3U; i++) {
        half[i] *= sine;
    }
    turn(state->quaternion, 1 - HALF * square, half, true);
    if (square > TURN_LARGE) {
        nav_ins_unit(state->quaternion);
    }
}

void nav_ins_correct(nav_state_t *state, const nav_real_t x[NAV_STATES])
{
    nav_real_t half[3];
    for (uint8_t i = 0; i < 3U; i++) {
        state->position_m[i] += x[NAV_R0 + i];
        state->velocity_mps[i] += x[NAV_V0 + i];
        half[i] = -HALF * x[NAV_M0 + i];
#if NAV_STATES > 9
        state->gyro_drift_rps[i] += x[NAV_C0 + i];
#endif
    }
    turn(state->quaternion, 1, half, false);
    nav_ins_unit(state->quaternion);
}
