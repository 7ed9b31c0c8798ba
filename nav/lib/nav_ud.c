/* The covariance as U D U'. Loops skip elements known to be 0 or 1: a product costs 150 cycles on the AVR. */
#include "nav_ud.h"
#include "nav_vector.h"

#define HALF NAV_R(0.5)

/* Start of column j. */
static uint8_t column(uint8_t j)
{
    uint8_t next = (uint8_t)(j + 1U);
    return (uint8_t)((uint16_t)((uint16_t)j * (uint16_t)next) / 2U);
}

void nav_ud_start(nav_real_t ud[NAV_PACKED], const nav_real_t sigma[4])
{
    for (uint8_t i = 0; i < NAV_PACKED; i++) {
        ud[i] = 0;
    }
    for (uint8_t j = 0; j < NAV_STATES; j++) {
        ud[column(j) + j] = sigma[j / 3U] * sigma[j / 3U];
    }
}

/* Factors of Phi, computed once per step. */
typedef struct {
    nav_real_t step, half_step;
    nav_real_t force[3], half_force[3]; /* x step, x step / 2 */
    const nav_real_t *dcm;
} phi_t;

/* A column of the velocity, where v is (1, 0, 0)', (u3, 1, 0)' or (u3, u4, 1)': r += step v. */
static void carry_velocity_column(nav_real_t *u, uint8_t j, nav_real_t step)
{
    uint8_t diagonal = (uint8_t)(j - NAV_V0);
    for (uint8_t i = 0; i < diagonal; i++) {
        u[NAV_R0 + i] += step * u[NAV_V0 + i];
    }
    u[NAV_R0 + diagonal] += step;
}

#if NAV_STATES > 9
/* mu += step A c, where c ends with the 1 on the diagonal; twice: mu before + mu after. */
static void carry_attitude(nav_real_t *u, uint8_t j, nav_real_t twice[3], const phi_t *phi)
{
    uint8_t diagonal = (uint8_t)(j - NAV_C0);
    const nav_real_t *a = phi->dcm;
    for (uint8_t i = 0; i < 3U; i++) {
        nav_real_t sum = a[diagonal];
        for (uint8_t k = 0; k < diagonal; k++) {
            sum += a[k] * u[NAV_C0 + k];
        }
        nav_real_t before = u[NAV_M0 + i];
        u[NAV_M0 + i] = before + phi->step * sum;
        twice[i] = before + u[NAV_M0 + i];
        a += 3;
    }
}
#endif

/* A column of attitude or drift: v += f x (mu before + mu after) step / 2, r += (v before + v after) step / 2. */
static void carry_column(nav_real_t *u, uint8_t j, const phi_t *phi)
{
    nav_real_t both[3];
    nav_real_t mu[3];
    const nav_real_t *force = phi->force;
    for (uint8_t i = 0; i < 3U; i++) {
        uint8_t at = (uint8_t)(NAV_M0 + i);
        both[i] = u[NAV_V0 + i];
        mu[i] = (at < j) ? u[at] : (nav_real_t)((at == j) ? 1 : 0);
    }
#if NAV_STATES > 9
    if (j >= NAV_C0) {
        carry_attitude(u, j, mu, phi);
        force = phi->half_force;
    }
#endif
    nav_add_cross(u + NAV_V0, force, mu);
    for (uint8_t i = 0; i < 3U; i++) {
        both[i] += u[NAV_V0 + i];
    }
    nav_add_scaled(u + NAV_R0, phi->half_step, both);
}

void nav_ud_phi(nav_real_t ud[NAV_PACKED], nav_real_t step_s, const nav_real_t force_mps2[3], const nav_real_t dcm[9])
{
    phi_t phi;
    phi.step = step_s;
    phi.half_step = HALF * step_s;
    for (uint8_t i = 0; i < 3U; i++) {
        phi.force[i] = force_mps2[i] * step_s;
        phi.half_force[i] = force_mps2[i] * phi.half_step;
    }
    phi.dcm = dcm;
    for (uint8_t j = NAV_V0; j < NAV_STATES; j++) {
        nav_real_t *u = ud + column(j);
        if (j < NAV_M0) {
            carry_velocity_column(u, j, step_s);
        } else {
            carry_column(u, j, &phi);
        }
    }
}

