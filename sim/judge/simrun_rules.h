/* Rules of the data sheet that simavr does not hold the program to. */
#ifndef SIMRUN_RULES_H
#define SIMRUN_RULES_H

#include <stdint.h>
#include <stdio.h>

void rules_start(void); /* once every other part has its registers */
void rules_on_reset(void);
void rules_on_step(uint32_t from); /* a step that began there may have ended with SLEEP, or with interrupts enabled */
void rules_print(FILE *json);

#endif
