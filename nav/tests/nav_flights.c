/* Flights of paper 003 through a variant of nav/lib. */
#include "nav_flights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TWO_PI 6.283185307179586

const nav_variant_t *const nav_all[NAV_ALL] = { &n9f, &n12f, &n9d, &n12d };

static const double start_sigma[4] = { 57.3, 1.2, 0.02, 1e-3 };
static const double walk[4] = { 0.005e-4, 1e-4, 0.3e-4, 0.0 };
static const double measured[4] = { 0.1, 5.0, 1.0, 0.0349 };

bool nav_flight_has_gps(double t)
{
    return t <= 160.0 || t >= 400.0;
}

void nav_flight_setting(nav_setting_t *s, double walk_scale)
{
    flight_truth_t truth;
    flight_truth(&truth, 0.0);
    memset(s, 0, sizeof *s);
    double length = sqrt(1.0 + 3.0 * 0.05 * 0.05);
    const double lambda[4] = { 1.0 / length, 0.05 / length, -0.05 / length, 0.05 / length };
    flight_product(s->start.quaternion, truth.quaternion, lambda);
    for (int i = 0; i < 3; i++) {
        s->start.velocity[i] = 1.01 * truth.velocity[i];
        s->start.position[i] = 1.01 * truth.position[i];
        s->field[i] = flight_field[i];
    }
    for (int i = 0; i < 4; i++) {
        s->sigma[i] = start_sigma[i];
        s->walk[i] = walk_scale * walk[i];
        s->measured[i] = measured[i];
    }
    s->gravity = FLIGHT_GRAVITY;
    s->gate = 0.0;
    s->period_us = 10000;
}

/* What both ways share. */
typedef struct {
    const nav_plan_t *plan;
    nav_setting_t setting;
    nav_memory_t memory;
    nav_values_t values;
    double tau[6];
} flown_t;

/* x += K (z - h x), h being 1 at `main`, or three elements in the attitude. */
static void scalar_at_once(flown_t *f, int main, const double *more, double z, double sigma, double *x)
{
    nav_test_row_t row = { { 0 } };
    double gain[12];
    double left = z;
    for (int i = 0; i < 3 && main < 0; i++) {
        row.h[6 + i] = more[i];
    }
    if (main >= 0) {
        row.h[main] = 1.0;
    }
    for (int i = 0; i < f->plan->variant->states; i++) {
        left -= row.h[i] * x[i];
    }
    f->plan->variant->ud_scalar(&f->memory, &row, sigma * sigma, gain);
    for (int i = 0; i < f->plan->variant->states; i++) {
        x[i] += gain[i] * left;
    }
}

static void field_at_once(flown_t *f, const double field[3], double *x)
{
    double c[9];
    double z[2] = { 0, 0 };
    double length = sqrt(field[0] * field[0] + field[1] * field[1] + field[2] * field[2]);
    flight_dcm(c, f->values.quaternion);
    for (int i = 0; i < 3; i++) {
        double ned = (c[3 * i] * field[0] + c[3 * i + 1] * field[1] + c[3 * i + 2] * field[2]) / length;
        z[0] -= f->tau[3 + i] * ned;
        z[1] += f->tau[i] * ned;
    }
    scalar_at_once(f, -1, f->tau, z[0], measured[3], x);
    scalar_at_once(f, -1, f->tau + 3, z[1], measured[3], x);
}

static void measure_at_once(flown_t *f, const flight_sample_t *sample, bool gps, bool down, bool field)
{
    double x[12] = { 0 };
    if (field) {
        field_at_once(f, sample->field, x);
    }
    for (int i = 0; gps && i < 3; i++) {
        scalar_at_once(f, 3 + i, NULL, sample->gps_velocity[i] - f->values.velocity[i], measured[0], x);
    }
    for (int i = 0; gps && i < 3; i++) {
        scalar_at_once(f, i, NULL, sample->gps_position[i] - f->values.position[i], measured[1], x);
    }
    if (down) {
        scalar_at_once(f, 2, NULL, sample->down - f->values.position[2], measured[2], x);
    }
    if (gps || down || field) {
        f->plan->variant->correct(&f->values, x);
    }
}

static void step_at_once(flown_t *f, const flight_sample_t *sample)
{
    const nav_variant_t *v = f->plan->variant;
    double c[9];
    double force[3];
    double rate[3];
    for (int i = 0; i < 3; i++) {
        rate[i] = sample->rate[i] - f->values.drift[i];
    }
    flight_dcm(c, f->values.quaternion);
    v->step(&f->values, force, rate, sample->force, FLIGHT_GRAVITY, FLIGHT_STEP);
    v->ud_phi(&f->memory, FLIGHT_STEP, force, c);
    for (int i = 0; i < v->states; i++) {
        double q = f->setting.walk[i / 3];
        v->ud_noise(&f->memory, i, q * q);
    }
}

