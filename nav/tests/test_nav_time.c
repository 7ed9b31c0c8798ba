/* Times of IMU records: what leaps, what goes back, what is missing. */
#include "nav_running.h"
#include "support/test.h"

#include <math.h>

TEST(time_that_goes_back_is_refused)
{
    running_t r;
    still_begin(&r, &n12f, 0);
    still_seconds(&r, 3);
    nav_values_t before;
    nav_values_t behind;
    r.v->state(&r.m, &before);
    TEST_ASSERT_EQUAL(ANSWER_BACKWARDS, r.v->imu(&r.m, r.t_us, still_rate, still_force));
    TEST_ASSERT_EQUAL(ANSWER_BACKWARDS, r.v->imu(&r.m, r.t_us - 10000U, still_rate, still_force));
    r.v->state(&r.m, &behind);
    TEST_ASSERT_EQUAL_MEMORY(&before, &behind, sizeof before);
    TEST_ASSERT_EQUAL(2, r.v->count(&r.m, ANSWER_BACKWARDS));
    still_seconds(&r, 20);
    still_is_seen(&r);
}

/* A sender that began anew: nine records are refused, the tenth is believed, and it goes on. */
TEST(clock_that_began_anew_is_believed)
{
    running_t r;
    still_begin(&r, &n12f, 1000000000U);
    still_seconds(&r, 10);
    r.t_us = 0;
    for (int i = 1; i <= 10; i++) {
        TEST_ASSERT_EQUAL((i < 10) ? ANSWER_BACKWARDS : ANSWER_GAP, still_record(&r));
    }
    still_seconds(&r, 20);
    still_is_seen(&r);
}

/* A stamp that is refused without a trace but for its count; then the next in time is taken as if nothing had been. */
static void stamp_leaves_no_trace(running_t *r, uint32_t t_us, int want)
{
    static const double spun[3] = { 1.0, 1.0, 1.0 };
    nav_values_t before;
    nav_values_t behind;
    double p[144];
    double q[144];
    size_t size = (size_t)(r->v->states * r->v->states) * sizeof *p;
    unsigned count = r->v->count(&r->m, want);
    r->v->state(&r->m, &before);
    r->v->covariance(&r->m, p);
    TEST_ASSERT_EQUAL(want, r->v->imu(&r->m, t_us, spun, still_force));
    r->v->state(&r->m, &behind);
    r->v->covariance(&r->m, q);
    TEST_ASSERT_EQUAL_MEMORY(&before, &behind, sizeof before);
    TEST_ASSERT_EQUAL_MEMORY(p, q, size);
    TEST_ASSERT_EQUAL(count + 1U, r->v->count(&r->m, want));
}

/* One wrong stamp, or every second one, or three in a row that do not go on from one another. */
TEST(wrong_stamps_are_refused)
{
    static const uint32_t ahead_us[] = { 110000, 1000000, 1000000000, 2000000000 };
    for (int v = 0; v < NAV_ALL; v++) {
        running_t r;
        still_begin(&r, nav_all[v], 4294000000U);
        still_seconds(&r, 20);
        for (int again = 0; again < 12; again++) {
            for (int i = 0; i < 4; i++) {
                stamp_leaves_no_trace(&r, r.t_us + ahead_us[i], ANSWER_OUT_OF_RANGE);
                TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
                stamp_leaves_no_trace(&r, r.t_us - ahead_us[i], ANSWER_BACKWARDS);
                TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
            }
        }
        for (int i = 0; i < 4; i++) {
            stamp_leaves_no_trace(&r, r.t_us + ahead_us[i], ANSWER_OUT_OF_RANGE);
            stamp_leaves_no_trace(&r, r.t_us + ahead_us[3 - i] + 1000000U, ANSWER_OUT_OF_RANGE);
        }
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
        TEST_ASSERT_EQUAL(0, r.v->count(&r.m, ANSWER_GAP));
        still_seconds(&r, 20);
        still_is_seen(&r);
    }
}

/* A clock stuck ahead confirms nothing; records too far apart to be bridged are believed now and then. */
TEST(strays_are_believed_in_the_end)
{
    running_t r;
    still_begin(&r, &n12f, 0);
    still_seconds(&r, 20);
    for (int i = 0; i < 9; i++) {
        stamp_leaves_no_trace(&r, r.t_us + 1000000U, ANSWER_OUT_OF_RANGE);
    }
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
    for (int i = 1; i <= 30; i++) {
        r.t_us += 300000U;
        TEST_ASSERT_EQUAL((i % 10 != 0) ? ANSWER_OUT_OF_RANGE : ANSWER_GAP, still_record(&r));
    }
    still_seconds(&r, 20);
    still_is_seen(&r);
}

