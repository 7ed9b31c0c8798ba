/*
 * The time of a pass of the main loop: who works through a list of pieces asks before each whether there is time for
 * one more. A pass that ends for lack of time wakes itself (app.c). Main only.
 */
#ifndef PASS_H
#define PASS_H

#include <stdbool.h>
#include <stdint.h>

/* No further piece begins after this: with the longest one, a filter's reset, a pass stays below 4 ms. */
#define PASS_US 704u

void pass_begin(void);
bool pass_in_time(void);

#endif