static void slot(flown_t *f, int k, const flight_sample_t *sample, nav_flight_t *flight)
{
    const nav_plan_t *plan = f->plan;
    const nav_variant_t *v = plan->variant;
    uint32_t t_us = plan->start_us + 10000U * (uint32_t)(k + 1);
    bool second = (k + 1) % FLIGHT_RATE == 0;
    bool gps = second && nav_flight_has_gps((k + 1) * FLIGHT_STEP);
    bool field = (k + 1) % plan->field_every == 0;
    if (plan->at_once) {
        step_at_once(f, sample);
        measure_at_once(f, sample, gps, second, field);
        return;
    }
    v->imu(&f->memory, t_us, sample->rate, sample->force);
    if (gps) {
        v->gps(&f->memory, t_us, sample->gps_velocity, sample->gps_position);
    }
    if (second) {
        v->down(&f->memory, t_us, sample->down);
    }
    if (field) {
        v->field(&f->memory, t_us, sample->field);
    }
    int queued = v->queued(&f->memory);
    flight->deepest_queue = (queued > flight->deepest_queue) ? queued : flight->deepest_queue;
}

static void note(nav_second_t *second, flown_t *f, double t)
{
    const nav_variant_t *v = f->plan->variant;
    flight_truth_t truth;
    double is[3];
    double taken[3];
    flight_truth(&truth, t);
    if (!f->plan->at_once) {
        v->state(&f->memory, &f->values);
    }
    flight_euler(is, truth.quaternion);
    flight_euler(taken, f->values.quaternion);
    for (int i = 0; i < 3; i++) {
        second->euler[i] = remainder(is[i] - taken[i], TWO_PI);
        second->velocity[i] = truth.velocity[i] - f->values.velocity[i];
        second->position[i] = truth.position[i] - f->values.position[i];
        second->drift[i] = f->plan->drift->gyro[i] - f->values.drift[i];
    }
    v->variances(&f->memory, second->variance);
}

/* Kept for the next plan with the same seed and drift: making them takes longer than flying. */
static const flight_sample_t *samples_of(const nav_plan_t *plan)
{
    static flight_sample_t sample[FLIGHT_SECONDS * FLIGHT_RATE];
    static bool begun;
    static const flight_drift_t *drift;
    static uint32_t seed;
    static test_random_t random;
    static int made;
    if (!begun || plan->drift != drift || plan->seed != seed) {
        begun = true;
        drift = plan->drift;
        seed = plan->seed;
        random_seed(&random, seed);
        made = 0;
    }
    for (; made < plan->seconds * FLIGHT_RATE; made++) {
        flight_sample(&sample[made], made, drift, &random);
    }
    return sample;
}

void nav_fly(nav_flight_t *flight, const nav_plan_t *plan)
{
    static flown_t f;
    const flight_sample_t *sample = samples_of(plan);
    memset(flight, 0, sizeof *flight);
    f.plan = plan;
    nav_flight_setting(&f.setting, plan->walk_scale);
    f.setting.gate = plan->gate;
    f.values = f.setting.start;
    plan->variant->init(&f.memory, &f.setting);
    plan->variant->tau(f.tau, f.setting.field);
    flight->least_d = INFINITY;
    for (int k = 0; k < plan->seconds * FLIGHT_RATE; k++) {
        slot(&f, k, &sample[k], flight);
        flight->least_d = fmin(flight->least_d, plan->variant->least_d(&f.memory));
        if (k % FLIGHT_RATE == plan->note_at) {
            note(&flight->second[k / FLIGHT_RATE], &f, (k + 1) * FLIGHT_STEP);
        }
    }
    for (int i = 0; i < ANSWERS; i++) {
        flight->count[i] = plan->variant->count(&f.memory, i);
    }
}

double nav_worst_euler(const nav_flight_t *flight, int axis, int from, int to)
{
    double worst = 0.0;
    for (int i = from; i < to; i++) {
        worst = fmax(worst, fabs(flight->second[i].euler[axis]));
    }
    return worst;
}

double nav_worst_position(const nav_flight_t *flight, int from, int to)
{
    double worst = 0.0;
    for (int i = from; i < to; i++) {
        const double *r = flight->second[i].position;
        worst = fmax(worst, sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]));
    }
    return worst;
}

static int ascending(const void *a, const void *b)
{
    double left = *(const double *)a;
    double right = *(const double *)b;
    return (left > right) - (left < right);
}

double nav_median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, ascending);
    return (count % 2 == 1) ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}
