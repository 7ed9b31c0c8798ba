/* The numbers of an outage in the line that tells its end, at once or late. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "adxl345.h"
#include "base/counters.h"
#include "base/notices.h"
#include "path/pipeline.h"
#include "support/talk.h"
#include "support/test.h"

/* What a line says of an outage that is over. */
typedef struct {
    unsigned code, lost, address;
    double ms;
} told_t;

static told_t told_by(size_t note)
{
    static const char words[] = "# fault %u over: after %lf ms, %u lost, sensor at 0x%x";
    told_t told;
    TEST_ASSERT_EQUAL_INT(4, sscanf(board.notes[note], words, &told.code, &told.ms, &told.lost, &told.address));
    return told;
}

/* The next note of a fault. */
static size_t next_fault_note(size_t from)
{
    while (from < board.note_count && strncmp(board.notes[from], "# fault", 7) != 0) {
        from++;
    }
    TEST_ASSERT_TRUE(from < board.note_count);
    return from;
}

/* An outage as it was: what was done, and when the driver saw it. */
typedef struct {
    double off_ms, seen_ms, over_ms;
    double there_ms; /* meanwhile, for a moment */
    unsigned address;
} outage_t;

static double wait_for_fault(bool fault)
{
    for (int ms = 0; (adxl345_fault() != ADXL345_FAULT_NONE) != fault; ms++) {
        TEST_ASSERT_TRUE(ms < 200);
        board_run_ms(1.0);
    }
    return hal_host_now_ms();
}

static void take_away(outage_t *was, double ms)
{
    was->there_ms = 0.0;
    was->off_ms = hal_host_now_ms();
    adxl345_model_power(hal_host_sensor(), false);
    was->seen_ms = wait_for_fault(true);
    board_run_ms(ms);
}

static void give_back(outage_t *was)
{
    was->address = hal_host_sensor()->address;
    adxl345_model_power(hal_host_sensor(), true);
    was->over_ms = wait_for_fault(false);
    board_run_ms(200);
}

/*
 * Of the length in periods up to two more than are lost: the sample that ends an outage is not, and the last one before
 * it came up to a period earlier; the moments are a millisecond late at most. Twice, where two outages are one.
 */
static void assert_told_as_it_was(const outage_t *was, size_t note)
{
    told_t told = told_by(note);
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_NO_SENSOR, told.code);
    TEST_ASSERT_DOUBLE_WITHIN(20.0, was->over_ms - was->seen_ms, told.ms);
    TEST_ASSERT_DOUBLE_WITHIN(4.4, (was->over_ms - was->off_ms - was->there_ms) / 10.0, told.lost);
    TEST_ASSERT_EQUAL_HEX(was->address, told.address);
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
    told_t told = told_by(board.note_count - 1);
    TEST_ASSERT_EQUAL_UINT(missing_after(row), told.lost);
    TEST_ASSERT_DOUBLE_WITHIN(tolerance_ms, board.note_ms[board.note_count - 1] - board.note_ms[note], told.ms);
    TEST_ASSERT_EQUAL_UINT32(told.lost, counted(COUNT_LOST));
}

TEST(test_end_of_a_fault_tells_its_length_and_the_samples_lost)
{
    static const double lengths_ms[] = { 60, 333, 2000, 58000, 90000 };
    for (size_t i = 0; i < sizeof lengths_ms / sizeof lengths_ms[0]; i++) {
        board_start_resting();
        board_run_ms(3500);
        size_t note = board.note_count;
        size_t row = board.row_count;
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(lengths_ms[i]);
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(500);
        assert_outage_is_told(note, row, lengths_ms[i] < 59000 ? 20.0 : 1100.0);
    }
}

/* The second outage tells of itself alone. */
TEST(test_each_outage_begins_anew)
{
    board_start_resting();
    board_run_ms(500);
    unsigned lost[2];
    for (unsigned i = 0; i < 2; i++) {
        size_t row = board.row_count;
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(i == 0 ? 700 : 300);
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(500);
        lost[i] = told_by(board.note_count - 1).lost;
        TEST_ASSERT_EQUAL_UINT(missing_after(row), lost[i]);
    }
    TEST_ASSERT_TRUE(lost[1] < lost[0]);
    TEST_ASSERT_EQUAL_UINT32(lost[0] + lost[1], counted(COUNT_LOST));
}

/* As many replies wait as there is room for, and the line stands still. */
static void fill_replies(void)
{
    hal_host_faults()->tx_stuck = true;
    for (int i = 0; i < 12; i++) {
        board_type("odr");
    }
    board_run_ms(20);
    TEST_ASSERT_FALSE(notices_room());
}

TEST(test_a_fault_for_which_there_is_no_room_is_told_later)
{
    board_start_resting();
    board_run_ms(500);
    for (int ends = 0; ends <= 1; ends++) {
        const char *words = ends ? "# fault 1 over" : "# fault 1: ";
        fill_replies();
        adxl345_model_power(hal_host_sensor(), ends);
        board_run_ms(150);
        TEST_ASSERT_EQUAL(ends ? ADXL345_FAULT_NONE : ADXL345_FAULT_NO_SENSOR, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with(words, 0));
        hal_host_faults()->tx_stuck = false;
        board_run_ms(2000);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(words, 0));
    }
    TEST_ASSERT_EQUAL_UINT64(0, hal_host_watchdog_bite());
}

/* What is told is when it was seen, not when there was room for its line. */
TEST(test_a_fault_that_begins_while_there_is_no_room_is_as_long_as_it_was)
{
    outage_t was;
    board_start_resting();
    board_run_ms(1000);
    fill_replies();
    size_t before = board.note_count;
    take_away(&was, 150);
    hal_host_faults()->tx_stuck = false;
    board_run_ms(1850);
    give_back(&was);
    assert_told_as_it_was(&was, next_fault_note(next_fault_note(before) + 1));
}

