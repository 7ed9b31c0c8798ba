/* What the programs of this folder print, on the PC to stdout and on the chip to its UART (1 Mbaud). */
#ifndef OUTPUT_H
#define OUTPUT_H

#include <stdint.h>

void output_start(void);
void output_char(char c);
/* Last call: waits until all is out; on the chip it then sleeps with interrupts off, which ends simrun. */
void output_end(void);

void output_text(const char *text);
void output_u32(uint32_t value);
void output_hex(uint32_t value, uint8_t digits);

#endif
