/* The queue: scalars one per slot against all at once, late epochs, what is taken when. */
#include "nav_flights.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SEED 3100

static nav_flight_t spread, once;

static void fly_both(const nav_variant_t *v)
{
    /* behind slot 58 of a second everything is used, and the next field comes one slot later */
    nav_plan_t plan = { .variant = v,
                        .drift = &flight_gyro_drift,
                        .walk_scale = 1.0,
                        .field_every = 10,
                        .note_at = 58,
                        .seed = SEED,
                        .seconds = 160 };
    nav_fly(&spread, &plan);
    plan.at_once = true;
    nav_fly(&once, &plan);
}

/*
 * The gain K of a scalar is off by twice what the sigmas are, 8e-3, where they are off by 4e-3. An error of
 * K sqrt(R) x 8e-3 at each epoch, forgotten with 1 - K, adds up to 8e-3 sqrt(K R / 2), and P = K R: 6e-3 sigma rms,
 * four times that at most in 150 epochs of 12 states. What is of second order in the age is g mu (0.15 s)^2 / 2 = 1e-4
 * m here.
 */
TEST(spread_scalars_give_what_all_at_once_give)
{
    fly_both(&n12d);
    double sigma_off = 0.0;
    double state_off = 0.0;
    double rms = 0.0;
    for (int t = 10; t < 160; t++) {
        for (int i = 0; i < 12; i++) {
            double sigma = sqrt(once.second[t].variance[i]);
            sigma_off = fmax(sigma_off, fabs(sqrt(spread.second[t].variance[i]) / sigma - 1.0));
            const double *a = (i < 3) ? spread.second[t].position
                                      : ((i < 6) ? spread.second[t].velocity : spread.second[t].drift);
            const double *b = (i < 3) ? once.second[t].position
                                      : ((i < 6) ? once.second[t].velocity : once.second[t].drift);
            if (i < 6 || i >= 9) {
                double off = fabs(a[i % 3] - b[i % 3]) / sigma;
                state_off = fmax(state_off, off);
                rms += off * off / (150.0 * 9.0);
            }
        }
    }
    printf("spread against at once: sigmas %.1e, states %.1e rms, %.1e of their sigmas at most\n", sigma_off, sqrt(rms),
           state_off);
    TEST_ASSERT_EQUAL(0, spread.count[ANSWER_QUEUE_FULL]);
    TEST_ASSERT_TRUE(sigma_off < 4e-3);
    TEST_ASSERT_TRUE(sqrt(rms) < 6e-3);
    TEST_ASSERT_TRUE(state_off < 2.4e-2);
}

/* 6 (GPS) + 1 + 2 wait behind a full second, and are used within 13 slots: 1 to take in, 9, and 3 of noise between. */
TEST(nine_scalars_wait_and_are_used_in_thirteen_slots)
{
    nav_memory_t m;
    nav_setting_t setting;
    test_random_t random;
    flight_sample_t sample;
    random_seed(&random, SEED);
    nav_flight_setting(&setting, 1.0);
    TEST_ASSERT_TRUE(n12f.init(&m, &setting));
    flight_sample(&sample, 0, &flight_no_drift, &random);
    n12f.imu(&m, 10000, sample.rate, sample.force);
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.gps(&m, 10000, sample.gps_velocity, sample.gps_position));
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.down(&m, 10000, sample.down));
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.field(&m, 10000, sample.field));
    TEST_ASSERT_EQUAL(9, n12f.queued(&m));
    for (int k = 1; k <= 13; k++) {
        TEST_ASSERT_TRUE(n12f.queued(&m) > 0);
        flight_sample(&sample, k, &flight_no_drift, &random);
        n12f.imu(&m, 10000U * (uint32_t)(k + 1), sample.rate, sample.force);
    }
    TEST_ASSERT_EQUAL(0, n12f.queued(&m));
}

