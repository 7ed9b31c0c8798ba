/* Strapdown INS in NED (paper 003, 3.3.4: no Earth rotation, no curvature). */
#include "nav_ins.h"
#include "nav_ud.h"

#define HALF NAV_R(0.5)
#define THREE_HALVES NAV_R(1.5)
#define SIXTH NAV_R(0.16666666666666667)

void nav_ins_dcm(nav_real_t dcm[9], const nav_real_t quaternion[4])
{
    nav_real_t w = quaternion[0];
    nav_real_t x = quaternion[1];
    nav_real_t y = quaternion[2];
    nav_real_t z = quaternion[3];
    nav_real_t x2 = x + x;
    nav_real_t y2 = y + y;
    nav_real_t z2 = z + z;
    nav_real_t xx = x * x2;
    nav_real_t yy = y * y2;
    nav_real_t zz = z * z2;
    nav_real_t xy = x * y2;
    nav_real_t xz = x * z2;
    nav_real_t yz = y * z2;
    nav_real_t wx = w * x2;
    nav_real_t wy = w * y2;
    nav_real_t wz = w * z2;
    dcm[0] = 1 - (yy + zz);
    dcm[1] = xy - wz;
    dcm[2] = xz + wy;
    dcm[3] = xy + wz;
    dcm[4] = 1 - (xx + zz);
    dcm[5] = yz - wx;
    dcm[6] = xz - wy;
    dcm[7] = yz + wx;
    dcm[8] = 1 - (xx + yy);
}

/* quaternion <- quaternion (w, v) */
static void turn(nav_real_t quaternion[4], nav_real_t w, const nav_real_t v[3])
{
    nav_real_t a = quaternion[0];
    nav_real_t b = quaternion[1];
    nav_real_t c = quaternion[2];
    nav_real_t d = quaternion[3];
    quaternion[0] = w * a - v[0] * b - v[1] * c - v[2] * d;
    quaternion[1] = w * b + v[0] * a + v[2] * c - v[1] * d;
    quaternion[2] = w * c + v[1] * a - v[2] * b + v[0] * d;
    quaternion[3] = w * d + v[2] * a + v[1] * b - v[0] * c;
}

/* force, turned by half the rotation: f + half x f, in NED. */
static void mean_force(nav_real_t out[3], const nav_real_t dcm[9], const nav_real_t half[3], const nav_real_t force[3])
{
    nav_real_t f[3];
    f[0] = force[0] + (half[1] * force[2] - half[2] * force[1]);
    f[1] = force[1] + (half[2] * force[0] - half[0] * force[2]);
    f[2] = force[2] + (half[0] * force[1] - half[1] * force[0]);
    for (uint8_t i = 0; i < 3U; i++) {
        const nav_real_t *row = dcm + 3U * i;
        out[i] = row[0] * f[0] + row[1] * f[1] + row[2] * f[2];
    }
}

void nav_ins_step(nav_state_t *state, nav_real_t force_ned_mps2[3], const nav_real_t dcm[9],
                  const nav_real_t rate_rps[3], const nav_real_t force_mps2[3], nav_real_t gravity_mps2,
                  nav_real_t step_s)
{
    nav_real_t half_step = HALF * step_s;
    nav_real_t half[3];
    for (uint8_t i = 0; i < 3U; i++) {
        half[i] = rate_rps[i] * half_step;
    }
    mean_force(force_ned_mps2, dcm, half, force_mps2);
    for (uint8_t i = 0; i < 3U; i++) {
        nav_real_t acceleration = force_ned_mps2[i];
        if (i == 2U) {
            acceleration += gravity_mps2;
        }
        nav_real_t before = state->velocity_mps[i];
        nav_real_t behind = before + acceleration * step_s;
        state->position_m[i] += half_step * (before + behind);
        state->velocity_mps[i] = behind;
    }
    nav_real_t square = half[0] * half[0] + half[1] * half[1] + half[2] * half[2];
    nav_real_t sine = 1 - SIXTH * square;
    for (uint8_t i = 0; i < 3U; i++) {
        half[i] *= sine;
    }
    turn(state->quaternion, 1 - HALF * square, half);
}

void nav_ins_unit(nav_real_t quaternion[4])
{
    nav_real_t square = quaternion[0] * quaternion[0] + quaternion[1] * quaternion[1] + quaternion[2] * quaternion[2] +
                        quaternion[3] * quaternion[3];
    nav_real_t factor = THREE_HALVES - HALF * square;
    for (uint8_t i = 0; i < 4U; i++) {
        quaternion[i] *= factor;
    }
}

/* quaternion <- (1, v) quaternion */
static void turn_before(nav_real_t quaternion[4], const nav_real_t v[3])
{
    nav_real_t a = quaternion[0];
    nav_real_t b = quaternion[1];
    nav_real_t c = quaternion[2];
    nav_real_t d = quaternion[3];
    quaternion[0] = a - v[0] * b - v[1] * c - v[2] * d;
    quaternion[1] = b + v[0] * a + v[1] * d - v[2] * c;
    quaternion[2] = c + v[1] * a + v[2] * b - v[0] * d;
    quaternion[3] = d + v[2] * a + v[0] * c - v[1] * b;
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
    turn_before(state->quaternion, half);
    nav_ins_unit(state->quaternion);
}
