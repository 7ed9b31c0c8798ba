/* The whole firmware while its line changes: what waits is kept, and replies never cost a row. */
#include <stdio.h>

#include "rows.h"
#include "settings.h"
#include "support_board.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* Typed ahead, before the line has drained and changed: they wait in the receive ring and are obeyed afterwards. */
static void test_lines_behind_a_change_of_baud_are_obeyed(void)
{
    board_start_resting();
    board_run_ms(200);
    size_t before = board.note_count;
    board_type("baud 500000");
    board_type("every 3");
    board_type("range 4");
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(before + 3, board.note_count);
    TEST_ASSERT_EQUAL_STRING("# baud 500000", board.notes[before]);
    TEST_ASSERT_EQUAL_STRING("# every 3", board.notes[before + 1]);
    TEST_ASSERT_EQUAL_STRING("# range 4 g, 256 LSB per g", board.notes[before + 2]);
    TEST_ASSERT_EQUAL_UINT32(500000, hal_host_baud());
    TEST_ASSERT_EQUAL_UINT(4, settings.range_g);
}

/* 160 rows of 72 bytes a second fill 115200 baud; here 100 a second do, and help and status are asked for all the time. */
static void test_replies_never_push_a_row_out(void)
{
    stream_t wide = board_constant_stream(1000, 100.0, -4096, -4095, -4094);
    board_start(&wide, 0.0, 4200000000u);
    board_run_ms(300);
    for (int i = 0; i < 40; i++) {
        board_type("help");
        board_type("status");
        board_run_ms(100);
    }
    TEST_ASSERT_TRUE(board_notes_with("# stop, go, status, help", 0) >= 30);
    TEST_ASSERT_EQUAL_UINT16(0, rows_dropped());
    TEST_ASSERT_TRUE(board.row_count + 2 >= board.latched_count);
    for (size_t i = 1; i < board.row_count; i++) {
        TEST_ASSERT_UINT32_WITHIN(2, 10000, board.rows[i].t_us - board.rows[i - 1].t_us);
    }
    stream_free(&wide);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lines_behind_a_change_of_baud_are_obeyed);
    RUN_TEST(test_replies_never_push_a_row_out);
    return UNITY_END();
}
