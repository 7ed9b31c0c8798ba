/*
 * The whole firmware on the host's HAL when things fail: sensor faults told once, long waits without a reset, hung
 * stages.
 */
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "base/hang_test.h"
#include "base/health.h"
#include "hal_watchdog.h"
#include "path/pipeline.h"
#include "support/talk.h"
#include "support/test.h"

void setUp(void)
{
    *hang_stages_here() = 0;
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(0, hal_host_faults()->tx_stuck, "a test left a fault behind");
}

/* A board at rest that has sent rows for a while; returns how many other lines. */
static size_t start_streaming(void)
{
    board_start_resting();
    board_run_ms(500);
    return board.note_count;
}

static void assert_fault_is_told(const char *words)
{
    board_run_ms(700);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(words, 0));
    TEST_ASSERT_TRUE(board.row_count >= 4);
    TEST_ASSERT_EQUAL_UINT(ROW_FAULT | ROW_COASTED, board.rows[board.row_count - 1].flags & (ROW_FAULT | ROW_COASTED));
}

TEST(test_no_sensor_is_told_once)
{
    board_start_resting();
    adxl345_model_power(hal_host_sensor(), false);
    assert_fault_is_told("fault 1: no sensor at 0x53 or 0x1D");
}

TEST(test_wrong_identity_is_told_once)
{
    board_start_resting();
    hal_host_faults()->id_wrong = true;
    assert_fault_is_told(": DEVID 0x00, not 0xE5");
}

TEST(test_silent_int1_is_told_once)
{
    board_start_resting();
    hal_host_faults()->int1_cut = true;
    board_run_ms(700);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("INT1 stays low: check INT1 to D2", 0));
    /* read by the clock: rows at the sensor's rate, each of a sample */
    size_t before = board.row_count;
    size_t latched = board.latched_count;
    board_run_ms(1000);
    TEST_ASSERT_INT_WITHIN(2, (int)(board.latched_count - latched), (int)(board.row_count - before));
    for (size_t i = before; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_FAULT | ROW_COASTED));
    }
    hal_host_faults()->int1_cut = false;
    board_run_ms(100);
    TEST_ASSERT_EQUAL_STRING_LEN("# fault 5 over: after ", board_last_note(), 22);
}

TEST(test_fault_begins_and_ends_with_one_line_each)
{
    size_t before = start_streaming();
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(2000);
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("over: after", before));
    TEST_ASSERT_EQUAL_INT(0, strncmp(board_last_note(), "# fault 1 over: ", 16));
    TEST_ASSERT_TRUE(board.note_count - before <= 3);
    TEST_ASSERT_FALSE(hal_host_led());
    TEST_ASSERT_EQUAL_UINT(0, board.rows[board.row_count - 1].flags & ROW_FAULT);
}

TEST(test_stop_during_a_fault_does_not_call_it_over)
{
    (void)start_streaming();
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(300);
    size_t before = talk_typed("stop", 300);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
}

/* The line that says so is out; from then on nothing is told and no row comes, whatever the sensor was doing. */
static void assert_silent_after_stop(size_t from)
{
    board_run_ms(60);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# stopped", from));
    size_t notes = board.note_count;
    size_t rows = board.row_count;
    board_run_ms(350);
    TEST_ASSERT_EQUAL_size_t(notes, board.note_count);
    TEST_ASSERT_EQUAL_size_t(rows, board.row_count);
    TEST_ASSERT_FALSE(hal_host_led());
}

/* Stop at every 0.5 ms of the way back from an unplugged sensor; the fault was told once, and not again by the stop. */
TEST(test_stop_at_any_moment_of_a_recovery_is_silent)
{
    for (unsigned phase = 0; phase < 140; phase++) {
        size_t before = start_streaming();
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(200);
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(phase * 0.5);
        board_type("stop");
        assert_silent_after_stop(before);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1: ", before));
    }
}

/* A line is low until main backs off; stop then: the sensor still measures, and is to rest. */
TEST(test_stop_between_two_attempts_puts_the_sensor_to_rest)
{
    for (unsigned phase = 0; phase < 60; phase++) {
        size_t before = start_streaming();
        hal_host_faults()->sda_low = true;
        board_run_ms(40.0 + phase * 0.5);
        TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_SDA_LOW, adxl345_fault());
        hal_host_faults()->sda_low = false;
        board_type("stop");
        assert_silent_after_stop(before);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(hal_host_sensor()));
    }
}

/* Both at once, as a script sends them: the sensor is still away, so nothing is over, wherever main is meanwhile. */
TEST(test_stop_and_go_at_once_during_a_fault_do_not_call_it_over)
{
    size_t before = start_streaming();
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(300);
    for (int blanks = 0; blanks < 120; blanks++) { /* 87 us each before the commands: 10 ms of phases */
        char typed[160];
        snprintf(typed, sizeof typed, "%*s", blanks + 7, "stop\ngo");
        (void)talk_typed(typed, 60);
    }
    TEST_ASSERT_EQUAL_size_t(120, board_notes_with("# going", before));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("over: after", before));
    TEST_ASSERT_EQUAL_UINT(0, board.rows[board.row_count - 1].flags & ROW_FAULT);
}

