/* Line assembly, words and values. What a command does is app.c's. */
#include "commands.h"

#include <stdbool.h>

#include "app.h"
#include "counters.h"
#include "filter_any.h"
#include "flash.h"
#include "fx.h"
#include "hal_sleep.h"
#include "hal_uart.h"
#include "replies.h"
#include "reply_lines.h"
#include "settings.h"

static char line[COMMANDS_LINE_MAX + 1u];
static uint8_t length;
static bool too_long;
static bool garbage;
static bool answered; /* a legal value was refused, with a reply of its own */

void commands_start(void)
{
    length = 0;
    too_long = false;
    garbage = false;
    line[0] = '\0';
}

static void refuse(reply_kind_t kind, uint8_t argument)
{
    count(COUNT_REFUSED);
    (void)replies_add(kind, argument);
}

static bool equal(const char *ram, flash_text_t words)
{
    char c = flash_char(words);
    while (c != '\0' && *ram == c) {
        ram++;
        words++;
        c = flash_char(words);
    }
    return c == '\0' && *ram == '\0';
}

/* Written out: the product would be a call of 32 by 32 bits. */
static uint32_t times_ten(uint32_t number)
{
    number += number << 2;
    return number << 1;
}

/* A decimal number of up to seven digits, in units, or in tenths with at most one decimal; false for anything else. */
static bool parse(const char *text, bool in_tenths, uint32_t *value)
{
    uint32_t number = 0;
    uint8_t digits = 0;
    uint8_t decimals = 0;
    for (; *text != '\0'; text++) {
        if (*text == '.' && in_tenths && digits != 0 && decimals == 0) {
            decimals = 1;
            continue;
        }
        if (*text < '0' || *text > '9' || decimals > 1 || ++digits > 7) {
            return false;
        }
        decimals = (uint8_t)(decimals * 2U);
        number = times_ten(number) + (uint8_t)(*text - '0');
    }
    if (in_tenths && decimals == 0) {
        number = times_ten(number);
    }
    *value = number;
    return digits != 0 && decimals != 1;
}

FX_NOINLINE void refuse_combination(uint8_t filter, uint16_t rate_dhz)
{
    refuse(REPLY_TOO_SLOW, reply_combination(filter, rate_dhz));
    answered = true;
}

static bool set_filter(const char *value)
{
    filter_kind_t kind = filter_any_find(value);
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
    if (equal(value, FLASH_TEXT("csv"))) {
        app_set_mode(MODE_CSV);
        return true;
    }
    if (equal(value, FLASH_TEXT("plot"))) {
        app_set_mode(MODE_PLOT);
        return true;
    }
    return false;
}

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

static bool set(uint8_t setting, const char *value)
{
    if (setting == REPLY_FILTER) {
        return set_filter(value);
    }
    if (setting == REPLY_MODE) {
        return set_mode(value);
    }
    uint32_t number;
    if (!parse(value, setting == REPLY_RATE, &number)) {
        return false;
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
    uint8_t kind = REPLY_GOING;
    while (kind != REPLY_BANNER && !equal(name, reply_command_name(kind))) {
        kind--;
    }
    return kind;
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

FX_NOINLINE void run_line(void)
{
    const char *value = split_value();
    uint8_t kind = command_named(line);
    answered = false;
    if (kind == REPLY_BANNER || (value != 0 && !is_setting(kind))) {
        refuse(REPLY_UNKNOWN, PROBLEM_COMMAND);
        return;
    }
    if (value != 0 && !set(kind, value)) {
        refuse(REPLY_REFUSED, kind);
        return;
    }
    if (kind == REPLY_STOPPED) {
        app_stop();
    } else if (kind == REPLY_GOING) {
        app_go();
    }
    if (!answered) {
        (void)replies_add((reply_kind_t)kind, value != 0);
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

void commands_pass(void)
{
    uint8_t byte;
    while (replies_room() && app_takes_commands() && hal_uart_rx(&byte)) {
        if (byte == '\r' || byte == '\n') {
            end_line();
            hal_wake();
            return;
        }
        take_byte(byte);
    }
}
