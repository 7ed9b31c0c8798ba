/* The values in the texts of replies, and what decides how a line goes on. */
#include "reply_said.h"

#include "adxl345.h"
#include "app.h"
#include "calibrate.h"
#include "counters.h"
#include "filter_list.h"
#include "flash.h"
#include "fx.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "measure_lines.h"
#include "number.h"
#include "parameters.h"
#include "reply_lines.h"
#include "reply_texts.h"
#include "sensor_watch.h"
#include "settings.h"
#include "settings_kept.h"
#include "supervisor.h"
#include "text.h"

_Static_assert(TEXT_KEPT_UNREAD - TEXT_KEPT_DAMAGED == KEPT_UNREAD - KEPT_DAMAGED, "words for what was kept");
_Static_assert(TEXT_TWO_SENSORS - TEXT_NO_SENSOR == ADXL345_FAULT_TWO_SENSORS - 1, "words for each fault");
_Static_assert(TEXT_WATCHDOG - TEXT_POWER_ON == HAL_RESET_WATCHDOG, "words for each cause");
_Static_assert(TEXT_STATE_FAULTY - TEXT_STATE_STOPPED == ADXL345_FAULTY, "words for each phase");

said_t said;

static void say_filters(void)
{
    for (uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        if (kind != 0) {
            text_char(' ');
        }
        text_words(filter_listed_name((filter_kind_t)kind));
    }
}

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

static bool every_is_forced(void)
{
    return settings_every_in_force() != settings.every;
}

static void say_why(void)
{
    if (every_is_forced()) {
        bool carried = settings_every_in_force() == settings_smallest_every(settings.baud, settings.rate_dhz);
        said.next = carried ? TEXT_LINE_CARRIES : TEXT_FILTER_LEAVES;
    }
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
        return settings_filter_cycles(said.filter);
    case SAY_LEFT:
        return settings_left_cycles(said.rate_dhz);
    case SAY_RANGE:
        return settings.range_g;
    case SAY_EVERY:
        return settings_every_in_force();
    case SAY_BAUD:
        return settings.baud;
    case SAY_RESIDUAL:
        return calibrate_told.residual_mg;
    case SAY_TO_GO:
        return calibrate_told.left;
    case SAY_NOTE:
        return hal_reset_note();
    case SAY_OUTAGE_MS:
        return sensor_watch_outage.ms;
    case SAY_OUTAGE_LOST:
        return sensor_watch_outage.lost;
    default:
        return said.subject;
    }
}

/* A parameter: its name, value and unit, or what is legal. */
static void say_parameter(uint8_t what)
{
    const filter_parameter_t *parameter = parameters_at(said.subject);
    uint8_t bits = fx_flash_u8(&parameter->fraction_bits);
    if (what == SAY_PARAMETER) {
        text_words(parameter->name);
        for (uint8_t i = 0; i < parameters_numbers(said.subject); i++) {
            text_char(' ');
            number_write(parameters_value(said.subject, i), bits);
        }
        if (flash_char(parameter->unit) != '\0') {
            text_char(' ');
            text_words(parameter->unit);
        }
        return;
    }
    text_words(FLASH_TEXT(": "));
    number_write(fx_flash_u32((const uint32_t *)&parameter->min), bits);
    text_words(FLASH_TEXT(" to "));
    number_write(fx_flash_u32((const uint32_t *)&parameter->max), bits);
    if (fx_flash_u8(&parameter->zero_means_off) != 0) {
        text_words(FLASH_TEXT(", 0: off"));
    }
}

static void say_axes(void)
{
    for (uint8_t i = 0; i < 3; i++) {
        int8_t axis = settings.calibration.axes[i];
        if (axis < 0) {
            text_char('-');
            axis = (int8_t)-axis;
        }
        text_char((char)('x' - 1 + axis));
    }
}

