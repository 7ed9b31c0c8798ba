/*
 * Fault 14: at rest the sensor does not read gravity. Which seconds count in the sample path alone, then the lines, the
 * LED and `status` of the whole firmware on the host's HAL.
 */
#include <stdio.h>
#include <string.h>

#include "adxl345.h"
#include "app/app.h"
#include "base/counters.h"
#include "base/notices.h"
#include "control/sensor_watch.h"
#include "path/gravity.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/path.h"
#include "support/talk.h"
#include "support/test.h"

enum { STARTS_S = 1 }; /* the first second warms up */

static uint32_t t_us;
static stream_t stream;

void setUp(void)
{
    t_us = 0;
}

static void sample(int16_t x_lsb, int16_t y_lsb, int16_t z_lsb)
{
    adxl345_sample_t s = { .t_us = t_us, .lsb = { x_lsb, y_lsb, z_lsb } };
    t_us += 10000u;
    pipeline_sample(&s);
    pipeline_flag(0);
    pipeline_finish();
}

/* Seconds of these readings, each with these flags of the driver in the middle of it. */
static void seconds(int many, int16_t z_lsb, uint16_t flags)
{
    while (many-- != 0) {
        for (int i = 0; i < 100; i++) {
            sample(0, 0, z_lsb);
            if (i == 50) {
                pipeline_flag(flags);
            }
        }
        pipeline_second(10000);
    }
}

TEST(test_ten_seconds_at_rest_and_the_first_within)
{
    path_start(0, 1000, 16, 0);
    seconds(STARTS_S + LIMIT_NO_GRAVITY_S - 1, 20, 0);
    TEST_ASSERT_FALSE(gravity_absent());
    seconds(1, 20, 0);
    TEST_ASSERT_TRUE(gravity_absent());
    seconds(100, 20, 0);
    TEST_ASSERT_TRUE(gravity_absent());
    seconds(1, 256, 0); /* it moves there */
    TEST_ASSERT_TRUE(gravity_absent());
    seconds(1, 256, 0);
    TEST_ASSERT_FALSE(gravity_absent());
    seconds(LIMIT_NO_GRAVITY_S, 20, 0); /* and back in the first of them */
    TEST_ASSERT_FALSE(gravity_absent());
    seconds(1, 20, 0);
    TEST_ASSERT_TRUE(gravity_absent());
    gravity_forget();
    TEST_ASSERT_FALSE(gravity_absent());
}

static bool lacks(int16_t x_lsb, int16_t y_lsb, int16_t z_lsb)
{
    path_start(0, 1000, 16, 0);
    for (int k = 0; k < STARTS_S + LIMIT_NO_GRAVITY_S; k++) {
        for (int i = 0; i < 100; i++) {
            sample(x_lsb, y_lsb, z_lsb);
        }
        pipeline_second(10000);
    }
    return gravity_absent();
}

TEST(test_the_limits_on_every_axis)
{
    static const int limits_lsb[] = { LIMIT_GRAVITY_LEAST_LSB, LIMIT_GRAVITY_MOST_LSB };
    for (size_t i = 0; i < 2; i++) {
        for (int more = -1; more <= 1; more++) {
            int lsb = limits_lsb[i] + more;
            bool wanted = lsb < LIMIT_GRAVITY_LEAST_LSB || lsb > LIMIT_GRAVITY_MOST_LSB;
            for (int sign = -1; sign <= 1; sign += 2) {
                int16_t reading = (int16_t)(sign * lsb);
                TEST_ASSERT_EQUAL(wanted, lacks(reading, 0, 0));
                TEST_ASSERT_EQUAL(wanted, lacks(0, reading, 0));
                TEST_ASSERT_EQUAL(wanted, lacks(0, 0, reading));
            }
        }
    }
    TEST_ASSERT_FALSE(lacks(91, -91, 90)); /* 157.0 LSB, and 156.5 */
    TEST_ASSERT_TRUE(lacks(90, -90, 91));
    TEST_ASSERT_TRUE(lacks(4000, 4000, -4000));
}

