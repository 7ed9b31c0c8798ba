/* Writes the texts of replies with the values in them. */
#include "console/reply_said.h"

#include "adxl345.h"
#include "base/counters.h"
#include "base/health.h"
#include "base/notices.h"
#include "base/number.h"
#include "base/text.h"
#include "console/measure_lines.h"
#include "console/reply_lines.h"
#include "console/reply_texts.h"
#include "control/calibrate.h"
#include "control/sensor_watch.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "machine.h"
#include "path/pipeline.h"
#include "path/supervisor.h"
#include "settings/settings.h"
#include "settings/settings_kept.h"
#include "settings/settings_table.h"

_Static_assert(TEXT_KEPT_CALIBRATION - TEXT_KEPT_DAMAGED == KEPT_CALIBRATION - KEPT_DAMAGED, "words for what was kept");
_Static_assert(TEXT_I2C_SLOWED - TEXT_NO_SENSOR == FAULT_I2C_SLOWED - 1, "words for each fault");
_Static_assert(TEXT_WATCHDOG - TEXT_POWER_ON == HAL_RESET_WATCHDOG, "words for each cause");
_Static_assert(TEXT_STATE_FAULTY - TEXT_STATE_STOPPED == ADXL345_FAULTY, "words for each phase");

_Static_assert(TEXT_KEEP - TEXT_LISTED == SAY_KEEP - SAY_LISTED, "a text for each");

/* value / 100, with both decimals. */
static void say_hundredths(uint32_t value)
{
    text_u32(value / 100u);
    text_char('.');
    uint8_t cents = (uint8_t)(value % 100u);
    if (cents < 10u) {
        text_char('0');
    }
    text_u32(cents);
}

/* The counters of the firmware, then those of the driver. */
static uint32_t next_count(said_t *said)
{
    uint8_t at = said->counters_out++;
    if (at < COUNTERS) {
        return counted(at);
    }
    return adxl345_count((uint8_t)(at - COUNTERS));
}

static uint32_t number(said_t *said, uint8_t what)
{
    switch (what) {
    case SAY_COUNT:
        return next_count(said);
    case SAY_SERIAL_LOST:
        return hal_uart_rx_lost();
    case SAY_CYCLES:
        return settings_cycles()->takes;
    case SAY_LEFT:
        return settings_cycles()->left;
    case SAY_RESIDUAL:
        return calibrate_report()->residual_mg;
    case SAY_TO_GO:
        return calibrate_report()->left;
    case SAY_RUN_NOTE:
        return hal_reset_note();
    case SAY_OUTAGE_MS:
        return sensor_watch_outage()->ms;
    case SAY_OUTAGE_LOST:
        return sensor_watch_outage()->lost;
    default:
        return said->subject;
    }
}

static uint8_t hexadecimal(uint8_t what)
{
    switch (what) {
    case SAY_OUTAGE_ADDRESS:
        return sensor_watch_outage()->address;
    case SAY_FOREIGN_ADDRESS:
        return adxl345_foreign_address();
    case SAY_FOREIGN_ID:
        return adxl345_foreign_id();
    default:
        return adxl345_address();
    }
}

/* The settings in the banner. */
static void say_settings(void)
{
    for (uint8_t which = SETTING_FILTER; which <= SETTING_BAUD; which++) {
        if (which != SETTING_FILTER) {
            text_words(FLASH_TEXT(", "));
        }
        setting_write(which);
    }
}

static void say_verbs(void)
{
    for (uint8_t kind = NOTICE_STOPPED; kind <= NOTICE_LISTING; kind++) {
        if (kind != NOTICE_STOPPED) {
            text_words(FLASH_TEXT(", "));
        }
        text_words(reply_command_name(kind));
    }
}