/* The first record's stamp may be the wrong one: those behind it are believed, and hardly anything is owed. */
TEST(wrong_first_stamp_is_forgotten)
{
    static const uint32_t wrong_us[] = { 1000000000, 0xC0000000U };
    for (int early = 0; early < 2; early++) {
        double before[12];
        double behind[12];
        running_t r;
        still_begin(&r, &n12f, 0);
        TEST_ASSERT_EQUAL(ANSWER_TAKEN, r.v->imu(&r.m, wrong_us[early], still_rate, still_force));
        r.v->variances(&r.m, before);
        for (int i = 1; i < ((early != 0) ? 2 : 10); i++) {
            TEST_ASSERT_EQUAL((early != 0) ? ANSWER_OUT_OF_RANGE : ANSWER_BACKWARDS, still_record(&r));
        }
        TEST_ASSERT_EQUAL(ANSWER_GAP, still_record(&r));
        for (int i = 0; i < 7; i++) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
        }
        r.v->variances(&r.m, behind);
        TEST_ASSERT_DOUBLE_WITHIN(0.0025 + 1e-4, before[8], behind[8]); /* 0.25 of a gap of a second */
        r.t_us += 2000000U;
        TEST_ASSERT_EQUAL(ANSWER_OUT_OF_RANGE, still_record(&r));
        TEST_ASSERT_EQUAL(ANSWER_GAP, still_record(&r));
        for (int i = 0; i < 7; i++) {
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
        }
        r.v->variances(&r.m, behind);
        TEST_ASSERT_TRUE(behind[8] > before[8] + 0.24); /* the next is a gap as any */
        still_seconds(&r, 20);
        still_is_seen(&r);
    }
}

/* What turned before a gap has no part in a step that is bridged behind it. */
TEST(bridge_behind_a_gap_forgets_the_rate_before_it)
{
    static const double spin[3] = { 0, 0, 10.0 };
    nav_values_t before;
    nav_values_t behind;
    running_t r;
    still_begin(&r, &n12f, 0);
    still_seconds(&r, 3);
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, r.v->imu(&r.m, r.t_us + 10000U, spin, still_force));
    r.t_us += 1000000U;
    TEST_ASSERT_EQUAL(ANSWER_OUT_OF_RANGE, still_record(&r));
    TEST_ASSERT_EQUAL(ANSWER_GAP, still_record(&r));
    r.v->state(&r.m, &before);
    r.t_us += 80000U;
    TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
    r.v->state(&r.m, &behind);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3, before.quaternion[3], behind.quaternion[3]); /* 0.2 with the mean of both */
}

/* Missing records, 2 to 10 periods: bridged. Longer: a gap, once confirmed, that owes its uncertainty. */
TEST(missing_records_are_bridged_and_gaps_are_survived)
{
    for (int v = 0; v < NAV_ALL; v++) {
        running_t r;
        still_begin(&r, nav_all[v], 4294000000U); /* the clock wraps within a second */
        still_seconds(&r, 20);
        for (uint32_t missing = 1; missing < 10; missing++) {
            r.t_us += 10000U * missing;
            TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
        }
        still_is_seen(&r);
        for (uint32_t gap_us = 100000; gap_us < 2000000000U; gap_us *= 11U) {
            double before[12];
            double behind[12];
            r.v->variances(&r.m, before);
            r.t_us += gap_us;
            TEST_ASSERT_EQUAL(ANSWER_OUT_OF_RANGE, still_record(&r));
            TEST_ASSERT_EQUAL(ANSWER_GAP, still_record(&r));
            for (int i = 0; i < 7; i++) {
                TEST_ASSERT_EQUAL(ANSWER_TAKEN, still_record(&r));
            }
            r.v->variances(&r.m, behind);
            double gap = fmin(1e-6 * gap_us, 10.0);
            TEST_ASSERT_TRUE(behind[0] > before[0] + 0.99 * 6.25 * gap * gap * gap * gap);
            TEST_ASSERT_TRUE(behind[4] > before[4] + 0.99 * 25.0 * gap * gap);
            TEST_ASSERT_TRUE(behind[8] > before[8] + 0.99 * fmin(0.25, 0.25 * gap * gap));
            still_seconds(&r, 20);
            still_is_seen(&r);
        }
    }
}
