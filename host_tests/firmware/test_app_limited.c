/* The report that R limits q: once for each change, and of no filter but the one in force. */
#include "base/counters.h"
#include "base/notices.h"
#include "path/pipeline.h"
#include "support/talk.h"
#include "support/test.h"

static size_t limits_reported(const char *typed, double ms)
{
    return board_notes_with("# limited: q by r", talk_typed(typed, ms));
}

/* q 10^9 at 100 Hz is a process noise of 1000 LSB^2 per sample; the limit is 14 R. */
TEST(test_a_limited_q_is_reported_once_for_each_change)
{
    talk_start();
    TEST_ASSERT_EQUAL_size_t(0, limits_reported("filter {plain}", 3000));
    TEST_ASSERT_EQUAL_size_t(1, limits_reported("q 1000000000", 5000));
    TEST_ASSERT_EQUAL_size_t(1, limits_reported("r 65", 3000));
    TEST_ASSERT_EQUAL_size_t(0, limits_reported("r 80", 3000));
    TEST_ASSERT_EQUAL_size_t(1, limits_reported("r 1", 3000));
    TEST_ASSERT_EQUAL_size_t(0, limits_reported("save", 3000));
    size_t before = board.note_count;
    talk_power_cycle(false);
    board_run_ms(5000);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# limited: q by r", before));
    TEST_ASSERT_EQUAL_size_t(0, limits_reported("filter {default}", 3000));
}

/* The filters take over a change with the next samples: none come after `stop`. */
TEST(test_a_limit_of_the_filter_before_the_change_is_not_reported)
{
    static const char *const changed_to[] = { "q 1000", "filter {light}", "filter {plain}" };
    for (int i = 0; i < 3; i++) {
        talk_start();
        talk_type("filter {plain}");
        if (i == 2) {
            talk_type("filter {robust}");
        }
        TEST_ASSERT_EQUAL_size_t(1, limits_reported("q 1000000000", 3000));
        talk_type("stop");
        TEST_ASSERT_EQUAL_size_t(0, limits_reported(changed_to[i], 3000));
        TEST_ASSERT_EQUAL_size_t(0, limits_reported("go", 3000));
    }
}

/* The plotter takes no line that is not asked for: it comes when csv rows come. */
TEST(test_a_limit_is_not_reported_to_the_plotter)
{
    talk_start();
    talk_type("mode plot");
    talk_type("filter {plain}");
    TEST_ASSERT_EQUAL_size_t(0, limits_reported("q 1000000000", 3000));
    TEST_ASSERT_EQUAL_size_t(1, limits_reported("mode csv", 3000));
}

/* A change reaches the filters when samples come again. */
TEST(test_a_limit_is_reported_when_the_sensor_is_back)
{
    talk_start();
    talk_type("filter {plain}");
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(0, limits_reported("q 1000000000", 3000));
    size_t before = board.note_count;
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(3000);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# limited: q by r", before));
}

/* At 12.5 Hz the three axes follow a change within 240 ms: at every moment of a second. */
TEST(test_a_change_at_any_moment_reports_only_its_own_limit)
{
    talk_start();
    talk_type("rate 12.5");
    talk_type("filter {plain}");
    TEST_ASSERT_EQUAL_size_t(1, limits_reported("q 1000000000", 3000));
    for (int i = 0; i < 25; i++) {
        TEST_ASSERT_EQUAL_size_t(0, limits_reported("q 1000", 2040));
        TEST_ASSERT_EQUAL_size_t(1, limits_reported("q 1000000000", 2000));
    }
}

/* Process noise of 100 LSB^2 a sample: more than 14 R on the axis that moves by 1 LSB, below R at a noise of 20 LSB. */
TEST(test_a_limit_on_any_axis_is_reported)
{
    for (size_t quiet = 0; quiet < 3; quiet++) {
        stream_t stream = board_noisy_stream(6000, 100.0, 20.0, 7u);
        for (size_t i = 0; i < stream.count; i++) {
            stream.rows[i].lsb[quiet] = (int16_t)(i & 1u);
        }
        board_start(&stream, 0.0, 0);
        talk_type("filter {plain}");
        board_run_ms(30000);
        TEST_ASSERT_EQUAL_size_t(1, limits_reported("q 100000000", 3000));
        TEST_ASSERT_FALSE(filter_limited(&pipeline_axes()[(quiet + 1) % 3].filter));
        TEST_ASSERT_FALSE(filter_limited(&pipeline_axes()[(quiet + 2) % 3].filter));
    }
}

/* The line stands still over the end of a second, with as many replies waiting as there is room for. */
TEST(test_a_limit_for_which_there_is_no_room_is_reported_later)
{
    talk_start();
    talk_type("filter {plain}");
    uint32_t second = counted(COUNT_SECONDS);
    while (counted(COUNT_SECONDS) == second) {
        board_run_ms(1);
    }
    board_run_ms(850);
    hal_host_faults()->tx_stuck = true;
    size_t before = board.note_count;
    board_type("q 1000000000");
    for (int i = 0; i < 12; i++) {
        board_type("odr");
    }
    board_run_ms(170);
    TEST_ASSERT_EQUAL_UINT32(second + 2, counted(COUNT_SECONDS));
    TEST_ASSERT_FALSE(notices_room());
    hal_host_faults()->tx_stuck = false;
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# limited: q by r", before));
    board_run_ms(1000);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# limited: q by r", before));
}
