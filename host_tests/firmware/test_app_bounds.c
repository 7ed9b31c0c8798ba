/*
 * Numbers that a person meets, just inside and just beyond their bounds: characters of a line, an outage longer than
 * the clock's wrap, how late the service may be, when a run counts as lasting, the largest acceleration of a row.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "adxl345.h"
#include "app/app.h"
#include "base/counters.h"
#include "hal_time.h"
#include "hal_watchdog.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/talk.h"
#include "support/test.h"

/* A line is of the characters from blank to `~`, 32 to 126; what ends it is no character of it. */
TEST(test_every_other_byte_in_a_line_is_refused_as_such)
{
    talk_start();
    for (int byte = 1; byte <= 255; byte++) {
        if (byte == '\n' || byte == '\r') {
            continue;
        }
        char typed[8] = { 'u', 'p', 't', (char)byte, 'x', 0 };
        bool is_character = byte >= 32 && byte <= LIMIT_CHARACTER_MAX;
        TEST_ASSERT_EQUAL_MESSAGE(!is_character, strcmp("# refused 3: illegal characters", talk_answer(typed)) == 0,
                                  "the words of the refusal");
    }
}

/* So many characters are a command, whose name is the first four; with one more they are a line too long. */
TEST(test_a_line_has_so_many_characters_and_no_more)
{
    talk_start();
    for (int characters = LIMIT_LINE_MAX - 1; characters <= LIMIT_LINE_MAX + 1; characters++) {
        char typed[LIMIT_LINE_MAX + 2];
        memset(typed, '0', sizeof typed);
        memcpy(typed, "tare ", 5);
        typed[characters] = 0;
        TEST_ASSERT_EQUAL_STRING(characters <= LIMIT_LINE_MAX ? "# refused 1: unknown command (type help)"
                                                              : "# refused 2: line too long",
                                 talk_answer(typed));
    }
}

/* The clock of microseconds wraps after 71.6 minutes: 72 are not reported as half a minute. */
TEST(test_an_outage_longer_than_the_wrap_of_the_clock)
{
    talk_start();
    const double minutes_ms = 72.0 * 60e3;
    adxl345_model_power(hal_host_sensor(), false);
    double begun_ms = hal_host_now_ms();
    board_run_ms(minutes_ms);
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(500);
    double reported_ms = 0.0;
    TEST_ASSERT_EQUAL_INT(1, sscanf(board_last_note(), "# fault 1 over: after %lf ms", &reported_ms));
    TEST_ASSERT_TRUE(hal_host_now_ms() - begun_ms > minutes_ms);
    TEST_ASSERT_DOUBLE_WITHIN(1100.0, minutes_ms, reported_ms); /* whole seconds, and the way back */
}

static void run_until_second(uint32_t end_s)
{
    while (counted(COUNT_SECONDS) != end_s) {
        board_run_ms(1.0);
    }
}

/* What the line says of an outage over so many beginnings of a second, from 0.5 s before the first on, ms. */
static double reported_outage_ms(uint32_t seconds)
{
    talk_start();
    run_until_second(2);
    board_run_ms(500);
    adxl345_model_power(hal_host_sensor(), false);
    run_until_second(2 + seconds);
    board_run_ms(200);
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(500);
    double reported_ms = 0.0;
    TEST_ASSERT_EQUAL_INT(1, sscanf(board_last_note(), "# fault 1 over: after %lf ms", &reported_ms));
    return reported_ms;
}

/* To the millisecond, then in whole seconds as they were counted; the way back takes less than 100 ms. */
TEST(test_an_outage_from_a_minute_on_is_in_whole_seconds)
{
    double shorter_ms = reported_outage_ms(LIMIT_OUTAGE_S - 1);
    double since_ms = shorter_ms - 1e3 * (LIMIT_OUTAGE_S - 1) + 500.0; /* the last beginning of a second */
    TEST_ASSERT_TRUE(since_ms >= 200.0 - 30.0 && since_ms <= 300.0);
    TEST_ASSERT_TRUE(fmod(shorter_ms, 1e3) != 0.0);
    for (uint32_t seconds = LIMIT_OUTAGE_S; seconds <= LIMIT_OUTAGE_S + 1; seconds++) {
        TEST_ASSERT_TRUE(reported_outage_ms(seconds) == 1e3 * seconds);
    }
}

