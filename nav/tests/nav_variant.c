/* One variant of nav/lib behind the table of functions: compiled once for each (nav/nav_lib.mk). */
#include "nav_variants.h"

#include "nav.h"
#include "nav_align.h"
#include "nav_ins.h"
#include "nav_noise.h"
#include "nav_ud.h"

#include <stddef.h>
#include <string.h>

#ifndef NAV_VARIANT
#define NAV_VARIANT nav_as_it_is
#endif
#define TEXT_OF(name) #name
#define TEXT(name) TEXT_OF(name)

_Static_assert(sizeof(nav_t) <= sizeof(nav_memory_t), "nav_memory_t holds every variant");
_Static_assert(ANSWERS == (int)NAV_ANSWERS && ANSWER_GAP == (int)NAV_GAP,
               "the answers of the table are those of the library");

static nav_t *nav_of(nav_memory_t *memory)
{
    return (nav_t *)(void *)memory;
}

static const nav_t *read_of(const nav_memory_t *memory)
{
    return (const nav_t *)(const void *)memory;
}

static void to_real(nav_real_t *to, const double *from, int count)
{
    for (int i = 0; i < count; i++) {
        to[i] = (nav_real_t)from[i];
    }
}

static void to_double(double *to, const nav_real_t *from, int count)
{
    for (int i = 0; i < count; i++) {
        to[i] = (double)from[i];
    }
}

static void state_in(nav_state_t *to, const nav_values_t *from)
{
    to_real(to->quaternion, from->quaternion, 4);
    to_real(to->velocity_mps, from->velocity, 3);
    to_real(to->position_m, from->position, 3);
    to_real(to->gyro_drift_rps, from->drift, 3);
}

static void state_out(nav_values_t *to, const nav_state_t *from)
{
    to_double(to->quaternion, from->quaternion, 4);
    to_double(to->velocity, from->velocity_mps, 3);
    to_double(to->position, from->position_m, 3);
    to_double(to->drift, from->gyro_drift_rps, 3);
}

static bool init(nav_memory_t *nav, const nav_setting_t *s)
{
    nav_config_t c;
    state_in(&c.start, &s->start);
    to_real(c.field, s->field, 3);
    c.gravity_mps2 = (nav_real_t)s->gravity;
    c.start_position_m = (nav_real_t)s->sigma[0];
    c.start_velocity_mps = (nav_real_t)s->sigma[1];
    c.start_attitude_rad = (nav_real_t)s->sigma[2];
    c.start_drift_rps = (nav_real_t)s->sigma[3];
    c.walk_position_m = (nav_real_t)s->walk[0];
    c.walk_velocity_mps = (nav_real_t)s->walk[1];
    c.walk_attitude_rad = (nav_real_t)s->walk[2];
    c.walk_drift_rps = (nav_real_t)s->walk[3];
    c.sigma_gps_velocity_mps = (nav_real_t)s->measured[0];
    c.sigma_gps_position_m = (nav_real_t)s->measured[1];
    c.sigma_down_m = (nav_real_t)s->measured[2];
    c.sigma_field = (nav_real_t)s->measured[3];
    c.gate = (nav_real_t)s->gate;
    c.period_us = s->period_us;
    return nav_init(nav_of(nav), &c);
}

static int imu(nav_memory_t *nav, uint32_t t_us, const double rate[3], const double force[3])
{
    nav_real_t r[3];
    nav_real_t f[3];
    to_real(r, rate, 3);
    to_real(f, force, 3);
    return (int)nav_imu(nav_of(nav), t_us, r, f);
}

static int gps(nav_memory_t *nav, uint32_t t_us, const double velocity[3], const double position[3])
{
    nav_real_t v[3];
    nav_real_t r[3];
    to_real(v, velocity, 3);
    to_real(r, position, 3);
    return (int)nav_gps(nav_of(nav), t_us, v, r);
}

static int down(nav_memory_t *nav, uint32_t t_us, double value)
{
    return (int)nav_down(nav_of(nav), t_us, (nav_real_t)value);
}

static int field(nav_memory_t *nav, uint32_t t_us, const double value[3])
{
    nav_real_t f[3];
    to_real(f, value, 3);
    return (int)nav_field(nav_of(nav), t_us, f);
}

static void state(const nav_memory_t *nav, nav_values_t *out)
{
    state_out(out, nav_state(read_of(nav)));
}

static void variances(const nav_memory_t *nav, double *out)
{
    nav_real_t v[NAV_STATES];
    nav_variances(read_of(nav), v);
    to_double(out, v, NAV_STATES);
}

static unsigned count(const nav_memory_t *nav, int answer)
{
    return nav_counts(read_of(nav))->answer[answer];
}

static int queued(const nav_memory_t *nav)
{
    return nav_queued(read_of(nav));
}

static bool healthy(const nav_memory_t *nav)
{
    return nav_healthy(read_of(nav));
}

static void ud_start(nav_memory_t *nav, const double sigma[4])
{
    nav_real_t s[4];
    to_real(s, sigma, 4);
    nav_ud_start(nav_of(nav)->ud, s);
}

static void ud_phi(nav_memory_t *nav, double step_s, const double force[3], const double dcm[9])
{
    nav_real_t f[3];
    nav_real_t c[9];
    to_real(f, force, 3);
    to_real(c, dcm, 9);
    nav_ud_phi(nav_of(nav)->ud, (nav_real_t)step_s, f, c);
}