/* Exact records for 1 s, then an exact GPS epoch `age_us` ago, said to be of `said_us` ago; error of the position. */
static double error_after(const nav_variant_t *v, uint32_t age_us, uint32_t said_us, double slow)
{
    static nav_memory_t m;
    nav_setting_t setting;
    flight_truth_t truth;
    nav_values_t state;
    nav_flight_setting(&setting, 1.0);
    flight_truth(&truth, 0.0);
    memcpy(setting.start.quaternion, truth.quaternion, sizeof truth.quaternion);
    memcpy(setting.start.velocity, truth.velocity, sizeof truth.velocity);
    memcpy(setting.start.position, truth.position, sizeof truth.position);
    setting.sigma[1] = 1e-3; /* all is known but the position, which the first epoch gives */
    setting.sigma[2] = 1e-5;
    setting.sigma[3] = 0.0;
    setting.measured[1] = 0.01;
    if (slow > 0.0) { /* or all but the velocity, which is off by this */
        setting.start.velocity[0] += slow;
        setting.sigma[0] = 1e-3;
        setting.sigma[1] = slow;
        setting.measured[0] = 1e3;
    }
    v->init(&m, &setting);
    for (int k = 0; k < 115; k++) {
        const double gravity[3] = { 0, 0, -FLIGHT_GRAVITY };
        double force[3] = { 0 };
        double c[9];
        if (k == 100) {
            flight_truth(&truth, 1.0 - 1e-6 * age_us);
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, v->gps(&m, 1000000U - said_us, truth.velocity, truth.position));
        }
        flight_truth(&truth, (k + 0.5) * FLIGHT_STEP);
        flight_dcm(c, truth.quaternion);
        for (int i = 0; i < 9; i++) {
            force[i % 3] += c[i] * (truth.acceleration[i / 3] + gravity[i / 3]);
        }
        v->imu(&m, 10000U * (uint32_t)(k + 1), truth.rate, force);
    }
    flight_truth(&truth, 1.15);
    v->state(&m, &state);
    return fabs(state.position[0] - truth.position[0]); /* flies along it */
}

/* 6 m/s x 120 ms = 0.72 m. */
TEST(late_epoch_between_two_records_is_interpolated)
{
    for (int i = 0; i < NAV_ALL; i++) {
        TEST_ASSERT_TRUE(error_after(nav_all[i], 123500, 123500, 0.0) < 0.01);
        TEST_ASSERT_TRUE(error_after(nav_all[i], 0, 0, 0.0) < 0.01);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.741,
                                  error_after(nav_all[i], 123500, 0, 0.0)); /* twin: believed to be of now */
    }
}

/*
 * The epoch 123.5 ms ago tells the velocity by its way in 0.8765 s: the row's age makes it exact. Without it the way
 * would be that of 1 s, the velocity 12 % less, and the position 0.14 m off behind 1.15 s.
 */
TEST(age_of_a_position_is_in_its_row)
{
    for (int i = 0; i < NAV_ALL; i++) {
        TEST_ASSERT_TRUE(error_after(nav_all[i], 123500, 123500, 1.0) < 0.02);
    }
}

typedef struct {
    nav_memory_t m;
    nav_setting_t setting;
    uint32_t t_us;
} running_t;

static const double no_rate[3] = { 0, 0, 0 };
static const double weight[3] = { 0, 0, -FLIGHT_GRAVITY };
static const double nowhere[3] = { 0, 0, 0 };

/* At rest, level, heading north, at the origin. */
static void begin(running_t *r, const nav_variant_t *v, double gate)
{
    nav_flight_setting(&r->setting, 1.0);
    const double level[4] = { 1, 0, 0, 0 };
    memcpy(r->setting.start.quaternion, level, sizeof level);
    memset(r->setting.start.velocity, 0, sizeof r->setting.start.velocity);
    memset(r->setting.start.position, 0, sizeof r->setting.start.position);
    r->setting.gate = gate;
    TEST_ASSERT_TRUE(v->init(&r->m, &r->setting));
    r->t_us = 0;
}

static void rest(running_t *r, const nav_variant_t *v, int records)
{
    for (int i = 0; i < records; i++) {
        r->t_us += 10000U;
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, v->imu(&r->m, r->t_us, no_rate, weight));
    }
}

