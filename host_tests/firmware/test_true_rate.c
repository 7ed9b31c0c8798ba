/*
 * The measured rate of a sensor handed to the filters: when, and that no row shows it but by what the filters do. The
 * pipeline alone, then the whole firmware on the host's HAL.
 */
#include <math.h>

#include "app/app.h"
#include "base/counters.h"
#include "filter_list.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/path.h"
#include "support/roles.h"
#include "support/test.h"

#define FOR_EACH_FILTER(kind) for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++)

static uint32_t t_us;
static row_t row;
static bool rows_come;

void setUp(void)
{
    t_us = 0;
    rows_come = true;
}

static void begin(uint8_t kind)
{
    path_start(kind, 1000, 16, 0);
}

static void sample_of(int16_t x_lsb, int16_t y_lsb, int16_t z_lsb)
{
    adxl345_sample_t s = { .t_us = t_us, .lsb = { x_lsb, y_lsb, z_lsb } };
    t_us += 10000u;
    pipeline_sample(&s);
    pipeline_finish();
    if (rows_come) {
        pipeline_row(&row);
        pipeline_row_done();
    }
}

static void sample(int16_t y_lsb)
{
    sample_of(0, y_lsb, 248);
}

/* The look at the end of each second; true when the filters get another rate. */
static bool look(uint32_t period_us)
{
    TEST_ASSERT_TRUE(pipeline_changed());
    pipeline_second(period_us);
    pipeline_finish();
    return !pipeline_changed();
}

static bool second(uint32_t period_us, int16_t from_lsb, int16_t step_lsb)
{
    for (int16_t k = 0; k < 100; k++) {
        sample((int16_t)(from_lsb + k * step_lsb / 100));
    }
    return look(period_us);
}

/* About (1,1,1), which leaves the sum of the axes as it is; gravity 30 degrees off it. Angles in radians. */
static bool second_of_turn(uint32_t period_us, double from, double step)
{
    const double third = 2.0943951023931953;
    for (int k = 0; k < 100; k++) {
        double lsb[3];
        for (int axis = 0; axis < 3; axis++) {
            lsb[axis] = 128.0 + 104.5 * cos(from + step * k / 100.0 - third * axis);
        }
        sample_of((int16_t)lrint(lsb[0]), (int16_t)lrint(lsb[1]), (int16_t)lrint(lsb[2]));
    }
    return look(period_us);
}

TEST(test_the_sixth_second_off_hands_the_rate_over_once)
{
    static const uint32_t periods_us[] = { 9500, 9900, 10100, 10500 };
    for (size_t i = 0; i < 4; i++) {
        begin(0);
        (void)second(10000, 60, 0);
        for (int k = 1; k <= 30; k++) {
            TEST_ASSERT_EQUAL_INT(k == LIMIT_FOLLOW_S + 1, second(periods_us[i], 60, 0));
        }
        for (int k = 1; k <= 6; k++) { /* the nominal one is the one that is off now */
            TEST_ASSERT_EQUAL_INT(k == 6, second(10000, 60, 0));
        }
    }
}

TEST(test_what_is_near_or_comes_back_changes_nothing)
{
    begin(0);
    for (int k = 1; k <= 60; k++) {
        TEST_ASSERT_FALSE(second(k % 5 == 0 ? 10000 : 10300, 60, 0));
        TEST_ASSERT_FALSE(second(k & 1 ? 9950 : 10050, 60, 0));
    }
}

/* By more than its 128th part and 0.1 Hz, which is 0.9 % at 100 Hz and more the slower the sensor is. */
TEST(test_the_least_that_is_followed_at_each_rate)
{
    for (uint16_t rate_dhz = 125; rate_dhz <= 8000; rate_dhz = (uint16_t)(rate_dhz * 2u)) {
        uint32_t nominal_us = 10000000u / rate_dhz;
        uint32_t step_us = nominal_us / 10000u + 1u;
        for (uint32_t us = nominal_us * 97u / 100u; us <= nominal_us * 103u / 100u; us += step_us) {
            double off_dhz = fabs((double)(10000000u / us) - rate_dhz);
            bool followed = false;
            path_start(0, rate_dhz, 16, 0);
            for (int k = 0; k <= LIMIT_FOLLOW_S; k++) {
                followed = look(us);
            }
            TEST_ASSERT_EQUAL(off_dhz > 1.0 + (double)rate_dhz / LIMIT_FOLLOW_PART, followed);
        }
    }
}

/* 10 s of readings whose mean is so many eighths of an LSB: the estimate has come to it. */
static void settle(int eighths)
{
    for (int k = 0; k < 1000; k++) {
        sample((int16_t)(eighths * (k + 1) / 8 - eighths * k / 8));
    }
}

/* In quarters of an LSB, from the middle of one to the middle of another. */
TEST(test_the_most_that_is_standing_still)
{
    enum { FROM = 8 * 60 + 1, MOST = 2 * LIMIT_STILL_LSB_Q1 };
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int quarters = MOST - 1; quarters <= MOST + 1; quarters++) {
            begin(0);
            settle(FROM);
            for (int k = 0; k < LIMIT_FOLLOW_S + 1; k++) {
                TEST_ASSERT_FALSE(look(k == 0 ? 10000 : 10300));
            }
            settle(FROM + sign * 2 * quarters);
            TEST_ASSERT_EQUAL(quarters <= MOST, look(10300));
        }
    }
}

