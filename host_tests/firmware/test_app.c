/* The whole firmware on the host's HAL: protocol, commands, faults, watchdog stages, baud and rate changes. */
#include <stdio.h>

#include "app/app.h"
#include "base/hang_test.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/roles.h"
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

static void assert_every_latched_sample_has_its_row(size_t allowed_pending)
{
    TEST_ASSERT_TRUE(board.row_count <= board.latched_count);
    TEST_ASSERT_TRUE(board.latched_count - board.row_count <= allowed_pending);
    for (size_t i = 0; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_INT(board.latched_lsb[i][0], board.rows[i].lsb[0]);
        TEST_ASSERT_EQUAL_INT(board.latched_lsb[i][1], board.rows[i].lsb[1]);
        TEST_ASSERT_EQUAL_INT(board.latched_lsb[i][2], board.rows[i].lsb[2]);
    }
}

TEST(test_banner_then_header_then_rows)
{
    board_start_resting();
    board_run_ms(1000);
    TEST_ASSERT_EQUAL_STRING_LEN("# tilt-uno ", board.notes[0], 11);
    TEST_ASSERT_EQUAL_STRING("# reset: power on", board.notes[1]);
    TEST_ASSERT_EQUAL_STRING(by_role("# filter {default}, rate 100 Hz, range 16 g, every 1, baud 115200"),
                             board.notes[2]);
    TEST_ASSERT_EQUAL_STRING("# settings: defaults, none saved", board.notes[3]);
    TEST_ASSERT_EQUAL_STRING("# sensor: ADXL345 at 0x53, I2C at 363.6 kHz", board.notes[5]);
    TEST_ASSERT_EQUAL_STRING("t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags", board.notes[6]);
    TEST_ASSERT_EQUAL_size_t(7, board.note_count);
    assert_every_latched_sample_has_its_row(1);
    TEST_ASSERT_INT_WITHIN(6, 98, (int)board.row_count);
}

TEST(test_first_five_rows_warm_up)
{
    talk_start();
    for (size_t i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT(i < LIMIT_WARM_ROWS ? ROW_WARMING_UP : 0, board.rows[i].flags & ROW_WARMING_UP);
    }
}

/* (31, -53, 248) LSB: 117, -200, 969 mg; roll atan2(-200, 969) = -11.66, pitch atan2(-117, 989) = -6.74 degrees. */
TEST(test_values_of_a_resting_board)
{
    stream_t still = board_constant_stream(200, 100.0, 31, -53, 248);
    board_start(&still, 0.0, 0);
    board_run_ms(500);
    const board_row_t *row = &board.rows[20];
    TEST_ASSERT_EQUAL_INT(117, row->mg[0]);
    TEST_ASSERT_EQUAL_INT(-200, row->mg[1]);
    TEST_ASSERT_EQUAL_INT(969, row->mg[2]);
    TEST_ASSERT_INT_WITHIN(6, -1166, row->roll_cdeg);
    TEST_ASSERT_INT_WITHIN(6, -674, row->pitch_cdeg);
    TEST_ASSERT_EQUAL_UINT(ROW_STUCK, row->flags);
}

TEST(test_clock_wrap_is_seamless)
{
    stream_t noisy = board_noisy_stream(1000, 100.0, 1.5, 3u);
    board_start(&noisy, 0.0, 0xFFFFFFFFu - 5000000u);
    board_run_ms(10000);
    for (size_t i = 1; i < board.row_count; i++) {
        TEST_ASSERT_UINT32_WITHIN(2, 10000, board.rows[i].t_us - board.rows[i - 1].t_us);
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_COASTED | ROW_FAULT | ROW_DROPPED));
    }
    TEST_ASSERT_TRUE(board.row_count > 990);
}

