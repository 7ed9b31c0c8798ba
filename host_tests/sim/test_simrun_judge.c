/*
 * The judge of the rows, given rows and samples made by hand. The rule: a row without flag 1, 2, 16, 32 or 64
 * equals a triplet that the model latched, no older than two sample periods; and time stamps do not step back.
 */
#include <string.h>

#include "simrun_judge.h"
#include "support/test.h"

enum { US = 16, PERIOD_US = 10000, SAMPLES = 10 };

static judge_t judge;
static served_t served[SAMPLES];

/* Ten samples, 10 ms apart, the first latched 10 ms after the clock began at cycle 5000: sample i is i, -i, 256 + i. */
void setUp(void)
{
    judge = (judge_t){ .cycles_per_us = US };
    judge_clock_begins(&judge, 5000);
    for (int i = 0; i < SAMPLES; i++) {
        served[i] = (served_t){ .cycle = 5000u + (uint64_t)(i + 1) * PERIOD_US * US,
                                .lsb = { (int16_t)i, (int16_t)-i, (int16_t)(256 + i) } };
    }
}

/* The readings of sample i in a row stamped t_us by a clock that begins at 0, sent `late_us` after that. */
static row_t row_of(int i, uint32_t t_us, unsigned flags, uint32_t late_us)
{
    row_t row = { .t_us = t_us, .flags = flags, .sent = 5000u + (uint64_t)(t_us + late_us) * US };
    memcpy(row.lsb, served[i].lsb, sizeof row.lsb);
    return row;
}

/* As the row ahead of it left the samples. */
static judge_verdict_t next_verdict_of(row_t row)
{
    return judge_row(&judge, &row, served, SAMPLES, PERIOD_US);
}

static void forget_what_was_shown(void)
{
    for (int i = 0; i < SAMPLES; i++) {
        served[i].shown = false;
    }
}

/* As if no row had shown anything. */
static judge_verdict_t verdict_of(row_t row)
{
    forget_what_was_shown();
    return next_verdict_of(row);
}

TEST(a_row_of_its_sample_is_right)
{
    for (int i = 0; i < SAMPLES; i++) {
        TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row_of(i, (uint32_t)(i + 1) * PERIOD_US + 6u, 0, 5000)));
    }
    TEST_ASSERT_EQUAL_UINT32(SAMPLES, judge_judged(&judge));
    TEST_ASSERT_FALSE(judge.any_fault);
}

TEST(one_reading_that_was_never_latched_is_wrong)
{
    for (int axis = 0; axis < 3; axis++) {
        row_t row = row_of(4, 50000, 0, 5000);
        row.lsb[axis]++;
        TEST_ASSERT_EQUAL(JUDGE_WRONG, verdict_of(row));
    }
    TEST_ASSERT_EQUAL_UINT32(3, judge.count[JUDGE_WRONG]);
    TEST_ASSERT_EQUAL_UINT32(3, judge_judged(&judge));
}

TEST(readings_of_different_samples_are_wrong)
{
    row_t row = row_of(4, 50000, 0, 5000);
    row.lsb[2] = served[3].lsb[2];
    TEST_ASSERT_EQUAL(JUDGE_WRONG, verdict_of(row));
}

TEST(a_sample_is_stale_after_two_periods)
{
    /* sample 2 was latched at 30 ms */
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row_of(2, 50000, 0, 5000)));
    TEST_ASSERT_EQUAL(JUDGE_STALE, verdict_of(row_of(2, 50001, 0, 5000)));
    TEST_ASSERT_EQUAL_UINT32(1, judge.count[JUDGE_STALE]);
    forget_what_was_shown();
    row_t row = row_of(2, 32501, 0, 0);
    TEST_ASSERT_EQUAL(JUDGE_STALE, judge_row(&judge, &row, served, SAMPLES, 1250));
    row = row_of(2, 32500, 0, 0);
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, judge_row(&judge, &row, served, SAMPLES, 1250));
}

