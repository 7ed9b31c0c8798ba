#include "nav_running.h"
#include "unity.h"

#include <math.h>
#include <string.h>

const double still_rate[3] = { 0, 0, 0 };
const double still_force[3] = { 0, 0, -FLIGHT_GRAVITY };
const double still_nowhere[3] = { 0, 0, 0 };

void still_setting(nav_setting_t *s)
{
    const double level[4] = { 1, 0, 0, 0 };
    nav_flight_setting(s, 1.0);
    memcpy(s->start.quaternion, level, sizeof level);
    memset(s->start.velocity, 0, sizeof s->start.velocity);
    memset(s->start.position, 0, sizeof s->start.position);
    s->gate = 5.0;
}

void still_begin(running_t *r, const nav_variant_t *v, uint32_t t_us)
{
    memset(&r->m, 0, sizeof r->m);
    r->v = v;
    still_setting(&r->setting);
    TEST_ASSERT_TRUE(v->init(&r->m, &r->setting));
    r->t_us = t_us;
}

int still_record(running_t *r)
{
    r->t_us += 10000U;
    return r->v->imu(&r->m, r->t_us, still_rate, still_force);
}

void still_seconds(running_t *r, int seconds)
{
    for (int k = 0; k < 100 * seconds; k++) {
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(r));
        if (k % 10 == 0) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, r->v->field(&r->m, r->t_us, flight_field));
        }
        if (k % 100 == 0) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, r->v->gps(&r->m, r->t_us, still_nowhere, still_nowhere));
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, r->v->down(&r->m, r->t_us, 0.0));
        }
    }
}

void still_is_seen(const running_t *r)
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