TEST(epochs_are_taken_from_150_ms_ago_to_100_ms_ahead)
{
    running_t r;
    begin(&r, &n12f, 5.0);
    TEST_ASSERT_EQUAL(ANSWER_GAP, n12f.gps(&r.m, 0, nowhere, nowhere)); /* no record yet */
    rest(&r, &n12f, 5);
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.gps(&r.m, 0, nowhere, nowhere)); /* the start */
    TEST_ASSERT_EQUAL(ANSWER_LATE, n12f.down(&r.m, 0U - 1U, 0.0));
    rest(&r, &n12f, 95);
    TEST_ASSERT_EQUAL(ANSWER_LATE, n12f.gps(&r.m, r.t_us - 150001U, nowhere, nowhere));
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.gps(&r.m, r.t_us - 150000U, nowhere, nowhere));
    TEST_ASSERT_EQUAL(ANSWER_LATE, n12f.field(&r.m, r.t_us - 50001U, flight_field));
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.field(&r.m, r.t_us - 50000U, flight_field));
    TEST_ASSERT_EQUAL(ANSWER_GAP, n12f.down(&r.m, r.t_us + 100001U, 0.0));
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.down(&r.m, r.t_us + 5000U, 0.0)); /* waits for the next record */
    TEST_ASSERT_EQUAL(ANSWER_QUEUE_FULL, n12f.gps(&r.m, r.t_us, nowhere, nowhere));
    rest(&r, &n12f, 13);
    TEST_ASSERT_EQUAL(0, n12f.queued(&r.m));
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, n12f.gps(&r.m, r.t_us, nowhere, nowhere));
    rest(&r, &n12f, 13);
    TEST_ASSERT_EQUAL(ANSWER_BACKWARDS, n12f.gps(&r.m, r.t_us - 130000U, nowhere, nowhere)); /* the same once more */
}

/*
 * An epoch of the very time of the record that it waited for, which is also the newest that is remembered (20 ms
 * apart): 10 m east, and a position of 57.3 m against a GPS of 5 m goes there but for 5^2 / 57.3^2 = 0.8 %.
 */
TEST(epoch_ahead_is_used_at_its_own_time)
{
    static const double aside[3] = { 0, 10.0, 0 };
    for (int i = 0; i < NAV_ALL; i++) {
        running_t r;
        nav_values_t state;
        begin(&r, nav_all[i], 0.0);
        r.setting.period_us = 20000;
        TEST_ASSERT_TRUE(nav_all[i]->init(&r.m, &r.setting));
        for (uint32_t t_us = 20000; t_us <= 500000U; t_us += 20000U) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, nav_all[i]->imu(&r.m, t_us, no_rate, weight));
            if (t_us == 100000U) {
                TEST_ASSERT_EQUAL(ANSWER_TAKEN, nav_all[i]->gps(&r.m, 120000, nowhere, aside));
            }
        }
        nav_all[i]->state(&r.m, &state);
        TEST_ASSERT_DOUBLE_WITHIN(0.05, 10.0 * (1.0 - 25.0 / (57.3 * 57.3 + 25.0)), state.position[1]);
    }
}

/* An altimeter that was silent for more than half the clock's round, 36 minutes, is heard again at once. */
TEST(sensor_silent_for_half_the_clock_is_taken)
{
    for (uint32_t minutes = 30; minutes <= 70; minutes += 5) {
        running_t r;
        begin(&r, &n9f, 0.0);
        r.setting.period_us = 100000;
        TEST_ASSERT_TRUE(n9f.init(&r.m, &r.setting));
        for (uint32_t k = 1; k <= 600U * minutes; k++) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, n9f.imu(&r.m, 100000U * k, no_rate, weight));
            if (k == 1U) {
                TEST_ASSERT_EQUAL(ANSWER_TAKEN, n9f.down(&r.m, 100000U, 0.0));
            }
        }
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, n9f.down(&r.m, 60000000U * minutes, 0.0));
    }
}

