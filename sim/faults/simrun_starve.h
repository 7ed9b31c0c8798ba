/* A main loop that gets no time, as if something it calls never returned, while interrupts continue. */
#ifndef SIMRUN_STARVE_H
#define SIMRUN_STARVE_H

#include <stdbool.h>

/* While on, no instruction is executed outside interrupt handlers and sections with interrupts off; a reset ends it. */
void starve(bool on);

#endif
