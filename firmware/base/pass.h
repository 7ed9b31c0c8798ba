/*
 * Time budget of a pass of the main loop: code that works through pieces checks before each whether there is time for
 * one more. A pass that runs out of time wakes itself (app.c). Main only.
 */
#ifndef PASS_H
#define PASS_H

#include <stdbool.h>
#include <stdint.h>

/* No piece starts after this: with the longest one, a filter reset, a pass stays below 4 ms. */
#define PASS_US 704u

void pass_begin(void);
bool pass_in_time(void);

#endif
