/* What the user can set, with its legal values. One instance, owned by app.c; changed by commands in main. */
#ifndef SETTINGS_H
#define SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

typedef enum { MODE_CSV, MODE_PLOT } output_mode_t;

typedef struct {
    uint32_t baud;     /* SETTINGS_BAUD_DEFAULT, see settings_baud_valid */
    uint16_t rate_dhz; /* output data rate in 0.1 Hz */
    uint16_t every;    /* a row for every Nth sample, as asked for: 1..SETTINGS_EVERY_MAX */
    uint8_t range_g;   /* 2, 4, 8, 16 */
    uint8_t filter;    /* filter_kind_t */
    uint8_t mode;      /* output_mode_t */
} settings_t;

#define SETTINGS_BAUD_DEFAULT 115200ul
#define SETTINGS_EVERY_MAX 10000u

/* What the line must carry for a row: at most 67 bytes (csv) or 69 (plot), and some for replies. */
#define SETTINGS_ROW_MAX 72u

extern settings_t settings;

void settings_defaults(void);
bool settings_baud_valid(uint32_t baud);

/* The smallest `every` with which this baud rate carries rows of SETTINGS_ROW_MAX bytes at this output data rate. */
uint16_t settings_smallest_every(uint32_t baud, uint16_t rate_dhz);

/* What is in force: the greater of what was asked for and the smallest that fits. */
uint16_t settings_every_in_force(void);

#endif
