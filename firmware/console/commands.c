/* Lines and their first words. settings_table.c decides what a setting accepts, control.c what a command does. */
#include "console/commands.h"

#include <stdbool.h>

#include "base/counters.h"
#include "base/notices.h"
#include "base/pass.h"
#include "base/text.h"
#include "console/reply_lines.h"
#include "control/calibrate.h"
#include "control/control.h"
#include "control/measure.h"
#include "hal_sleep.h"
#include "hal_uart.h"
#include "machine.h"
#include "output/rows.h"
#include "settings/settings_table.h"

static char line[COMMANDS_LINE_MAX + 1u];
static uint8_t length;
static uint8_t wrong; /* what is wrong with the line: NOTICE_TOO_LONG, NOTICE_GARBAGE, or 0 */

void commands_start(void)
{
    length = 0;
    wrong = 0;
    line[0] = '\0';
}

_Static_assert(NOTICE_SETTING + SETTING_ILLEGAL == (int)NOTICE_ILLEGAL, "answers in the order of their replies");
_Static_assert(NOTICE_SETTING + SETTING_TOO_SLOW == (int)NOTICE_TOO_SLOW, "the same");

static void answer(uint8_t kind, uint8_t argument)
{
    if (kind >= NOTICE_ILLEGAL && kind <= NOTICE_BUSY) {
        count(COUNT_REFUSED);
    }
    (void)notices_add((notice_kind_t)kind, argument);
}

static void run_setting(uint8_t which, const char *value)
{
    setting_answer_t taken = SETTING_TAKEN;
    if (*value != '\0') {
        taken = control_set(which, value);
        if (taken == SETTING_TAKEN) {
            which |= NOTICE_CHANGED;
        }
    }
    answer((uint8_t)(NOTICE_SETTING + taken), which);
}

/* The notice kind of a command's name; NOTICE_BANNER if it is not a command. */
static uint8_t command_named(const char *name)
{
    if (name[0] == '?' && name[1] == '\0') {
        return NOTICE_HELP;
    }
    uint8_t kind = NOTICE_LISTING;
    while (kind != NOTICE_BANNER && !text_equal(name, reply_command_name(kind))) {
        kind--;
    }
    return kind;
}

/* The text after the first blanks, "" if there is none; terminates the name before it (the blanks become its end). */
static char *split_value(void)
{
    char *at = line;
    while (*at != '\0' && *at != ' ') {
        at++;
    }
    while (*at == ' ') {
        *at++ = '\0';
    }
    return at;
}

/* Runs a verb and returns the kind of its reply, or why it is refused. */
static uint8_t run_verb(uint8_t verb)
{
    switch (verb) {
    case NOTICE_STOPPED:
    case NOTICE_GOING:
        control_sample(verb == NOTICE_GOING);
        break;
    case NOTICE_SAVED:
        return control_save() ? verb : NOTICE_BUSY;
    case NOTICE_LOADED:
    case NOTICE_DEFAULTS:
        control_restore(verb == NOTICE_LOADED);
        break;
    case NOTICE_NOISE:
    case NOTICE_SELFTEST:
    case NOTICE_TARE:
    case NOTICE_CAL:
    case NOTICE_CAL6:
        return measure_start(verb) ? verb : NOTICE_BUSY;
    default:
        break;
    }
    return verb;
}

static void run_command(uint8_t kind, const char *value)
{
    if (kind == NOTICE_CAL6 && text_equal(value, FLASH_TEXT("stop"))) {
        measure_stop();
        answer(NOTICE_CAL6, MEASURE_STOPPED);
    } else {
        answer(kind == NOTICE_BANNER || *value != '\0' ? NOTICE_UNKNOWN : run_verb(kind), MEASURE_BEGUN);
    }
}

static void run_line(void)
{
    const char *value = split_value();
    uint8_t which = setting_named(line);
    if (which == SETTING_NONE) {
        run_command(command_named(line), value);
    } else {
        run_setting(which, value);
    }
}

/* A typed line ends the hold of rows, unless it asks for another listing. */
static void end_line(void)
{
    while (length != 0 && line[length - 1u] == ' ') {
        length--;
    }
    line[length] = '\0';
    if (wrong != 0) {
        answer(wrong, 0);
    } else if (length != 0) {
        run_line();
    }
    rows_typed(notices_hold(NOTICE_HELP, NOTICE_LISTING));
    length = 0;
    wrong = 0;
}

static void take_byte(uint8_t byte)
{
    if (byte < ' ' || byte > '~') {
        wrong = wrong != 0 ? wrong : NOTICE_GARBAGE;
    } else if (length == COMMANDS_LINE_MAX) {
        wrong = NOTICE_TOO_LONG;
    } else if (length != 0 || byte != ' ') {
        bool upper = byte >= 'A' && byte <= 'Z';
        line[length++] = (char)(upper ? byte + ('a' - 'A') : byte);
    }
}

/* Not while a reply waits that reports what the next command may change, or that keeps the line busy for long. */
static bool commands_wanted(void)
{
    return notices_room() && !notices_hold(NOTICE_HELP, NOTICE_TOO_SLOW);
}

bool commands_pass(void)
{
    uint8_t byte;
    while (commands_wanted() && hal_uart_rx(&byte)) {
        if (byte == '\r' || byte == '\n') {
            end_line();
            hal_wake();
            return true;
        }
        take_byte(byte);
        if (!pass_in_time()) {
            hal_wake();
            break;
        }
    }
    return false;
}
