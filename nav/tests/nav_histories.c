/* The covariance alone, over the flight of 3.4. */
#include "nav_histories.h"
#include "reference_nav.h"

#include <math.h>
#include <string.h>

enum { STEPS = FLIGHT_SECONDS * FLIGHT_RATE };

static const double sigma_ours[4] = { 57.3, 1.2, 0.02, 1e-3 };
static const double sigma_theirs[4] = { 0.02, 1.2, 57.3, 1e-3 };
static const double walk_ours[4] = { 0.005e-4, 1e-4, 0.3e-4, 0.0 };
static const double walk_theirs[4] = { 0.3e-4, 1e-4, 0.005e-4, 0.0 };
static const double measured[4] = { 0.0349, 0.1, 5.0, 1.0 }; /* field, velocity, position, down */

/* Force in NED and attitude in the middle of step k. */
static void linearised(int k, double force[3], double dcm[9])
{
    flight_truth_t truth;
    flight_truth(&truth, (k + 0.5) * FLIGHT_STEP);
    flight_dcm(dcm, truth.quaternion);
    for (int i = 0; i < 3; i++) {
        force[i] = truth.acceleration[i] - ((i == 2) ? FLIGHT_GRAVITY : 0.0);
    }
}

static void roots_of(double *sigma, const double *variance, int states)
{
    for (int i = 0; i < states; i++) {
        sigma[i] = sqrt(variance[i]);
    }
}

void nav_history_of_reference(nav_history_t *h, int form, int states, int printed)
{
    reference_nav_t f;
    const double nothing[9] = { 0 };
    double x[12];
    reference_nav_start(&f, form, states, sigma_theirs, flight_field, printed);
    for (int k = 0; k < STEPS; k++) {
        double force[3];
        double dcm[9];
        linearised(k, force, dcm);
        reference_nav_time(&f, FLIGHT_STEP, force, dcm, walk_theirs);
        if ((k + 1) % FLIGHT_RATE == 0) {
            double variance[12];
            reference_nav_measure(&f, true, nav_flight_has_gps((k + 1) * FLIGHT_STEP), true, nothing, measured, x);
            reference_nav_variances(&f, variance);
            roots_of(h->sigma[k / FLIGHT_RATE], variance, states);
        }
    }
}

static void scalar(const nav_variant_t *v, nav_memory_t *m, int main, const double *mu, double sigma)
{
    nav_test_row_t row = { { 0 } };
    double gain[12];
    if (main >= 0) {
        row.h[main] = 1.0;
    } else {
        memcpy(row.h + 6, mu, 3 * sizeof *mu);
    }
    v->ud_scalar(m, &row, sigma * sigma, gain);
}

static void measure(const nav_variant_t *v, nav_memory_t *m, const double tau[9], bool gps)
{
    scalar(v, m, -1, tau + 3, measured[0]);
    scalar(v, m, -1, tau + 6, measured[0]);
    for (int i = 0; gps && i < 3; i++) {
        scalar(v, m, 3 + i, NULL, measured[1]);
    }
    for (int i = 0; gps && i < 3; i++) {
        scalar(v, m, i, NULL, measured[2]);
    }
    scalar(v, m, 2, NULL, measured[3]);
}

void nav_history_of_ours(nav_history_t *h, const nav_variant_t *v, bool turns)
{
    static nav_memory_t m;
    double tau[9];
    memset(&m, 0, sizeof m);
    reference_nav_tau(tau, flight_field, false);
    v->ud_start(&m, sigma_ours);
    v->noise_start(&m, walk_ours, 10000);
    h->least_d = INFINITY;
    for (int k = 0; k < STEPS; k++) {
        double force[3];
        double dcm[9];
        linearised(k, force, dcm);
        v->ud_phi(&m, FLIGHT_STEP, force, dcm);
        for (int i = 0; i < v->states && !turns; i++) {
            v->ud_noise(&m, i, walk_ours[i / 3] * walk_ours[i / 3]);
        }
        if (turns) {
            v->noise_job(&m, 10000U * (uint32_t)(k + 1));
        }
        if ((k + 1) % FLIGHT_RATE == 0) {
            double variance[12];
            measure(v, &m, tau, nav_flight_has_gps((k + 1) * FLIGHT_STEP));
            v->variances(&m, variance);
            roots_of(h->sigma[k / FLIGHT_RATE], variance, v->states);
            h->least_d = fmin(h->least_d, v->least_d(&m));
        }
    }
}

double nav_histories_apart(const nav_history_t *a, const nav_history_t *b, int states)
{
    double worst = 0.0;
    for (int t = 0; t < FLIGHT_SECONDS; t++) {
        for (int i = 0; i < states; i++) {
            worst = fmax(worst, fabs(a->sigma[t][i] / b->sigma[t][i] - 1.0));
        }
    }
    return worst;
}
