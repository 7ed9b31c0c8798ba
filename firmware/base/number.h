/* Decimal text to fixed point and back, for what is typed and printed; rows use format.h. Main only. */
#ifndef NUMBER_H
#define NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/*
 * Reads the number at *text (RAM), rounded to the nearest value with this many fraction bits (at most 16), in two's
 * complement; *text moves past it and the blanks that follow. At most four decimals, none without fraction bits, and
 * without its point the number times 2^fraction_bits must stay below 2^31. False: no such number; *text is then
 * undefined.
 */
bool number_parse(const char **text, uint8_t fraction_bits, uint32_t *value);

/*
 * Prints a value with this many fraction bits (at most 16), truncated to four decimals, without trailing zeros. With up
 * to 12 fraction bits number_parse reads the same value back.
 */
void number_write(uint32_t value, uint8_t fraction_bits);

#endif
