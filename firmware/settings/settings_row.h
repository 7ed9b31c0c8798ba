/* Shared by settings_table.c, which has the table, and settings_typed.c, which parses and prints values by it. */
#ifndef SETTINGS_ROW_H
#define SETTINGS_ROW_H

#include <stdbool.h>
#include <stdint.h>

/* One of a list, as words or as numbers; one number or three in a range; or axes. */
enum { WORDS, LIST, NUMBER, VECTOR, SIGNED_AXES };

typedef struct {
    uint8_t place; /* offset in settings_t */
    uint8_t size;  /* of a number there, bytes */
    uint8_t kind;
    uint8_t fraction_bits;
    uint8_t starts; /* STARTS_* of settings_table.h */
} format_t;

/* A setting being accessed: its row, or the descriptor of the filter's parameter. */
typedef struct {
    format_t format;
    uint8_t which;
    bool zero_is_off;
    int32_t least, most; /* of a list: where it starts, and its length */
} setting_t;

void setting_look(setting_t *s, uint8_t which);

/* The i-th value of a list, as stored. */
uint32_t setting_choice(const setting_t *s, uint8_t i);

#endif
