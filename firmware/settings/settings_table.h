/*
 * All settings in one table: a row for each, with name, unit, format, legal values and what a change starts; the
 * parameters of the filter in force follow as if they were rows. One way to set, to show and to list. Main only.
 */
#ifndef SETTINGS_TABLE_H
#define SETTINGS_TABLE_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

/* Rows, in the order of the listing. */
enum {
    SETTING_FILTER,
    SETTING_RATE,
    SETTING_RANGE,
    SETTING_EVERY,
    SETTING_BAUD,
    SETTING_MODE,
    SETTING_ADDRESS,
    SETTING_I2C,
    SETTING_AXES,
    SETTING_OFFSET, /* from here on numbers, which are shown with their legal range */
    SETTING_SCALE,
    SETTING_LEVEL,
    SETTING_PARAMETERS, /* the first of the filter's parameters */
    SETTING_NONE = 0xFF
};

/* What a change starts, as bits. */
enum { STARTS_FILTER = 1, STARTS_SENSOR = 2, STARTS_LINE = 4, STARTS_CALIBRATION = 8 };

typedef enum { SETTING_TAKEN, SETTING_ILLEGAL, SETTING_TOO_SLOW } setting_answer_t;

/* Number of settings, with the filter in force. */
uint8_t settings_count(void);

/* The setting with this name (RAM); SETTING_NONE if there is none. */
uint8_t setting_named(const char *name);

/* Its name in program memory, as typed; the unit follows the terminator, empty if there is none. */
flash_text_t setting_name(uint8_t which);

/*
 * Takes what was typed for a setting if it is legal together with all others; else nothing changes. *starts: what the
 * change starts, 0 if the value was already in force.
 */
setting_answer_t setting_set(uint8_t which, const char *text, uint8_t *starts);

/* Prints name, value and unit; without the unit the text can be typed again. */
void setting_write(uint8_t which);

/* Prints all legal values, or their range. */
void setting_write_legal(uint8_t which);

#endif