/* Neither counted nor a break: it is not known what the sensor read. */
TEST(test_a_second_with_disturbed_samples_proves_nothing)
{
    static const uint16_t flags[] = { ROW_COASTED, ROW_COASTED | ROW_FAULT, ROW_STUCK, ROW_CLIPPED, ROW_WARMING_UP };
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        path_start(0, 1000, 16, 0);
        seconds(STARTS_S + LIMIT_NO_GRAVITY_S - 1, 20, 0);
        seconds(3 * LIMIT_NO_GRAVITY_S, 20, flags[i]);
        TEST_ASSERT_FALSE(gravity_absent());
        seconds(1, 20, ROW_GATED | ROW_INTEGRITY | ROW_REACQUIRED);
        TEST_ASSERT_TRUE(gravity_absent());
        seconds(1, 256, 0);
        seconds(3, 256, flags[i]);
        TEST_ASSERT_TRUE(gravity_absent());
    }
}

TEST(test_seconds_without_samples_prove_nothing)
{
    path_start(0, 1000, 16, 0);
    seconds(STARTS_S + 1, 20, 0);
    for (int k = 0; k < 3 * LIMIT_NO_GRAVITY_S; k++) {
        pipeline_second(10000);
    }
    TEST_ASSERT_FALSE(gravity_absent());
}

/* As on a wheel that turns: it does not read gravity, but is not at rest. */
TEST(test_a_second_that_moves_restarts_the_ten)
{
    path_start(0, 1000, 16, 0);
    for (int k = 0; k < 5; k++) {
        seconds(LIMIT_NO_GRAVITY_S, 20, 0); /* the first of them moves, or warms up */
        TEST_ASSERT_FALSE(gravity_absent());
        seconds(1, 100, 0);
    }
    seconds(LIMIT_NO_GRAVITY_S, 100, 0);
    TEST_ASSERT_TRUE(gravity_absent());
}

/* --- the whole firmware --- */

static const char first_line[] = "# fault 14: not an ADXL345, or offsets beyond its data sheet: cal6";
static const char last_line[] = "# fault 14 over: after ";

/* A sensor that reads z at rest, with the noise of a desk, for so many milliseconds. */
static void start(int16_t z_lsb, double ms)
{
    stream = board_noisy_stream(1000, 100.0, 1.0, 1401u);
    for (size_t i = 0; i < stream.count; i++) {
        stream.rows[i].lsb[0] = (int16_t)(stream.rows[i].lsb[0] - 31);
        stream.rows[i].lsb[1] = (int16_t)(stream.rows[i].lsb[1] + 53);
        stream.rows[i].lsb[2] = (int16_t)(stream.rows[i].lsb[2] - 248 + z_lsb);
    }
    board_start(&stream, 0.0, 0);
    board_run_ms(ms);
}

static void move_z(int by_lsb)
{
    for (size_t i = 0; i < stream.count; i++) {
        stream.rows[i].lsb[2] = (int16_t)(stream.rows[i].lsb[2] + by_lsb);
    }
}

/* In every pass as many notices as the queue takes. */
static void fill_for_ms(double ms)
{
    double end_ms = hal_host_now_ms() + ms;
    while (hal_host_now_ms() < end_ms) {
        while (notices_add(NOTICE_STATUS, 0)) {
        }
        app_pass();
    }
}

static void assert_lines(size_t first, size_t last)
{
    TEST_ASSERT_EQUAL_size_t(first, board_notes_with(first_line, 0));
    TEST_ASSERT_EQUAL_size_t(last, board_notes_with(last_line, 0));
}

TEST(test_it_is_reported_once_and_ends_with_its_length)
{
    start(20, 10000);
    assert_lines(0, 0);
    TEST_ASSERT_EQUAL_UINT8(0, sensor_watch_fault());
    board_run_ms(3000);
    assert_lines(1, 0);
    TEST_ASSERT_EQUAL_UINT8(FAULT_OTHER_PART, sensor_watch_fault());
    (void)talk_typed("status", 20000);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(", fault 14, ", 0));
    assert_lines(1, 0);
    move_z(236);
    board_run_ms(5000);
    assert_lines(1, 1);
    TEST_ASSERT_EQUAL_UINT8(0, sensor_watch_fault());
    unsigned ms, lost, address;
    TEST_ASSERT_EQUAL_INT(
        3, sscanf(board_last_note(), "# fault 14 over: after %u ms, %u lost, sensor at 0x%x", &ms, &lost, &address));
    TEST_ASSERT_UINT_WITHIN(2000, 23500, ms);
    TEST_ASSERT_EQUAL_UINT(0, ms % 1000);
    TEST_ASSERT_EQUAL_UINT(0, lost);
    TEST_ASSERT_EQUAL_HEX(0x53, address);
}