/* Whether a row is written each second or not. */
TEST(test_a_board_that_moves_keeps_its_rates_of_change)
{
    for (int with_rows = 0; with_rows <= 1; with_rows++) {
        rows_come = with_rows != 0;
        begin(0);
        (void)second(10000, -120, 20);
        for (int16_t k = 1; k <= 12; k++) {
            TEST_ASSERT_FALSE(second(10300, (int16_t)(-120 + 20 * k), 20)); /* 4.5 degrees a second */
        }
        TEST_ASSERT_TRUE(second(10300, 140, 0));
    }
}

TEST(test_a_turn_that_leaves_the_sum_of_the_axes_is_no_standing_still)
{
    const double step = 0.2; /* 11 degrees a second, 6 of gravity's direction */
    begin(0);
    (void)second_of_turn(10000, -step, step);
    for (int k = 0; k < 40; k++) {
        TEST_ASSERT_FALSE(second_of_turn(10300, k * step, step));
    }
    TEST_ASSERT_TRUE(second_of_turn(10300, 40 * step, 0));
}

/* Rows before and behind it: no flag, and no more change than half a reading's unit, 0.12 degree. */
TEST(test_no_row_shows_it)
{
    FOR_EACH_FILTER(kind)
    {
        begin(kind);
        for (int k = 1; k <= 5; k++) {
            TEST_ASSERT_FALSE(second(10500, 60, 0));
        }
        int before_cdeg = row.roll_cdeg;
        (void)second(10500, 60, 0);
        for (int k = 0; k < 20; k++) {
            sample(60);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(0, row.flags, filter_listed_name((filter_kind_t)kind));
            TEST_ASSERT_INT_WITHIN_MESSAGE(12, before_cdeg, row.roll_cdeg, filter_listed_name((filter_kind_t)kind));
        }
    }
}

/* Longer steps of time let the rate wander more from one to the next: a plain Kalman filter follows a step faster. */
static int16_t answer_to_a_step(uint32_t period_us)
{
    begin((uint8_t)plain_kind());
    for (int k = 0; k < 8; k++) {
        (void)second(period_us, 60, 0);
    }
    sample(100);
    pipeline_row(&row);
    return row.mg[1];
}

TEST(test_the_filter_has_the_parameters_of_the_true_rate)
{
    int16_t nominal_mg = answer_to_a_step(10000);
    TEST_ASSERT_GREATER_THAN_INT16(nominal_mg, answer_to_a_step(11000));
    TEST_ASSERT_LESS_THAN_INT16(nominal_mg, answer_to_a_step(9000));
}

/* A change of filter goes on with it, a start or another nominal rate does not. */
TEST(test_how_long_it_holds)
{
    begin(0);
    for (int k = 1; k <= 6; k++) {
        (void)second(10500, 60, 0);
    }
    settings_take_filter(1);
    pipeline_change(&settings()->choice, 1000, 16);
    pipeline_finish();
    for (int k = 1; k <= 10; k++) {
        TEST_ASSERT_FALSE(second(10500, 60, 0));
    }
    settings_take_filter(1);
    pipeline_change(&settings()->choice, 2000, 16);
    pipeline_finish();
    for (int k = 1; k <= 10; k++) {
        TEST_ASSERT_FALSE(second(5000, 60, 0));
    }
}

/* The seconds from the start to the hand-over, 0: none in 20; rows are checked on the way. */
static double handed_over_at_s(double ppm)
{
    stream_t stream = board_noisy_stream(2000, 100.0, 0.7, 61006);
    board_start(&stream, ppm, 0);
    board_run_ms(1000);
    hal_host_faults()->lap_step = 1; /* passes of a few pieces: a change is seen under way */
    double at_s = 0.0;
    while (hal_host_now_ms() < 20000.0) {
        app_pass();
        if (!pipeline_changed() && at_s == 0.0) {
            at_s = hal_host_now_ms() / 1000.0;
        }
    }
    for (size_t i = 200; i + 1 < board.row_count; i++) {
        TEST_ASSERT_EQUAL_HEX16(0, board.rows[i].flags & ~(unsigned)ROW_GATED);
        TEST_ASSERT_INT_WITHIN(100, board.rows[i].roll_cdeg, board.rows[i + 1].roll_cdeg);
    }
    hal_host_faults()->lap_step = 0;
    return at_s;
}

TEST(test_the_firmware_hands_over_what_it_has_measured)
{
    static const double clocks_ppm[] = { -50000.0, -20000.0, 20000.0, 50000.0 };
    for (size_t i = 0; i < 4; i++) {
        double at_s = handed_over_at_s(clocks_ppm[i]);
        TEST_ASSERT_TRUE(at_s >= 5.0 && at_s <= 10.0);
    }
    TEST_ASSERT_TRUE(handed_over_at_s(5000.0) == 0.0);
}
