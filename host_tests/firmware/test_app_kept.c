/* Settings over power cycles as a person meets them: save, load, defaults, the strap, resets again and again. */
#include <string.h>

#include "app/app.h"
#include "base/counters.h"
#include "filter_list.h"
#include "hal_watchdog.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "settings/settings_kept.h"
#include "support/roles.h"
#include "support/talk.h"
#include "support/test.h"

/* The mode may be another one: the header follows. */
static void assert_loaded(const char *line, const char *words)
{
    size_t before = talk_typed(line, 400);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(before + 2, board.note_count, line);
    TEST_ASSERT_EQUAL_STRING(words, board.notes[before]);
    TEST_ASSERT_EQUAL_INT(0, strncmp(board.notes[before + 1], "t_us,", 5));
}

static void save_some(void)
{
    talk_type("filter {robust}");
    talk_type("gate 4.5");
    talk_type("rate 50");
    talk_type("range 4");
    talk_type("every 3");
    talk_type("stop");
    TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
}

TEST(test_saved_settings_survive_power)
{
    talk_start();
    save_some();
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_UINT(KEPT_GOOD, settings_kept());
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# settings: as saved", 0));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# filter {robust}, rate 50 Hz, range 4 g, every 3, baud 115200", 0));
    TEST_ASSERT_EQUAL_STRING("# gate 4.5 sigma: 1 to 16, 0: off", talk_answer("gate"));
    TEST_ASSERT_EQUAL_UINT(4 * 256 + 128, pipeline_axes()[1].filter.own.kalman.of.gated.gate_sigma_q8);
}

/* Rows go on through a save, one for each sample, and what is saved is whole. */
TEST(test_a_save_while_sampling_costs_no_row)
{
    talk_start();
    talk_type("filter {robust}");
    size_t first = board.row_count;
    TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
    board_run_ms(500);
    for (size_t i = first + 1; i < board.row_count; i++) {
        TEST_ASSERT_UINT32_WITHIN(50, 10000, board.rows[i].t_us - board.rows[i - 1].t_us);
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_COASTED | ROW_DROPPED));
    }
    TEST_ASSERT_TRUE(board.row_count > first + 50);
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_UINT(KEPT_GOOD, settings_kept());
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# filter {robust}, rate 100 Hz", 0));
}

/* A set of another version: its calibration counts, the rest is as shipped, and the EEPROM is left alone. */
TEST(test_the_calibration_outlives_another_version)
{
    for (uint8_t version = 0; version <= SETTINGS_VERSION + 1u; version++) {
        bool own = version == SETTINGS_VERSION;
        uint8_t before[1024];
        talk_start();
        talk_type("offset 3 -4 5.5");
        talk_type("scale 260 261 250");
        talk_type("axes -yxz");
        talk_type("rate 50");
        settings()->version = version;
        calibration_t saved = settings()->calibration;
        TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
        memcpy(before, hal_host_eeprom(), sizeof before);
        talk_power_cycle(false);
        TEST_ASSERT_EQUAL_UINT(own ? KEPT_GOOD : KEPT_CALIBRATION, settings_kept());
        TEST_ASSERT_EQUAL_size_t(own ? 0 : 1,
                                 board_notes_with("# settings: defaults but calibration, saved by another", 0));
        TEST_ASSERT_EQUAL_MEMORY(&saved, &settings()->calibration, sizeof saved);
        TEST_ASSERT_EQUAL_UINT(own ? 500 : 1000, settings()->rate_dhz);
        board_run_ms(500);
        TEST_ASSERT_EQUAL_MEMORY(before, hal_host_eeprom(), sizeof before);
        TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
        talk_power_cycle(false);
        TEST_ASSERT_EQUAL_UINT(KEPT_GOOD, settings_kept());
    }
}

/*
 * Where every version finds them in a record: bytes 0 and 1, then offset, scale, level, axes, little-endian. What
 * follows, and its length, are those of this version: baud, rate, every, range, mode, address, i2c at its end. The
 * last is 0 in what an image without it has saved, which is auto.
 */
TEST(test_the_places_of_a_record)
{
    static const char other[] =
        "the saved record has another form: raise SETTINGS_VERSION, or settings that were saved "
        "before are read at wrong places; then enter the new bytes here";
    talk_start();
    talk_type("offset 1 -2 3");
    talk_type("scale 260 265 256");
    talk_type("level 0 0 1");
    talk_type("axes -yxz");
    TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
    const uint8_t *copy = hal_host_eeprom() + STORE_COPY_0;
    if (copy[STORE_IMAGE_SIZE] != STORE_VERSION) {
        copy = hal_host_eeprom() + STORE_COPY_1;
    }
    static const uint8_t wanted[] = { 1,    72,   16, 0, 0xE0, 0xFF, 48, 0,    0x00, 0x41, 0x40, 0x42,
                                      0x00, 0x40, 0,  0, 0,    0,    0,  0x40, 0xFE, 1,    3 };
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(wanted, copy, sizeof wanted, other);
    static const uint8_t end[] = { 0x00, 0xC2, 1, 0, 0xE8, 3, 1, 0, 16, MODE_CSV, 0, 0 };
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(end, copy + wanted[1] - sizeof end, sizeof end, other);
}