/* Whether the LED is lit at a time, by the pattern of fault 1: two flashes of 65.5 ms in 1,049 ms. */
static bool lit_at(uint32_t t_us)
{
    uint32_t in_pattern = t_us % (1u << 20);
    return in_pattern % (1u << 17) < (1u << 16) && in_pattern < 2u << 17;
}

/*
 * Passes that never have time for the service (4 ms apart) hold it up by 20 ms at most: what it shows is what was due
 * at some moment of the last 24 ms.
 */
TEST(test_a_service_without_time_is_late_by_20_ms_at_most)
{
    enum { LATE_US = 24200 };
    talk_start();
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
    hal_host_faults()->lap_step = 13; /* 0.8 ms from look to look: a pass is over before it has begun a piece */
    board_run_ms(30);
    unsigned changes = 0;
    bool was = hal_host_led();
    for (double end_ms = hal_host_now_ms() + 4000.0; hal_host_now_ms() < end_ms;) {
        board_run_ms(0.5);
        uint32_t now_us = hal_time_us();
        bool is = hal_host_led();
        bool was_due = false;
        for (uint32_t ago_us = 0; ago_us <= LATE_US && !was_due; ago_us += 50) {
            was_due = lit_at(now_us - ago_us) == is;
        }
        TEST_ASSERT_TRUE_MESSAGE(was_due, "the LED is late");
        changes += is != was;
        was = is;
    }
    TEST_ASSERT_TRUE(changes >= 4 * 3); /* the pattern was met whole three times */
    TEST_ASSERT_EQUAL_UINT64(0, hal_host_watchdog_bite());
}

/*
 * The sensor goes: the row of the sample that is missing first is half a period and so long out after it was due, and
 * its bytes, 10 us each at 1,000,000 baud.
 */
TEST(test_a_predicted_row_waits_for_a_sample_on_its_way)
{
    talk_start();
    talk_type("baud 1000000");
    board_run_ms(100);
    adxl345_model_power(hal_host_sensor(), false);
    size_t first = board.row_count;
    board_run_ms(100);
    while ((board.rows[first].flags & ROW_COASTED) == 0) {
        first++;
    }
    TEST_ASSERT_TRUE(first < board.row_count);
    double late_us = 1e3 * board.rows[first].at_ms - board.rows[first].t_us - 5000.0;
    TEST_ASSERT_TRUE(late_us >= LIMIT_READ_LATE_US && late_us <= LIMIT_READ_LATE_US + 67 * 10 + 100);
}

/* Watchdog resets in a row, each after so long a run; the rate that follows, 0.1 Hz. */
static uint16_t rate_after_resets(int count, double run_ms)
{
    board_start_resting();
    for (int resets = 0; resets < count; resets++) {
        board_run_ms(run_ms);
        hal_host_reset_mcu(HAL_RESET_WATCHDOG);
        app_start();
    }
    board_run_ms(500);
    return settings()->rate_dhz;
}

TEST(test_the_third_reset_in_a_row_brings_safe_settings)
{
    for (int resets = LIMIT_RESETS_TO_SAFE - 1; resets <= LIMIT_RESETS_TO_SAFE + 1; resets++) {
        TEST_ASSERT_EQUAL_UINT16(resets < LIMIT_RESETS_TO_SAFE ? 1000 : 125, rate_after_resets(resets, 400.0));
    }
}

/*
 * What hangs so often, each time sooner than so long after its start, gets the lowest rate; a run of more than that was
 * a good one.
 */
TEST(test_a_run_of_ten_seconds_counts_as_lasting)
{
    TEST_ASSERT_EQUAL_UINT16(125, rate_after_resets(LIMIT_RESETS_TO_SAFE, 1e3 * LIMIT_SETTLED_S - 300.0));
    TEST_ASSERT_EQUAL_UINT16(1000, rate_after_resets(LIMIT_RESETS_TO_SAFE, 1e3 * LIMIT_SETTLED_S + 300.0));
}

