/* What the user is told of a fault: its words and the LED. The numbers: test_app_outage.c. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "adxl345.h"
#include "adxl345_driver.h"
#include "base/counters.h"
#include "base/notices.h"
#include "base/text.h"
#include "control/sensor_watch.h"
#include "path/gravity.h"
#include "path/pipeline.h"
#include "support/documented_limits.h"
#include "support/talk.h"
#include "support/test.h"

/*
 * One pattern of 2^20 us, begun in its dark part: so many flashes of 65.5 ms. main looks every 8.2 ms at the latest, so
 * each may begin and end that much late.
 */
static void assert_led_flashes(unsigned times)
{
    const double pattern_ms = 1048.576;
    board_run_ms(pattern_ms - fmod(hal_host_now_ms(), pattern_ms) + 0.6 * pattern_ms);
    unsigned flashes = 0;
    double lit_ms = 0.0;
    bool was = hal_host_led();
    TEST_ASSERT_FALSE(was);
    double now_ms = hal_host_now_ms();
    for (double end_ms = now_ms + pattern_ms; now_ms < end_ms; now_ms = hal_host_now_ms()) {
        board_run_ms(1.0);
        lit_ms += was ? hal_host_now_ms() - now_ms : 0.0;
        bool is = hal_host_led();
        flashes += is && !was;
        was = is;
    }
    TEST_ASSERT_EQUAL_UINT(times, flashes);
    TEST_ASSERT_DOUBLE_WITHIN(10.0 * times, (LIMIT_LED_MS + 0.5) * times, lit_ms);
}

TEST(test_led_flashes_by_what_to_look_at)
{
    board_start_resting();
    board_run_ms(500);
    adxl345_model_power(hal_host_sensor(), false);
    assert_led_flashes(2);
    board_start_resting();
    hal_host_faults()->id_wrong = true;
    assert_led_flashes(2);
    board_start_resting();
    hal_host_faults()->sda_low = true;
    assert_led_flashes(1);
    board_start_resting();
    hal_host_faults()->scl_low = true;
    assert_led_flashes(1);
    board_start_resting();
    hal_host_faults()->int1_cut = true;
    assert_led_flashes(3);
    board_start_resting();
    assert_led_flashes(0);
}

/* Over one pattern, begun in its dark part, a look at least every 8.2 ms. */
static unsigned flashes_shown(void)
{
    const uint32_t pattern_us = 1u << 20;
    unsigned flashes = 0;
    bool was = false;
    for (uint32_t t_us = pattern_us - 8000u; t_us < 2u * pattern_us - 8000u; t_us += 8000u) {
        sensor_watch_pass(t_us);
        flashes += hal_host_led() && !was;
        was = hal_host_led();
    }
    return flashes;
}

/* The column LED of docs/faults.md, also for those that only a real sensor or bus can bring about. */
TEST(test_each_fault_has_its_flashes)
{
    static const uint8_t flashes[] = { 0, 2, 2, 1, 2, 3, 2, 1, 1, 3, 4, 4, 4, 3 }; /* by code */
    board_start_resting();
    board_run_ms(500);
    for (uint8_t code = 0; code < sizeof flashes; code++) {
        adxl345_driver_state()->fault = code;
        TEST_ASSERT_EQUAL_UINT8(code, sensor_watch_fault());
        TEST_ASSERT_EQUAL_UINT(flashes[code], flashes_shown());
    }
    adxl345_driver_state()->fault = ADXL345_FAULT_NONE;
    adxl345_driver_state()->garbled = GARBLED_SLOW;
    sensor_watch_second();
    TEST_ASSERT_EQUAL_UINT8(15, sensor_watch_fault());
    TEST_ASSERT_EQUAL_UINT(1, flashes_shown());
    for (int s = 0; s < LIMIT_NO_GRAVITY_S; s++) {
        gravity_second(true, 0);
    }
    sensor_watch_second();
    TEST_ASSERT_EQUAL_UINT8(14, sensor_watch_fault());
    TEST_ASSERT_EQUAL_UINT(4, flashes_shown());
}

