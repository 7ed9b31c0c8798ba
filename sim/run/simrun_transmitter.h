/* The transmitter of the UART. */
#ifndef SIMRUN_TRANSMITTER_H
#define SIMRUN_TRANSMITTER_H

#include <stdint.h>

#include "avr_uart.h"

void transmitter_start(avr_uart_t *of, void (*on_byte)(uint8_t byte)); /* on_byte: called as its start bit is sent */
void transmitter_reset(void);
uint64_t transmitter_byte_cycles(void);  /* at the divider in force, sent or received */
uint64_t transmitter_frame_cycles(void); /* duration of a byte sent that begins at this moment */
void transmitter_stall(uint64_t until);  /* it holds each byte until this cycle; 0: no longer */

#endif