TEST(an_equal_sample_within_time_is_enough_and_an_older_one_is_not)
{
    memcpy(served[5].lsb, served[1].lsb, sizeof served[5].lsb);
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row_of(1, 60000, 0, 2000)));
    TEST_ASSERT_EQUAL(JUDGE_STALE, verdict_of(row_of(1, 50000, 0, 2000)));
    /* sample 5, too new for this stamp, does not hide that sample 1 was in time */
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row_of(1, 20000, 0, 60000)));
}

TEST(a_sample_of_the_future_is_wrong)
{
    /* sample 6 comes at 70 ms: this row is sent before; the next is sent after, with a stamp that lies */
    TEST_ASSERT_EQUAL(JUDGE_WRONG, verdict_of(row_of(6, 69000, 0, 999)));
    TEST_ASSERT_EQUAL(JUDGE_WRONG, verdict_of(row_of(6, 39999, 0, 40000)));
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row_of(6, 40000, 0, 40000)));
}

TEST(only_five_flags_disown_a_row)
{
    for (unsigned bit = 0; bit < 11; bit++) {
        unsigned flag = 1u << bit;
        bool disowns = flag == 1 || flag == 2 || flag == 16 || flag == 32 || flag == 64;
        row_t row = row_of(4, 50000, flag, 5000);
        row.lsb[0] = 1234;
        TEST_ASSERT_EQUAL_MESSAGE(disowns ? JUDGE_DISOWNED_ROW : JUDGE_WRONG, verdict_of(row), "flag");
    }
    TEST_ASSERT_EQUAL_UINT32(6, judge_judged(&judge));
}

TEST(a_sample_delivered_twice_is_at_fault)
{
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, next_verdict_of(row_of(4, 50000, 0, 5000)));
    TEST_ASSERT_EQUAL(JUDGE_TWICE, next_verdict_of(row_of(4, 50000, 0, 5000)));
    TEST_ASSERT_EQUAL(JUDGE_TWICE, next_verdict_of(row_of(4, 60000, 0, 5000)));
    TEST_ASSERT_EQUAL(JUDGE_DISOWNED_ROW, next_verdict_of(row_of(4, 60000, 2, 5000)));
    TEST_ASSERT_EQUAL(JUDGE_STALE, next_verdict_of(row_of(4, 70001, 0, 5000)));
    TEST_ASSERT_EQUAL_UINT32(2, judge.count[JUDGE_TWICE]);
    TEST_ASSERT_EQUAL_UINT32(4, judge_judged(&judge));
    TEST_ASSERT_NOT_NULL(strstr(judge_summary(&judge), "1 stale, 2 twice; "));
    TEST_ASSERT_NOT_NULL(strstr(judge_summary(&judge), "another row has shown this sample already"));
}

TEST(a_row_that_disowns_its_readings_shows_no_sample)
{
    TEST_ASSERT_EQUAL(JUDGE_DISOWNED_ROW, next_verdict_of(row_of(4, 50000, 1, 5000)));
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, next_verdict_of(row_of(4, 50000, 0, 5000)));
}

TEST(as_many_rows_as_equal_samples_are_right)
{
    for (int i = 3; i < 7; i++) {
        memcpy(served[i].lsb, served[3].lsb, sizeof served[i].lsb);
    }
    for (int i = 3; i < 7; i++) {
        TEST_ASSERT_EQUAL(JUDGE_RIGHT, next_verdict_of(row_of(3, (uint32_t)(i + 1) * PERIOD_US, 0, 5000)));
    }
    TEST_ASSERT_EQUAL(JUDGE_TWICE, next_verdict_of(row_of(3, 75000, 0, 5000)));
}