TEST(test_settings_show_and_set)
{
    static const struct {
        const char *typed, *answer;
    } talk[] = { { "filter", "# filter {default}" },
                 { "filter {plain}", "# filter {plain}" },
                 { "FILTER  {robust} ", "# filter {robust}" },
                 { "rate", "# rate 100 Hz, I2C at 363.6 kHz" },
                 { "rate 50", "# rate 50 Hz, I2C at 363.6 kHz" },
                 { "rate 12.5", "# rate 12.5 Hz, I2C at 363.6 kHz" },
                 { "rate 100", "# rate 100 Hz, I2C at 363.6 kHz" },
                 { "range 4", "# range 4 g" },
                 { "every 3", "# every 3" },
                 { "every", "# every 3" },
                 { "mode", "# mode csv" },
                 { "baud", "# baud 115200" },
                 { "stop", "# stopped" },
                 { "go", "# going" } };
    talk_start();
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        TEST_ASSERT_EQUAL_STRING(by_role(talk[i].answer), talk_answer(talk[i].typed));
    }
}

TEST(test_refusals_name_the_legal_values)
{
    static const struct {
        const char *typed, *answer;
    } talk[] = { { "rate 60", "# refused 4: rate is one of 12.5 25 50 100 200 400 800" },
                 { "rate 1600", "# refused 4: rate is one of 12.5 25 50 100 200 400 800" },
                 { "rate 100.55", "# refused 4: rate is one of 12.5 25 50 100 200 400 800" },
                 { "rate -100", "# refused 4: rate is one of 12.5 25 50 100 200 400 800" },
                 { "rate 99999999999", "# refused 4: rate is one of 12.5 25 50 100 200 400 800" },
                 { "range 3", "# refused 4: range is one of 2 4 8 16" },
                 { "range 258", "# refused 4: range is one of 2 4 8 16" },
                 { "every 0", "# refused 4: every is one of 1 to 10000" },
                 { "every 10001", "# refused 4: every is one of 1 to 10000" },
                 { "every 65537", "# refused 4: every is one of 1 to 10000" },
                 { "every 1.5", "# refused 4: every is one of 1 to 10000" },
                 { "baud 12345", "# refused 4: baud is one of 9600 19200 38400 57600 115200 250000 500000 1000000" },
                 { "mode xml", "# refused 4: mode is one of csv plot" },
                 { "hello", "# refused 1: unknown command (type help)" },
                 { "stop now", "# refused 1: unknown command (type help)" } };
    talk_start();
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        TEST_ASSERT_EQUAL_STRING(by_role(talk[i].answer), talk_answer(talk[i].typed));
    }
    assert_every_latched_sample_has_its_row(1);
}

TEST(test_line_ends_and_blank_lines)
{
    talk_start();
    size_t before = board.note_count;
    hal_host_type("every 2\revery 3\r\n\n\r\n  \nevery 4\n");
    board_run_ms(200);
    TEST_ASSERT_EQUAL_size_t(before + 3, board.note_count);
    TEST_ASSERT_EQUAL_STRING("# every 2", board.notes[before]);
    TEST_ASSERT_EQUAL_STRING("# every 4", board.notes[before + 2]);
}

TEST(test_garbage_and_long_lines_are_refused_whole)
{
    talk_start();
    size_t before = talk_typed("rate 400 and then a great deal more than any command has", 100);
    TEST_ASSERT_EQUAL_STRING("# refused 2: line too long", board.notes[before]);
    (void)talk_typed("ra\x01te 400", 100);
    TEST_ASSERT_EQUAL_STRING("# refused 3: illegal characters", board.notes[before + 1]);
    TEST_ASSERT_EQUAL_UINT(1000, settings()->rate_dhz);
    assert_every_latched_sample_has_its_row(1);
    (void)talk_typed("status", 300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("lines refused 2", before));
}

TEST(test_flood_of_garbage_costs_no_row)
{
    talk_start();
    for (int i = 0; i < 60; i++) {
        hal_host_type("\x02\xFFzzzz help help help help help help help help help ~\x7F");
    }
    board_run_ms(1500);
    assert_every_latched_sample_has_its_row(1);
    TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
}

TEST(test_help_lists_every_command)
{
    static const char *const words[] = { "filter", "rate", "range", "every",  "baud",
                                         "mode",   "stop", "go",    "status", "help" };
    talk_start();
    size_t before = talk_typed("help", 500);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(board_notes_with(words[i], before) > 0, words[i]);
    }
}

