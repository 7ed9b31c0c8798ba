/* Cycles of each instruction executed (--profile), and by call chain (--calls). */
#ifndef SIMRUN_PROFILE_H
#define SIMRUN_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

void profile_start(const char *path, const char *calls); /* either may be NULL */
bool profile_wanted(void);

/*
 * Cycles of a run from there that ends with the first instruction after which the program may go elsewhere; no longer
 * than about the most. 0: one instruction.
 */
uint64_t profile_straight_cycles(uint32_t pc, uint64_t most);
void profile_on_step(uint32_t pc, uint64_t cycles); /* such a run, or a shorter one */
void profile_reset(void);                           /* of the MCU */
void profile_finish(void);

#endif
