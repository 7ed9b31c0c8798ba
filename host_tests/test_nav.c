/* lib/nav record by record: what it refuses and what it survives. */
#include "nav_flights.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define SEED 3200

void setUp(void) {}

void tearDown(void) {}

static const double no_rate[3] = { 0, 0, 0 };
static const double weight[3] = { 0, 0, -FLIGHT_GRAVITY };
static const double nowhere[3] = { 0, 0, 0 };

typedef struct {
    const nav_variant_t *v;
    nav_memory_t m;
    nav_setting_t setting;
    uint32_t t_us;
} running_t;

static void rest_setting(nav_setting_t *s)
{
    const double level[4] = { 1, 0, 0, 0 };
    nav_flight_setting(s, 1.0);
    memcpy(s->start.quaternion, level, sizeof level);
    memset(s->start.velocity, 0, sizeof s->start.velocity);
    memset(s->start.position, 0, sizeof s->start.position);
    s->gate = 5.0;
}

static void begin(running_t *r, const nav_variant_t *v, uint32_t t_us)
{
    memset(&r->m, 0, sizeof r->m);
    r->v = v;
    rest_setting(&r->setting);
    TEST_ASSERT_TRUE(v->init(&r->m, &r->setting));
    r->t_us = t_us;
}

static int record(running_t *r)
{
    r->t_us += 10000U;
    return r->v->imu(&r->m, r->t_us, no_rate, weight);
}

/* At rest with all sensors for some seconds. */
static void rest(running_t *r, int seconds)
{
    for (int k = 0; k < 100 * seconds; k++) {
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, record(r));
        if (k % 10 == 0) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, r->v->field(&r->m, r->t_us, flight_field));
        }
        if (k % 100 == 0) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, r->v->gps(&r->m, r->t_us, nowhere, nowhere));
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, r->v->down(&r->m, r->t_us, 0.0));
        }
    }
}

/* Within 5 sigma of what a still body at the origin is, and healthy. */
static void is_at_rest(const running_t *r)
{
    nav_values_t s;
    double variance[12];
    r->v->state(&r->m, &s);
    r->v->variances(&r->m, variance);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(variance[i]), 0.0, s.position[i]);
        TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(variance[3 + i]), 0.0, s.velocity[i]);
        TEST_ASSERT_DOUBLE_WITHIN(5.0 * sqrt(variance[6 + i]), 0.0, 2.0 * s.quaternion[1 + i]);
    }
    TEST_ASSERT_TRUE(variance[0] < 25.0 && variance[3] < 0.01);
    TEST_ASSERT_TRUE(r->v->healthy(&r->m));
}

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

static void values_out_of_range_or_not_finite_are_refused(void)
{
    static const struct {
        int sensor, place;
        double limit;
    } limits[] = { { 0, 0, 40.0 }, { 0, 4, 400.0 }, { 1, 1, 1e3 }, { 1, 5, 1e6 }, { 2, 0, 1e6 }, { 3, 2, 1e6 } };
    for (int v = 0; v < NAV_ALL; v++) {
        running_t r;
        begin(&r, nav_all[v], 0);
        rest(&r, 5);
        for (int k = 0; k < 20; k++) { /* nothing waits */
            record(&r);
        }
        for (size_t i = 0; i < sizeof limits / sizeof limits[0]; i++) {
            is_refused(&r, limits[i].sensor, limits[i].place, 1.001 * limits[i].limit, ANSWER_OUT_OF_RANGE);
            is_refused(&r, limits[i].sensor, limits[i].place, -1.001 * limits[i].limit, ANSWER_OUT_OF_RANGE);
            is_refused(&r, limits[i].sensor, limits[i].place, NAN, ANSWER_NOT_FINITE);
            is_refused(&r, limits[i].sensor, limits[i].place, INFINITY, ANSWER_NOT_FINITE);
            is_refused(&r, limits[i].sensor, limits[i].place, -INFINITY, ANSWER_NOT_FINITE);
        }
        is_refused(&r, 3, 0, 0.0, ANSWER_NO_LENGTH);
        rest(&r, 20);
        is_at_rest(&r);
    }
}

