/* The whole firmware while its line changes: what waits is kept, and replies never cost a row. */

#include "base/counters.h"
#include "settings/settings.h"
#include "support/talk.h"
#include "support/test.h"

/* Virtual milliseconds until the notes have become so many. */
static void run_until_notes(size_t count)
{
    double end_ms = hal_host_now_ms() + 300.0;
    while (board.note_count < count && hal_host_now_ms() < end_ms) {
        board_run_ms(0.01);
    }
    TEST_ASSERT_EQUAL_size_t(count, board.note_count);
}

/*
 * Typed ahead, before the line has drained and changed: they wait in the receive ring, are obeyed and answered
 * afterwards.
 */
TEST(test_lines_behind_a_change_of_baud_are_obeyed)
{
    talk_start();
    size_t before = board.note_count;
    board_type("baud 500000");
    board_type("every 3");
    board_type("range 4");
    run_until_notes(before + 1);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(115200, hal_host_baud(), "told at the old speed");
    run_until_notes(before + 2);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(500000, hal_host_baud(), "the line behind is answered at the new one");
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(before + 3, board.note_count);
    TEST_ASSERT_EQUAL_STRING("# baud 500000", board.notes[before]);
    TEST_ASSERT_EQUAL_STRING("# every 3", board.notes[before + 1]);
    TEST_ASSERT_EQUAL_STRING("# range 4 g", board.notes[before + 2]);
    TEST_ASSERT_EQUAL_UINT(4, settings()->range_g);
}

/*
 * Long replies, for which rows are not held, asked for again when they have come, for so many times, at another phase
 * of the rows each time.
 */
static void ask_all_the_time(size_t times)
{
    for (size_t i = 1; i <= times; i++) {
        double end_ms = hal_host_now_ms() + 30e3;
        board_type("baud 1");
        board_type("rate 1");
        board_type("axes 1");
        while (board_notes_with("# refused 4: axes", 0) < i && hal_host_now_ms() < end_ms) {
            board_run_ms(1.0);
        }
        board_run_ms(0.37 * (double)(i % 28U));
        TEST_ASSERT_TRUE_MESSAGE(hal_host_now_ms() < end_ms, "no answer in half a minute");
    }
}

/*
 * The widest rows, as many as the line carries: 900 of 960 bytes a second, 3,600 of 3,840, 7,200 of 11,520. Replies
 * take what is left, and not a row is missing or late to the ring.
 */
TEST(test_replies_never_push_a_row_out)
{
    static const struct {
        const char *rate, *baud;
        uint32_t period_us;
        size_t times;
    } lines[] = { { "rate 12.5", "baud 9600", 80000, 30 },
                  { "rate 50", "baud 38400", 20000, 60 },
                  { "rate 100", "baud 115200", 10000, 120 } };
    stream_t wide = board_constant_stream(1000, 100.0, -4096, -4095, -4094);
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        board_start(&wide, 0.0, 4000000000u);
        board_run_ms(300);
        board_type(lines[i].rate);
        (void)talk_typed(lines[i].baud, 1500);
        size_t first = board.row_count;
        ask_all_the_time(lines[i].times);
        TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_DROPPED));
        TEST_ASSERT_TRUE(board.row_count > first + 100);
        for (size_t row = first + 1; row < board.row_count; row++) {
            uint32_t step_us = board.rows[row].t_us - board.rows[row - 1].t_us;
            TEST_ASSERT_UINT32_WITHIN(2, lines[i].period_us, step_us);
        }
    }
}
