#include "support/board.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "adxl345.h"
#include "app/app.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "support/roles.h"

board_t board;

static char line[512];
static size_t line_length;
static stream_t playing;

static void take_line(void)
{
    board_row_t *row = &board.rows[board.row_count];
    if (line[0] == '\0') {
        return;
    }
    int fields = sscanf(line, "%u,%d,%d,%d,%d,%d,%d,%d,%d,%u", &row->t_us, &row->lsb[0], &row->lsb[1], &row->lsb[2],
                        &row->mg[0], &row->mg[1], &row->mg[2], &row->roll_cdeg, &row->pitch_cdeg, &row->flags);
    if (fields == 10) {
        row->at_ms = hal_host_now_ms();
        board.row_count += board.row_count < BOARD_ROWS_MAX - 1;
    } else if (board.note_count < BOARD_NOTES_MAX) {
        snprintf(board.notes[board.note_count], BOARD_NOTE_LENGTH, "%.159s", line);
        board.note_ms[board.note_count] = hal_host_now_ms();
        board.note_count++;
    }
}

static void on_tx(uint8_t byte)
{
    if (byte == '\n') {
        line[line_length] = '\0';
        take_line();
        line_length = 0;
    } else if (line_length < sizeof line - 1) {
        line[line_length++] = (char)byte;
    }
}

static void on_latched(uint64_t t_us, size_t row, const int16_t lsb[3])
{
    (void)row;
    if (board.latched_count < BOARD_ROWS_MAX) {
        board.latched_us[board.latched_count] = (uint32_t)t_us;
        memcpy(board.latched_lsb[board.latched_count], lsb, sizeof board.latched_lsb[0]);
        board.latched_count++;
    }
}

static void begin(hal_host_config_t config, const stream_t *stream)
{
    config.on_tx = on_tx;
    config.on_latched = on_latched;
    board.row_count = 0;
    board.note_count = 0;
    board.latched_count = 0;
    line_length = 0;
    if (stream != NULL) {
        if (stream->rows != playing.rows) {
            stream_free(&playing);
        }
        playing = *stream;
    }
    hal_host_begin(&config, stream != NULL ? &playing : NULL, true);
    app_start();
}

void board_start(const stream_t *stream, double ppm, uint32_t time_start_us)
{
    begin((hal_host_config_t){ .time_start_us = time_start_us, .ppm = ppm }, stream);
}

void board_start_with_rx(const stream_t *stream, uint8_t (*on_rx)(uint8_t reg, uint8_t byte))
{
    begin((hal_host_config_t){ .on_rx = on_rx }, stream);
}

void board_start_resting(void)
{
    stream_t resting = board_noisy_stream(1000, 100.0, 1.5, 7u);
    board_start(&resting, 0.0, 0);
}

void board_run_ms(double ms)
{
    double end_ms = hal_host_now_ms() + ms;
    while (hal_host_now_ms() < end_ms && hal_host_watchdog_bite() == 0) {
        app_pass();
    }
}

void board_driver_sleep(void)
{
    hal_wake_at(adxl345_deadline_us());
    hal_sleep_until_wake();
}

void board_type(const char *text)
{
    hal_host_type(by_role(text));
    hal_host_type("\n");
}

size_t board_notes_with(const char *text, size_t from)
{
    size_t count = 0;
    const char *wanted = by_role(text);
    for (size_t i = from; i < board.note_count; i++) {
        count += strstr(board.notes[i], wanted) != NULL;
    }
    return count;
}

const char *board_last_note(void)
{
    return board.note_count == 0 ? "" : board.notes[board.note_count - 1];
}

stream_t board_constant_stream(size_t n, double rate_hz, int16_t x, int16_t y, int16_t z)
{
    stream_t stream = { .count = n, .rate_hz = rate_hz };
    stream.rows = calloc(n, sizeof *stream.rows);
    for (size_t i = 0; stream.rows != NULL && i < n; i++) {
        stream.rows[i] = (stream_row_t){ .t_us = (uint64_t)((double)i * 1e6 / rate_hz), .lsb = { x, y, z } };
    }
    return stream;
}

/* Sum of twelve uniform numbers: near enough to a normal one. */
static double noise(uint32_t *state)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        *state = *state * 1664525u + 1013904223u;
        sum += (double)(*state >> 8) / 16777216.0;
    }
    return sum;
}

stream_t board_noisy_stream(size_t n, double rate_hz, double sigma_lsb, uint32_t seed)
{
    stream_t stream = board_constant_stream(n, rate_hz, 31, -53, 248);
    for (size_t i = 0; i < n; i++) {
        for (size_t axis = 0; axis < 3; axis++) {
            stream.rows[i].lsb[axis] = (int16_t)(stream.rows[i].lsb[axis] + (int)lround(sigma_lsb * noise(&seed)));
        }
    }
    return stream;
}

stream_t board_hung_stream(size_t n, uint32_t seed, size_t first, size_t equal)
{
    stream_t stream = board_noisy_stream(n, 100.0, 1.5, seed);
    for (size_t i = first + 1; i < first + equal; i++) {
        memcpy(stream.rows[i].lsb, stream.rows[first].lsb, sizeof stream.rows[i].lsb);
    }
    return stream;
}
