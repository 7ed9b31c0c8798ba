/* Texts of replies with the values in them. */
#include "reply_said.h"

#include "adxl345.h"
#include "app.h"
#include "calibrate.h"
#include "counters.h"
#include "flash.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "measure_lines.h"
#include "number.h"
#include "replies.h"
#include "reply_lines.h"
#include "reply_texts.h"
#include "sensor_watch.h"
#include "settings.h"
#include "settings_kept.h"
#include "settings_table.h"
#include "supervisor.h"
#include "text.h"

_Static_assert(TEXT_KEPT_UNREAD - TEXT_KEPT_DAMAGED == KEPT_UNREAD - KEPT_DAMAGED, "words for what was kept");
_Static_assert(TEXT_TWO_SENSORS - TEXT_NO_SENSOR == ADXL345_FAULT_TWO_SENSORS - 1, "words for each fault");
_Static_assert(TEXT_WATCHDOG - TEXT_POWER_ON == HAL_RESET_WATCHDOG, "words for each cause");
_Static_assert(TEXT_STATE_FAULTY - TEXT_STATE_STOPPED == ADXL345_FAULTY, "words for each phase");

said_t said;

/* value / 100, with both decimals. */
static void say_hundredths(uint32_t value)
{
    uint8_t cents = (uint8_t)(value % 100u);
    text_u32(value / 100u);
    text_char('.');
    text_char((char)('0' + cents / 10u));
    text_char((char)('0' + cents % 10u));
}

/* The counters of the firmware, then those of the driver. */
static uint32_t next_count(void)
{
    uint8_t at = said.counters_out++;
    if (at < COUNTERS) {
        return counters[at];
    }
    return adxl345_count((uint8_t)(at - COUNTERS));
}

static uint32_t number(uint8_t what)
{
    switch (what) {
    case SAY_COUNT:
        return next_count();
    case SAY_FAULT:
        return (uint32_t)adxl345_fault();
    case SAY_SERIAL_LOST:
        return hal_uart_rx_lost();
    case SAY_CYCLES:
        return settings_cycles.takes;
    case SAY_LEFT:
        return settings_cycles.left;
    case SAY_RESIDUAL:
        return calibrate_told.residual_mg;
    case SAY_TO_GO:
        return calibrate_told.left;
    case SAY_RUN_NOTE:
        return hal_reset_note();
    case SAY_OUTAGE_MS:
        return sensor_watch_outage.ms;
    case SAY_OUTAGE_LOST:
        return sensor_watch_outage.lost;
    default:
        return said.subject;
    }
}

static uint8_t hexadecimal(uint8_t what)
{
    switch (what) {
    case SAY_OUTAGE_ADDRESS:
        return sensor_watch_outage.address;
    case SAY_FOREIGN_ADDRESS:
        return adxl345_foreign_address();
    case SAY_FOREIGN_ID:
        return adxl345_foreign_id();
    default:
        return adxl345_address();
    }
}

/* Those of the banner. */
static void say_settings(void)
{
    for (uint8_t which = SETTING_FILTER; which <= SETTING_BAUD; which++) {
        setting_write(which);
        if (which != SETTING_BAUD) {
            text_words(FLASH_TEXT(", "));
        }
    }
}

/* What is to be said of a setting behind its value. */
static void say_note(void)
{
    if (said.subject == SETTING_RATE) {
        say(TEXT_RATE_NOTE);
    }
    if (said.subject == SETTING_EVERY && settings_every_in_force() != settings.every) {
        bool carried = settings_every_in_force() == settings_smallest_every(settings.baud, settings.rate_dhz);
        say(carried ? TEXT_LINE_CARRIES : TEXT_FILTER_LEAVES);
    }
}

static void say_verbs(void)
{
    for (uint8_t kind = REPLY_HELP; kind <= REPLY_LISTING; kind++) {
        text_words(reply_command_name(kind));
        text_words(FLASH_TEXT(", ") + (kind == REPLY_LISTING));
    }
}

/* A text that is one of several. */
static uint8_t text_chosen(uint8_t what)
{
    switch (what) {
    case SAY_CAUSE:
        return (uint8_t)(TEXT_POWER_ON + hal_reset_cause());
    case SAY_SAFE:
        return app_is_safe() ? TEXT_SAFE : TEXT_NOTHING;
    case SAY_STATE:
        return (uint8_t)(TEXT_STATE_STOPPED + adxl345_phase());
    case SAY_KEPT:
        return (uint8_t)(TEXT_KEPT_DAMAGED + settings_kept);
    case SAY_LIMITS:
        return said.axis == 2 ? TEXT_LIMITS_Z : TEXT_LIMITS_XY;
    case SAY_VERDICT:
        return (uint8_t)(TEXT_FAIL - VERDICT_FAIL + measure_verdict(said.axis));
    default:
        return (uint8_t)(TEXT_NO_SENSOR - ADXL345_FAULT_NO_SENSOR + said.subject);
    }
}

/* What stands for a value. */
static void say_value(uint8_t what)
{
    switch (what) {
    case SAY_NAME:
        text_words(reply_command_name(said.subject));
        break;
    case SAY_SETTING_NAME:
        text_words(setting_name(said.subject));
        break;
    case SAY_SETTING:
        setting_write(said.subject);
        break;
    case SAY_LEGAL:
        setting_write_legal(said.subject);
        break;
    case SAY_SETTING_NOTE:
        say_note();
        break;
    case SAY_SETTINGS:
        say_settings();
        break;
    case SAY_VERBS:
        say_verbs();
        break;
    case SAY_RATE:
        text_tenths(settings.rate_dhz);
        break;
    case SAY_MEASURED:
        say_hundredths(adxl345_rate_chz());
        break;
    case SAY_BUS_KHZ: /* 800 Hz needs 400, where tLOW is 1.25 us instead of the 1.3 us of both data sheets */
        text_tenths(settings.rate_dhz == 8000 ? 4000 : 3636);
        break;
    case SAY_POSITION:
        text_char((said.axis & 1u) != 0 ? '-' : '+');
        text_char((char)('x' + (said.axis >> 1)));
        break;
    case SAY_AXIS:
        text_char((char)('x' + said.axis));
        break;
    case SAY_CHOICES:
#if SUPERVISOR
        supervisor_say();
#endif
        break;
    default:
        if (what <= SAY_LAST_NUMBER) {
            text_u32(number(what));
        } else if (what <= SAY_LAST_HEXADECIMAL) {
            text_hex8(hexadecimal(what));
        } else if (what <= SAY_LAST_Q8) {
            number_write((uint32_t)measure_number_q8(what, said.axis), 8);
        } else {
            say(text_chosen(what));
        }
    }
}

static void say_byte(uint8_t code)
{
    while (code >= SAY_PAIR) {
        uint8_t first = reply_pair(code, 0);
        say_byte(first);
        code = reply_pair(code, 1);
    }
    if (code >= ' ' && code < SAY_ABOVE) {
        text_char((char)code);
    } else {
        say_value(code);
    }
}

void say(uint8_t text)
{
    const uint8_t *at = reply_text(text);
    for (uint8_t code = flash_u8(at); code != 0; code = flash_u8(at)) {
        say_byte(code);
        at++;
    }
}
