/* A board for tests: the whole firmware over the host's HAL, its output cut into lines. */
#ifndef SUPPORT_BOARD_H
#define SUPPORT_BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal_host.h"

enum { BOARD_ROWS_MAX = 70000, BOARD_NOTES_MAX = 2000, BOARD_NOTE_LENGTH = 160 };

typedef struct {
    uint32_t t_us;
    int lsb[3], mg[3];
    int roll_cdeg, pitch_cdeg;
    unsigned flags;
    double at_ms; /* when its last byte left */
} board_row_t;

typedef struct {
    board_row_t rows[BOARD_ROWS_MAX];
    size_t row_count;
    char notes[BOARD_NOTES_MAX][BOARD_NOTE_LENGTH]; /* lines that are no data rows: '#' lines and the header */
    double note_ms[BOARD_NOTES_MAX];
    size_t note_count;
    size_t latched_count; /* samples the sensor took */
    uint32_t latched_us[BOARD_ROWS_MAX];
    int16_t latched_lsb[BOARD_ROWS_MAX][3];
} board_t;

extern board_t board;

/*
 * Power on with a stream (NULL: a sensor that never has data), clock error and start time, and start the firmware. The
 * stream's rows are the board's from here on: they are freed when another stream starts.
 */
void board_start(const stream_t *stream, double ppm, uint32_t time_start_us);

/* The same, where on_rx says what arrives of each byte of a register. */
void board_start_with_rx(const stream_t *stream, uint8_t (*on_rx)(uint8_t reg, uint8_t byte));

/* The same with a stream of n rows of one resting vector at 100 Hz, looped. */
void board_start_resting(void);

/* Run for so many virtual milliseconds, or until the watchdog bites. */
void board_run_ms(double ms);

/* For a main of its own around the driver: sleeps as app_pass does, with the driver's alarm set. */
void board_driver_sleep(void);

/* Type a line (the newline is added). */
void board_type(const char *line); /* with the roles of support/roles.h */

/* Notes that contain the text, from note index `from` on. */
size_t board_notes_with(const char *text, size_t from);

/* Last note, "" when there is none. */
const char *board_last_note(void);

/* A stream in memory: n rows at rate_hz, all (x, y, z). */
stream_t board_constant_stream(size_t n, double rate_hz, int16_t x, int16_t y, int16_t z);

/* As above with Gaussian-like noise of about sigma LSB and a counter in no axis; seed fixed by the caller. */
stream_t board_noisy_stream(size_t n, double rate_hz, double sigma_lsb, uint32_t seed);

/* The same at 100 Hz with 1.5 LSB, but rows first + 1 to first + equal - 1 repeat row `first`. */
stream_t board_hung_stream(size_t n, uint32_t seed, size_t first, size_t equal);

#endif
