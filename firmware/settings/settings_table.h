/*
 * All settings by one table: a row for each, with its name, unit, format, what is legal and what a change starts; the
 * parameters of the filter in force follow as if they were rows. One set, one show, one list. Main only.
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
    SETTING_AXES,
    SETTING_OFFSET, /* from here on numbers, whose legal range is shown with them */
    SETTING_SCALE,
    SETTING_LEVEL,
    SETTING_PARAMETERS, /* the first of the filter's */
    SETTING_NONE = 0xFF
};

/* What a change starts, as bits. */
enum { STARTS_FILTER = 1, STARTS_SENSOR = 2, STARTS_LINE = 4, STARTS_CALIBRATION = 8 };

typedef enum { SETTING_TAKEN, SETTING_ILLEGAL, SETTING_TOO_SLOW } setting_answer_t;

/* How many there are, with the filter in force. */
uint8_t settings_count(void);

/* Which has this name (RAM); SETTING_NONE when none has. */
uint8_t setting_named(const char *name);

/* In program memory, as typed; after its end follows the unit, empty where there is none. */
flash_text_t setting_name(uint8_t which);

/*
 * Takes what was typed for it, if it is legal together with all others; else nothing changes. *starts: what a change
 * starts, 0 where the value was in force before.
 */
setting_answer_t setting_set(uint8_t which, const char *text, uint8_t *starts);

/* Name, value and unit: can be typed again without the unit. */
void setting_write(uint8_t which);

/* All legal values, or their range. */
void setting_write_legal(uint8_t which);

#endif