/* What is typed behind a save that fails is not taken for its outcome. */
TEST(test_a_failed_save_is_said_before_the_next_command)
{
    talk_start();
    hal_host_eeprom_wear_out(STORE_COPY_0 + 5);
    talk_type("rate 50");
    size_t before = board.note_count;
    board_type("save");
    (void)talk_typed("load", 2000);
    TEST_ASSERT_EQUAL_STRING("# refused 7: EEPROM failed", board.notes[before]);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# saved", before));
}

/* A measurement would change what is being saved. */
TEST(test_no_save_while_something_is_measured)
{
    uint8_t before[1024];
    talk_start();
    memcpy(before, hal_host_eeprom(), sizeof before);
    talk_type("tare");
    TEST_ASSERT_EQUAL_STRING("# refused 10: busy measuring", talk_answer("save"));
    board_run_ms(1000);
    TEST_ASSERT_EQUAL_MEMORY(before, hal_host_eeprom(), sizeof before);
    TEST_ASSERT_EQUAL_UINT32(1, counted(COUNT_REFUSED));
}

/* Settings do not change under a save: what is typed meanwhile waits, and then counts. */
TEST(test_commands_wait_for_the_save)
{
    talk_start();
    talk_type("stop");
    size_t before = board.note_count;
    hal_host_type("save\nrate 200\ngo\n");
    board_run_ms(1500);
    TEST_ASSERT_EQUAL_STRING("# saved", board.notes[before]);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# rate 200 Hz", before));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# going", before));
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_UINT(1000, settings()->rate_dhz);
}

TEST(test_load_and_defaults)
{
    talk_start();
    assert_loaded("load", "# settings: defaults, none saved");
    save_some();
    talk_type("rate 400");
    talk_type("filter {plain}");
    assert_loaded("load", "# settings: as saved");
    TEST_ASSERT_EQUAL_STRING("# rate 50 Hz, I2C at 363.6 kHz", talk_answer("rate"));
    TEST_ASSERT_EQUAL_STRING("# gate 4.5 sigma: 1 to 16, 0: off", talk_answer("gate"));
    assert_loaded("defaults", "# settings: defaults");
    TEST_ASSERT_EQUAL_STRING("# rate 100 Hz, I2C at 363.6 kHz", talk_answer("rate"));
    TEST_ASSERT_EQUAL_STRING(by_role("# filter {default}"), talk_answer("filter"));
    talk_type("go");
    size_t rows = board.row_count;
    board_run_ms(1000);
    TEST_ASSERT_INT_WITHIN(3, 100, (int)(board.row_count - rows));
    talk_power_cycle(false); /* defaults were not saved */
    TEST_ASSERT_EQUAL_UINT(500, settings()->rate_dhz);
}

/* A saved baud rate that the PC does not speak is no trap. */
TEST(test_the_strap_brings_the_default_baud_back)
{
    talk_start();
    talk_type("stop");
    talk_type("baud 1000000");
    board_run_ms(500);
    talk_type("save");
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_UINT32(1000000, hal_host_baud());
    talk_power_cycle(true);
    TEST_ASSERT_EQUAL_UINT32(115200, hal_host_baud());
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# settings: defaults, saved ones not read", 0));
    talk_power_cycle(false); /* and it is still there */
    TEST_ASSERT_EQUAL_UINT32(1000000, hal_host_baud());
    talk_power_cycle(true);
    talk_type("stop");
    TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_UINT32(115200, hal_host_baud());
}

/* A watchdog that bites again and again may bite because of what was saved. */
TEST(test_resets_again_and_again_leave_saved_settings_alone)
{
    talk_start();
    save_some();
    for (int i = 0; i < 3; i++) {
        hal_host_reset_mcu(HAL_RESET_WATCHDOG);
        app_start();
        board_run_ms(800);
    }
    TEST_ASSERT_EQUAL_UINT(KEPT_UNREAD, settings_kept());
    TEST_ASSERT_EQUAL_UINT(125, settings()->rate_dhz);
    TEST_ASSERT_EQUAL_UINT(16, settings()->range_g);
}

/* Each filter of the list has a mark of its own, and what another image saved keeps all but the filter. */
TEST(test_a_filter_that_the_image_does_not_hold)
{
    for (uint8_t a = 0; a < FILTER_KIND_COUNT; a++) {
        for (uint8_t b = 0; b < a; b++) {
            TEST_ASSERT_NOT_EQUAL_UINT8(settings_filter_mark(a), settings_filter_mark(b));
        }
    }
    talk_start();
    talk_type("rate 50");
    talk_type("gate 2"); /* adaptive has none: refused */
    talk_type("guard 2");
    talk_type("stop");
    settings()->choice.mark = (uint8_t)~settings()->choice.mark;
    for (uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        TEST_ASSERT_NOT_EQUAL_UINT8(settings_filter_mark(kind), settings()->choice.mark);
    }
    talk_type("save");
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# settings: as saved, but another filter", 0));
    TEST_ASSERT_EQUAL_UINT(500, settings()->rate_dhz);
    TEST_ASSERT_EQUAL_UINT(0, settings()->choice.filter);
    TEST_ASSERT_EQUAL_UINT(0, settings()->choice.own);
}