/* Every code has words, also those that only a real sensor or bus can bring about. */
TEST(test_each_fault_has_its_words)
{
    board_start_resting();
    board_run_ms(500);
    for (uint8_t code = ADXL345_FAULT_NO_SENSOR; code <= ADXL345_FAULT_TWO_SENSORS; code++) {
        char begin[24];
        snprintf(begin, sizeof begin, "# fault %u: ", code);
        size_t before = board.note_count;
        TEST_ASSERT_TRUE(notices_add(NOTICE_FAULT_BEGIN, code));
        board_run_ms(100);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(begin, before));
        TEST_ASSERT_TRUE(strlen(board_last_note()) > strlen(begin) + 20);
        TEST_ASSERT_TRUE(strlen(board_last_note()) < TEXT_LINE_MAX);
    }
}

/* A change of rate stops the sensor for a moment: no sample is missing. */
TEST(test_a_change_of_rate_loses_nothing)
{
    board_start_resting();
    board_run_ms(500);
    (void)talk_typed("rate 200", 500);
    (void)talk_typed("range 4", 500);
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_LOST));
}

/* What is missing of a second at the new rate: the old one ends with its command. */
TEST(test_a_change_of_rate_in_an_outage_forgets_no_sample)
{
    board_start_resting();
    board_run_ms(500);
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(500);
    (void)talk_typed("rate 200", 500);
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1 over", 0));
    TEST_ASSERT_UINT32_WITHIN(10, 205, counted(COUNT_LOST));
}

/* x jumps to its double and back, as where two sensors answer. */
static stream_t two_sensors(void)
{
    stream_t stream = board_noisy_stream(8000, 100.0, 1.5, 5u);
    for (size_t i = 0; i < stream.count; i++) {
        stream.rows[i].lsb[0] = (int16_t)(stream.rows[i].lsb[0] + (i % 5 == 0 ? 400 - 31 : 200 - 31));
    }
    return stream;
}

/* A command configures the sensor anew, which mends neither its wires nor itself: nothing is over by it. */
TEST(test_a_command_does_not_call_a_lasting_fault_over)
{
    static const uint8_t faults[] = { ADXL345_FAULT_INT1_STUCK, ADXL345_FAULT_STUCK, ADXL345_FAULT_TWO_SENSORS };
    static const char *const commands[] = { "rate 50", "range 8", "rate 100" };
    for (size_t i = 0; i < sizeof faults; i++) {
        stream_t stream = faults[i] == ADXL345_FAULT_STUCK ? board_constant_stream(8000, 100.0, 5, 6, 250)
                                                           : two_sensors();
        board_start(&stream, 0.0, 0);
        hal_host_faults()->int1_high = faults[i] == ADXL345_FAULT_INT1_STUCK;
        board_run_ms(4000);
        TEST_ASSERT_EQUAL_UINT(faults[i], adxl345_fault());
        size_t before = board.note_count;
        for (size_t k = 0; k < sizeof commands / sizeof commands[0]; k++) {
            (void)talk_typed(commands[k], 700);
            TEST_ASSERT_EQUAL_UINT_MESSAGE(faults[i], adxl345_fault(), commands[k]);
        }
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# fault", before));
        (void)talk_typed("stop", 200);
        (void)talk_typed("go", 700);
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault", before)); /* told again behind the stop */
    }
}

/* What repeats, or holds INT1, may have been taken away with the supply: no suspicion is left. */
TEST(test_a_sensor_that_was_away_is_not_suspected)
{
    stream_t stream = board_hung_stream(8000, 5u, 100, 110);
    board_start(&stream, 0.0, 0);
    board_run_ms(2000);
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_STUCK, adxl345_fault());
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(1500);
    size_t row = board.row_count;
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(500);
    for (; row < board.row_count; row++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[row].flags & ROW_STUCK);
    }
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_NONE, adxl345_fault());
}
