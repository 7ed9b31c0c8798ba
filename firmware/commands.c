/* Line assembly, words and values. What a command does is app.c's. */
#include "commands.h"

#include <stdbool.h>

#include "app.h"
#include "calibrate.h"
#include "counters.h"
#include "filter_list.h"
#include "flash.h"
#include "fx.h"
#include "hal_sleep.h"
#include "hal_uart.h"
#include "measure.h"
#include "number.h"
#include "parameters.h"
#include "pass.h"
#include "replies.h"
#include "reply_lines.h"
#include "settings.h"
#include "text.h"

static char line[COMMANDS_LINE_MAX + 1u];
static uint8_t length;
static bool too_long;
static bool garbage;
static bool complete; /* its end has come */
static bool answered; /* a legal value was refused, with a reply of its own */

void commands_start(void)
{
    length = 0;
    too_long = false;
    garbage = false;
    complete = false;
    line[0] = '\0';
}

static void refuse(reply_kind_t kind, uint8_t argument)
{
    count(COUNT_REFUSED);
    (void)replies_add(kind, argument);
}

FX_NOINLINE void refuse_combination(uint8_t filter, uint16_t rate_dhz)
{
    refuse(REPLY_TOO_SLOW, reply_combination(filter, rate_dhz));
    answered = true;
}

static bool set_filter(const char *value)
{
    filter_kind_t kind = filter_find(value);
    if (kind == FILTER_KIND_COUNT) {
        return false;
    }
    if (app_set_filter((uint8_t)kind) == APP_TOO_SLOW) {
        refuse_combination((uint8_t)kind, settings.rate_dhz);
    }
    return true;
}

static bool set_mode(const char *value)
{
    if (text_equal(value, FLASH_TEXT("csv"))) {
        app_set_mode(MODE_CSV);
        return true;
    }
    if (text_equal(value, FLASH_TEXT("plot"))) {
        app_set_mode(MODE_PLOT);
        return true;
    }
    return false;
}

/* All of the text is one number. */
FX_NOINLINE bool parse(const char *text, uint8_t fraction_bits, uint32_t *value)
{
    return number_parse(&text, fraction_bits, value) && *text == '\0';
}

/* Fraction bits with which each rate is exact, and as many of ten times it that must be 0 then. */
enum { RATE_BITS = 6, RATE_REST_BITS = 5 };

static app_answer_t set_number(uint8_t setting, uint32_t number)
{
    if (setting == REPLY_BAUD) {
        return app_set_baud(number);
    }
    if (number > UINT16_MAX) {
        return APP_ILLEGAL;
    }
    switch (setting) {
    case REPLY_RATE:
        return app_set_rate((uint16_t)number);
    case REPLY_RANGE:
        return app_set_range((uint16_t)number);
    default:
        return app_set_every((uint16_t)number);
    }
}

/* As it is told: hexadecimal. */
static bool set_address(const char *value)
{
    uint8_t address;
    if (text_equal(value, FLASH_TEXT("auto"))) {
        address = 0;
    } else if (text_equal(value, FLASH_TEXT("53"))) {
        address = 0x53;
    } else if (text_equal(value, FLASH_TEXT("1d"))) {
        address = 0x1D;
    } else {
        return false;
    }
    app_set_address(address);
    return true;
}

/* Each of x, y, z once, with a sign where it is reversed, and no mirror image: that is no way to mount a board. */
static bool set_axes(const char *value)
{
    calibration_t wanted = settings.calibration;
    bool mirrored = false;
    int8_t before = 0;
    for (uint8_t i = 0; i < 3; i++) {
        bool reversed = *value == '-';
        value += reversed;
        int8_t axis = (int8_t)(*value++ - ('x' - 1));
        if (axis < 1 || axis > 3) {
            return false;
        }
        bool backward = i == 1u && axis != before % 3 + 1;
        mirrored ^= reversed ^ backward;
        before = axis;
        wanted.axes[i] = (int8_t)(reversed ? -axis : axis);
    }
    return !mirrored && *value == '\0' && settings_calibrate(&wanted);
}

static bool set(uint8_t setting, const char *value)
{
    if (setting == REPLY_AXES) {
        return set_axes(value);
    }
    if (setting == REPLY_ADDRESS) {
        return set_address(value);
    }
    if (setting == REPLY_FILTER) {
        return set_filter(value);
    }
    if (setting == REPLY_MODE) {
        return set_mode(value);
    }
    uint32_t number;
    if (!parse(value, setting == REPLY_RATE ? RATE_BITS : 0, &number)) {
        return false;
    }
    if (setting == REPLY_RATE) {
        number *= 10u >> (RATE_BITS - RATE_REST_BITS);
        if ((uint8_t)number & ((1u << RATE_REST_BITS) - 1u)) {
            return false;
        }
        number >>= RATE_REST_BITS;
    }
    app_answer_t answer = set_number(setting, number);
    if (answer == APP_TOO_SLOW) {
        refuse_combination(settings.filter, (uint16_t)number);
    }
    return answer != APP_ILLEGAL;
}

/* The reply kind of a command's first word; REPLY_BANNER when it is none. */
static uint8_t command_named(const char *name)
{
    uint8_t kind = REPLY_LISTING;
    while (kind != REPLY_BANNER && !text_equal(name, reply_command_name(kind))) {
        kind--;
    }
    return kind;
}

