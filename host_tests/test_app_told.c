/* What the user is told of a fault: its words, how long it was, what it lost, and the LED. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "adxl345.h"
#include "counters.h"
#include "pipeline.h"
#include "replies.h"
#include "support_board.h"
#include "text.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

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
    TEST_ASSERT_DOUBLE_WITHIN(10.0 * times, 65.5 * times, lit_ms);
}

static void test_led_flashes_by_what_to_look_at(void)
{
    board_start_resting();
    board_run_ms(500);
    adxl345_model_power(&hal_host_sensor, false);
    assert_led_flashes(2);
    board_start_resting();
    hal_host_faults.id_wrong = true;
    assert_led_flashes(2);
    board_start_resting();
    hal_host_faults.sda_low = true;
    assert_led_flashes(1);
    board_start_resting();
    hal_host_faults.scl_low = true;
    assert_led_flashes(1);
    board_start_resting();
    hal_host_faults.int1_cut = true;
    assert_led_flashes(3);
    board_start_resting();
    assert_led_flashes(0);
}

/* Every code has words, also those that only a real sensor or bus can bring about. */
static void test_each_fault_has_its_words(void)
{
    board_start_resting();
    board_run_ms(500);
    for (uint8_t code = ADXL345_FAULT_NO_SENSOR; code <= ADXL345_FAULT_TWO_SENSORS; code++) {
        char begin[24];
        snprintf(begin, sizeof begin, "# fault %u: ", code);
        size_t before = board.note_count;
        TEST_ASSERT_TRUE(replies_add(REPLY_FAULT_BEGIN, code));
        board_run_ms(100);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(begin, before));
        TEST_ASSERT_TRUE(strlen(board_last_note()) > strlen(begin) + 20);
        TEST_ASSERT_TRUE(strlen(board_last_note()) < TEXT_LINE_MAX);
    }
}

/* Rows of samples are those without predictions; returns how many are missing between the two about the gap. */
static unsigned missing_after(size_t from_row)
{
    const board_row_t *last = &board.rows[from_row - 1];
    for (size_t i = from_row; i < board.row_count; i++) {
        if ((board.rows[i].flags & ROW_COASTED) == 0 && board.rows[i].t_us - last->t_us > 15000u) {
            return (board.rows[i].t_us - last->t_us + 5000u) / 10000u - 1u;
        }
        last = (board.rows[i].flags & ROW_COASTED) ? last : &board.rows[i];
    }
    return 0;
}

/* What the line says is what the rows show, and what `status` adds up; the fault was told when its line left. */
static void assert_outage_is_told(size_t note, size_t row, double tolerance_ms)
{
    unsigned code, ms, lost;
    TEST_ASSERT_EQUAL_INT(
        3, sscanf(board_last_note(), "# fault %u over: samples again after %u ms, %u lost", &code, &ms, &lost));
    TEST_ASSERT_EQUAL_UINT(missing_after(row), lost);
    TEST_ASSERT_DOUBLE_WITHIN(tolerance_ms, board.note_ms[board.note_count - 1] - board.note_ms[note], ms);
    TEST_ASSERT_EQUAL_UINT32(lost, counters[COUNT_LOST]);
}

static void test_end_of_a_fault_tells_its_length_and_the_samples_lost(void)
{
    static const double lengths_ms[] = { 60, 333, 2000, 58000, 90000 };
    for (size_t i = 0; i < sizeof lengths_ms / sizeof lengths_ms[0]; i++) {
        board_start_resting();
        board_run_ms(3500);
        size_t note = board.note_count;
        size_t row = board.row_count;
        adxl345_model_power(&hal_host_sensor, false);
        board_run_ms(lengths_ms[i]);
        adxl345_model_power(&hal_host_sensor, true);
        board_run_ms(500);
        assert_outage_is_told(note, row, lengths_ms[i] < 59000 ? 20.0 : 1100.0);
    }
}

/* The second outage tells of itself alone. */
static void test_each_outage_begins_anew(void)
{
    board_start_resting();
    board_run_ms(500);
    unsigned lost[2];
    for (unsigned i = 0; i < 2; i++) {
        size_t row = board.row_count;
        adxl345_model_power(&hal_host_sensor, false);
        board_run_ms(i == 0 ? 700 : 300);
        adxl345_model_power(&hal_host_sensor, true);
        board_run_ms(500);
        const char *count = strstr(board_last_note(), "ms, ");
        TEST_ASSERT_NOT_NULL(count);
        lost[i] = (unsigned)strtoul(count + 4, NULL, 10);
        TEST_ASSERT_EQUAL_UINT(missing_after(row), lost[i]);
    }
    TEST_ASSERT_TRUE(lost[1] < lost[0]);
    TEST_ASSERT_EQUAL_UINT32(lost[0] + lost[1], counters[COUNT_LOST]);
}

