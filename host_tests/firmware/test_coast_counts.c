/* What the clock of missing samples counts, and which samples it keeps out, from the start and through long outages. */
#include "base/counters.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/path.h"
#include "support/test.h"

enum { PERIOD_US = 10000, LOOK_US = 4000, START_US = 1000000 };

void setUp(void)
{
    path_start(0, 1000, 16, START_US);
}

static bool row_by(uint32_t t_us)
{
    bool row = coast_due(t_us) && coast_over(PERIOD_US, false);
    pipeline_finish();
    return row;
}

static bool sample_at(uint32_t t_us)
{
    adxl345_sample_t sample = { .t_us = t_us, .lsb = { 0, 0, 256 } };
    bool taken = coast_sample(t_us, PERIOD_US);
    if (taken) {
        pipeline_sample(&sample);
        pipeline_finish();
    }
    return taken;
}

/* The first sample may have waited in the sensor while rows went out that no sample came for. */
TEST(test_a_first_sample_older_than_the_newest_row_is_dropped)
{
    TEST_ASSERT_TRUE(row_by(START_US + 100001u));
    uint32_t newest_us = pipeline_newest_us();
    TEST_ASSERT_FALSE(sample_at(newest_us));
    TEST_ASSERT_EQUAL_UINT32(1, counted(COUNT_LATE));
    TEST_ASSERT_TRUE(sample_at(newest_us + 1u));
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_LOST));
}

/* A sample that comes after its row is late, not lost: what is missing after it is counted from it, jitter or not. */
TEST(test_after_a_late_sample_only_the_missing_ones_are_lost)
{
    for (uint32_t missing = 0; missing <= 4; missing++) {
        for (int32_t early_us = -4000; early_us <= 4000; early_us += 2000) {
            setUp();
            TEST_ASSERT_TRUE(sample_at(START_US));
            TEST_ASSERT_TRUE(row_by(START_US + PERIOD_US + PERIOD_US / 2));
            TEST_ASSERT_FALSE(sample_at(START_US + PERIOD_US));
            TEST_ASSERT_EQUAL_UINT32(1, counted(COUNT_LATE));
            uint32_t next_us = START_US + (missing + 2u) * PERIOD_US - (uint32_t)early_us;
            while (row_by(next_us)) {
            }
            TEST_ASSERT_TRUE(sample_at(next_us));
            TEST_ASSERT_EQUAL_UINT32(missing, counted(COUNT_LOST));
        }
    }
}

/* What is missing before a sample that comes after its row is lost, whether the outage was short or long. */
TEST(test_what_is_missing_before_a_late_sample_is_lost)
{
    for (uint32_t missing = 0; missing <= 5; missing++) {
        setUp();
        TEST_ASSERT_TRUE(sample_at(START_US));
        uint32_t late_us = START_US + (missing + 1u) * PERIOD_US;
        while (row_by(late_us + PERIOD_US / 2)) {
        }
        TEST_ASSERT_FALSE(sample_at(late_us));
        TEST_ASSERT_EQUAL_UINT32(1, counted(COUNT_LATE));
        TEST_ASSERT_EQUAL_UINT32(missing, counted(COUNT_LOST));
        TEST_ASSERT_TRUE(sample_at(late_us + PERIOD_US));
        TEST_ASSERT_EQUAL_UINT32(missing, counted(COUNT_LOST));
    }
}

/*
 * More than half of what the clock of the samples counts, which wraps meanwhile; the last ones more than it counts.
 * Less than one sample for each 18 minutes is rounded off.
 */
TEST(test_samples_lost_in_a_long_outage_are_counted)
{
    static const uint32_t missing[] = { 3, 100, 214000, 216000, 420000, 429497, 640000, 1300000 };
    uint32_t t_us = START_US;
    uint32_t sum = 0;
    uint32_t rounded_off = 0;
    TEST_ASSERT_TRUE(sample_at(t_us));
    for (unsigned i = 0; i < sizeof missing / sizeof missing[0]; i++) {
        uint64_t gap_us = (missing[i] + UINT64_C(1)) * PERIOD_US;
        for (uint64_t past_us = 0; past_us < gap_us; past_us += LOOK_US) {
            while (row_by(t_us + (uint32_t)past_us)) {
            }
        }
        t_us += (uint32_t)gap_us;
        sum += missing[i];
        rounded_off += (uint32_t)(gap_us >> 30);
        TEST_ASSERT_TRUE(sample_at(t_us));
        TEST_ASSERT_UINT32_WITHIN(rounded_off, sum, counted(COUNT_LOST));
        TEST_ASSERT_TRUE(counted(COUNT_LOST) <= sum);
    }
}