static void say_set_address(void)
{
    if (settings.address == 0) {
        text_words(FLASH_TEXT("auto"));
    } else {
        text_hex8(settings.address);
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

/* What stands for a value. */
static void say_value(uint8_t what)
{
    switch (what) {
    case SAY_NAME:
        text_words(reply_command_name(said.subject));
        break;
    case SAY_FILTER:
        text_words(filter_listed_name((filter_kind_t)said.filter));
        break;
    case SAY_RATE:
        text_tenths(said.rate_dhz);
        break;
    case SAY_MEASURED:
        say_hundredths(adxl345_rate_chz());
        break;
    case SAY_BUS_KHZ: /* 800 Hz needs 400, where tLOW is 1.25 us instead of the 1.3 us of both data sheets */
        text_tenths(settings.rate_dhz == 8000 ? 4000 : 3636);
        break;
    case SAY_FILTERS:
        say_filters();
        break;
    case SAY_ADDRESS:
    case SAY_OUTAGE_ADDRESS:
    case SAY_FOREIGN_ADDRESS:
    case SAY_FOREIGN_ID:
        text_hex8(hexadecimal(what));
        break;
    case SAY_PARAMETER:
    case SAY_PARAMETER_RANGE:
        say_parameter(what);
        break;
    case SAY_AXES:
        say_axes();
        break;
    case SAY_SET_ADDRESS:
        say_set_address();
        break;
    case SAY_POSITION:
        text_char((said.axis & 1u) != 0 ? '-' : '+');
        text_char((char)('x' + (said.axis >> 1)));
        break;
    case SAY_AXIS:
        text_char((char)('x' + said.axis));
        break;
    case SAY_SHIFT:
    case SAY_RMS:
    case SAY_R:
    case SAY_OFF:
        number_write((uint32_t)measure_number_q8(what, said.axis), 8);
        break;
    default:
        text_u32(number(what));
        break;
    }
}

/* What decides how the line or the reply goes on. */
static void say_on(uint8_t what)
{
    switch (what) {
    case SAY_MORE:
        said.progress = REPLY_GOES_ON;
        break;
    case SAY_MORE_IF_FORCED:
        said.progress = every_is_forced() ? REPLY_GOES_ON : REPLY_ENDED;
        break;
    case SAY_THEN_CAUSE:
        said.next = (uint8_t)(TEXT_POWER_ON + hal_reset_cause());
        break;
    case SAY_THEN_SAFE:
        said.next = app_is_safe() ? TEXT_SAFE : TEXT_NONE;
        break;
    case SAY_THEN_LEGAL:
        said.next = (uint8_t)(TEXT_LEGAL_FILTER - REPLY_FILTER + said.subject);
        break;
    case SAY_THEN_FAULT:
        said.next = (uint8_t)(TEXT_NO_SENSOR - ADXL345_FAULT_NO_SENSOR + said.subject);
        break;
    case SAY_THEN_STATE:
        said.next = (uint8_t)(TEXT_STATE_STOPPED + adxl345_phase());
        break;
    case SAY_THEN_WHY:
        say_why();
        break;
    case SAY_THEN_KEPT:
        said.next = (uint8_t)(TEXT_KEPT_DAMAGED + settings_kept);
        break;
    case SAY_THEN_LIMITS:
        said.next = said.axis == 2 ? TEXT_LIMITS_Z : TEXT_LIMITS_XY;
        break;
    case SAY_THEN_VERDICT:
        said.next = (uint8_t)(TEXT_FAIL - VERDICT_FAIL + measure_verdict(said.axis));
        break;
    case SAY_THEN_MODE:
        said.next = (uint8_t)(TEXT_CSV + settings.mode);
        break;
    default:
        said.next = TEXT_STATE_REST;
        break;
    }
}

FX_ONCE void say_byte(uint8_t c)
{
    if (c >= ' ' && c < SAY_FOREIGN_ADDRESS) {
        text_char((char)c);
    } else if (c < SAY_MORE || (c >= SAY_FOREIGN_ADDRESS && c < SAY_THEN_KEPT)) {
        say_value(c);
    } else if (c != SAY_THEN_CHOICES) {
        say_on(c);
    } else {
#if SUPERVISOR
        supervisor_say();
#endif
    }
}
