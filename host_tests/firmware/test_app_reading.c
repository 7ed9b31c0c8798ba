/* What makes the console one for a person: rows wait while he reads, and the answers say what he needs next. */

#include "app/app.h"
#include "base/counters.h"
#include "output/rows.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/roles.h"
#include "support/talk.h"
#include "support/test.h"

/* After the last line of a long answer no row for so long; the next has the flag, and those in between are counted. */
static void assert_rows_wait(const char *command)
{
    talk_start();
    size_t note = talk_typed(command, 6000);
    TEST_ASSERT_TRUE_MESSAGE(board.note_count > note, command);
    double last_ms = board.note_ms[board.note_count - 1];
    size_t next = board.row_count;
    while (board.rows[next - 1].at_ms > last_ms) {
        next--;
    }
    TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(80.0, 1e3 * LIMIT_HELD_S, board.rows[next].at_ms - last_ms, command);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(ROW_DROPPED, board.rows[next].flags & ROW_DROPPED, command);
    uint32_t missing = (board.rows[next].t_us - board.rows[next - 1].t_us + 5000u) / 10000u - 1u;
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(missing, counted(COUNT_HELD), command);
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_DROPPED));
    for (size_t i = next + 1; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_DROPPED | ROW_WARMING_UP | ROW_COASTED));
    }
}

TEST(test_rows_wait_while_a_long_answer_is_read)
{
    assert_rows_wait("help");
    assert_rows_wait("settings");
    assert_rows_wait("status");
    assert_rows_wait("?");
}

/* From the answer, not from what was typed, by the samples' time in steps of 65.536 ms: to the one that is nearest. */
TEST(test_rows_are_held_to_the_nearest_step)
{
    enum { STEP_US = 65536, STEPS = (1000000 * LIMIT_HELD_S + STEP_US / 2) / STEP_US };
    for (uint32_t steps = STEPS - 1; steps <= STEPS + 1; steps++) {
        talk_start();
        (void)talk_typed("rate", 1000);
        uint32_t from_us = pipeline_newest_us();
        rows_hold();
        pipeline_coast(from_us + steps * STEP_US);
        pipeline_finish();
        uint32_t held = counted(COUNT_HELD);
        rows_sample(1, false);
        TEST_ASSERT_EQUAL_UINT32(steps < STEPS ? held + 1u : held, counted(COUNT_HELD));
    }
}

/* Samples are filtered meanwhile: the first row afterwards is where a filter that went on is. */
TEST(test_filters_go_on_meanwhile)
{
    talk_start();
    uint32_t before = counted(COUNT_SAMPLES);
    (void)talk_typed("help", 1500);
    TEST_ASSERT_UINT32_WITHIN(2, before + 150u, counted(COUNT_SAMPLES));
}

TEST(test_short_answers_and_a_reset_hold_no_row)
{
    talk_start();
    board_type("rate");
    board_type("version");
    (void)talk_typed("nonsense", 1000);
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_HELD));
}

/* Who types on has read it: Enter alone, too. */
TEST(test_the_next_line_lets_rows_go_on)
{
    static const char *const lines[] = { "", "rate" };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        talk_start();
        (void)talk_typed("status", 500);
        double typed_ms = hal_host_now_ms();
        size_t rows = board.row_count;
        (void)talk_typed(lines[i], 300);
        TEST_ASSERT_TRUE(board.row_count > rows + 25);
        TEST_ASSERT_TRUE(board.rows[rows].at_ms - typed_ms < 30.0);
    }
}

TEST(test_a_plot_goes_on)
{
    talk_start();
    talk_type("mode plot");
    (void)talk_typed("help", 3000);
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_HELD));
}

TEST(test_the_filter_in_force_keeps_its_parameters)
{
    talk_start();
    talk_type("filter {robust}");
    talk_type("gate 5");
    size_t first = board.row_count;
    TEST_ASSERT_EQUAL_STRING(by_role("# filter {robust}"), talk_answer("filter {robust}"));
    TEST_ASSERT_EQUAL_STRING("# gate 5 sigma: 1 to 16, 0: off", talk_answer("gate"));
    board_run_ms(300);
    for (size_t i = first; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & ROW_WARMING_UP);
    }
    talk_type("filter {plain}");
    talk_type("filter {robust}");
    TEST_ASSERT_EQUAL_STRING("# gate 3 sigma: 1 to 16, 0: off", talk_answer("gate"));
}

/* A parameter typed as it was before its filter was left is no unchanged one: the filter gets it. */
TEST(test_a_parameter_typed_again_after_another_filter_counts)
{
    talk_start();
    talk_type("filter {robust}");
    talk_type("gate 4.5");
    talk_type("filter {plain}");
    talk_type("filter {robust}");
    TEST_ASSERT_EQUAL_STRING("# gate 4.5 sigma: 1 to 16, 0: off", talk_answer("gate 4.5"));
    board_run_ms(300);
    TEST_ASSERT_EQUAL_UINT(4 * 256 + 128, pipeline_axes()[1].filter.own.kalman.of.gated.gate_sigma_q8);
}

/* Long answers first: a change of the line's rate behind them stops the filters for the last one at most. */
TEST(test_a_change_of_baud_behind_long_answers_resets_nothing)
{
    static const char *const lines[] = { "help", "status" };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        talk_start();
        talk_type("baud 9600");
        board_run_ms(500);
        for (int k = 0; k < 4; k++) {
            board_type(lines[i]);
        }
        (void)talk_typed("baud 19200", 12000);
        TEST_ASSERT_EQUAL_UINT(0, (unsigned)hal_host_watchdog_bite());
        TEST_ASSERT_EQUAL_UINT32(19200, settings()->baud);
    }
}

TEST(test_help_lists_the_parameters_of_the_filter_in_force)
{
    talk_start();
    talk_type("filter {robust}");
    size_t before = talk_typed("help", 1000);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# gate: 1 to 16, 0: off", before));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# b0", before));
    talk_type("filter {default}");
    before = talk_typed("help", 1000);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# gate:", before));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# every: 1 to 10000", before));
}

TEST(test_the_version_is_said)
{
    talk_start();
    TEST_ASSERT_EQUAL_STRING(board.notes[0], talk_answer("version"));
    TEST_ASSERT_EQUAL_STRING_LEN("# tilt-uno ", board.notes[0], 11);
}
