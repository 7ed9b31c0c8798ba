/* Stack depth. */
#ifndef SIMRUN_STACK_H
#define SIMRUN_STACK_H

#include <stdbool.h>
#include <stdint.h>

void stack_paint(void);                /* before the start */
void stack_paint_is(void);             /* takes the present RAM content as the paint (junk after a power cycle) */
bool stack_watch(uint32_t end_of_ram); /* true: SP is suspiciously low, check again after each instruction */
uint16_t stack_high_water(void);       /* bytes used so far */

#endif
