/* Speaks the texts of reply_texts.h: which ones make a reply's lines, and the values in them. */
#include "reply_lines.h"

#include <stdbool.h>

#include "adxl345.h"
#include "app.h"
#include "calibrate.h"
#include "counters.h"
#include "filter_any.h"
#include "flash.h"
#include "fx.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "measure.h"
#include "measure_lines.h"
#include "number.h"
#include "parameters.h"
#include "reply_texts.h"
#include "sensor_watch.h"
#include "settings.h"
#include "settings_kept.h"
#include "store.h"
#include "text.h"

#define RATE_LOWEST_DHZ 125u
#define COMBINATION_RATE 16u

enum { BANNER_DIAGNOSIS = 5, HELP_VERBS = REPLY_SETTINGS_END - REPLY_FILTER };

_Static_assert(FILTER_KIND_COUNT <= COMBINATION_RATE, "a filter's kind has four bits in reply_combination");
_Static_assert(TEXT_FAULT_END - TEXT_WHO == (int)REPLY_FAULT_END, "a text for each reply");
_Static_assert(TEXT_KEPT_UNREAD - TEXT_KEPT_DAMAGED == KEPT_UNREAD - KEPT_DAMAGED, "words for what was kept");
_Static_assert(TEXT_LEGAL_AXES - TEXT_LEGAL_FILTER == REPLY_AXES - REPLY_FILTER, "legal values for each setting");
_Static_assert(TEXT_REPEATED - TEXT_HOLD_STILL == MEASURE_REPEATED - MEASURE_BEGUN, "words for each outcome");
_Static_assert(TEXT_NO_GRAVITY - TEXT_TILTED == CALIBRATION_NO_GRAVITY - CALIBRATION_TILTED, "words for each verdict");
_Static_assert(TEXT_TWO_SENSORS - TEXT_NO_SENSOR == ADXL345_FAULT_TWO_SENSORS - 1, "words for each fault");
_Static_assert(TEXT_WATCHDOG - TEXT_POWER_ON == HAL_RESET_WATCHDOG, "words for each cause");
_Static_assert(TEXT_STATE_FAULTY - TEXT_STATE_STOPPED == ADXL345_FAULTY, "words for each phase");

/* What the line that is being spoken is about. */
static struct {
    uint16_t rate_dhz;
    uint8_t filter;
    uint8_t subject;      /* the reply's argument; the setting in a list of settings */
    uint8_t counters_out; /* how many `status` has told */
    uint8_t axis;         /* of this line of a measurement, or the position */
    uint8_t next;         /* enum reply_text: where it goes on */
    uint8_t progress;
    bool listed; /* what is legal follows the setting */
} said;

flash_text_t reply_command_name(uint8_t kind)
{
    return reply_name((uint8_t)(kind - REPLY_HELP));
}

/* The rates are 12.5 Hz times a power of two: its exponent above four bits of the filter's kind. */
uint8_t reply_combination(uint8_t filter, uint16_t rate_dhz)
{
    for (; rate_dhz > RATE_LOWEST_DHZ; rate_dhz >>= 1) {
        filter = (uint8_t)(filter + COMBINATION_RATE);
    }
    return filter;
}