/*
 * While a slow line carries a text one fault ends and another one passes, and another sensor comes: each is told with
 * its own numbers.
 */
TEST(test_the_end_of_a_fault_keeps_its_numbers_until_it_is_told)
{
    outage_t was[2];
    board_start_resting();
    (void)talk_typed("baud 9600", 1000);
    size_t before = board.note_count;
    take_away(&was[0], 500);
    for (int i = 0; i < 6; i++) {
        board_type("help");
    }
    give_back(&was[0]);
    take_away(&was[1], 200);
    hal_host_sensor()->address = 0x1D;
    give_back(&was[1]);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
    board_run_ms(20000);
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("over", before));
    size_t note = before;
    for (int i = 0; i < 2; i++) {
        note = next_fault_note(next_fault_note(note) + 1) + 1; /* behind its begin */
        assert_told_as_it_was(&was[i], note - 1);
    }
}

/* Samples that come again while the line drains for its new rate wait until it has it. */
TEST(test_what_is_lost_is_counted_before_it_is_told)
{
    outage_t was;
    board_start_resting();
    (void)talk_typed("baud 9600", 1000);
    take_away(&was, 500);
    for (int i = 0; i < 6; i++) { /* 0.2 s of answers */
        board_type("odr");
    }
    (void)talk_typed("baud 115200", 20);
    give_back(&was);
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_LOST));
    board_run_ms(1500);
    told_t told = told_by(next_fault_note(next_fault_note(0) + 1));
    TEST_ASSERT_EQUAL_UINT32(counted(COUNT_LOST), told.lost);
    TEST_ASSERT_DOUBLE_WITHIN(4.0, (was.over_ms - was.off_ms) / 10.0, told.lost);
}

/* Milliseconds in 32 bits wrap after 49.7 days: what is longer is told as the greatest number. */
TEST(test_an_outage_of_two_months_is_not_told_as_a_short_one)
{
    static const uint32_t passed_s[] = { 4294900u, 4294967u, 5184000u };
    for (size_t i = 0; i < sizeof passed_s / sizeof passed_s[0]; i++) {
        board_start_resting();
        board_run_ms(500);
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(500);
        for (uint32_t s = 0; s < passed_s[i]; s++) {
            count(COUNT_SECONDS);
        }
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(500);
        double ms = told_by(board.note_count - 1).ms;
        TEST_ASSERT_DOUBLE_WITHIN(2000.0, fmin(passed_s[i] * 1e3, UINT32_MAX), ms);
    }
}

/* A plot has no lines: what ended meanwhile is told behind it, as long as it was. */
TEST(test_a_fault_that_ends_in_a_plot_is_told_with_its_length)
{
    board_start_resting();
    board_run_ms(500);
    for (int twice = 0; twice <= 1; twice++) {
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(300);
        size_t before = talk_typed("mode plot", 400);
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(2000);
        if (twice) { /* gone again before it was told: one outage */
            adxl345_model_power(hal_host_sensor(), false);
            board_run_ms(500);
            adxl345_model_power(hal_host_sensor(), true);
            board_run_ms(2000);
        }
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("over", before));
        (void)talk_typed("mode csv", 200);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("over", before));
        told_t told = told_by(board.note_count - 1);
        TEST_ASSERT_DOUBLE_WITHIN(50.0, twice ? 3220 : 720, told.ms);
        TEST_ASSERT_UINT_WITHIN(6, twice ? 123 : 71, told.lost);
    }
}

/* Twice, which is one outage; over before the plot is, or not. */
TEST(test_a_fault_that_begins_in_a_plot_is_told_behind_it)
{
    for (int over = 0; over <= 1; over++) {
        outage_t first, was;
        board_start_resting();
        board_run_ms(500);
        (void)talk_typed("mode plot", 300);
        take_away(&first, 700);
        give_back(&first);
        take_away(&was, 3000);
        was.there_ms = was.off_ms - first.over_ms;
        was.off_ms = first.off_ms;
        was.seen_ms = first.seen_ms;
        for (int step = 0; step <= 1; step++) {
            if (step == over) {
                TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# fault", 0));
                (void)talk_typed("mode csv", 500);
            } else {
                give_back(&was);
            }
        }
        size_t begin = next_fault_note(0);
        TEST_ASSERT_EQUAL_STRING_LEN("# fault 1: no sensor", board.notes[begin], 20);
        assert_told_as_it_was(&was, next_fault_note(begin + 1));
        TEST_ASSERT_EQUAL_size_t(2, board_notes_with("# fault", 0));
    }
}

/*
 * INT1 is cut at any moment between two samples: the driver finds out by asking the sensor, and what it reads then is
 * in time for its row. So no sample is discarded as late, and the line may say that none is lost.
 */
TEST(test_a_cut_of_int1_loses_no_sample)
{
    static const char *const rates[] = { "rate 12.5", "rate 25",  "rate 50", "rate 100",
                                         "rate 200",  "rate 400", "rate 800" };
    for (size_t r = 0; r < sizeof rates / sizeof rates[0]; r++) {
        talk_start();
        (void)talk_typed(rates[r], 1000);
        for (unsigned tenths = 0; tenths < 10; tenths++) {
            hal_host_faults()->int1_cut = true;
            board_run_ms(500);
            hal_host_faults()->int1_cut = false;
            board_run_ms(300 + tenths * adxl345_period_us() / 10000.0);
            told_t told = told_by(board.note_count - 1);
            TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_INT1_SILENT, told.code);
            TEST_ASSERT_EQUAL_UINT(0, told.lost);
        }
        TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_LATE));
    }
}