/* As many numbers as it has, with blanks between. */
static bool parse_numbers(const char *text, uint8_t which, uint32_t numbers[PARAMETERS_AXES])
{
    uint8_t bits = fx_flash_u8(&parameters_at(which)->fraction_bits);
    for (uint8_t left = parameters_numbers(which); left != 0; left--) {
        if (!number_parse(&text, bits, numbers)) {
            return false;
        }
        numbers++;
    }
    return *text == '\0';
}

/* `gate` or `gate 3.5`: false if the filter in force has no such parameter. */
static bool run_parameter(const char *value)
{
    uint8_t which = parameters_find(line);
    if (which == PARAMETERS_NONE) {
        return false;
    }
    if (value != 0) {
        uint32_t numbers[PARAMETERS_AXES];
        if (!parse_numbers(value, which, numbers) || !app_set_parameter(which, numbers)) {
            refuse(REPLY_ILLEGAL_PARAMETER, which);
            return true;
        }
    }
    (void)replies_add(REPLY_PARAMETER, which);
    return true;
}

static bool is_setting(uint8_t kind)
{
    return kind >= REPLY_FILTER && kind < REPLY_SETTINGS_END;
}

/* The text after the first blanks, NULL when there is none; the name before it is cut off (a blank becomes the end). */
FX_NOINLINE char *split_value(void)
{
    char *at = line;
    while (*at != '\0' && *at != ' ') {
        at++;
    }
    char *blank = at;
    while (*at == ' ') {
        at++;
    }
    if (*at == '\0') {
        *blank = '\0';
        return 0;
    }
    *blank = '\0';
    return at;
}

/* False: it was refused. */
static bool run_verb(uint8_t verb)
{
    switch (verb) {
    case REPLY_STOPPED:
        app_stop();
        break;
    case REPLY_GOING:
        app_go();
        break;
    case REPLY_SAVED:
        if (!app_save()) {
            refuse(REPLY_STREAMING, 0);
            return false;
        }
        break;
    case REPLY_LOADED:
        app_load();
        break;
    case REPLY_DEFAULTS:
        app_defaults();
        break;
    case REPLY_NOISE:
    case REPLY_SELFTEST:
    case REPLY_TARE:
    case REPLY_CAL:
    case REPLY_CAL6:
        if (!CALIBRATE_SIX && verb == REPLY_CAL6) {
            refuse(REPLY_NO_ROOM, 0);
            return false;
        }
        if (!measure_start(verb)) {
            refuse(REPLY_BUSY, 0);
            return false;
        }
        break;
    default:
        break;
    }
    return true;
}

/* A setting, shown or set, or a verb. */
static void run_command(uint8_t kind, const char *value)
{
    answered = false;
    if (value != 0) {
        if (!is_setting(kind)) {
            refuse(REPLY_UNKNOWN, PROBLEM_COMMAND);
            return;
        }
        if (!set(kind, value)) {
            refuse(REPLY_REFUSED, kind);
            return;
        }
    } else if (kind >= REPLY_SETTINGS_END && !run_verb(kind)) {
        return;
    }
    if (!answered) {
        (void)replies_add((reply_kind_t)kind, value != 0);
    }
}

FX_NOINLINE void run_line(void)
{
    const char *value = split_value();
    uint8_t kind = command_named(line);
    if (kind == REPLY_CAL6 && value != 0 && text_equal(value, FLASH_TEXT("stop"))) {
        measure_stop();
        (void)replies_add(REPLY_CAL6, MEASURE_STOPPED);
    } else if (kind != REPLY_BANNER) {
        run_command(kind, value);
    } else if (!run_parameter(value)) {
        refuse(REPLY_UNKNOWN, PROBLEM_COMMAND);
    }
}

static void end_line(void)
{
    while (length != 0 && line[length - 1u] == ' ') {
        length--;
    }
    line[length] = '\0';
    if (too_long) {
        refuse(REPLY_UNKNOWN, PROBLEM_TOO_LONG);
    } else if (garbage) {
        refuse(REPLY_UNKNOWN, PROBLEM_GARBAGE);
    } else if (length != 0) {
        run_line();
    }
    length = 0;
    too_long = false;
    garbage = false;
}

static void take_byte(uint8_t byte)
{
    if (byte < ' ' || byte > '~') {
        garbage = true;
    } else if (length == COMMANDS_LINE_MAX) {
        too_long = true;
    } else if (length != 0 || byte != ' ') {
        bool upper = byte >= 'A' && byte <= 'Z';
        line[length++] = (char)(upper ? byte + ('a' - 'A') : byte);
    }
}

/* Not while a line tells of what the next command may change, or a reply waits that tells what parameters there are. */
static bool commands_wanted(void)
{
    return replies_room() && !replies_speaking() && !replies_hold(REPLY_LISTING, REPLY_ILLEGAL_PARAMETER) &&
           app_takes_commands();
}

/* A line is run early in a pass, of which it may take two thirds: behind many bytes it waits for the next one. */
bool commands_pass(void)
{
    uint8_t byte;
    while (commands_wanted()) {
        if (complete) {
            complete = false;
            end_line();
            hal_wake();
            return true;
        }
        if (!hal_uart_rx(&byte)) {
            break;
        }
        complete = byte == '\r' || byte == '\n';
        if (!complete) {
            take_byte(byte);
        }
        if (!pass_in_time()) {
            hal_wake();
            break;
        }
    }
    return false;
}
