/* All the words that the firmware says in answer to something; the long lists are in reply_lists.c. */
#include "reply_lines.h"

#include "adxl345.h"
#include "filter_any.h"
#include "flash.h"
#include "fx.h"
#include "hal_watchdog.h"
#include "health.h"
#include "reply_lists.h"
#include "rows.h"
#include "sensor_watch.h"
#include "settings.h"
#include "text.h"
#include "version.h"

static void begin(flash_text_t words)
{
    text_words(FLASH_TEXT("# "));
    text_words(words);
}

static reply_progress_t end(bool last)
{
    text_close();
    return last ? REPLY_ENDED : REPLY_GOES_ON;
}

FX_NOINLINE void write_filter_name(void)
{
    text_words(filter_any_name((filter_kind_t)settings.filter));
}

static void write_reset_cause(void)
{
    begin(FLASH_TEXT("reset: "));
    switch (hal_reset_cause()) {
    case HAL_RESET_POWER_ON:
        text_words(FLASH_TEXT("power on"));
        break;
    case HAL_RESET_EXTERNAL:
        text_words(FLASH_TEXT("reset button or serial port opened"));
        break;
    case HAL_RESET_BROWN_OUT:
        text_words(FLASH_TEXT("supply dropped"));
        break;
    default:
        text_words(FLASH_TEXT("watchdog, waiting for stage mask "));
        text_u32(hal_reset_note());
        text_words(FLASH_TEXT(" (1 sampling, 2 filtering, 4 output)"));
        break;
    }
}

/* 800 Hz needs 400 kHz, where tLOW is 1.25 us instead of the 1.3 us that both data sheets ask for. */
static void write_bus_speed(void)
{
    text_words(FLASH_TEXT("I2C at "));
    text_tenths(settings.rate_dhz == 8000 ? 4000 : 3636);
    text_words(FLASH_TEXT(" kHz"));
}

static void write_fault(uint8_t fault)
{
    begin(FLASH_TEXT("fault "));
    text_u32(fault);
    text_words(FLASH_TEXT(": "));
    sensor_watch_describe(fault);
}

static bool write_diagnosis(void)
{
    adxl345_fault_t fault = adxl345_fault();
    if (fault != ADXL345_FAULT_NONE) {
        write_fault((uint8_t)fault);
        return true;
    }
    if (adxl345_phase() != ADXL345_STREAMING) {
        return false;
    }
    begin(FLASH_TEXT("sensor: ADXL345 at 0x"));
    text_hex8(adxl345_address());
    text_words(FLASH_TEXT(", "));
    write_bus_speed();
    return true;
}

static void write_settings(void)
{
    begin(FLASH_TEXT("filter "));
    write_filter_name();
    text_words(FLASH_TEXT(", rate "));
    text_tenths(settings.rate_dhz);
    text_words(FLASH_TEXT(" Hz, range "));
    text_u32(settings.range_g);
    text_words(FLASH_TEXT(" g, every "));
    text_u32(settings_every_in_force());
    text_words(FLASH_TEXT(", baud "));
    text_u32(settings.baud);
}

static reply_progress_t banner_line(uint8_t line)
{
    switch (line) {
    case 0:
        text_char('\n'); /* ends a line that a reset has cut */
        begin(FLASH_TEXT(FIRMWARE_NAME " " FIRMWARE_VERSION ": roll and pitch from an ADXL345"));
        return end(false);
    case 1:
        write_reset_cause();
        return end(false);
    case 2:
        write_settings();
        return end(false);
    case 3:
        begin(FLASH_TEXT("type help, or mode plot for the Arduino plotter"));
        return end(false);
    case 4:
        return write_diagnosis() ? end(false) : REPLY_WAITS;
    default:
        text_words(rows_header());
        return end(true);
    }
}