/* x, y and z read the same on a carrier that lies across: all of it comes to one axis, reading x sqrt(3) / 200. */
static int z_mg_of(int16_t lsb)
{
    stream_t stream = board_constant_stream(200, 100.0, lsb, lsb, lsb);
    board_start(&stream, 0.0, 0);
    board_run_ms(300);
    talk_type("scale 200 200 200");
    talk_type("level 0.5774 0.5774 0.5774");
    talk_type("filter {plain}");
    board_run_ms(1000);
    const board_row_t *row = &board.rows[board.row_count - 1];
    TEST_ASSERT_EQUAL_INT(lsb, row->lsb[0]);
    return row->mg[2];
}

/* A row shows up to 32 g, which is 3,695 LSB there; what is more is shown as 32 g, to the rail of 4,095 LSB, 35.5 g. */
TEST(test_a_row_shows_up_to_32_g)
{
    for (int lsb = 3600; lsb <= 4094; lsb += 19) {
        double exact_mg = fmin(32000.0, 1000.0 * lsb * 1.7320508 / 200.0);
        TEST_ASSERT_INT_WITHIN(12, (int)lround(exact_mg), z_mg_of((int16_t)lsb)); /* the matrix is good to 3e-4 */
        TEST_ASSERT_INT_WITHIN(12, (int)-lround(exact_mg), z_mg_of((int16_t)-lsb));
    }
}

/*
 * Samples wait while the line drains for its new rate, and the sensor goes; then another range is asked for. There is
 * nothing to put to rest, but those samples are of the old range: 600 LSB is no rail of theirs.
 */
TEST(test_samples_of_a_sensor_that_went_are_not_clipped_by_the_next_range)
{
    stream_t stream = board_constant_stream(2000, 100.0, 600, 0, 248);
    board_start(&stream, 0.0, 0);
    board_run_ms(300);
    talk_type("baud 9600");
    board_run_ms(500);
    board_type("rate 1"); /* long answers */
    board_type("baud 1");
    board_type("baud 1");
    board_type("baud 115200");
    while (adxl345_queued() < 4) {
        TEST_ASSERT_TRUE(hal_host_now_ms() < 1500.0);
        board_run_ms(1.0);
    }
    size_t first = board.row_count;
    adxl345_model_power(hal_host_sensor(), false);
    (void)talk_typed("range 2", 60);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
    TEST_ASSERT_EQUAL_UINT8(4, adxl345_queued());
    board_run_ms(4000);
    TEST_ASSERT_EQUAL_UINT8(2, settings()->range_g);
    size_t waited = 0;
    for (size_t i = first; i < board.row_count; i++) {
        waited += board.rows[i].lsb[0] == 600 && (board.rows[i].flags & ROW_COASTED) == 0;
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & ROW_CLIPPED);
    }
    TEST_ASSERT_TRUE_MESSAGE(waited > 3, "no sample of the old range met the new one");
}

/*
 * `every 50` counts from the header on, whatever was counted before a reset: the first row is that of the 50th sample.
 */
TEST(test_the_first_row_after_a_header_is_a_whole_every_later)
{
    for (double before_ms = 200.0; before_ms <= 500.0; before_ms += 100.0) {
        talk_start();
        talk_type("every 50");
        talk_type("stop");
        talk_type("save");
        talk_type("go");
        board_run_ms(before_ms);
        size_t rows = board.row_count;
        talk_power_cycle(false);
        size_t header = board.note_count;
        do {
            TEST_ASSERT_TRUE_MESSAGE(header != 0, "no header");
            header--;
        } while (strncmp(board.notes[header], "t_us,", 5) != 0);
        TEST_ASSERT_TRUE(board.row_count > rows);
        double after_ms = board.rows[rows].at_ms - board.note_ms[header];
        TEST_ASSERT_DOUBLE_WITHIN(30.0, 500.0, after_ms); /* three samples wait while the banner is printed */
    }
}
