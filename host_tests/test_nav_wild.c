/* lib/nav under records of any kind, order and time. */
#include "nav_flights.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>

#define SEED 3300

void setUp(void) {}

void tearDown(void) {}

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
static void hundred_thousand_wild_records_leave_it_healthy(void)
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
static void unhealthy_is_seen(void)
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(hundred_thousand_wild_records_leave_it_healthy);
    RUN_TEST(unhealthy_is_seen);
    return UNITY_END();
}