TEST(test_the_drivers_faults_begin_and_end_meanwhile)
{
    start(20, 13000);
    assert_lines(1, 0);
    for (size_t times = 1; times <= 2; times++) {
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(300);
        TEST_ASSERT_EQUAL_UINT8(ADXL345_FAULT_NO_SENSOR, sensor_watch_fault());
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(3000);
        TEST_ASSERT_EQUAL_size_t(times, board_notes_with("# fault 1: ", 0));
        TEST_ASSERT_EQUAL_size_t(times, board_notes_with("# fault 1 over: after ", 0));
        TEST_ASSERT_EQUAL_UINT8(FAULT_OTHER_PART, sensor_watch_fault());
    }
    assert_lines(1, 0);
}

/* Both end during a plot, so that both lines are due at once: each has its own numbers. */
TEST(test_the_ends_of_two_faults_do_not_mix)
{
    start(20, 13000);
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(300);
    (void)talk_typed("mode plot", 200);
    adxl345_model_power(hal_host_sensor(), true);
    move_z(236);
    board_run_ms(5000);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over: after", 0));
    (void)talk_typed("mode csv", 1000);
    assert_lines(1, 1);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1 over: after 5", 0));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("000 ms, 0 lost, sensor at 0x53", 0));
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("over: after", 0));
}

TEST(test_nothing_is_reported_in_a_plot)
{
    start(20, 300);
    (void)talk_typed("mode plot", 500);
    size_t before = board.note_count;
    board_run_ms(15000);
    TEST_ASSERT_EQUAL_UINT8(FAULT_OTHER_PART, sensor_watch_fault());
    for (size_t i = before; i < board.note_count; i++) {
        TEST_ASSERT_NULL(strchr(board.notes[i], '#'));
    }
    (void)talk_typed("mode csv", 1000);
    assert_lines(1, 0);
}

TEST(test_stop_and_go_leave_it_as_it_is)
{
    start(20, 13000);
    (void)talk_typed("stop", 20000);
    assert_lines(1, 0);
    TEST_ASSERT_EQUAL_UINT8(FAULT_OTHER_PART, sensor_watch_fault());
    TEST_ASSERT_EQUAL_STRING("# stopped", board_last_note());
    (void)talk_typed("go", 14000);
    TEST_ASSERT_EQUAL_UINT8(FAULT_OTHER_PART, sensor_watch_fault());
    assert_lines(1, 0);
}

TEST(test_measurements_neither_count_nor_forget)
{
    static const char *const commands[] = { "selftest", "noise", "tare", "cal" };
    for (size_t i = 0; i < sizeof commands / sizeof commands[0]; i++) {
        start(20, 7300);
        (void)talk_typed(commands[i], 8000);
        assert_lines(1, 0);
        (void)talk_typed(commands[i], 8000);
        TEST_ASSERT_EQUAL_UINT8(FAULT_OTHER_PART, sensor_watch_fault());
        assert_lines(1, 0);
    }
}

/* A full queue of notices refuses the line: it is told when there is room, and so is the end. */
TEST(test_a_full_queue_delays_the_lines_alone)
{
    start(20, 10000);
    fill_for_ms(3000);
    assert_lines(0, 0);
    board_run_ms(2500);
    assert_lines(1, 0);
    move_z(236);
    fill_for_ms(4000);
    assert_lines(1, 0);
    board_run_ms(2500);
    assert_lines(1, 1);
}

/* Wires off and on again, values that hang, and a stop: all with a sound sensor. */
TEST(test_a_sound_sensor_is_never_accused)
{
    static const int16_t z_lsb[] = { 256 + 64, 256 - 64, -256 - 64, -256 + 64 };
    for (size_t i = 0; i < sizeof z_lsb / sizeof z_lsb[0]; i++) {
        start(z_lsb[i], 5000);
        for (int outage = 0; outage < 8; outage++) {
            adxl345_model_power(hal_host_sensor(), false);
            board_run_ms(outage * 2500);
            adxl345_model_power(hal_host_sensor(), true);
            board_run_ms(1300 + outage * 171);
        }
        (void)talk_typed("stop", 15000);
        (void)talk_typed("go", 15000);
        assert_lines(0, 0);
    }
}

int main(void)
{
    return test_all();
}