static void ud_noise(nav_memory_t *nav, int k, double variance)
{
    nav_ud_noise(nav_of(nav)->ud, (uint8_t)k, (nav_real_t)variance);
}

static void ud_spread(nav_memory_t *nav, const double *a, int k, double variance)
{
    nav_real_t along[NAV_STATES];
    to_real(along, a, NAV_STATES);
    nav_ud_spread(nav_of(nav)->ud, along, (uint8_t)k, (nav_real_t)variance);
}

static double ud_scalar(nav_memory_t *nav, const nav_test_row_t *row, double variance, double *gain)
{
    nav_ud_scalar_t scalar;
    scalar.first = NAV_STATES;
    scalar.end = 0;
    for (int i = 0; i < NAV_STATES; i++) {
        scalar.f[i] = (nav_real_t)row->h[i];
        if (row->h[i] != 0.0) {
            scalar.first = (scalar.end == 0U) ? (uint8_t)i : scalar.first;
            scalar.end = (uint8_t)(i + 1);
        }
    }
    nav_ud_look(&scalar, nav_of(nav)->ud, (nav_real_t)variance);
    nav_ud_update(nav_of(nav)->ud, &scalar, (nav_real_t)variance);
    to_double(gain, scalar.gain, NAV_STATES);
    return (double)scalar.variance;
}

static int place(int i, int j)
{
    return j * (j + 1) / 2 + i;
}

static double least_d(const nav_memory_t *nav)
{
    double least = (double)read_of(nav)->ud[0];
    for (int j = 1; j < NAV_STATES; j++) {
        double d = (double)read_of(nav)->ud[place(j, j)];
        least = (d < least) ? d : least;
    }
    return least;
}

static double u_of(const nav_real_t *ud, int i, int j)
{
    return (i == j) ? 1.0 : ((i < j) ? (double)ud[place(i, j)] : 0.0);
}

static void covariance(const nav_memory_t *nav, double *p)
{
    const nav_real_t *ud = read_of(nav)->ud;
    for (int i = 0; i < NAV_STATES; i++) {
        for (int j = 0; j < NAV_STATES; j++) {
            p[i * NAV_STATES + j] = 0.0;
            for (int k = 0; k < NAV_STATES; k++) {
                p[i * NAV_STATES + j] += u_of(ud, i, k) * (double)ud[place(k, k)] * u_of(ud, j, k);
            }
        }
    }
}

static void noise_start(nav_memory_t *nav, const double walk[4], uint32_t period_us)
{
    nav_real_t w[4];
    to_real(w, walk, 4);
    nav_noise_start(&nav_of(nav)->noise, w, period_us);
}

static void noise_job(nav_memory_t *nav, uint32_t t_us)
{
    nav_noise_job(&nav_of(nav)->noise, nav_of(nav)->ud, t_us);
}

static bool tau(double out[6], const double from[3])
{
    nav_real_t f[3];
    nav_real_t t[2][3];
    to_real(f, from, 3);
    bool made = nav_align_tau(t, f);
    if (made) {
        to_double(out, t[0], 3);
        to_double(out + 3, t[1], 3);
    }
    return made;
}

static void dcm(double out[9], const double quaternion[4])
{
    nav_real_t q[4];
    nav_real_t c[9];
    to_real(q, quaternion, 4);
    nav_ins_dcm(c, q);
    to_double(out, c, 9);
}

static void step(nav_values_t *values, double force_ned[3], const double rate[3], const double force[3], double gravity,
                 double step_s)
{
    nav_state_t s;
    nav_real_t c[9];
    nav_real_t w[3];
    nav_real_t f[3];
    nav_real_t n[3];
    state_in(&s, values);
    to_real(w, rate, 3);
    to_real(f, force, 3);
    nav_ins_dcm(c, s.quaternion);
    nav_ins_step(&s, n, c, w, f, (nav_real_t)gravity, (nav_real_t)step_s);
    nav_ins_unit(s.quaternion);
    to_double(force_ned, n, 3);
    state_out(values, &s);
}

static void correct(nav_values_t *values, const double *x)
{
    nav_state_t s;
    nav_real_t by[NAV_STATES];
    state_in(&s, values);
    to_real(by, x, NAV_STATES);
    nav_ins_correct(&s, by);
    state_out(values, &s);
}

static void set_state(nav_memory_t *nav, const nav_values_t *values)
{
    state_in(&nav_of(nav)->state, values);
}

static void break_covariance(nav_memory_t *nav, int k, double d)
{
    nav_of(nav)->ud[place(k, k)] = (nav_real_t)d;
}

extern const nav_variant_t NAV_VARIANT;
const nav_variant_t NAV_VARIANT = {
    .name = TEXT(NAV_VARIANT),
    .states = NAV_STATES,
    .in_double = sizeof(nav_real_t) == sizeof(double),
    .bytes = sizeof(nav_t),
    .init = init,
    .imu = imu,
    .gps = gps,
    .down = down,
    .field = field,
    .state = state,
    .variances = variances,
    .count = count,
    .queued = queued,
    .healthy = healthy,
    .ud_start = ud_start,
    .ud_phi = ud_phi,
    .ud_noise = ud_noise,
    .ud_spread = ud_spread,
    .ud_scalar = ud_scalar,
    .least_d = least_d,
    .covariance = covariance,
    .noise_start = noise_start,
    .noise_job = noise_job,
    .tau = tau,
    .dcm = dcm,
    .step = step,
    .correct = correct,
    .set_state = set_state,
    .break_covariance = break_covariance,
};
