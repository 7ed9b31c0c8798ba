/* Cycles of each instruction executed (--profile), and by call chain (--calls). */
#ifndef SIMRUN_PROFILE_H
#define SIMRUN_PROFILE_H

#include <stdbool.h>
#include <stdint.h>

bool profile_start(const char *path, const char *calls); /* either may be NULL; both: false */
void profile_on_step(uint32_t pc, uint64_t cycles);
void profile_reset(void); /* of the MCU */
void profile_finish(void);

#endif
