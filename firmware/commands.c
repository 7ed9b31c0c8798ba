/* Line assembly, words and values. What a command does is app.c's. */
#include "commands.h"

#include <stdbool.h>

#include "app.h"
#include "filter_any.h"
#include "flash.h"
#include "fx.h"
#include "hal_uart.h"
#include "replies.h"
#include "reply_lists.h"
#include "settings.h"

static char line[COMMANDS_LINE_MAX + 1u];
static uint8_t length;
static uint16_t refused;
static bool too_long;
static bool garbage;
static bool answered; /* a legal value was refused, with a reply of its own */

void commands_start(void)
{
    length = 0;
    too_long = false;
    garbage = false;
    refused = 0;
    line[0] = '\0';
}

uint16_t commands_refused(void)
{
    return refused;
}

static void refuse(reply_kind_t kind, uint8_t argument)
{
    refused = (uint16_t)(refused + (refused != UINT16_MAX));
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

/*
 * A decimal number of up to seven digits, in units, or in tenths with at most one decimal; false for anything else.
 * Times ten is written out: the product would be a call of 32 by 32 bits.
 */
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
        number = (number << 3) + (number << 1) + (uint8_t)(*text - '0');
    }
    if (in_tenths && decimals == 0) {
        number = (number << 3) + (number << 1);
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

static bool set_rate(const char *value)
{
    uint32_t tenths;
    if (!parse(value, true, &tenths) || tenths > UINT16_MAX) {
        return false;
    }
    app_answer_t answer = app_set_rate((uint16_t)tenths);
    if (answer == APP_TOO_SLOW) {
        refuse_combination(settings.filter, (uint16_t)tenths);
    }
    return answer != APP_ILLEGAL;
}

static bool set_range(const char *value)
{
    uint32_t range;
    return parse(value, false, &range) && range <= UINT8_MAX && app_set_range((uint8_t)range);
}

static bool set_every(const char *value)
{
    uint32_t every;
    return parse(value, false, &every) && every <= SETTINGS_EVERY_MAX && app_set_every((uint16_t)every);
}

static bool set_baud(const char *value)
{
    uint32_t baud;
    return parse(value, false, &baud) && app_set_baud(baud);
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

static bool set(uint8_t setting, const char *value)
{
    switch (setting) {
    case REPLY_FILTER:
        return set_filter(value);
    case REPLY_RATE:
        return set_rate(value);
    case REPLY_RANGE:
        return set_range(value);
    case REPLY_EVERY:
        return set_every(value);
    case REPLY_BAUD:
        return set_baud(value);
    default:
        return set_mode(value);
    }
}

/* The reply kind of a setting's name; REPLY_SETTINGS_END when it is none. */
static uint8_t setting_named(const char *name)
{
    uint8_t setting = REPLY_FILTER;
    while (setting != REPLY_SETTINGS_END && !equal(name, reply_setting_name(setting))) {
        setting++;
    }
    return setting;
}

static bool run_verb(void)
{
    if (equal(line, FLASH_TEXT("help"))) {
        (void)replies_add(REPLY_HELP, 0);
    } else if (equal(line, FLASH_TEXT("status"))) {
        (void)replies_add(REPLY_STATUS, 0);
    } else if (equal(line, FLASH_TEXT("stop"))) {
        app_stop();
        (void)replies_add(REPLY_STOPPED, 0);
    } else if (equal(line, FLASH_TEXT("go"))) {
        app_go();
        (void)replies_add(REPLY_GOING, 0);
    } else {
        return false;
    }
    return true;
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
    uint8_t setting = setting_named(line);
    if (setting == REPLY_SETTINGS_END) {
        if (value != 0 || !run_verb()) {
            refuse(REPLY_UNKNOWN, PROBLEM_COMMAND);
        }
        return;
    }
    answered = false;
    if (value != 0 && !set(setting, value)) {
        refuse(REPLY_REFUSED, setting);
    } else if (!answered) {
        (void)replies_add((reply_kind_t)setting, value != 0);
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
            return;
        }
        take_byte(byte);
    }
}
