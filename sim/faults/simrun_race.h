/* Interrupts at accesses that main shares with their handlers (--race). */
#ifndef SIMRUN_RACE_H
#define SIMRUN_RACE_H

#include <stdbool.h>

bool race_start(const char *path); /* NULL: false */
/* Before each step; awake: it is an instruction. May let time pass and enter a handler; true: check everything. */
bool race_on_step(bool awake);
void race_finish(void); /* stderr, and the file */

#endif