/* A second line only where the line's rate or the filter forces another decimation than was asked for. */
static reply_progress_t every_line(bool first)
{
    uint16_t every = settings_every_in_force();
    bool forced = every != settings.every;
    if (!first && !forced) {
        return REPLY_ENDED;
    }
    begin(FLASH_TEXT("every "));
    text_u32(every);
    if (forced) {
        text_words(FLASH_TEXT(": the smallest that "));
        if (every == settings_smallest_every(settings.baud, settings.rate_dhz)) {
            text_u32(settings.baud);
            text_words(FLASH_TEXT(" baud carries at "));
        } else {
            write_filter_name();
            text_words(FLASH_TEXT(" leaves time for at "));
        }
        text_tenths(settings.rate_dhz);
        text_words(FLASH_TEXT(" Hz"));
    }
    return end(true);
}

static reply_progress_t range_line(void)
{
    begin(FLASH_TEXT("range "));
    text_u32(settings.range_g);
    text_words(FLASH_TEXT(" g, 256 LSB per g"));
    return end(true);
}

/* A setting that rows depend on, and then what it makes of `every`. */
static reply_progress_t setting_line(reply_kind_t kind, uint8_t line)
{
    if (line != 0) {
        return every_line(false);
    }
    switch (kind) {
    case REPLY_FILTER:
        begin(FLASH_TEXT("filter "));
        write_filter_name();
        break;
    case REPLY_RATE:
        begin(FLASH_TEXT("rate "));
        text_tenths(settings.rate_dhz);
        text_words(FLASH_TEXT(" Hz, "));
        write_bus_speed();
        break;
    default:
        begin(FLASH_TEXT("baud "));
        text_u32(settings.baud);
        break;
    }
    return end(false);
}

/* After a change to csv the header follows: `set` is the reply's argument. */
static reply_progress_t mode_line(uint8_t line, uint8_t set)
{
    if (line != 0) {
        text_words(rows_header());
        return end(true);
    }
    begin(FLASH_TEXT("mode "));
    text_words(settings.mode == MODE_PLOT ? FLASH_TEXT("plot") : FLASH_TEXT("csv"));
    return end(set == 0 || settings.mode == MODE_PLOT);
}

static reply_progress_t fault_line(bool begins, uint8_t fault)
{
    if (begins) {
        write_fault(fault);
    } else {
        begin(FLASH_TEXT("fault "));
        text_u32(fault);
        text_words(FLASH_TEXT(" over: samples again"));
    }
    return end(true);
}

static reply_progress_t unknown_line(uint8_t problem)
{
    switch (problem) {
    case PROBLEM_TOO_LONG:
        begin(FLASH_TEXT("refused: line too long"));
        break;
    case PROBLEM_GARBAGE:
        begin(FLASH_TEXT("refused: characters that no command has"));
        break;
    default:
        begin(FLASH_TEXT("unknown command (type help)"));
        break;
    }
    return end(true);
}

static reply_progress_t word_line(flash_text_t words)
{
    begin(words);
    return end(true);
}

reply_progress_t reply_write_line(reply_kind_t kind, uint8_t argument, uint8_t line)
{
    switch (kind) {
    case REPLY_BANNER:
        return banner_line(line);
    case REPLY_HELP:
        return reply_help_line(line);
    case REPLY_STATUS:
        return reply_status_line(line);
    case REPLY_FILTER:
    case REPLY_RATE:
    case REPLY_BAUD:
        return setting_line(kind, line);
    case REPLY_RANGE:
        return range_line();
    case REPLY_EVERY:
        return every_line(true);
    case REPLY_MODE:
        return mode_line(line, argument);
    case REPLY_STOPPED:
        return word_line(FLASH_TEXT("stopped"));
    case REPLY_GOING:
        return word_line(FLASH_TEXT("going"));
    case REPLY_UNKNOWN:
        return unknown_line(argument);
    case REPLY_REFUSED:
        return reply_refused_line(argument);
    case REPLY_TOO_SLOW:
        return reply_too_slow_line(argument);
    default:
        return fault_line(kind == REPLY_FAULT_BEGIN, argument);
    }
}