/* A change of rate stops the sensor for a moment: no sample is missing. */
static void test_a_change_of_rate_loses_nothing(void)
{
    board_start_resting();
    board_run_ms(500);
    board_type("rate 200");
    board_run_ms(500);
    board_type("range 4");
    board_run_ms(500);
    TEST_ASSERT_EQUAL_UINT32(0, counters[COUNT_LOST]);
}

/* What is missing of a second at the new rate: the old one ends with its command. */
static void test_a_change_of_rate_in_an_outage_forgets_no_sample(void)
{
    board_start_resting();
    board_run_ms(500);
    adxl345_model_power(&hal_host_sensor, false);
    board_run_ms(500);
    board_type("rate 200");
    board_run_ms(500);
    adxl345_model_power(&hal_host_sensor, true);
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1 over", 0));
    TEST_ASSERT_UINT32_WITHIN(10, 205, counters[COUNT_LOST]);
}

/* As many replies wait as there is room for, and the line stands still. */
static void fill_replies(void)
{
    hal_host_faults.tx_stuck = true;
    for (int i = 0; i < 12; i++) {
        board_type("help");
    }
    board_run_ms(20);
    TEST_ASSERT_FALSE(replies_room());
}

static void test_a_fault_for_which_there_is_no_room_is_told_later(void)
{
    board_start_resting();
    board_run_ms(500);
    for (int ends = 0; ends <= 1; ends++) {
        const char *words = ends ? "# fault 1 over" : "# fault 1: ";
        fill_replies();
        adxl345_model_power(&hal_host_sensor, ends);
        board_run_ms(150);
        TEST_ASSERT_EQUAL(ends ? ADXL345_FAULT_NONE : ADXL345_FAULT_NO_SENSOR, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with(words, 0));
        hal_host_faults.tx_stuck = false;
        board_run_ms(2000);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(words, 0));
    }
    TEST_ASSERT_EQUAL_UINT64(0, hal_host_watchdog_bite());
}

/* While a slow line carries a text one fault ends and another one passes: each is told with its own numbers. */
static void test_the_end_of_a_fault_keeps_its_numbers_until_it_is_told(void)
{
    unsigned code, ms[2], lost[2];
    board_start_resting();
    board_type("baud 9600");
    board_run_ms(1000);
    size_t before = board.note_count;
    adxl345_model_power(&hal_host_sensor, false);
    board_run_ms(700);
    for (int i = 0; i < 6; i++) {
        board_type("help");
    }
    for (int fault = 0; fault < 2; fault++) {
        adxl345_model_power(&hal_host_sensor, true);
        board_run_ms(200);
        adxl345_model_power(&hal_host_sensor, fault != 0);
        board_run_ms(300);
    }
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
    board_run_ms(20000);
    size_t ends = 0;
    for (size_t i = before; i < board.note_count; i++) {
        static const char words[] = "# fault %u over: samples again after %u ms, %u lost";
        if (strstr(board.notes[i], "over") != NULL && ends < 2) {
            TEST_ASSERT_EQUAL_INT(3, sscanf(board.notes[i], words, &code, &ms[ends], &lost[ends]));
            ends++;
        }
    }
    TEST_ASSERT_EQUAL_size_t(2, ends);
    TEST_ASSERT_UINT_WITHIN(60, 720, ms[0]);
    TEST_ASSERT_UINT_WITHIN(6, 72, lost[0]);
    TEST_ASSERT_UINT_WITHIN(6, 32, lost[1]);
}

/* Milliseconds in 32 bits wrap after 49.7 days: what is longer is told as the greatest number. */
static void test_an_outage_of_two_months_is_not_told_as_a_short_one(void)
{
    static const uint32_t passed_s[] = { 4294900u, 4294967u, 5184000u };
    for (size_t i = 0; i < sizeof passed_s / sizeof passed_s[0]; i++) {
        unsigned code;
        double ms;
        board_start_resting();
        board_run_ms(500);
        adxl345_model_power(&hal_host_sensor, false);
        board_run_ms(500);
        counters[COUNT_SECONDS] += passed_s[i];
        adxl345_model_power(&hal_host_sensor, true);
        board_run_ms(500);
        TEST_ASSERT_EQUAL_INT(2, sscanf(board_last_note(), "# fault %u over: samples again after %lf ms", &code, &ms));
        TEST_ASSERT_DOUBLE_WITHIN(2000.0, fmin(passed_s[i] * 1e3, UINT32_MAX), ms);
    }
}

