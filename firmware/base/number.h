/* Decimal text to fixed point and back, for what is typed and printed; rows have format.h. Main only. */
#ifndef NUMBER_H
#define NUMBER_H

#include <stdbool.h>
#include <stdint.h>

/*
 * The number at *text (RAM), to the nearest value with so many fraction bits (at most 16), in two's complement; *text
 * goes on after it and the blanks that follow. At most four decimals, none without fraction bits, and without its
 * point the number times 2^fraction_bits must stay below 2^31. False, *text anywhere: no such number.
 */
bool number_parse(const char **text, uint8_t fraction_bits, uint32_t *value);

/*
 * A value with so many fraction bits (at most 16), cut to four decimals, zeros at the end left out: with up to 12
 * fraction bits number_parse makes the same value of it.
 */
void number_write(uint32_t value, uint8_t fraction_bits);

#endif
