#include "support/talk.h"

#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "hal_watchdog.h"
#include "unity.h"

void talk_type(const char *line)
{
    (void)talk_typed(line, 400.0);
}

const char *talk_answer(const char *line)
{
    size_t before = talk_typed(line, 400.0);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(before + 1, board.note_count, line);
    return board.notes[before];
}

size_t talk_typed(const char *command, double ms)
{
    size_t before = board.note_count;
    board_type(command);
    board_run_ms(ms);
    return before;
}

void talk_assert_note(const char *expected, size_t at)
{
    TEST_ASSERT_TRUE_MESSAGE(at < board.note_count, expected);
    TEST_ASSERT_EQUAL_STRING(expected, board.notes[at]);
}

void talk_assert_told_once(size_t note, const char *of)
{
    char done[40];
    snprintf(done, sizeof done, "# %s z ", of);
    size_t results = board_notes_with(done, note);
    size_t cut = board_notes_with("# refused 9: samples lost or settings changed", note);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(1, results + cut, of);
    snprintf(done, sizeof done, "# %s x ", of);
    TEST_ASSERT_EQUAL_size_t(results, board_notes_with(done, note));
    if (results != 0) {
        TEST_ASSERT_EQUAL_size_t(strcmp(of, "selftest") == 0 ? 3 : 0, board_notes_with(": pass", note));
    }
}

void talk_start(void)
{
    board_start_resting();
    board_run_ms(300);
}

void talk_power_cycle(bool strap)
{
    uint8_t kept[1024];
    memcpy(kept, hal_host_eeprom(), sizeof kept);
    hal_host_reset_mcu(HAL_RESET_POWER_ON);
    hal_host_faults()->strap_low = strap;
    TEST_ASSERT_EQUAL_MEMORY(kept, hal_host_eeprom(), sizeof kept);
    app_start();
    board_run_ms(1000);
}

void talk_start_noisy(double rate_hz, double ppm)
{
    stream_t stream = board_noisy_stream((size_t)(60.0 * rate_hz), rate_hz, 1.5, 11u);
    board_start(&stream, ppm, 0);
    board_run_ms(700);
}
