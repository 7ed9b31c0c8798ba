/* The covariance as U D U'. Loops leave out what is known to be 0 or 1: a product costs 150 cycles on the AVR. */
#include "nav_ud.h"

#define HALF NAV_R(0.5)

/* Where column j begins. */
static uint8_t column(uint8_t j)
{
    return (uint8_t)((uint8_t)(j * (uint8_t)(j + 1U)) / 2U);
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

/* What Phi works with, once per step. */
typedef struct {
    nav_real_t step, half_step;
    nav_real_t force[3]; /* x step / 2 */
    const nav_real_t *dcm;
} phi_t;

/* r += step / 2 (v before + v behind). */
static void carry_position(nav_real_t *u, const nav_real_t v[3], const phi_t *phi)
{
    for (uint8_t i = 0; i < 3U; i++) {
        u[NAV_R0 + i] += phi->half_step * (v[i] + u[NAV_V0 + i]);
    }
}

/* A column of the velocity: v is (u3, u4, 1)' or shorter, so r has one more than elements before the diagonal. */
static void carry_velocity_column(nav_real_t *u, uint8_t j, const phi_t *phi)
{
    uint8_t diagonal = (uint8_t)(j - NAV_V0);
    for (uint8_t i = 0; i < diagonal; i++) {
        u[NAV_R0 + i] += phi->step * u[NAV_V0 + i];
    }
    u[NAV_R0 + diagonal] += phi->step;
}

/* v += f x mu step, where mu is (m0, m1, 1)', (m0, 1, 0)' or (1, 0, 0)': without what is known. */
static void carry_velocity_attitude(nav_real_t *u, uint8_t j, const nav_real_t force[3])
{
    nav_real_t f[3];
    for (uint8_t i = 0; i < 3U; i++) {
        f[i] = force[i] + force[i];
    }
    if (j == NAV_M0) {
        u[NAV_V0 + 1] += f[2];
        u[NAV_V0 + 2] -= f[1];
        return;
    }
    nav_real_t m0 = u[NAV_M0];
    if (j == NAV_M0 + 1) {
        u[NAV_V0 + 0] -= f[2];
        u[NAV_V0 + 1] += f[2] * m0;
        u[NAV_V0 + 2] += f[0] - f[1] * m0;
        return;
    }
    nav_real_t m1 = u[NAV_M0 + 1];
    u[NAV_V0 + 0] += f[1] - f[2] * m1;
    u[NAV_V0 + 1] += f[2] * m0 - f[0];
    u[NAV_V0 + 2] += f[0] * m1 - f[1] * m0;
}

#if NAV_STATES > 9
/* v += f x (mu before + mu behind) step / 2. */
static void carry_velocity(nav_real_t *u, const nav_real_t twice[3], const nav_real_t force[3])
{
    u[NAV_V0 + 0] += force[1] * twice[2] - force[2] * twice[1];
    u[NAV_V0 + 1] += force[2] * twice[0] - force[0] * twice[2];
    u[NAV_V0 + 2] += force[0] * twice[1] - force[1] * twice[0];
}

/* mu += step A c, c being (c0, c1, 1)' or shorter. twice: mu before + mu behind. */
static void carry_attitude(nav_real_t *u, uint8_t j, nav_real_t twice[3], const phi_t *phi)
{
    uint8_t diagonal = (uint8_t)(j - NAV_C0);
    for (uint8_t i = 0; i < 3U; i++) {
        const nav_real_t *a = phi->dcm + 3U * i;
        nav_real_t sum = a[diagonal];
        for (uint8_t k = 0; k < diagonal; k++) {
            sum += a[k] * u[NAV_C0 + k];
        }
        nav_real_t before = u[NAV_M0 + i];
        nav_real_t behind = before + phi->step * sum;
        twice[i] = before + behind;
        u[NAV_M0 + i] = behind;
    }
}
#endif

static void carry_column(nav_real_t *u, uint8_t j, const phi_t *phi)
{
    const nav_real_t v[3] = { u[NAV_V0], u[NAV_V0 + 1], u[NAV_V0 + 2] };
    if (j < NAV_C0) {
        carry_velocity_attitude(u, j, phi->force);
    }
#if NAV_STATES > 9
    else {
        nav_real_t twice[3];
        carry_attitude(u, j, twice, phi);
        carry_velocity(u, twice, phi->force);
    }
#endif
    carry_position(u, v, phi);
}

void nav_ud_phi(nav_real_t ud[NAV_PACKED], nav_real_t step_s, const nav_real_t force_mps2[3], const nav_real_t dcm[9])
{
    phi_t phi;
    phi.step = step_s;
    phi.half_step = HALF * step_s;
    for (uint8_t i = 0; i < 3U; i++) {
        phi.force[i] = force_mps2[i] * phi.half_step;
    }
    phi.dcm = dcm;
    for (uint8_t j = NAV_V0; j < NAV_STATES; j++) {
        nav_real_t *u = ud + column(j);
        if (j < NAV_M0) {
            carry_velocity_column(u, j, &phi);
        } else {
            carry_column(u, j, &phi);
        }
    }
}

/* One column of Agee and Turner: P += c a a'. Gives c for the columns before. */
static nav_real_t spread_column(nav_real_t *u, nav_real_t *a, uint8_t j, nav_real_t c)
{
    nav_real_t d = u[j];
    nav_real_t along = c * a[j];
    nav_real_t sum = d + along * a[j];
    u[j] = sum;
    if (!(sum > 0)) { /* d = 0 and nothing to add: the columns before are as they were */
        return c;
    }
    nav_real_t inverse = 1 / sum;
    nav_real_t share = along * inverse;
    for (uint8_t i = 0; i < j; i++) {
        a[i] -= a[j] * u[i];
        u[i] += share * a[i];
    }
    return c * d * inverse;
}

static void spread_below(nav_real_t *ud, nav_real_t *a, uint8_t end, nav_real_t c)
{
    for (uint8_t j = end; j-- > 0U;) {
        c = spread_column(ud + column(j), a, j, c);
    }
}

void nav_ud_spread(nav_real_t ud[NAV_PACKED], nav_real_t a[NAV_STATES], uint8_t k, nav_real_t variance)
{
    spread_below(ud, a, (uint8_t)(k + 1U), variance);
}

void nav_ud_noise(nav_real_t ud[NAV_PACKED], uint8_t k, nav_real_t variance)
{
    nav_real_t a[NAV_STATES];
    nav_real_t *u = ud + column(k);
    nav_real_t d = u[k];
    nav_real_t sum = d + variance;
    if (!(sum > 0)) {
        return;
    }
    u[k] = sum;
    nav_real_t share = variance / sum;
    for (uint8_t i = 0; i < k; i++) {
        a[i] = -u[i];
        u[i] += share * a[i];
    }
    spread_below(ud, a, k, d * share);
}

/* Element j of h U. */
static nav_real_t row_column(const nav_row_t *row, const nav_real_t *u, uint8_t j)
{
    nav_real_t sum = 0;
    if (row->main < j) {
        sum = u[row->main];
    } else if (row->main == j) {
        sum = 1;
    }
    for (uint8_t n = 0; n < row->count && row->index[n] <= j; n++) {
        sum += (row->index[n] == j) ? row->more[n] : row->more[n] * u[row->index[n]];
    }
    return sum;
}

void nav_ud_look(nav_ud_scalar_t *scalar, const nav_real_t ud[NAV_PACKED], const nav_row_t *row, nav_real_t variance)
{
    scalar->first = row->main;
    if (row->count > 0U && row->index[0] < row->main) {
        scalar->first = row->index[0];
    }
    for (uint8_t j = scalar->first; j < NAV_STATES; j++) {
        const nav_real_t *u = ud + column(j);
        nav_real_t f = row_column(row, u, j);
        nav_real_t v = u[j] * f;
        scalar->f[j] = f;
        scalar->gain[j] = v;
        variance += f * v;
    }
    scalar->variance = variance;
}

/* Bierman, column by column: alpha is the variance of the innovation as far as the columns up to here make it. */
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

nav_real_t nav_row_times(const nav_row_t *row, const nav_real_t x[NAV_STATES])
{
    nav_real_t sum = (row->main < NAV_STATES) ? x[row->main] : 0;
    for (uint8_t n = 0; n < row->count; n++) {
        sum += row->more[n] * x[row->index[n]];
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