/* One column of Agee and Turner: P += c a a'. Returns c for the columns before. */
static nav_real_t spread_column(nav_real_t *u, nav_real_t *a, uint8_t j, nav_real_t c)
{
    nav_real_t d = u[j];
    nav_real_t part = a[j];
    nav_real_t along = c * part;
    nav_real_t sum = d + along * part;
    u[j] = sum;
    if (!(sum > 0)) { /* d = 0 and nothing to add: the columns before are unchanged */
        return c;
    }
    nav_real_t inverse = 1 / sum;
    nav_real_t share = along * inverse;
    for (uint8_t i = 0; i < j; i++) {
        a[i] -= part * u[i];
        u[i] += share * a[i];
    }
    return c * d * inverse;
}

void nav_ud_spread(nav_real_t ud[NAV_PACKED], nav_real_t a[NAV_STATES], uint8_t k, nav_real_t variance)
{
    for (uint8_t j = (uint8_t)(k + 1U); j-- > 0U;) {
        variance = spread_column(ud + column(j), a, j, variance);
    }
}

void nav_ud_noise(nav_real_t ud[NAV_PACKED], uint8_t k, nav_real_t variance)
{
    nav_real_t a[NAV_STATES];
    for (uint8_t i = 0; i < k; i++) {
        a[i] = 0;
    }
    a[k] = 1;
    nav_ud_spread(ud, a, k, variance);
}

/* From the last column to the first, so that h is intact until its last use. */
void nav_ud_look(nav_ud_scalar_t *scalar, const nav_real_t ud[NAV_PACKED], nav_real_t variance)
{
    for (uint8_t j = NAV_STATES; j-- > scalar->first;) {
        const nav_real_t *u = ud + column(j);
        nav_real_t f = scalar->f[j];
        for (uint8_t i = scalar->first; i < j && i < scalar->end; i++) {
            if (scalar->f[i] != 0) {
                f += scalar->f[i] * u[i];
            }
        }
        nav_real_t v = u[j] * f;
        scalar->f[j] = f;
        scalar->gain[j] = v;
        variance += f * v;
    }
    scalar->variance = variance;
}

void nav_ud_reach(nav_ud_scalar_t *scalar, const nav_real_t ud[NAV_PACKED], uint8_t begin, uint8_t end)
{
    for (uint8_t i = 0; i < end; i++) {
        nav_real_t sum = 0;
        for (uint8_t j = (i > scalar->first) ? i : scalar->first; i >= begin && j < NAV_STATES; j++) {
            sum += (j == i) ? scalar->gain[j] : ud[column(j) + i] * scalar->gain[j];
        }
        scalar->f[i] = sum;
    }
}

/* Bierman, column by column: alpha is the variance of the innovation from the columns up to this one. */
void nav_ud_update(nav_real_t ud[NAV_PACKED], nav_ud_scalar_t *scalar, nav_real_t variance)
{
    nav_real_t *gain = scalar->gain;
    nav_real_t alpha = variance;
    nav_real_t inverse = 1 / alpha;
    for (uint8_t i = 0; i < scalar->first; i++) {
        gain[i] = 0;
    }
    for (uint8_t j = scalar->first; j < NAV_STATES; j++) {
        nav_real_t *u = ud + column(j);
        nav_real_t f = scalar->f[j];
        nav_real_t v = gain[j];
        nav_real_t part = -f * inverse;
        nav_real_t before = alpha;
        alpha += f * v;
        inverse = 1 / alpha;
        u[j] = u[j] * before * inverse;
        for (uint8_t i = 0; i < j; i++) {
            nav_real_t was = u[i];
            u[i] = was + part * gain[i];
            gain[i] += was * v;
        }
    }
    for (uint8_t i = 0; i < NAV_STATES; i++) {
        gain[i] *= inverse;
    }
}

nav_real_t nav_ud_times(const nav_ud_scalar_t *scalar)
{
    nav_real_t sum = 0;
    for (uint8_t i = scalar->first; i < scalar->end; i++) {
        sum += scalar->f[i] * scalar->gain[i];
    }
    return sum;
}

void nav_ud_variances(const nav_real_t ud[NAV_PACKED], nav_real_t variance[NAV_STATES])
{
    for (uint8_t i = 0; i < NAV_STATES; i++) {
        nav_real_t sum = ud[column(i) + i];
        for (uint8_t j = (uint8_t)(i + 1U); j < NAV_STATES; j++) {
            const nav_real_t *u = ud + column(j);
            sum += u[i] * u[i] * u[j];
        }
        variance[i] = sum;
    }
}

bool nav_ud_positive(const nav_real_t ud[NAV_PACKED])
{
    for (uint8_t j = 0; j < NAV_STATES; j++) {
        if (!(ud[column(j) + j] >= 0)) {
            return false;
        }
    }
    return true;
}
