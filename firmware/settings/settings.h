/* The user's settings and their legal values. Main only. */
#ifndef SETTINGS_H
#define SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/choice.h"
#include "calibration.h"
#include "hal_uart.h"
#include "settings/store.h"

typedef enum { MODE_CSV, MODE_PLOT } output_mode_t;

/* Bytes that are saved; the image has room for what later versions add. */
#define SETTINGS_KEPT_BYTES (14u + sizeof(calibration_t) + sizeof(filter_choice_t))

/*
 * Version of the saved bytes: raised when one of them changes its meaning. Version, length and calibration have the
 * same place in every version, so that a calibration survives an update; what follows them depends on the version.
 */
#define SETTINGS_VERSION 1u

/* Little-endian on PC and chip and without padding in the saved part: its bytes are the image that `save` writes. */
typedef struct {
    uint8_t version;           /* SETTINGS_VERSION of the firmware that saved it */
    uint8_t length;            /* SETTINGS_KEPT_BYTES of that firmware */
    calibration_t calibration; /* legal: calibration_check */
    filter_choice_t choice;    /* as stored; the filter is found by its mark when settings are loaded */
    uint32_t baud;             /* legal values of this and the rest: settings_table.c */
    uint16_t rate_dhz;         /* output data rate in 0.1 Hz */
    uint16_t every;            /* one row per N samples, as requested: 1..SETTINGS_EVERY_MAX */
    uint8_t range_g;           /* 2, 4, 8, 16 */
    uint8_t mode;              /* output_mode_t */
    uint8_t address;           /* of the sensor, 7 bits; 0: whichever answers */
    uint8_t i2c;               /* adxl345_i2c_t; FALLS_BACK in what an image without it has saved */
    uint8_t spare[STORE_IMAGE_SIZE - SETTINGS_KEPT_BYTES];
    uint8_t store_tail[STORE_TAIL_SIZE]; /* the store's own, see store.h */
    /* not saved */
    uint16_t every_smallest; /* derived from baud, rate and filter: settings_follow */
    bool line_is_slower;     /* the line, not the processor, determines every_smallest */
} settings_t;

#if HAL_UART_REACHES(115200)
#define SETTINGS_BAUD_DEFAULT 115200ul
#else
#define SETTINGS_BAUD_DEFAULT 57600ul
#endif
#define SETTINGS_EVERY_MAX 10000u
#define SETTINGS_RATE_MIN_DHZ 125u
#define SETTINGS_RATE_DEFAULT_DHZ 1000u

/* Bytes that the line must carry per row: at most 67 (csv) or 69 (plot), and some for replies. */
#define SETTINGS_ROW_MAX 72u

/*
 * Cycles that a sample takes besides its three filters, and cycles of a row: worst cases over any length of time, as
 * `make bench` measures and judges them (sample_rest, row). The first covers the interrupts of bus and clock, passes of
 * the main loop, three noise estimates, and new variances as often as an estimate can differ from the last by an
 * eighth. During work that is longer but rare (five warm-up samples, variances on all axes at once, replies, a change
 * of settings) samples wait in the sensor's FIFO and the driver's queue, 39 together, and are caught up on in the time
 * that samples leave over. At 800 Hz the two leave 1,000 cycles, 333 for each axis: less than any filter takes, so not
 * every row goes out.
 */
#define SETTINGS_REST_CYCLES 7300u
#define SETTINGS_ROW_CYCLES 11700u

/* The only instance: changed by this room and by control. */
settings_t *settings(void);

void settings_defaults(void);
void settings_defaults_beside_calibration(void); /* leaves the calibration as it is */

/* A byte that identifies each filter of filter_list.h, whichever image has it. */
uint8_t settings_filter_mark(uint8_t filter);

/* Sets `filter`, with its mark and its parameters as shipped. */
void settings_take_filter(uint8_t filter);

/* Cycles that three axes of a filter take at most, and those that this output data rate leaves for them. */
uint16_t settings_filter_cycles(uint8_t filter);
uint32_t settings_left_cycles(uint16_t rate_dhz);

/* The rule: the first is less than the second. The difference is left for rows. */
bool settings_fit(uint8_t filter, uint16_t rate_dhz);

/* Both numbers, from the last check that failed. */
typedef struct {
    uint16_t takes;
    uint16_t left;
} settings_cycles_t;
const settings_cycles_t *settings_cycles(void);

/* Call after baud, rate or filter has changed: by defaults, by what was saved, or by a command. */
void settings_follow(void);

/* The smallest `every` at which this baud rate can carry rows of SETTINGS_ROW_MAX bytes at this output data rate. */
uint16_t settings_smallest_every(uint32_t baud, uint16_t rate_dhz);

/*
 * The `every` in force: the largest of what was requested, what the line can carry and what the processor has time for.
 */
uint16_t settings_every_in_force(void);

#endif
