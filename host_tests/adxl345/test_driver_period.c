/*
 * The measured period: of sixteen steps in a row between exact stamps, each within an eighth of the nominal one; and
 * the rate that the driver makes of it.
 */
#include "adxl345.h"
#include "adxl345_period.h"
#include "support/documented_limits.h"
#include "support/test.h"

enum { STEPS = LIMIT_PERIOD_STEPS };

static const uint32_t nominals_us[] = { 1250, 2500, 5000, 10000, 20000, 40000, 80000 };
static uint32_t t_us;

void setUp(void)
{
    t_us = 0xFFFFFFFFu - 40000u; /* the clock wraps on the way */
    adxl345_period_start(5000);
}

/* 0 until the period was measured. */
static uint32_t measured_us_q4(void)
{
    return adxl345_period_measured() ? adxl345_period_us_q4() : 0;
}

static void step(uint32_t us, bool exact)
{
    t_us += us;
    adxl345_period_sample(t_us, exact);
}

static void steps(unsigned count, uint32_t us)
{
    while (count-- != 0) {
        step(us, true);
    }
}

/* The first stamp has no step before it: 17 stamps are 16 steps. */
TEST(test_sixteen_steps_are_a_measurement)
{
    for (unsigned times = 0; times < 3; times++) {
        setUp();
        step(times, true);
        steps(STEPS - 1, 10100);
        TEST_ASSERT_EQUAL_UINT32(0, measured_us_q4());
        TEST_ASSERT_EQUAL_UINT32(10000, adxl345_period_us());
        steps(1, 10100);
        TEST_ASSERT_EQUAL_UINT32(10100u * 16u, measured_us_q4());
        TEST_ASSERT_EQUAL_UINT32(10100, adxl345_period_us());
    }
}

/* The next sixteen begin where these end, and count alone: their mean, whatever each is. */
TEST(test_each_sixteen_make_a_mean_of_their_own)
{
    step(0, true);
    steps(STEPS, 10100);
    steps(STEPS - 1, 9900);
    TEST_ASSERT_EQUAL_UINT32(10100, adxl345_period_us());
    steps(1, 9900);
    TEST_ASSERT_EQUAL_UINT32(9900u * 16u, measured_us_q4());
    for (unsigned i = 0; i < STEPS; i++) {
        step(10000 + 10 * i, true); /* 10075 on average */
    }
    TEST_ASSERT_EQUAL_UINT32(10075u * 16u, measured_us_q4());
}

/*
 * An eighth of the nominal period shorter or longer is a step between two samples; more, but for what is cut, is none.
 */
TEST(test_a_step_is_within_an_eighth_of_the_nominal_one)
{
    for (unsigned r = 0; r < sizeof nominals_us / sizeof nominals_us[0]; r++) {
        uint32_t shortest_us = (7u * nominals_us[r] + 7u) / 8u; /* the first whole number from 7/8 on */
        uint32_t longest_us = 9u * nominals_us[r] / 8u;
        const uint32_t lengths_us[] = { shortest_us - 1, shortest_us, longest_us, longest_us + 2 };
        for (unsigned i = 0; i < 4; i++) {
            setUp();
            adxl345_period_start((uint16_t)(nominals_us[r] / 2u));
            step(0, true);
            steps(STEPS, lengths_us[i]);
            bool is_step = i == 1 || i == 2;
            TEST_ASSERT_EQUAL_UINT32(is_step ? lengths_us[i] * 16u : 0, measured_us_q4());
            TEST_ASSERT_EQUAL_UINT32(is_step ? lengths_us[i] : nominals_us[r], adxl345_period_us());
        }
    }
}

/* A stamp that is interpolated, or a step that is none, at any place: the sixteen are counted from the next one. */
TEST(test_one_bad_stamp_at_any_place_begins_the_count_again)
{
    for (unsigned place = 1; place <= STEPS; place++) {
        setUp();
        step(0, true);
        steps(place - 1, 10100);
        step(10600, false); /* 500 us late, which a mean that begins here would show as 31 us less */
        TEST_ASSERT_EQUAL_UINT32(0, measured_us_q4());
        step(10100 - 500, true);
        steps(STEPS - 1, 10100);
        TEST_ASSERT_EQUAL_UINT32(0, measured_us_q4());
        steps(1, 10100);
        TEST_ASSERT_EQUAL_UINT32(10100u * 16u, measured_us_q4());

        setUp();
        step(0, true);
        steps(place - 1, 10100);
        step(20200, true); /* a sample is missing; this stamp is exact, and the first of the next sixteen */
        steps(STEPS - 1, 10100);
        TEST_ASSERT_EQUAL_UINT32(0, measured_us_q4());
        steps(1, 10100);
        TEST_ASSERT_EQUAL_UINT32(10100u * 16u, measured_us_q4());
    }
}

/* Another nominal period: nothing of the old one is left. */
TEST(test_a_start_forgets)
{
    step(0, true);
    steps(STEPS + STEPS / 2, 10100);
    adxl345_period_start(10000);
    TEST_ASSERT_EQUAL_UINT32(0, measured_us_q4());
    TEST_ASSERT_EQUAL_UINT32(20000, adxl345_period_us());
    step(20000, true);
    steps(STEPS - 1, 20000);
    TEST_ASSERT_EQUAL_UINT32(0, measured_us_q4());
}

/* 1e8 / period, rounded to 0.01 Hz. */
TEST(test_the_rate_is_one_over_the_period)
{
    for (unsigned r = 0; r < sizeof nominals_us / sizeof nominals_us[0]; r++) {
        for (int per_mille = -120; per_mille <= 120; per_mille += 5) {
            uint32_t us = nominals_us[r] + (uint32_t)((int32_t)nominals_us[r] * per_mille / 1000);
            adxl345_period_start((uint16_t)(nominals_us[r] / 2u));
            TEST_ASSERT_EQUAL_UINT32(0, adxl345_rate_chz());
            step(0, true);
            steps(STEPS / 2, us);
            steps(STEPS / 2, us + 1); /* half a microsecond more on average */
            double exact_chz = 1e8 / (us + 0.5);
            TEST_ASSERT_DOUBLE_WITHIN(0.5, exact_chz, adxl345_rate_chz());
            TEST_ASSERT_EQUAL_UINT32(us, adxl345_period_us());
        }
    }
}
