/* The run, from the first instruction to the end. */
#ifndef SIMRUN_MACHINE_H
#define SIMRUN_MACHINE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    double max_ms;     /* 0: no limit */
    unsigned gdb_port; /* 0: none */
    bool interactive;  /* somebody waits at the other end: the run has no end of its own */
} machine_options_t;

void machine_prepare(const machine_options_t *wanted); /* before the chip starts */
void machine_start(void);                              /* after it */
void machine_run(bool each);                           /* --race and the like look at each instruction */
uint64_t machine_steps(void); /* checks of PC and stack: the cost of the simulation, independent of the PC */

#endif