/* The largest that is legal is taken. */
static void limits_themselves_are_legal(void)
{
    running_t r;
    const double fast[3] = { 40.0, -40.0, 40.0 };
    const double hard[3] = { 400.0, -400.0, 400.0 };
    begin(&r, &n12f, 0);
    rest(&r, 1);
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, r.v->imu(&r.m, r.t_us + 10000U, fast, hard));
    TEST_ASSERT_TRUE(r.v->healthy(&r.m));
}

static void time_that_goes_back_is_refused(void)
{
    running_t r;
    begin(&r, &n12f, 0);
    rest(&r, 3);
    nav_values_t before;
    nav_values_t behind;
    r.v->state(&r.m, &before);
    TEST_ASSERT_EQUAL(ANSWER_BACKWARDS, r.v->imu(&r.m, r.t_us, no_rate, weight));
    TEST_ASSERT_EQUAL(ANSWER_BACKWARDS, r.v->imu(&r.m, r.t_us - 10000U, no_rate, weight));
    r.v->state(&r.m, &behind);
    TEST_ASSERT_EQUAL_MEMORY(&before, &behind, sizeof before);
    TEST_ASSERT_EQUAL(2, r.v->count(&r.m, ANSWER_BACKWARDS));
    rest(&r, 20);
    is_at_rest(&r);
}

/* A sender that began anew: nine records are refused, the tenth is believed, and it goes on. */
static void clock_that_began_anew_is_believed(void)
{
    running_t r;
    begin(&r, &n12f, 1000000000U);
    rest(&r, 10);
    r.t_us = 0;
    for (int i = 1; i <= 10; i++) {
        TEST_ASSERT_EQUAL((i < 10) ? ANSWER_BACKWARDS : ANSWER_GAP, record(&r));
    }
    rest(&r, 20);
    is_at_rest(&r);
}

/* Missing records, 2 to 10 periods: bridged. Longer: a gap, that owes its uncertainty. */
static void missing_records_are_bridged_and_gaps_are_survived(void)
{
    for (int v = 0; v < NAV_ALL; v++) {
        running_t r;
        begin(&r, nav_all[v], 4294000000U); /* the clock wraps within a second */
        rest(&r, 20);
        for (uint32_t missing = 1; missing < 10; missing++) {
            r.t_us += 10000U * missing;
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, record(&r));
        }
        is_at_rest(&r);
        for (uint32_t gap_us = 100000; gap_us < 2000000000U; gap_us *= 11U) {
            double before[12];
            double behind[12];
            r.v->variances(&r.m, before);
            r.t_us += gap_us;
            TEST_ASSERT_EQUAL(ANSWER_GAP, record(&r));
            for (int i = 0; i < 7; i++) {
                TEST_ASSERT_EQUAL(ANSWER_TAKEN, record(&r));
            }
            r.v->variances(&r.m, behind);
            double gap = fmin(1e-6 * gap_us, 10.0);
            TEST_ASSERT_TRUE(behind[0] > before[0] + 0.99 * 6.25 * gap * gap * gap * gap);
            TEST_ASSERT_TRUE(behind[4] > before[4] + 0.99 * 25.0 * gap * gap);
            TEST_ASSERT_TRUE(behind[8] > before[8] + 0.99 * fmin(0.25, 0.25 * gap * gap));
            rest(&r, 20);
            is_at_rest(&r);
        }
    }
}

/* One record with NaN is one that is missing. */
static void flight_with_bad_records_ends_where_the_good_one_does(void)
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

static void configurations_that_are_not_legal_are_refused(void)
{
    nav_setting_t good;
    nav_memory_t m;
    rest_setting(&good);
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(values_out_of_range_or_not_finite_are_refused);
    RUN_TEST(limits_themselves_are_legal);
    RUN_TEST(time_that_goes_back_is_refused);
    RUN_TEST(clock_that_began_anew_is_believed);
    RUN_TEST(missing_records_are_bridged_and_gaps_are_survived);
    RUN_TEST(flight_with_bad_records_ends_where_the_good_one_does);
    RUN_TEST(configurations_that_are_not_legal_are_refused);
    return UNITY_END();
}
