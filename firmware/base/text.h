/*
 * Writes lines of text directly into the UART's transmit ring: text_open checks the room, the others append, text_close
 * ends the line and commits it whole. Main only.
 */
#ifndef TEXT_H
#define TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

/* Longest line that anything here writes, line end included: the refusal that names all filters. */
#define TEXT_LINE_MAX 144u

/* A line of up to `length` bytes fits: then append and close. Nothing is staged if false. */
bool text_open(uint8_t length);
void text_close(void);

void text_char(char c);
void text_words(flash_text_t words);
void text_u32(uint32_t value);
void text_hex8(uint8_t value);

/* value / 10, with the decimal only if it is not 0: 125 gives 12.5, 1000 gives 100. */
void text_tenths(uint16_t value);

/* Skips `after` texts of a sequence, each with its terminator, and returns the next. */
flash_text_t text_nth(flash_text_t texts, uint8_t after);

/* `ram`, typed in lower case, equals `words`, which may have capitals. */
bool text_equal(const char *ram, flash_text_t words);

#endif