/* A plot has no lines: what ended meanwhile is told behind it, as long as it was. */
static void test_a_fault_that_ends_in_a_plot_is_told_with_its_length(void)
{
    unsigned code, ms, lost;
    board_start_resting();
    board_run_ms(500);
    for (int twice = 0; twice <= 1; twice++) {
        adxl345_model_power(&hal_host_sensor, false);
        board_run_ms(300);
        size_t before = board.note_count;
        board_type("mode plot");
        board_run_ms(400);
        adxl345_model_power(&hal_host_sensor, true);
        board_run_ms(2000);
        if (twice) { /* gone again before it was told: one outage */
            adxl345_model_power(&hal_host_sensor, false);
            board_run_ms(500);
            adxl345_model_power(&hal_host_sensor, true);
            board_run_ms(2000);
        }
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
        board_type("mode csv");
        board_run_ms(200);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("over", before));
        TEST_ASSERT_EQUAL_INT(
            3, sscanf(board_last_note(), "# fault %u over: samples again after %u ms, %u lost", &code, &ms, &lost));
        TEST_ASSERT_UINT_WITHIN(50, twice ? 3220 : 720, ms);
        TEST_ASSERT_UINT_WITHIN(6, twice ? 123 : 71, lost);
    }
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
static void test_a_command_does_not_call_a_lasting_fault_over(void)
{
    static const uint8_t faults[] = { ADXL345_FAULT_INT1_STUCK, ADXL345_FAULT_STUCK, ADXL345_FAULT_TWO_SENSORS };
    static const char *const commands[] = { "rate 50", "range 8", "rate 100" };
    for (size_t i = 0; i < sizeof faults; i++) {
        stream_t stream = faults[i] == ADXL345_FAULT_STUCK ? board_constant_stream(8000, 100.0, 5, 6, 250)
                                                           : two_sensors();
        board_start(&stream, 0.0, 0);
        hal_host_faults.int1_high = faults[i] == ADXL345_FAULT_INT1_STUCK;
        board_run_ms(4000);
        TEST_ASSERT_EQUAL_UINT(faults[i], adxl345_fault());
        size_t before = board.note_count;
        for (size_t k = 0; k < sizeof commands / sizeof commands[0]; k++) {
            board_type(commands[k]);
            board_run_ms(700);
            TEST_ASSERT_EQUAL_UINT_MESSAGE(faults[i], adxl345_fault(), commands[k]);
        }
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("fault", before));
        board_type("stop");
        board_run_ms(200);
        board_type("go");
        board_run_ms(700);
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("fault", before)); /* told again behind the stop */
        stream_free(&stream);
    }
}

/* What repeats, or holds INT1, may have been taken away with the supply: no suspicion is left. */
static void test_a_sensor_that_was_away_is_not_suspected(void)
{
    stream_t stream = board_noisy_stream(8000, 100.0, 1.5, 5u);
    for (size_t i = 100; i < 210; i++) {
        memcpy(stream.rows[i].lsb, stream.rows[100].lsb, sizeof stream.rows[i].lsb);
    }
    board_start(&stream, 0.0, 0);
    board_run_ms(2000);
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_STUCK, adxl345_fault());
    adxl345_model_power(&hal_host_sensor, false);
    board_run_ms(1500);
    size_t row = board.row_count;
    adxl345_model_power(&hal_host_sensor, true);
    board_run_ms(500);
    for (; row < board.row_count; row++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[row].flags & ROW_STUCK);
    }
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_NONE, adxl345_fault());
    stream_free(&stream);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_led_flashes_by_what_to_look_at);
    RUN_TEST(test_each_fault_has_its_words);
    RUN_TEST(test_end_of_a_fault_tells_its_length_and_the_samples_lost);
    RUN_TEST(test_each_outage_begins_anew);
    RUN_TEST(test_a_change_of_rate_loses_nothing);
    RUN_TEST(test_a_change_of_rate_in_an_outage_forgets_no_sample);
    RUN_TEST(test_a_fault_for_which_there_is_no_room_is_told_later);
    RUN_TEST(test_the_end_of_a_fault_keeps_its_numbers_until_it_is_told);
    RUN_TEST(test_a_fault_that_ends_in_a_plot_is_told_with_its_length);
    RUN_TEST(test_an_outage_of_two_months_is_not_told_as_a_short_one);
    RUN_TEST(test_a_command_does_not_call_a_lasting_fault_over);
    RUN_TEST(test_a_sensor_that_was_away_is_not_suspected);
    return UNITY_END();
}
