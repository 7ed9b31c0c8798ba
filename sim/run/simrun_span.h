/* Cycles from one function's entry to another's (--span). */
#ifndef SIMRUN_SPAN_H
#define SIMRUN_SPAN_H

#include <stdbool.h>
#include <stdint.h>

/* FROM:TO:CSV, or NULL: false. Needs the symbols; exits with EXIT_INPUT if a name is unknown. */
bool span_start(const char *wanted);
void span_on_pc(uint32_t pc);
void span_reset(void);
void span_finish(void);

#endif
