/* Between settings_table.c, which has the table, and settings_typed.c, which takes and writes values by it. */
#ifndef SETTINGS_ROW_H
#define SETTINGS_ROW_H

#include <stdbool.h>
#include <stdint.h>

/* One of a list, as words or as numbers; numbers in a range, one or three; or axes. */
enum { WORDS, LIST, NUMBER, VECTOR, SIGNED_AXES };

typedef struct {
    uint8_t place; /* in settings_t */
    uint8_t size;  /* of a number there, bytes */
    uint8_t kind;
    uint8_t fraction_bits;
    uint8_t starts; /* settings_table.h */
} format_t;

/* A setting that is looked at: its row, or the descriptor of the filter's parameter. */
typedef struct {
    format_t format;
    uint8_t which;
    bool zero_is_off;
    int32_t least, most; /* of a list where it begins, and how long it is */
} setting_t;

void setting_look(setting_t *s, uint8_t which);

/* Of a list, as stored. */
uint32_t setting_choice(const setting_t *s, uint8_t i);

#endif