/* 1152 rows a second is what 115200 baud would carry of 10-byte rows; of 67-byte rows 171. */
TEST(test_every_follows_what_the_line_carries)
{
    TEST_ASSERT_EQUAL_UINT16(1, settings_smallest_every(115200, 1000));
    TEST_ASSERT_EQUAL_UINT16(2, settings_smallest_every(115200, 2000));
    TEST_ASSERT_EQUAL_UINT16(3, settings_smallest_every(115200, 4000));
    TEST_ASSERT_EQUAL_UINT16(5, settings_smallest_every(115200, 8000));
    TEST_ASSERT_EQUAL_UINT16(1, settings_smallest_every(500000, 4000));
    TEST_ASSERT_EQUAL_UINT16(2, settings_smallest_every(500000, 8000));
    TEST_ASSERT_EQUAL_UINT16(1, settings_smallest_every(1000000, 8000));
    TEST_ASSERT_EQUAL_UINT16(60, settings_smallest_every(9600, 8000));
    TEST_ASSERT_EQUAL_UINT16(1, settings_smallest_every(1000u * LIMIT_ROW_BYTES, 1000)); /* ten bits a byte */
    TEST_ASSERT_EQUAL_UINT16(2, settings_smallest_every(1000u * LIMIT_ROW_BYTES - 1u, 1000));
    talk_start();
    size_t before = talk_typed("rate 400", 200);
    TEST_ASSERT_EQUAL_STRING("# every 3: the least for this baud rate", board.notes[before + 1]);
}

TEST(test_800_hz_says_its_bus_speed)
{
    talk_start();
    size_t before = talk_typed("rate 800", 200);
    TEST_ASSERT_EQUAL_STRING("# rate 800 Hz, I2C at 400 kHz", board.notes[before]);
}

TEST(test_baud_change_loses_nothing)
{
    talk_start();
    (void)talk_typed("baud 500000", 500);
    TEST_ASSERT_EQUAL_UINT32(500000, hal_host_baud());
    TEST_ASSERT_EQUAL_STRING("# baud 500000", board_last_note());
    (void)talk_typed("baud 9600", 2000);
    TEST_ASSERT_EQUAL_UINT32(9600, hal_host_baud());
    TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
}

TEST(test_every_thins_rows_and_keeps_flags)
{
    stream_t still = board_constant_stream(1000, 100.0, 0, 0, 256);
    still.rows[104].lsb[2] = 4095;
    board_start(&still, 0.0, 0);
    board_run_ms(150);
    (void)talk_typed("every 10", 3000);
    size_t clipped = 0;
    for (size_t i = 0; i < board.row_count; i++) {
        clipped += (board.rows[i].flags & ROW_CLIPPED) != 0;
    }
    TEST_ASSERT_EQUAL_size_t(1, clipped);
    TEST_ASSERT_INT_WITHIN(4, 12 + 30, (int)board.row_count);
}

/* 9600 baud carries a short row in 40 ms; `every` forced, it fits, so fill the ring by hand: the line stands still. */
TEST(test_rows_without_room_are_dropped_whole_and_told)
{
    board_start_resting();
    board_run_ms(500);
    hal_host_faults()->tx_stuck = true;
    board_run_ms(150);
    hal_host_faults()->tx_stuck = false;
    board_run_ms(500);
    size_t marked = 0;
    for (size_t i = 0; i < board.row_count; i++) {
        marked += (board.rows[i].flags & ROW_DROPPED) != 0;
    }
    TEST_ASSERT_EQUAL_size_t(1, marked);
    TEST_ASSERT_TRUE(board.row_count < board.latched_count);
    size_t missing = 0;
    for (size_t i = 1; i < board.row_count; i++) {
        uint32_t step_us = board.rows[i].t_us - board.rows[i - 1].t_us;
        missing += (step_us + 5000u) / 10000u - 1u;
    }
    size_t before = talk_typed("status", 300);
    char told[32];
    snprintf(told, sizeof told, "dropped %u,", (unsigned)missing);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(told, before));
}

