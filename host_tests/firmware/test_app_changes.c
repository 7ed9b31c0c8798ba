/*
 * The whole firmware where one state gives way to another: faults that alternate, go after stop, range, the seconds
 * counted.
 */
#include <stdio.h>

#include "app/app.h"
#include "base/counters.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/talk.h"
#include "support/test.h"

/* No sensor and wrong identity by turns, ten times: each is told once until samples come again, then anew. */
TEST(test_alternating_faults_are_told_once_each)
{
    board_start_resting();
    board_run_ms(500);
    size_t before = board.note_count;
    for (int turn = 0; turn < 10; turn++) {
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(150);
        adxl345_model_power(hal_host_sensor(), true);
        hal_host_faults()->id_wrong = true;
        board_run_ms(150);
    }
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1: ", before));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 2: ", before));
    hal_host_faults()->id_wrong = false;
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("over: after", before));
    TEST_ASSERT_EQUAL_size_t(before + 3 + board_notes_with("# fault 15: ", before), board.note_count);
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("# fault 1: ", before));
}

TEST(test_counters_stay_at_their_greatest_value)
{
    counters_start();
    count_lost(UINT32_MAX - 1u);
    count(COUNT_LOST);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, counted(COUNT_LOST));
    count(COUNT_LOST);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, counted(COUNT_LOST));
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_SAMPLES));
}

/* Whole seconds since the start, over a stop and over the wrap of the microseconds. */
TEST(test_uptime_counts_seconds)
{
    stream_t stream = board_constant_stream(1000, 100.0, 31, -53, 248);
    board_start(&stream, 0.0, 0xFFFFFFFFu - 2500000u);
    board_run_ms(990);
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_SECONDS));
    board_run_ms(30);
    TEST_ASSERT_EQUAL_UINT32(1, counted(COUNT_SECONDS));
    (void)talk_typed("stop", 6000);
    TEST_ASSERT_EQUAL_UINT32(7, counted(COUNT_SECONDS));
    size_t before = talk_typed("status", 300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(", uptime s 7", before));
}

/*
 * z alternates between 242 and 254. A filter that goes on would put out about 248 (969 mg); a cold one puts out the
 * running median: the first sample itself, then the mean of two, and five rows are marked.
 */
TEST(test_go_begins_cold)
{
    stream_t stream = board_constant_stream(1000, 100.0, 0, 0, 248);
    for (size_t i = 0; i < stream.count; i++) {
        stream.rows[i].lsb[2] = (int16_t)((i & 1u) ? 254 : 242);
    }
    board_start(&stream, 0.0, 0);
    board_run_ms(2000);
    (void)talk_typed("stop", 200);
    size_t first = board.row_count;
    (void)talk_typed("go", 400);
    const board_row_t *row = &board.rows[first];
    TEST_ASSERT_TRUE(board.row_count >= first + 10);
    /* 242 and 254 LSB are 945.3 and 992.2 mg */
    TEST_ASSERT_EQUAL_INT(row[0].lsb[2] == 242 ? 945 : 992, row[0].mg[2]);
    TEST_ASSERT_EQUAL_INT(969, row[1].mg[2]);
    TEST_ASSERT_EQUAL_INT(row[0].mg[2], row[2].mg[2]);
    for (size_t i = 0; i < 10; i++) {
        TEST_ASSERT_EQUAL_UINT(i < 5 ? ROW_WARMING_UP : 0, row[i].flags & ROW_WARMING_UP);
    }
}

/*
 * x is 600 LSB: no rail at 16 g (4095), beyond the one at 2 g (511). Samples latched before the change took effect are
 * those of the old range and must not be called clipped, whatever the phase at which the command comes.
 */
TEST(test_old_samples_are_filtered_as_before_a_change_of_range)
{
    size_t old_on_the_way = 0;
    stream_t stream = board_constant_stream(1000, 100.0, 600, 0, 248);
    for (unsigned phase = 0; phase < 116; phase++) {
        board_start(&stream, 0.0, 0);
        board_run_ms(300.0);
        char typed[160];
        snprintf(typed, sizeof typed, "%*s", (int)phase + 8, "range 2"); /* a leading blank takes 87 us */
        board_type(typed);
        double changed_ms = 0.0;
        while (settings()->range_g != 2 && hal_host_now_ms() < 400.0) {
            changed_ms = hal_host_now_ms(); /* before the pass that obeys */
            app_pass();
        }
        board_run_ms(200);
        for (size_t i = 0; i < board.row_count; i++) {
            const board_row_t *row = &board.rows[i];
            TEST_ASSERT_TRUE(row->lsb[0] == 600 || row->lsb[0] == 511);
            TEST_ASSERT_EQUAL_UINT(row->lsb[0] == 511 ? ROW_CLIPPED : 0, row->flags & ROW_CLIPPED);
            /* a burst takes 0.3 ms: this sample was under way, or not even latched */
            old_on_the_way += row->lsb[0] == 600 && row->t_us > changed_ms * 1000.0 - 200.0;
        }
        TEST_ASSERT_EQUAL_INT(511, board.rows[board.row_count - 1].lsb[0]);
    }
    TEST_ASSERT_TRUE_MESSAGE(old_on_the_way > 0, "no phase met a sample of the old range");
}

/*
 * The sensor goes and the filter changes within its first three missing samples: each has its row, 10 ms after the one
 * before, and is counted.
 */
TEST(test_a_change_of_filter_in_an_outage_leaves_no_row_out)
{
    for (unsigned phase = 0; phase < 30; phase++) {
        board_start_resting();
        board_run_ms(500);
        size_t row = board.row_count;
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(phase);
        (void)talk_typed("filter {plain}", 200);
        TEST_ASSERT_TRUE(board.row_count >= row + 18);
        unsigned missing = 0;
        for (; row < board.row_count; row++) {
            TEST_ASSERT_UINT32_WITHIN(50, 10000, board.rows[row].t_us - board.rows[row - 1].t_us);
            missing += (board.rows[row].flags & ROW_COASTED) != 0;
        }
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(200);
        for (; row < board.row_count; row++) {
            missing += (board.rows[row].flags & ROW_COASTED) != 0;
        }
        TEST_ASSERT_EQUAL_UINT32(missing, counted(COUNT_LOST));
    }
}

/* One axis ahead of each of the next three samples, 10 ms apart, so that no row waits for all of them. */
TEST(test_a_change_of_filter_goes_axis_by_axis)
{
    board_start_resting();
    board_run_ms(500);
    const filter_law_t *old = pipeline_axes()[0].filter.law;
    board_type("filter {plain}");
    int changed = 0;
    for (int ms = 0; ms < 40; ms++) {
        board_run_ms(1);
        int now = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            now += pipeline_axes()[axis].filter.law != old;
        }
        TEST_ASSERT_TRUE(now == changed || now == changed + 1);
        changed = now;
    }
    TEST_ASSERT_EQUAL_INT(3, changed);
}
