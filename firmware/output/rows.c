/* A row is composed on the stack and goes out whole or not at all. */
#include "output/rows.h"

#include "base/counters.h"
#include "base/format.h"
#include "hal_uart.h"
#include "machine.h"
#include "path/pipeline.h"

/* The longest row is one of the plotter: four angles of FORMAT_HUNDREDTHS_MAX and the labels, 69 bytes. */
enum { ROW_MAX = 72 };

enum { HELD_TIMES = 31 }; /* units of newest_time, 2 s */

static uint16_t since_row;
static bool enabled;
static bool held;
static uint16_t held_from; /* as newest_time */

void rows_enable(bool now_enabled)
{
    enabled = now_enabled;
    held = false;
    since_row = 0;
}

/* Time of the newest sample in units of 65.536 ms; wraps after 71 minutes. */
static uint16_t newest_time(void)
{
    return (uint16_t)(pipeline_newest_us() >> 16);
}

void rows_hold(void)
{
    held = true;
    held_from = newest_time();
}

void rows_typed(bool more_to_read)
{
    if (!more_to_read) {
        held = false;
    }
    held_from = newest_time();
}

static char *write_csv(char *at, const row_t *row)
{
    at = format_u32(at, row->t_us);
    for (uint8_t column = 0; column < ROW_COLUMNS; column++) {
        *at++ = ',';
        at = format_i16(at, row->columns[column]);
    }
    *at++ = ',';
    return format_u16(at, row->flags);
}

static char *label(char *at, flash_text_t words)
{
    for (char c = flash_char(words); c != '\0'; c = flash_char(words)) {
        *at++ = c;
        words++;
    }
    return at;
}

static char *write_plot(char *at, const row_t *row)
{
    const tilt_t *raw = pipeline_raw_tilt();
    at = format_hundredths(label(at, FLASH_TEXT("roll_raw:")), raw->roll_cdeg);
    at = format_hundredths(label(at, FLASH_TEXT(",roll:")), row->roll_cdeg);
    at = format_hundredths(label(at, FLASH_TEXT(",pitch_raw:")), raw->pitch_cdeg);
    at = format_hundredths(label(at, FLASH_TEXT(",pitch:")), row->pitch_cdeg);
    at = label(at, FLASH_TEXT(",gated:"));
    *at++ = (row->flags & ROW_GATED) ? '1' : '0';
    return at;
}

static void write(const row_t *row, bool plot)
{
    char line[ROW_MAX];
    char *end = plot ? write_plot(line, row) : write_csv(line, row);
    *end++ = '\n';
    if (!hal_uart_tx_write(line, (uint8_t)(end - line))) {
        count(COUNT_DROPPED);
        pipeline_flag(ROW_DROPPED);
        return;
    }
    count(COUNT_ROWS);
    pipeline_row_done();
}

static MACHINE_APART void rows_at_once(bool plot)
{
    if (!enabled) {
        return;
    }
    since_row = 0;
    if ((uint16_t)(newest_time() - held_from) >= HELD_TIMES) {
        held = false;
    }
    if (held && !plot) {
        count(COUNT_HELD);
        pipeline_flag(ROW_DROPPED);
        return;
    }
    row_t row;
    pipeline_row(&row);
    write(&row, plot);
}

void rows_sample(uint16_t every, bool plot)
{
    since_row++;
    if (since_row >= every) {
        rows_at_once(plot);
    }
}