/* 150 ms ago the past must still be there when it is taken in one slot later, whatever the period. */
TEST(past_reaches_back_at_every_period)
{
    for (uint32_t period = 1000; period <= 100000; period += 1111) {
        running_t r;
        begin(&r, &n9f, 0.0);
        r.setting.period_us = period;
        TEST_ASSERT_TRUE(n9f.init(&r.m, &r.setting));
        for (uint32_t t = period; t < 1000000U + 200U * period; t += period) {
            r.t_us = t;
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, n9f.imu(&r.m, t, no_rate, weight));
            if (t > 400000U) {
                int answer = n9f.gps(&r.m, t - 150000U, nowhere, nowhere);
                TEST_ASSERT_TRUE(answer == ANSWER_TAKEN || answer == ANSWER_QUEUE_FULL);
            }
        }
    }
}

static double east(const running_t *r, const nav_variant_t *v)
{
    nav_values_t state;
    v->state(&r->m, &state);
    return state.position[1];
}

static void settle(running_t *r, const nav_variant_t *v, const double position[3], int epochs)
{
    for (int i = 0; i < epochs; i++) {
        rest(r, v, 20);
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, v->gps(&r->m, r->t_us, nowhere, position));
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, v->field(&r->m, r->t_us, flight_field));
        rest(r, v, 20);
    }
}

/* 1 km east in one epoch: refused, counted, the state unmoved. Five in a row: believed. */
TEST(gps_jump_is_gated_and_a_new_place_is_found)
{
    static const double far[3] = { 0, 1000.0, 0 };
    for (int i = 0; i < NAV_ALL; i++) {
        const nav_variant_t *v = nav_all[i];
        running_t r;
        begin(&r, v, 5.0);
        settle(&r, v, nowhere, 20);
        TEST_ASSERT_EQUAL(0, v->count(&r.m, ANSWER_GATED));
        double before = east(&r, v);
        settle(&r, v, far, 1);
        TEST_ASSERT_EQUAL(1, v->count(&r.m, ANSWER_GATED));
        TEST_ASSERT_DOUBLE_WITHIN(1.0, before, east(&r, v));
        settle(&r, v, nowhere, 1);
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 0.0, east(&r, v));
        settle(&r, v, far, 4);
        TEST_ASSERT_EQUAL(5, v->count(&r.m, ANSWER_GATED));
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 0.0, east(&r, v));
        settle(&r, v, far, 1); /* the fifth: half of the variance is the innovation's square, so the gain is nearly 1 */
        TEST_ASSERT_EQUAL(6, v->count(&r.m, ANSWER_GATED));
        TEST_ASSERT_DOUBLE_WITHIN(1.0, 1000.0, east(&r, v));
        TEST_ASSERT_TRUE(v->healthy(&r.m));
    }
}

/*
 * Heading 0.3 rad off, known to 0.02: the field, good to 0.01, is refused (0.39 x sin 0.3 = 0.116 against 5 x 0.0128),
 * five times, then believed. Without that the heading would stay.
 */
TEST(field_that_the_gate_refuses_is_believed_in_the_end)
{
    running_t r;
    nav_values_t state;
    double variance[12];
    begin(&r, &n12d, 5.0);
    const double turned[4] = { cos(0.15), 0, 0, sin(0.15) };
    memcpy(r.setting.start.quaternion, turned, sizeof turned);
    r.setting.measured[3] = 0.01;
    TEST_ASSERT_TRUE(n12d.init(&r.m, &r.setting));
    settle(&r, &n12d, nowhere, 4);
    n12d.state(&r.m, &state);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.3, 2.0 * asin(state.quaternion[3]));
    settle(&r, &n12d, nowhere, 20);
    n12d.state(&r.m, &state);
    n12d.variances(&r.m, variance);
    TEST_ASSERT_EQUAL(5, n12d.count(&r.m, ANSWER_GATED));
    TEST_ASSERT_DOUBLE_WITHIN(3.0 * sqrt(variance[8]), 0.0, 2.0 * asin(state.quaternion[3]));
    TEST_ASSERT_TRUE(n12d.healthy(&r.m));
}