/* The text printed after a setting's value. */
static uint8_t note(said_t *said)
{
    if (said->subject == SETTING_RATE) {
        return TEXT_BUS;
    }
    if (said->subject == SETTING_EVERY && settings_every_in_force() != settings()->every) {
        return settings()->line_is_slower ? TEXT_LINE_CARRIES : TEXT_FILTER_LEAVES;
    }
    return TEXT_NONE;
}

/* A text chosen from several. */
static uint8_t text_chosen(said_t *said, uint8_t what)
{
    switch (what) {
    case SAY_CAUSE:
        return (uint8_t)(TEXT_POWER_ON + hal_reset_cause());
    case SAY_SAFE:
        return health_is_safe() ? TEXT_SAFE : TEXT_NONE;
    case SAY_STATE:
        return (uint8_t)(TEXT_STATE_STOPPED + adxl345_phase());
    case SAY_KEPT:
        return (uint8_t)(TEXT_KEPT_DAMAGED + settings_kept());
    case SAY_LIMITS:
        return said->subject == 2 ? TEXT_LIMITS_Z : TEXT_LIMITS_XY;
    case SAY_VERDICT:
        return (uint8_t)(TEXT_FAIL - VERDICT_FAIL + measure_verdict(said->subject));
    case SAY_SETTING_NOTE:
        return note(said);
    case SAY_EVERY:
        said->subject = SETTING_EVERY;
        return TEXT_SETTING;
    case SAY_SENSOR:
        said->subject = sensor_watch_start(hal_time_us());
        return said->subject == ADXL345_FAULT_NONE ? TEXT_SENSOR : TEXT_FAULT_BEGIN;
    case SAY_FAULT_WORDS:
        return (uint8_t)(TEXT_NO_SENSOR - ADXL345_FAULT_NO_SENSOR + said->subject);
    default:
        return (uint8_t)(TEXT_LISTED - SAY_LISTED + what);
    }
}

/* 800 Hz needs 400 kHz, where tLOW is 1.25 us instead of the 1.3 us of both data sheets. */
static void say_bus_khz(void)
{
    text_tenths((uint16_t)(40000u / adxl345_scl_025us(settings()->rate_dhz)));
}

/* Codes that are neither a text nor one of many numbers. */
static void say_other(said_t *said, uint8_t what)
{
    switch (what) {
    case SAY_NAME:
        text_words(reply_command_name(said->subject));
        break;
    case SAY_SETTING_NAME:
        text_words(setting_name(said->subject));
        break;
    case SAY_SETTING:
        setting_write(said->subject);
        break;
    case SAY_LEGAL:
        setting_write_legal(said->subject);
        break;
    case SAY_SETTINGS:
        say_settings();
        break;
    case SAY_VERBS:
        say_verbs();
        break;
    case SAY_RATE:
        text_tenths(settings()->rate_dhz);
        break;
    case SAY_MEASURED:
        say_hundredths(adxl345_rate_chz());
        break;
    case SAY_BUS_KHZ:
        say_bus_khz();
        break;
    case SAY_POSITION:
        text_char((said->subject & 1u) != 0 ? '-' : '+');
        text_char((char)('x' + (said->subject >> 1)));
        break;
    case SAY_AXIS:
        text_char((char)('x' + said->subject));
        break;
    default:
#if SUPERVISOR
        supervisor_say(pipeline_axes());
#endif
        break;
    }
}

uint8_t say(said_t *said, uint8_t code)
{
    if (code >= SAY_ALONE) {
        return text_chosen(said, code);
    }
    if (code >= ' ') {
        text_char((char)code);
    } else if (code <= SAY_LAST_NUMBER) {
        text_u32(number(said, code));
    } else if (code <= SAY_LAST_HEXADECIMAL) {
        text_hex8(hexadecimal(code));
    } else if (code == SAY_SHIFT) {
        number_write((uint32_t)measure_shift_q4(said->subject), 4);
    } else if (code <= SAY_LAST_Q8) {
        number_write((uint32_t)measure_number_q8(code, said->subject), 8);
    } else {
        say_other(said, code);
    }
    return TEXT_NONE;
}
