/* nav/lib under records of any kind, order and time. */
#include "nav_flights.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SEED 3300

static void begin(nav_memory_t *m, const nav_variant_t *v)
{
    nav_setting_t setting;
    nav_flight_setting(&setting, 1.0);
    setting.gate = 5.0;
    TEST_ASSERT_TRUE(v->init(m, &setting));
}

static double wild(test_random_t *random)
{
    switch (random_below(random, 12)) {
    case 0:
        return NAN;
    case 1:
        return INFINITY;
    case 2:
        return 0.0;
    case 3:
        return 1e30 * random_normal(random);
    case 4:
        return 1e5 * random_normal(random);
    default:
        return pow(10.0, 8.0 * random_uniform(random) - 6.0) * random_normal(random);
    }
}

static void wild3(double out[3], test_random_t *random)
{
    bool mostly = random_below(random, 3) != 0U;
    for (int i = 0; i < 3; i++) {
        out[i] = mostly ? 10.0 * random_normal(random) : wild(random);
    }
}

static uint32_t wild_time(uint32_t now, test_random_t *random)
{
    uint32_t kind = random_below(random, 40);
    if (kind == 0U) {
        return random_u32(random);
    }
    return now + ((kind < 4U) ? random_below(random, 400000) - 200000U : random_below(random, 20000) - 5000U);
}

/* A record of any kind; the IMU's mostly in time. */
static void any_record(const nav_variant_t *v, nav_memory_t *m, uint32_t *now, test_random_t *random)
{
    double a[3];
    double b[3];
    wild3(a, random);
    wild3(b, random);
    uint32_t t_us = wild_time(*now, random);
    uint32_t which = random_below(random, 8);
    if (which < 5U) {
        t_us = (which < 4U) ? *now + 10000U : t_us;
        int answer = v->imu(m, t_us, a, b);
        *now = (answer == ANSWER_TAKEN || answer == ANSWER_GAP) ? t_us : *now;
    } else if (which == 5U) {
        v->gps(m, t_us, a, b);
    } else if (which == 6U) {
        v->down(m, t_us, a[0]);
    } else {
        v->field(m, t_us, a);
    }
}

/* Anything in any order: D stays positive or 0 and finite, the attitude a rotation, and every record has an answer. */
TEST(hundred_thousand_wild_records_leave_it_healthy)
{
    for (int i = 0; i < NAV_ALL; i++) {
        const nav_variant_t *v = nav_all[i];
        nav_memory_t m;
        test_random_t random;
        uint32_t now = 0;
        random_seed(&random, SEED + (uint32_t)i);
        begin(&m, v);
        for (int k = 0; k < 100000; k++) {
            any_record(v, &m, &now, &random);
            if (!v->healthy(&m) || !(v->least_d(&m) >= 0.0)) {
                printf("%s, seed %d, record %d: least D %g\n", v->name, SEED + i, k, v->least_d(&m));
                TEST_FAIL_MESSAGE("not healthy");
            }
        }
        for (int answer = ANSWER_TAKEN; answer < ANSWERS; answer++) {
            TEST_ASSERT_TRUE(v->count(&m, answer) > 0U || answer == ANSWER_NO_LENGTH);
        }
    }
}

/* Twin: the judge of the fuzz sees a covariance that is none. */
TEST(unhealthy_is_seen)
{
    static const double broken[4] = { -1e-9, NAN, INFINITY, -1.0 };
    for (int i = 0; i < 4; i++) {
        nav_memory_t m;
        begin(&m, &n12f);
        TEST_ASSERT_TRUE(n12f.healthy(&m));
        n12f.break_covariance(&m, 5, broken[i]);
        TEST_ASSERT_FALSE(n12f.healthy(&m));
    }
}

/* And a state that is none: of an attitude whose square is 1 % off, of a value that is no number. */
TEST(unhealthy_state_is_seen)
{
    for (int i = 0; i < NAV_ALL; i++) {
        const nav_variant_t *v = nav_all[i];
        nav_memory_t m;
        nav_values_t s;
        double *const values[3] = { s.velocity, s.position, s.drift };
        begin(&m, v);
        v->state(&m, &s);
        for (int k = 0; k < 9; k++) {
            double *at = &values[k / 3][k % 3];
            double was = *at;
            *at = (k % 2 == 0) ? NAN : INFINITY;
            v->set_state(&m, &s);
            TEST_ASSERT_FALSE(v->healthy(&m));
            *at = was;
        }
        for (int k = 0; k < 4; k++) {
            static const double first[4] = { 0.9949, 0.9951, 1.0049, 1.0051 }; /* squares: .9898 .9902 1.0098 1.0102 */
            const double turned[4] = { first[k], 0, 0, 0 };
            memcpy(s.quaternion, turned, sizeof turned);
            v->set_state(&m, &s);
            TEST_ASSERT_EQUAL(k == 1 || k == 2, v->healthy(&m));
        }
    }
}

/* A count that is full stays full, so that it never looks small again. */
TEST(counts_stay_at_their_end)
{
    nav_memory_t m;
    begin(&m, &n9f);
    for (long k = 0; k < 65535L + 10L; k++) {
        TEST_ASSERT_EQUAL(ANSWER_NOT_FINITE, n9f.down(&m, 0, NAN));
        TEST_ASSERT_EQUAL((k < 65535L) ? k + 1L : 65535L, n9f.count(&m, ANSWER_NOT_FINITE));
    }
}

/*
 * An attitude that is known exactly (sigma 0, no walk) stays as it is, whatever the field says: nothing is added to a
 * variance of 0, however often the gate refuses. The field is turned by 90 degrees about east. The count of what the
 * gate refused stays at its end too.
 */
TEST(attitude_known_exactly_is_believed_against_any_field)
{
    static const double rate[3] = { 0, 0, 0 };
    static const double force[3] = { 0, 0, -FLIGHT_GRAVITY };
    const double field[3] = { -flight_field[2], flight_field[1], flight_field[0] };
    nav_memory_t m;
    nav_setting_t setting;
    nav_values_t state;
    double p[81];
    const double level[4] = { 1, 0, 0, 0 };
    nav_flight_setting(&setting, 1.0);
    memcpy(setting.start.quaternion, level, sizeof level);
    setting.gate = 5.0;
    setting.sigma[2] = 0.0;
    setting.walk[2] = 0.0;
    TEST_ASSERT_TRUE(n9f.init(&m, &setting));
    uint32_t left = 100; /* slots behind the one that fills the count */
    for (uint32_t slot = 1; slot < 400000U && left != 0U; slot++) {
        n9f.imu(&m, 10000U * slot, rate, force);
        n9f.field(&m, 10000U * slot, field);
        left -= (n9f.count(&m, ANSWER_GATED) == 65535U) ? 1U : 0U;
    }
    TEST_ASSERT_EQUAL(0, left);
    n9f.state(&m, &state);
    n9f.covariance(&m, p);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(state.quaternion[1 + i] == 0.0);
        TEST_ASSERT_TRUE(p[(6 + i) * 9 + 6 + i] == 0.0);
    }
    TEST_ASSERT_TRUE(n9f.healthy(&m));
}