TEST(test_plot_mode_is_labels_only)
{
    talk_start();
    (void)talk_typed("mode plot", 300);
    size_t plot_rows = 0;
    for (size_t i = 0; i < board.note_count; i++) {
        float raw_roll, roll, raw_pitch, pitch;
        int gated;
        plot_rows += sscanf(board.notes[i], "roll_raw:%f,roll:%f,pitch_raw:%f,pitch:%f,gated:%d", &raw_roll, &roll,
                            &raw_pitch, &pitch, &gated) == 5;
    }
    TEST_ASSERT_INT_WITHIN(3, 29, (int)plot_rows);
    size_t before = board.note_count;
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("#", before));
    (void)talk_typed("mode csv", 300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("t_us,x_lsb", before));
}

/*
 * A change of filter or rate: no latched sample without its row, five rows marked, the estimate goes on from where it
 * was.
 */
static void change_and_check(const char *command)
{
    size_t rows_before = board.row_count;
    (void)talk_typed(command, 120);
    size_t warm = 0;
    for (size_t i = rows_before; i < board.row_count; i++) {
        warm += (board.rows[i].flags & ROW_WARMING_UP) != 0;
        TEST_ASSERT_INT_WITHIN(150, -1206, board.rows[i].roll_cdeg);
    }
    TEST_ASSERT_EQUAL_size_t(5, warm);
}

TEST(test_changes_at_every_phase_lose_nothing)
{
    static const char *const commands[] = { "filter {plain}", "rate 200", "filter {robust}",
                                            "rate 100",       "range 4",  "range 16" };
    talk_start();
    (void)talk_typed("baud 500000", 100);
    for (unsigned i = 0; i < 120; i++) {
        board_run_ms(10.0 + (double)i * 0.117);
        change_and_check(commands[i % 6]);
    }
    (void)talk_typed("stop", 100);
    assert_every_latched_sample_has_its_row(0);
    for (size_t i = 1; i < board.row_count; i++) {
        TEST_ASSERT_TRUE((int32_t)(board.rows[i].t_us - board.rows[i - 1].t_us) > 0);
    }
}

/* A byte lost to a framing error or a full ring makes its line garbage: "every 1000" must not become "every 100". */
TEST(test_a_line_with_a_lost_byte_is_refused)
{
    talk_start();
    hal_host_faults()->corrupt_rx_every = 9;
    (void)talk_typed("every 1000", 100);
    hal_host_faults()->corrupt_rx_every = 0;
    TEST_ASSERT_EQUAL_UINT(1, settings()->every);
    TEST_ASSERT_EQUAL_STRING("# refused 3: illegal characters", board_last_note());
}

/* The slowest line with the widest plot rows still answers and still obeys. */
TEST(test_plot_mode_on_a_slow_line_answers)
{
    stream_t wide = board_constant_stream(1000, 100.0, 190, -95, -141);
    board_start(&wide, 0.0, 0);
    board_run_ms(300);
    (void)talk_typed("baud 9600", 500);
    (void)talk_typed("mode plot", 3000);
    for (int i = 0; i < 9; i++) {
        board_type("status");
    }
    board_run_ms(20000);
    size_t before = talk_typed("mode csv", 90000);
    TEST_ASSERT_EQUAL_UINT(MODE_CSV, settings()->mode);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("t_us,x_lsb", before));
}

TEST(test_stop_is_not_undone_by_a_change_that_follows)
{
    board_start_resting();
    board_run_ms(500);
    board_type("stop");
    (void)talk_typed("rate 50", 500);
    size_t rows = board.row_count;
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(rows, board.row_count);
}

/* Readings alternate by +-6 LSB about 248: begun anew, a filter would put out the first of them, 23 mg off. */
TEST(test_change_of_filter_goes_on_from_the_old_output)
{
    stream_t alternating = board_constant_stream(1000, 100.0, 0, 0, 248);
    for (size_t i = 0; i < alternating.count; i++) {
        alternating.rows[i].lsb[2] = (int16_t)(248 + ((i & 1u) ? 6 : -6));
    }
    board_start(&alternating, 0.0, 0);
    (void)talk_typed("filter {plain}", 3000);
    size_t before = board.row_count;
    (void)talk_typed("filter {robust}", 100);
    for (size_t i = before; i < board.row_count; i++) {
        TEST_ASSERT_INT_WITHIN(14, 969, board.rows[i].mg[2]);
    }
    TEST_ASSERT_TRUE(board.row_count > before + 5);
}
