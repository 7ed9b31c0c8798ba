/*
 * Lines of text straight into the UART's transmit ring: text_open reserves, the others append, text_close ends the line
 * and hands it over whole. Main only.
 */
#ifndef TEXT_H
#define TEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

/* Longest line that anything here writes, end of line included; a program of all fourteen filters has a longer one. */
#ifndef TEXT_LINE_MAX
#define TEXT_LINE_MAX 128u
#endif

/* True when a line of up to `length` bytes fits now; then append and close. Nothing is staged when false. */
bool text_open(uint8_t length);
void text_close(void);

void text_char(char c);
void text_words(flash_text_t words);
void text_ram(const char *words);
void text_u32(uint32_t value);
void text_hex8(uint8_t value);

/* value / 10, the decimal only when it is not 0: 125 gives 12.5, 1000 gives 100. */
void text_tenths(uint16_t value);

/* Of texts that follow each other, each with its end, the one after so many. */
flash_text_t text_nth(flash_text_t texts, uint8_t after);

/* The text in RAM, as typed: without capitals, is that of the words, which may have some. */
bool text_equal(const char *ram, flash_text_t words);

#endif