/* SDA or SCL comes off, supply and INT1 stay: the first line names the sensor, and no line the bus. */
TEST(test_wires_off_are_told_as_a_missing_sensor)
{
    for (unsigned phase = 0; phase < 20; phase++) {
        board_start_resting();
        board_run_ms(500.0 + phase * 0.5);
        size_t before = board.note_count;
        hal_host_sensor()->address = 0x2A;
        board_run_ms(300);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1: no sensor", before));
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault", before));
    }
}

/* A line is low from a moment between two samples: known 3 ms after the next one began, told with its name and wire. */
TEST(test_a_line_that_is_low_is_told)
{
    for (unsigned phase = 0; phase < 20; phase++) {
        bool scl = (phase & 1u) != 0;
        board_start_resting();
        board_run_ms(500.0 + phase * 0.5);
        size_t before = board.note_count;
        hal_host_faults()->scl_low = scl;
        hal_host_faults()->sda_low = !scl;
        double low_ms = hal_host_now_ms();
        while (adxl345_fault() == ADXL345_FAULT_NONE) {
            TEST_ASSERT_TRUE(hal_host_now_ms() - low_ms < 10.0 + 3.5);
            board_run_ms(0.1);
        }
        board_run_ms(100);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(scl ? "# fault 7: SCL held low: check SDA, SCL"
                                                         : "# fault 8: SDA held low: check SDA, SCL",
                                                     before));
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault", before));
        hal_host_faults()->scl_low = false;
        hal_host_faults()->sda_low = false;
        board_run_ms(100);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(scl ? "# fault 7 over" : "# fault 8 over", before));
    }
}

TEST(test_ten_minutes_without_a_sensor)
{
    board_start_resting();
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(600e3);
    TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault ", 0));
}

TEST(test_ten_minutes_stopped)
{
    (void)start_streaming();
    (void)talk_typed("stop", 600e3);
    TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
    size_t rows = board.row_count;
    (void)talk_typed("go", 1000);
    TEST_ASSERT_INT_WITHIN(6, 97, (int)(board.row_count - rows));
}

TEST(test_slowest_rate_and_largest_every)
{
    talk_start();
    board_type("rate 12.5");
    (void)talk_typed("every 10000", 900e3);
    TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
    board_type("every 1");
    size_t rows = board.row_count;
    board_run_ms(1000);
    TEST_ASSERT_INT_WITHIN(2, 12, (int)(board.row_count - rows));
}

/*
 * Replies keep the transmit ring full for a minute at the slowest line: rows come late or are dropped whole, nothing
 * hangs.
 */
TEST(test_a_minute_with_the_ring_full)
{
    talk_start();
    (void)talk_typed("baud 9600", 500);
    for (int i = 0; i < 60; i++) {
        board_type("help");
        (void)talk_typed("status", 1000);
    }
    TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
    board_run_ms(15000); /* what waits is said, and 2 s are over */
    size_t rows = board.row_count;
    board_run_ms(5000);
    TEST_ASSERT_TRUE(board.row_count > rows + 60);
}

/* Each stage hung alone: the dog bites within 300 ms and the note names the stage. */
static void assert_bite(uint8_t stage)
{
    double begun_ms = hal_host_now_ms();
    board_run_ms(400);
    double bitten_ms = (double)hal_host_watchdog_bite() / 16000.0;
    TEST_ASSERT_TRUE(hal_host_watchdog_bite() != 0);
    TEST_ASSERT_TRUE(bitten_ms - begun_ms <= 300.0);
    *hang_stages_here() = 0;
    hal_host_faults()->tx_stuck = false;
    hal_host_reset_mcu(HAL_RESET_WATCHDOG);
    app_start();
    board_run_ms(100);
    TEST_ASSERT_EQUAL_HEX8(stage, hal_reset_note() & stage);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# reset: watchdog, stage mask", 0));
}

TEST(test_hung_sampling_is_bitten)
{
    (void)start_streaming();
    hal_host_faults()->int1_cut = true;
    *hang_stages_here() = HEALTH_SAMPLING;
    assert_bite(HEALTH_SAMPLING);
}

TEST(test_hung_filtering_is_bitten)
{
    (void)start_streaming();
    *hang_stages_here() = HEALTH_FILTERING;
    assert_bite(HEALTH_FILTERING);
}

TEST(test_hung_output_is_bitten)
{
    (void)start_streaming();
    hal_host_faults()->tx_stuck = true;
    assert_bite(HEALTH_OUTPUT);
}