static void say_filters(void)
{
    for (uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        if (kind != 0) {
            text_char(' ');
        }
        text_words(filter_any_name((filter_kind_t)kind));
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

/* A parameter of the filter: name, value, unit, and what is legal. */
static void say_parameter(void)
{
    const filter_parameter_t *parameter = parameters_at(said.subject);
    uint8_t bits = fx_flash_u8(&parameter->fraction_bits);
    bool is_signed = fx_flash_u8(&parameter->is_signed) != 0;
    text_words(parameter->name);
    for (uint8_t number = 0; number < parameters_numbers(said.subject); number++) {
        text_char(' ');
        number_write(parameters_value(said.subject, number), bits, is_signed);
    }
    if (flash_char(parameter->unit) != '\0') {
        text_char(' ');
        text_words(parameter->unit);
    }
    text_words(FLASH_TEXT(": "));
    number_write(fx_flash_u32((const uint32_t *)&parameter->min), bits, is_signed);
    text_words(FLASH_TEXT(" to "));
    number_write(fx_flash_u32((const uint32_t *)&parameter->max), bits, is_signed);
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

/* What stands for a value. */
static void say_value(uint8_t what)
{
    switch (what) {
    case SAY_NAME:
        text_words(reply_command_name(said.subject));
        break;
    case SAY_FILTER:
        text_words(filter_any_name((filter_kind_t)said.filter));
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
        text_hex8(adxl345_address());
        break;
    case SAY_OUTAGE_ADDRESS:
        text_hex8(sensor_watch_outage.address);
        break;
    case SAY_PARAMETER:
        say_parameter();
        break;
    case SAY_AXES:
        say_axes();
        break;
    case SAY_SET_ADDRESS:
        if (settings.address == 0) {
            text_words(FLASH_TEXT("auto"));
        } else {
            text_hex8(settings.address);
        }
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
        number_write((uint32_t)measure_number_q8(what, said.axis), 8, true);
        break;
    case SAY_DEVICE_ID:
        text_hex8(adxl345_device_id());
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

FX_NOINLINE void say_byte(uint8_t c)
{
    if (c >= ' ' && c < SAY_PARAMETER) {
        text_char((char)c);
    } else if (c < SAY_MORE || (c >= SAY_PARAMETER && c < SAY_THEN_KEPT)) {
        say_value(c);
    } else {
        say_on(c);
    }
}

static void say(uint8_t id)
{
    if (id != TEXT_HEADER) {
        text_words(FLASH_TEXT("\n# ") + (id != TEXT_WHO)); /* the first ends a line that a reset has cut */
    }
    said.next = id;
    while (said.next != TEXT_NONE) {
        reply_text_open(said.next);
        said.next = TEXT_NONE;
        for (uint8_t c = reply_text_next(); c != 0; c = reply_text_next()) {
            say_byte(c);
        }
        if (said.listed && said.next == TEXT_NONE) {
            said.listed = false;
            text_words(FLASH_TEXT(": "));
            said.next = (uint8_t)(TEXT_LEGAL_FILTER - REPLY_FILTER + said.subject);
        }
    }
    text_close();
}

/* The texts of a banner follow each other; one waits for the sensor, and says instead what is wrong with it. */
static uint8_t banner_text(uint8_t line)
{
    adxl345_fault_t fault = adxl345_fault();
    if (line == 0) {
        return TEXT_WHO;
    }
    if (line == BANNER_DIAGNOSIS) {
        if (fault != ADXL345_FAULT_NONE) {
            said.subject = (uint8_t)fault;
            said.progress = REPLY_GOES_ON;
            return TEXT_FAULT_BEGIN;
        }
        if (adxl345_phase() != ADXL345_STREAMING) {
            return TEXT_NONE;
        }
    }
    return (uint8_t)(TEXT_RESET - 1 + line);
}

static uint8_t help_text(uint8_t line)
{
    said.subject = (uint8_t)(REPLY_FILTER + line);
    return line < HELP_VERBS ? TEXT_HELP : TEXT_VERBS;
}

/* The settings with what is legal, then the parameters. */
static uint8_t listing_text(uint8_t line)
{
    if (line >= HELP_VERBS) {
        said.subject = (uint8_t)(line - HELP_VERBS);
        return TEXT_PARAMETER;
    }
    said.subject = (uint8_t)(REPLY_FILTER + line);
    said.listed = true;
    return (uint8_t)(TEXT_FILTER_NOW + line);
}

/* A setting that rows depend on, and then what it makes of `every`; after a change to csv the header. */
static uint8_t setting_text(uint8_t kind, uint8_t line)
{
    if (kind != REPLY_MODE) {
        return (uint8_t)(TEXT_WHO + (line == 0 ? kind : (uint8_t)REPLY_EVERY));
    }
    if (line != 0) {
        return TEXT_HEADER;
    }
    if (said.subject != 0 && settings.mode == MODE_CSV) {
        said.progress = REPLY_GOES_ON;
    }
    return TEXT_MODE_NOW;
}

static uint8_t too_slow_text(void)
{
    said.filter = said.subject % COMBINATION_RATE;
    said.rate_dhz = (uint16_t)(RATE_LOWEST_DHZ << (said.subject / COMBINATION_RATE));
    return TEXT_TOO_SLOW;
}

static uint8_t status_text(uint8_t line)
{
    if (line == 0) {
        said.counters_out = 0;
        return TEXT_STATUS;
    }
    return (uint8_t)(TEXT_SAMPLES - 1 + line);
}

static uint8_t saved_text(void)
{
    if (store_busy()) {
        return TEXT_NONE;
    }
    return store_failed() ? TEXT_NOT_SAVED : TEXT_SAVED;
}

/* The vectors of parameters.h that are new; of cal6 the residual before them. */
static uint8_t calibrated_text(uint8_t kind, uint8_t line)
{
    enum { OFFSET, SCALE, LEVEL };
    if (kind != REPLY_CAL6) {
        said.subject = kind == REPLY_TARE ? LEVEL : OFFSET;
        return TEXT_PARAMETER;
    }
    said.progress = line < 2 ? REPLY_GOES_ON : REPLY_ENDED;
    if (line == 0) {
        return TEXT_CAL6;
    }
    said.subject = (uint8_t)(OFFSET - 1 + line);
    return TEXT_PARAMETER;
}

/* A line for each axis, or why there is no result. */
static uint8_t measured_text(uint8_t kind, uint8_t line)
{
    uint8_t outcome = said.subject;
    said.subject = kind;
    if (outcome == MEASURE_WRONG) {
        said.axis = calibrate_told.verdict.where;
        return (uint8_t)(TEXT_TILTED - CALIBRATION_TILTED + calibrate_told.verdict.why);
    }
    if (outcome != MEASURE_DONE) {
        said.axis = calibrate_told.position;
        return (uint8_t)(TEXT_HOLD_STILL - MEASURE_BEGUN + outcome);
    }
    if (kind >= REPLY_TARE) {
        return calibrated_text(kind, line);
    }
    said.axis = line;
    said.progress = line < 2 ? REPLY_GOES_ON : REPLY_ENDED;
    return (uint8_t)(TEXT_WHO + kind);
}

static uint8_t text_of(uint8_t kind, uint8_t line)
{
    switch (kind) {
    case REPLY_BANNER:
        return banner_text(line);
    case REPLY_HELP:
        return help_text(line);
    case REPLY_STATUS:
        return status_text(line);
    case REPLY_LISTING:
        return listing_text(line);
    case REPLY_UNKNOWN:
        return said.subject == PROBLEM_COMMAND ? (uint8_t)TEXT_UNKNOWN : (uint8_t)(TEXT_TOO_LONG - 1 + said.subject);
    case REPLY_SAVED:
        return saved_text();
    case REPLY_ODR:
        return adxl345_rate_chz() == 0 ? (uint8_t)TEXT_ODR_UNKNOWN : (uint8_t)TEXT_ODR;
    case REPLY_NOISE:
    case REPLY_SELFTEST:
    case REPLY_TARE:
    case REPLY_CAL:
    case REPLY_CAL6:
        return measured_text(kind, line);
    case REPLY_TOO_SLOW:
        return too_slow_text();
    default:
        return kind < REPLY_SETTINGS_END ? setting_text(kind, line) : (uint8_t)(TEXT_WHO + kind);
    }
}

reply_progress_t reply_write_line(reply_kind_t kind, uint8_t argument, uint8_t line)
{
    said.rate_dhz = settings.rate_dhz;
    said.filter = settings.filter;
    said.subject = argument;
    said.progress = REPLY_ENDED;
    uint8_t id = text_of((uint8_t)kind, line);
    if (id == TEXT_NONE) {
        return REPLY_WAITS;
    }
    say(id);
    if (kind == REPLY_LISTING) {
        said.progress = line + 1u == (uint8_t)(HELP_VERBS + parameters_count()) ? REPLY_ENDED : REPLY_GOES_ON;
    }
    return (reply_progress_t)said.progress;
}
