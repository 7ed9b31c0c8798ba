/* What ends a run early: a failure, of which the first counts, or a signal. */
#ifndef SIMRUN_FAILURE_H
#define SIMRUN_FAILURE_H

#include <stdbool.h>
#include <stdint.h>

#include "simrun_output.h"

/* Before the chip: simavr's messages come here. last_pc: start of the last step, the place a wild jump came from. */
void failure_start(const uint32_t *last_pc);
void failure_set(exit_status_t status, const char *reason); /* `reason` must stay valid */
exit_status_t failure_status(void);
bool failure_asked_to_end(void); /* by SIGINT or SIGTERM: the run keeps its files and prints its summary */
/* The run is over: drops what simavr still says. The reason has its time and place; static text. */
exit_status_t failure_end(const char **reason);

#endif
