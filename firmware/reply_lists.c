/* Help, status and the legal values of each setting. */
#include "reply_lists.h"

#include "adxl345.h"
#include "app.h"
#include "commands.h"
#include "filter_any.h"
#include "flash.h"
#include "fx.h"
#include "hal_uart.h"
#include "pipeline.h"
#include "rows.h"
#include "settings.h"
#include "text.h"

#define RATE_LOWEST_DHZ 125u
#define COMBINATION_RATE 16u

_Static_assert(FILTER_KIND_COUNT <= COMBINATION_RATE, "a filter's kind has four bits in reply_combination");

static void number(flash_text_t name, uint32_t value)
{
    text_words(name);
    text_char(' ');
    text_u32(value);
}

static void write_filter_names(void)
{
    for (uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        if (kind != 0) {
            text_char(' ');
        }
        text_words(filter_any_name((filter_kind_t)kind));
    }
}

static void write_legal_values(uint8_t setting)
{
    switch (setting) {
    case REPLY_FILTER:
        write_filter_names();
        break;
    case REPLY_RATE:
        text_words(FLASH_TEXT("12.5 25 50 100 200 400 800"));
        break;
    case REPLY_RANGE:
        text_words(FLASH_TEXT("2 4 8 16"));
        break;
    case REPLY_EVERY:
        text_words(FLASH_TEXT("1 to 10000"));
        break;
    case REPLY_BAUD:
        text_words(FLASH_TEXT("9600 19200 38400 57600 115200 250000 500000 1000000"));
        break;
    default:
        text_words(FLASH_TEXT("csv plot"));
        break;
    }
}

flash_text_t reply_setting_name(uint8_t setting)
{
    switch (setting) {
    case REPLY_FILTER:
        return FLASH_TEXT("filter");
    case REPLY_RATE:
        return FLASH_TEXT("rate");
    case REPLY_RANGE:
        return FLASH_TEXT("range");
    case REPLY_EVERY:
        return FLASH_TEXT("every");
    case REPLY_BAUD:
        return FLASH_TEXT("baud");
    default:
        return FLASH_TEXT("mode");
    }
}

static void begin_refusal(void)
{
    text_words(FLASH_TEXT("# refused: "));
}

reply_progress_t reply_refused_line(uint8_t setting)
{
    begin_refusal();
    text_words(reply_setting_name(setting));
    text_words(FLASH_TEXT(" is one of "));
    write_legal_values(setting);
    text_close();
    return REPLY_ENDED;
}

/* The rates are 12.5 Hz times a power of two: its exponent above four bits of the filter's kind. */
uint8_t reply_combination(uint8_t filter, uint16_t rate_dhz)
{
    for (; rate_dhz > RATE_LOWEST_DHZ; rate_dhz >>= 1) {
        filter = (uint8_t)(filter + COMBINATION_RATE);
    }
    return filter;
}

FX_ONCE reply_progress_t reply_too_slow_line(uint8_t combination)
{
    uint8_t filter = combination % COMBINATION_RATE;
    uint16_t rate_dhz = (uint16_t)(RATE_LOWEST_DHZ << (combination / COMBINATION_RATE));
    begin_refusal();
    text_words(filter_any_name((filter_kind_t)filter));
    number(FLASH_TEXT(" takes"), settings_filter_cycles(filter));
    number(FLASH_TEXT(" of the"), settings_left_cycles(rate_dhz));
    text_words(FLASH_TEXT(" cycles that a sample at "));
    text_tenths(rate_dhz);
    text_words(FLASH_TEXT(" Hz leaves"));
    text_close();
    return REPLY_ENDED;
}

reply_progress_t reply_help_line(uint8_t line)
{
    text_words(FLASH_TEXT("# "));
    if (line < REPLY_SETTINGS_END - REPLY_FILTER) {
        uint8_t setting = (uint8_t)(REPLY_FILTER + line);
        text_words(reply_setting_name(setting));
        text_words(FLASH_TEXT(": "));
        write_legal_values(setting);
        text_close();
        return REPLY_GOES_ON;
    }
    text_words(FLASH_TEXT("stop, go, status, help; NAME VALUE sets, NAME shows"));
    text_close();
    return REPLY_ENDED;
}

static void write_state(void)
{
    text_words(FLASH_TEXT("state "));
    switch (adxl345_phase()) {
    case ADXL345_STOPPED:
        text_words(FLASH_TEXT("stopped"));
        break;
    case ADXL345_STREAMING:
        text_words(FLASH_TEXT("streaming"));
        break;
    case ADXL345_FAULTY:
        text_words(FLASH_TEXT("fault"));
        break;
    default:
        text_words(FLASH_TEXT("starting"));
        break;
    }
    number(FLASH_TEXT(", fault"), (uint32_t)adxl345_fault());
    number(FLASH_TEXT(", us per sample"), adxl345_period_us());
    number(FLASH_TEXT(", uptime s"), app_uptime_s());
}

static void write_sample_counters(void)
{
    pipeline_counters_t counters;
    pipeline_counters(&counters);
    number(FLASH_TEXT("samples"), counters.samples);
    number(FLASH_TEXT(", gated"), counters.gated);
    number(FLASH_TEXT(", reacquired"), counters.reacquired);
    number(FLASH_TEXT(", clipped"), counters.clipped);
}

static void write_row_counters(void)
{
    number(FLASH_TEXT("rows"), rows_written());
    number(FLASH_TEXT(", dropped"), rows_dropped());
    number(FLASH_TEXT(", serial bytes lost"), hal_uart_rx_lost());
    number(FLASH_TEXT(", lines refused"), commands_refused());
}

static void write_bus_counters(void)
{
    adxl345_counters_t counters;
    adxl345_counters(&counters);
    number(FLASH_TEXT("drained"), counters.samples_drained);
    number(FLASH_TEXT(", bus faults"), counters.bus_faults);
    number(FLASH_TEXT(", timeouts"), counters.timeouts);
    number(FLASH_TEXT(", restarts"), counters.restarts);
}

reply_progress_t reply_status_line(uint8_t line)
{
    text_words(FLASH_TEXT("# "));
    switch (line) {
    case 0:
        write_state();
        break;
    case 1:
        write_sample_counters();
        break;
    case 2:
        write_row_counters();
        break;
    default:
        write_bus_counters();
        break;
    }
    text_close();
    return line < 3 ? REPLY_GOES_ON : REPLY_ENDED;
}
