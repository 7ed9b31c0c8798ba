/*
 * Paths of the formatting: numbers, and whole rows of the real pipeline in both output modes. The UART of this program
 * is the output that is compared.
 */
#include "base/format.h"
#include "base/text.h"
#include "fx.h"
#include "hal_uart.h"
#include "output/rows.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "vectors.h"

enum { U16, I16, U32, HUNDREDTHS, TEXT_U32, TEXT_HEX8, TEXT_TENTHS, ROWS_CSV, ROWS_PLOT, TEXT_COUNT };

enum { NUMBER_ITEMS = 2 * VECTORS_BLOCK, ROW_ITEMS = 4 * VECTORS_BLOCK, ROWS_PER_START = 100 };

static const char names[TEXT_COUNT][20] IN_FLASH = { "format_u16",        "format_i16", "format_u32",
                                                     "format_hundredths", "text_u32",   "text_hex8",
                                                     "text_tenths",       "rows_csv",   "rows_plot" };

uint8_t text_paths(void)
{
    return TEXT_COUNT;
}

vectors_path_t text_path(uint8_t which)
{
    return (vectors_path_t){ names[which], (which >= ROWS_CSV) ? ROW_ITEMS : NUMBER_ITEMS };
}

uint8_t hal_uart_tx_room(void)
{
    return UINT8_MAX;
}

void hal_uart_tx_stage(uint8_t byte)
{
    vectors_output(byte, 1);
}

void hal_uart_tx_commit(void) {}

bool hal_uart_tx_write(const char *line, uint8_t length)
{
    for (uint8_t i = 0; i < length; i++) {
        vectors_output((uint8_t)line[i], 1);
    }
    return true;
}

static void number_item(uint8_t which)
{
    char text[FORMAT_U32_MAX];
    char *end = text;
    uint32_t v = vectors_random();
    v >>= v & 31U;
    vectors_input(v);
    uint16_t v16 = (uint16_t)v;
    int16_t signed16 = (int16_t)((int32_t)v16 - 32768);
    switch (which) {
    case U16:
        end = format_u16(text, v16);
        break;
    case I16:
        end = format_i16(text, signed16);
        break;
    case U32:
        end = format_u32(text, v);
        break;
    case HUNDREDTHS:
        end = format_hundredths(text, (int16_t)(signed16 == INT16_MIN ? 0 : signed16));
        break;
    case TEXT_U32:
        text_u32(v);
        break;
    case TEXT_HEX8:
        text_hex8((uint8_t)v);
        break;
    default:
        text_tenths(v16);
        break;
    }
    (void)hal_uart_tx_write(text, (uint8_t)(end - text));
}

static uint32_t now_us;

/* Four filters and some rates in turn, for there is no room for all; slow motion on each axis. */
static void begin_rows(uint8_t mode, uint16_t index)
{
    static const uint16_t rates_dhz[] IN_FLASH = { 1000, 125, 8000 };
    uint8_t turn = (uint8_t)(index / ROWS_PER_START);
    settings_defaults();
    settings()->mode = mode;
    settings()->baud = 1000000;
    settings()->choice.filter = turn % 4U; /* the first of the list */
    settings()->rate_dhz = flash_u16(&rates_dhz[turn % 3U]);
    now_us = vectors_random();
    coast_wait(now_us);
    pipeline_reset();
    pipeline_calibrate(&settings()->calibration);
    pipeline_forget();
    pipeline_change(&settings()->choice, settings()->rate_dhz, settings()->range_g);
    pipeline_finish();
    rows_enable(true);
}

static void row_item(uint8_t mode, uint16_t index)
{
    if (index % ROWS_PER_START == 0U) {
        begin_rows(mode, index);
    }
    uint32_t period_us = (uint32_t)10000000 / settings()->rate_dhz;
    uint32_t v = vectors_random();
    adxl345_sample_t sample = { 0 };
    now_us += ((v & 0x1FU) == 0U) ? 5U * period_us : period_us; /* a gap now and then */
    sample.t_us = now_us;
    for (uint8_t axis = 0; axis < 3; axis++) {
        v = vectors_random();
        int16_t noise_lsb = (int16_t)((v >> 16) & (((v & 0xFU) == 0U) ? 0x1FFFU : 0xFU));
        sample.lsb[axis] = (int16_t)(noise_lsb - 100 * (int16_t)axis + (int16_t)(index & 0xFFU));
        vectors_input((uint16_t)sample.lsb[axis]);
    }
    while (coast_due(now_us) && coast_over(period_us, true)) {
        pipeline_finish();
        rows_sample(settings_every_in_force(), settings()->mode == MODE_PLOT);
    }
    (void)coast_sample(now_us, period_us);
    pipeline_sample(&sample);
    pipeline_finish();
    rows_sample(settings_every_in_force(), settings()->mode == MODE_PLOT);
}

void text_path_item(uint8_t which, uint16_t index)
{
    if (which < ROWS_CSV) {
        number_item(which);
    } else {
        row_item(which == ROWS_CSV ? MODE_CSV : MODE_PLOT, index);
    }
}
