/* What a sample's period leaves: filters and rates that do not go together are refused, rows are thinned. */
#include <stdio.h>

#include "base/hang_test.h"
#include "filter_list.h"
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

/*
 * A processor of 15.5 MHz: 19,375 cycles a sample at 800 Hz, 11,075 without the rest of its way. 3 x 4,350 of the
 * slowest filter are too many, 3 x 3,650 of the next are not.
 */
static void board_start_with_a_slow_processor(void)
{
    board_start_resting();
    hal_host_set_cpu_hz(15500000);
    board_run_ms(200);
}

static void type_and_read(const char *typed, const char *answer)
{
    answer = by_role(answer);
    size_t before = talk_typed(typed, 150);
    TEST_ASSERT_TRUE_MESSAGE(board.note_count > before, typed);
    TEST_ASSERT_EQUAL_STRING(answer, board.notes[before]);
}

static filter_kind_t slowest_but_one(void)
{
    filter_kind_t found = plain_kind();
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        uint16_t cycles = filter_worst_cycles(filter_listed((filter_kind_t)kind));
        if (kind != (int)slowest_kind() && cycles > filter_worst_cycles(filter_listed(found))) {
            found = (filter_kind_t)kind;
        }
    }
    return found;
}

static void type_filter(filter_kind_t kind)
{
    char typed[32], answer[32];
    snprintf(typed, sizeof typed, "filter %s", filter_listed_name(kind));
    snprintf(answer, sizeof answer, "# filter %s", filter_listed_name(kind));
    type_and_read(typed, answer);
}

TEST(test_a_filter_too_slow_for_the_rate_is_refused)
{
    board_start_with_a_slow_processor();
    type_and_read("rate 800", "# rate 800 Hz, I2C at 400 kHz");
    type_and_read("filter {robust}", "# filter {robust}");
    type_and_read("gate 4", "# gate 4 sigma: 1 to 16, 0: off"); /* stays in force */
    settings_t kept = *settings();
    size_t rows = board.row_count;
    type_and_read("filter {slowest}", "# refused 5: takes 13050 of 12075 cycles a sample");
    TEST_ASSERT_EQUAL_MEMORY(&kept, settings(), sizeof kept);
    for (size_t i = rows + 1; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & ROW_WARMING_UP);
        TEST_ASSERT_UINT32_WITHIN(2, 1250u * settings_every_in_force(), board.rows[i].t_us - board.rows[i - 1].t_us);
    }
    TEST_ASSERT_TRUE(board.row_count > rows + 10);
    type_filter(slowest_but_one());
    type_and_read("rate 400", "# rate 400 Hz, I2C at 363.6 kHz");
    type_and_read("filter {slowest}", "# filter {slowest}");
}

TEST(test_a_rate_too_fast_for_the_filter_is_refused)
{
    board_start_with_a_slow_processor();
    type_and_read("filter {slowest}", "# filter {slowest}");
    settings_t kept = *settings();
    size_t before = board.note_count;
    type_and_read("rate 800", "# refused 5: takes 13050 of 12075 cycles a sample");
    TEST_ASSERT_EQUAL_size_t(before + 1, board.note_count);
    TEST_ASSERT_EQUAL_MEMORY(&kept, settings(), sizeof kept);
    type_and_read("rate 1600", "# refused 4: rate is one of 12.5 25 50 100 200 400 800");
    type_and_read("rate 400", "# rate 400 Hz, I2C at 363.6 kHz");
    type_and_read("rate 12.5", "# rate 12.5 Hz, I2C at 363.6 kHz");
    type_and_read("filter {plain}", "# filter {plain}");
    type_and_read("rate 800", "# rate 800 Hz, I2C at 400 kHz");
    hal_host_set_cpu_hz(5000000); /* not even the rest of a sample's way */
    type_and_read("filter {light}", "# refused 5: takes 2235 of 0 cycles a sample");
    (void)talk_typed("status", 300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("lines refused 3", before));
}

/* On this board: what starts is allowed, what is refused. */
TEST(test_every_filter_fits_every_rate_of_this_board_but_the_slowest_800_hz)
{
    board_start_resting();
    TEST_ASSERT_TRUE(settings_fit(settings()->choice.filter, settings()->rate_dhz));
    for (uint8_t filter = 0; filter < FILTER_KIND_COUNT; filter++) {
        for (uint16_t rate_dhz = 125; rate_dhz <= 8000; rate_dhz = (uint16_t)(rate_dhz * 2u)) {
            bool fits = filter != slowest_kind() || rate_dhz != 8000;
            const char *name = filter_listed_name((filter_kind_t)filter);
            TEST_ASSERT_EQUAL_MESSAGE(fits, settings_fit(filter, rate_dhz), name);
        }
    }
    TEST_ASSERT_EQUAL_UINT16(3u * filter_worst_cycles(filter_listed(slowest_kind())),
                             settings_filter_cycles(slowest_kind()));
    TEST_ASSERT_EQUAL_UINT32(20000u - LIMIT_REST_CYCLES, settings_left_cycles(8000));
    TEST_ASSERT_EQUAL_UINT32(1280000u - LIMIT_REST_CYCLES, settings_left_cycles(125));
    uint32_t full_hz = (LIMIT_REST_CYCLES + 3u * filter_worst_cycles(filter_listed(slowest_kind()))) * 800u;
    hal_host_set_cpu_hz(full_hz);
    TEST_ASSERT_FALSE(settings_fit(slowest_kind(), 8000)); /* nothing would be left for a row */
    hal_host_set_cpu_hz(full_hz + 800u);
    TEST_ASSERT_TRUE(settings_fit(slowest_kind(), 8000));
}

/* At 1,000,000 baud the line carries every row at 800 Hz; the filter leaves time for one in several. */
TEST(test_every_follows_what_the_filter_leaves_time_for)
{
    talk_start();
    (void)talk_typed("baud 1000000", 100);
    type_and_read("rate 800", "# rate 800 Hz, I2C at 400 kHz");
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        char typed[32], answer[96];
        if (kind == (int)slowest_kind() || kind == (int)settings()->choice.filter) {
            continue;
        }
        unsigned over = 20000u - LIMIT_REST_CYCLES - 3u * filter_worst_cycles(filter_listed((filter_kind_t)kind));
        unsigned every = 1;
        while (every * over < LIMIT_ROW_CYCLES) {
            every++;
        }
        size_t before = board.note_count;
        snprintf(typed, sizeof typed, "filter %s", filter_listed_name((filter_kind_t)kind));
        snprintf(answer, sizeof answer, "# every %u: the least for this filter", every);
        (void)talk_typed(typed, 150);
        TEST_ASSERT_EQUAL_UINT16(every, settings_every_in_force());
        TEST_ASSERT_EQUAL_size_t(every == 1 ? 0 : 1, board_notes_with(answer, before));
        TEST_ASSERT_EQUAL_size_t(before + (every == 1 ? 1 : 2), board.note_count);
    }
    type_and_read("rate 100", "# rate 100 Hz, I2C at 363.6 kHz");
    TEST_ASSERT_EQUAL_UINT16(1, settings_every_in_force());
}
