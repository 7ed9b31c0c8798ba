/*
 * A main loop that is out of time after each piece of work does the same as one that has time for all: a sample, a row,
 * a reply, an axis of a change of filter a pass, each pass followed at once by the next.
 */

#include "support/talk.h"
#include "support/test.h"

enum { SLOW = 2 }; /* counts a look: the third comes too late */

static stream_t stream;
static board_t quick;

void setUp(void)
{
    stream = board_noisy_stream(500, 100.0, 1.5, 11u);
}

static void run(uint8_t lap_step, const char *const *lines, size_t count)
{
    board_start(&stream, 0.0, 0);
    board_run_ms(300.0); /* the sensor's clock is the same in all runs */
    hal_host_faults()->lap_step = lap_step;
    for (size_t i = 0; i < count; i++) {
        (void)talk_typed(lines[i], 400.0);
    }
    board_run_ms(3000.0); /* rows are held for a person who reads */
}

/* Rows, times of rows and notes of the board are those of `quick`; the sensor may start an access later. */
static void assert_same(void)
{
    TEST_ASSERT_GREATER_THAN_UINT(50, quick.row_count);
    TEST_ASSERT_EQUAL_UINT(quick.row_count, board.row_count);
    uint32_t later_us = board.rows[0].t_us - quick.rows[0].t_us;
    TEST_ASSERT_LESS_THAN_UINT32(500, later_us);
    for (size_t i = 0; i < quick.row_count; i++) {
        const board_row_t *a = &quick.rows[i];
        const board_row_t *b = &board.rows[i];
        TEST_ASSERT_EQUAL_UINT32(a->t_us + later_us, b->t_us);
        TEST_ASSERT_EQUAL_INT_ARRAY(a->lsb, b->lsb, 3);
        TEST_ASSERT_EQUAL_INT_ARRAY(a->mg, b->mg, 3);
        TEST_ASSERT_EQUAL_INT(a->roll_cdeg, b->roll_cdeg);
        TEST_ASSERT_EQUAL_INT(a->pitch_cdeg, b->pitch_cdeg);
        TEST_ASSERT_EQUAL_HEX(a->flags, b->flags);
        TEST_ASSERT_TRUE_MESSAGE(b->at_ms - a->at_ms < 12.0, "the row comes late"); /* a line goes first */
    }
    TEST_ASSERT_EQUAL_UINT(quick.note_count, board.note_count);
    for (size_t i = 0; i < quick.note_count; i++) {
        TEST_ASSERT_EQUAL_STRING(quick.notes[i], board.notes[i]);
        TEST_ASSERT_TRUE_MESSAGE(board.note_ms[i] - quick.note_ms[i] < 6.0, "the note comes late");
    }
}

TEST(test_samples_and_replies_in_pieces)
{
    static const char *const lines[] = { "help", "status", "every 2", "nonsense" };
    run(0, lines, 3);
    quick = board;
    run(SLOW, lines, 3);
    assert_same();
}

/* The filters go on from the same output; which sample meets the new ones first is the same at 100 Hz. */
TEST(test_changes_in_pieces)
{
    static const char *const lines[] = { "filter {robust}", "filter {plain}", "filter {light}", "filter {default}" };
    run(0, lines, 4);
    quick = board;
    run(SLOW, lines, 4);
    assert_same();
}

/* A line that is being spoken tells of one rate, not of the next one's bus. */
TEST(test_a_command_waits_for_the_line_before)
{
    board_start(&stream, 0.0, 0);
    board_run_ms(300.0);
    board_type("baud 1000000"); /* so that the second is there before the first is answered */
    board_run_ms(100.0);
    hal_host_faults()->lap_step = SLOW;
    size_t before = board.note_count;
    hal_host_type("rate\nrate 800\n");
    board_run_ms(400.0);
    TEST_ASSERT_EQUAL_STRING("# rate 100 Hz, I2C at 363.6 kHz", board.notes[before]);
    TEST_ASSERT_EQUAL_STRING("# rate 800 Hz, I2C at 400 kHz", board.notes[before + 1]);
}