TEST(of_equal_samples_a_row_takes_the_oldest_in_time)
{
    memcpy(served[5].lsb, served[3].lsb, sizeof served[5].lsb);
    /* 55 ms is within two periods of both 40 and 60 ms, 65 ms of the second alone */
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, next_verdict_of(row_of(3, 55000, 0, 9000)));
    TEST_ASSERT_TRUE(served[3].shown);
    TEST_ASSERT_FALSE(served[5].shown);
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, next_verdict_of(row_of(3, 65000, 0, 9000)));
}

TEST(steps_back_are_counted_in_every_row)
{
    (void)verdict_of(row_of(4, 50000, 0, 5000));
    (void)verdict_of(row_of(4, 50000, 0, 5000));
    TEST_ASSERT_EQUAL_UINT32(0, judge.steps_back);
    (void)verdict_of(row_of(4, 49999, 2, 5000));
    TEST_ASSERT_EQUAL_UINT32(1, judge.steps_back);
    (void)verdict_of(row_of(5, 60000, 0, 5000));
    TEST_ASSERT_EQUAL_UINT32(1, judge.steps_back);
    TEST_ASSERT_NOT_NULL(strstr(judge_summary(&judge), "first row 3: t_us 49999, "));
    TEST_ASSERT_NOT_NULL(strstr(judge_summary(&judge), "stamped before the row ahead of it"));
}

TEST(a_clock_that_begins_elsewhere_may_wrap)
{
    judge = (judge_t){ .cycles_per_us = US, .start_us = UINT32_MAX - 24999u };
    judge_clock_begins(&judge, 5000);
    for (int i = 0; i < SAMPLES; i++) {
        row_t row = row_of(i, (uint32_t)(i + 1) * PERIOD_US, 0, 5000);
        row.t_us += judge.start_us;
        TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row));
    }
    TEST_ASSERT_EQUAL_UINT32(0, judge.steps_back);
    TEST_ASSERT_EQUAL_UINT32(75000, judge.last_us);
}

TEST(a_reset_begins_the_clock_anew)
{
    (void)verdict_of(row_of(3, 40000, 0, 5000));
    judge_clock_begins(&judge, 5000 + 45000 * US);
    row_t row = row_of(5, 15000, 0, 0);
    row.sent = 5000 + 62000 * US;
    TEST_ASSERT_EQUAL(JUDGE_RIGHT, verdict_of(row));
    TEST_ASSERT_EQUAL_UINT32(0, judge.steps_back);
    row.t_us = 60000; /* what a clock that had gone on would say: 45 ms after the sample */
    TEST_ASSERT_EQUAL(JUDGE_STALE, verdict_of(row));
}

TEST(without_a_clock_nothing_is_judged)
{
    judge = (judge_t){ .cycles_per_us = US };
    TEST_ASSERT_EQUAL(JUDGE_UNTIMED, verdict_of(row_of(3, 40000, 0, 5000)));
    TEST_ASSERT_EQUAL_UINT32(0, judge_judged(&judge));
    judge_clock_begins(&judge, 5000);
    row_t row = row_of(3, 40000, 0, 5000);
    TEST_ASSERT_EQUAL(JUDGE_WRONG, judge_row(&judge, &row, NULL, 0, PERIOD_US));
}

TEST(the_first_row_at_fault_is_named)
{
    (void)verdict_of(row_of(0, 10000, 0, 5000));
    TEST_ASSERT_EQUAL_STRING("1 rows judged: 0 wrong, 0 stale, 0 twice; 0 steps back in time", judge_summary(&judge));
    (void)verdict_of(row_of(0, 40000, 8, 5000));
    row_t row = row_of(4, 50000, 0, 5000);
    row.lsb[1] = -1;
    (void)verdict_of(row);
    TEST_ASSERT_EQUAL_STRING(
        "3 rows judged: 1 wrong, 1 stale, 0 twice; 0 steps back in time; first row 2: t_us 40000, readings "
        "0,0,256, flags 8, stale: the sensor latched these readings, but more than two sample "
        "periods before the stamp",
        judge_summary(&judge));
}
