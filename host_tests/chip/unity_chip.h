/*
 * Unity on the ATmega328P, included before anything else: text goes to the UART, names of tests stay in program memory
 * (2 KB of RAM), the end is a sleep with interrupts off.
 */
#ifndef UNITY_CHIP_H
#define UNITY_CHIP_H

#include "output.h"

#define UNITY_EXCLUDE_FLOAT
#define UNITY_EXCLUDE_DOUBLE
#define UNITY_OUTPUT_CHAR(c) output_char((char)(c))
#define UNITY_OUTPUT_START() output_start()
#define UNITY_OUTPUT_COMPLETE() output_end()

/* Not in unity.c, which brings its own PROGMEM and must not see these: it is compiled as c11, which has no AVR. */
#ifdef AVR
#include <avr/pgmspace.h>

#define TEST_TEXT(text) PSTR(text)
#define TEST_RUN unity_chip_run

/* Unity's runner, with the name copied from program memory. */
void unity_chip_run(void (*test)(void), const char *flash_name, int line);
#endif

#endif
