/* The words used as values of settings. Pure; any context. */
#ifndef SETTINGS_WORDS_H
#define SETTINGS_WORDS_H

#include <stdint.h>

#include "filter_list.h"
#include "machine.h"

/* Indices: filters by their kind, then output modes, then addresses of the sensor, then speeds of I2C. */
enum {
    WORD_FILTER,
    WORD_MODE = FILTER_KIND_COUNT,
    WORD_ADDRESS = WORD_MODE + 2,
    WORD_I2C = WORD_ADDRESS + 3,
    WORDS_END = WORD_I2C + 3
};

/* The word in program memory, as typed except for capitals. */
flash_text_t settings_word(uint8_t place);

#endif
