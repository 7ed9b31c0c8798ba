/* nav/lib record by record: what it refuses and what it survives. */
#include "nav_running.h"
#include "support/test.h"

#include <math.h>

#define SEED 3200

/* What one sensor's record, with one value in place of the good one, is answered; nothing may change but a count. */
static int answer_with(running_t *r, int sensor, int place, double value)
{
    double a[3] = { 0, 0, 0 };
    double b[3] = { 0, 0, 0 };
    double *at = (place < 3) ? a : b;
    at[place % 3] = value;
    switch (sensor) {
    case 0:
        return r->v->imu(&r->m, r->t_us + 10000U, a, b);
    case 1:
        return r->v->gps(&r->m, r->t_us, a, b);
    case 2:
        return r->v->down(&r->m, r->t_us, value);
    default:
        return r->v->field(&r->m, r->t_us, a);
    }
}

static void is_refused(running_t *r, int sensor, int place, double value, int want)
{
    nav_values_t before;
    nav_values_t behind;
    double p[144];
    double q[144];
    unsigned count = r->v->count(&r->m, want);
    int queued = r->v->queued(&r->m);
    r->v->state(&r->m, &before);
    r->v->covariance(&r->m, p);
    TEST_ASSERT_EQUAL(want, answer_with(r, sensor, place, value));
    r->v->state(&r->m, &behind);
    r->v->covariance(&r->m, q);
    TEST_ASSERT_EQUAL_MEMORY(&before, &behind, sizeof before);
    TEST_ASSERT_EQUAL_MEMORY(p, q, (size_t)(r->v->states * r->v->states) * sizeof *p);
    TEST_ASSERT_EQUAL(count + 1U, r->v->count(&r->m, want));
    TEST_ASSERT_EQUAL(queued, r->v->queued(&r->m));
}

TEST(values_out_of_range_or_not_finite_are_refused)
{
    static const struct {
        int sensor, place;
        double limit;
    } limits[] = { { 0, 0, 40.0 }, { 0, 4, 400.0 }, { 1, 1, 1e3 }, { 1, 5, 1e6 }, { 2, 0, 1e6 }, { 3, 2, 1e6 } };
    for (int v = 0; v < NAV_ALL; v++) {
        running_t r;
        still_begin(&r, nav_all[v], 0);
        still_seconds(&r, 5);
        for (int k = 0; k < 20; k++) { /* nothing waits */
            still_record(&r);
        }
        for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
            is_refused(&r, limits[i].sensor, limits[i].place, 1.001 * limits[i].limit, ANSWER_OUT_OF_RANGE);
            is_refused(&r, limits[i].sensor, limits[i].place, -1.001 * limits[i].limit, ANSWER_OUT_OF_RANGE);
            is_refused(&r, limits[i].sensor, limits[i].place, NAN, ANSWER_NOT_FINITE);
            is_refused(&r, limits[i].sensor, limits[i].place, INFINITY, ANSWER_NOT_FINITE);
            is_refused(&r, limits[i].sensor, limits[i].place, -INFINITY, ANSWER_NOT_FINITE);
        }
        is_refused(&r, 3, 0, 0.0, ANSWER_NO_LENGTH);
        still_seconds(&r, 20);
        still_is_seen(&r);
    }
}

/* The largest that is legal is taken. */
TEST(limits_themselves_are_legal)
{
    running_t r;
    const double fast[3] = { 40.0, -40.0, 40.0 };
    const double hard[3] = { 400.0, -400.0, 400.0 };
    still_begin(&r, &n12f, 0);
    still_seconds(&r, 1);
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, r.v->imu(&r.m, r.t_us + 10000U, fast, hard));
    TEST_ASSERT_TRUE(r.v->healthy(&r.m));
}

/* One record with NaN is one that is missing. */
TEST(flight_with_bad_records_ends_where_the_good_one_does)
{
    test_random_t random;
    nav_memory_t m[2];
    nav_setting_t setting;
    nav_values_t state[2];
    const double bad[3] = { NAN, 0, 0 };
    nav_flight_setting(&setting, 1.0);
    random_seed(&random, SEED);
    n12d.init(&m[0], &setting);
    n12d.init(&m[1], &setting);
    for (int k = 0; k < 6000; k++) {
        flight_sample_t s;
        uint32_t t_us = 10000U * (uint32_t)(k + 1);
        flight_sample(&s, k, &flight_no_drift, &random);
        for (int i = 0; i < 2; i++) {
            n12d.imu(&m[i], t_us, (i == 1 && k % 10 == 5) ? bad : s.rate, s.force);
            if (k % 100 == 99) {
                n12d.gps(&m[i], t_us, s.gps_velocity, s.gps_position);
            }
            if (k % 10 == 9) {
                n12d.field(&m[i], t_us, s.field);
            }
        }
    }
    double variance[12];
    n12d.variances(&m[0], variance);
    for (int i = 0; i < 2; i++) {
        n12d.state(&m[i], &state[i]);
    }
    TEST_ASSERT_EQUAL(600, n12d.count(&m[1], ANSWER_NOT_FINITE));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(sqrt(variance[i]), state[0].position[i], state[1].position[i]);
        TEST_ASSERT_DOUBLE_WITHIN(sqrt(variance[3 + i]), state[0].velocity[i], state[1].velocity[i]);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, state[0].quaternion[1 + i], state[1].quaternion[1 + i]);
    }
}

TEST(configurations_that_are_not_legal_are_refused)
{
    nav_setting_t good;
    nav_memory_t m;
    still_setting(&good);
    const struct {
        double *value;
        double bad[3];
    } cases[] = {
        { &good.start.quaternion[0], { 0.1, 3.0, NAN } },
        { &good.start.velocity[1], { 1.1e3, -1.1e3, NAN } },
        { &good.start.position[2], { 1.1e6, -1.1e6, INFINITY } },
        { &good.start.drift[0], { 1.1, -1.1, NAN } },
        { &good.field[0], { -1.5, 1e20, NAN } },
        { &good.gravity, { 0.0, 26.0, NAN } },
        { &good.sigma[0], { -1.0, 1e6, NAN } },
        { &good.sigma[3], { -1e-9, INFINITY, NAN } },
        { &good.walk[1], { -1.0, 1e6, NAN } },
        { &good.measured[0], { 0.0, 1e6, NAN } },
        { &good.measured[3], { 0.0, -1.0, NAN } },
        { &good.gate, { 0.5, -1.0, NAN } },
        { &good.gate, { 101.0, 0.99, INFINITY } },
    };
    for (int v = 0; v < NAV_ALL; v++) {
        TEST_ASSERT_TRUE(nav_all[v]->init(&m, &good));
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            double was = *cases[i].value;
            for (int k = 0; k < 3; k++) {
                *cases[i].value = cases[i].bad[k];
                TEST_ASSERT_FALSE(nav_all[v]->init(&m, &good));
            }
            *cases[i].value = was;
        }
        good.period_us = 999;
        TEST_ASSERT_FALSE(nav_all[v]->init(&m, &good));
        good.period_us = 100001;
        TEST_ASSERT_FALSE(nav_all[v]->init(&m, &good));
        good.period_us = 10000;
    }
}
