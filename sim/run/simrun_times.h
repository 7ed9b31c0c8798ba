/* Cycles asleep, in interrupts and awake, the load that follows, and how long the main loop's passes take. */
#ifndef SIMRUN_TIMES_H
#define SIMRUN_TIMES_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum {
    VECTORS = 26, /* 0 is the reset and not counted */
    VECTOR_BYTES = 4,
    ENTRY_CYCLES = 4 /* interrupt response (data sheet "Interrupt Response Time"), which simavr omits */
};

void times_start(void);
void times_reset(void);
void times_pass_ends(void);        /* main sleeps */
void times_sleep(uint64_t cycles); /* main has slept for so long */
uint64_t times_interrupted(void);  /* cycles in interrupt handlers, entry and return included */
uint64_t times_own_cycles(void);   /* awake, without the responses to interrupts */
bool times_in_interrupt(void);
const char *times_vector_name(unsigned vector); /* as in --stats; static text */
/* Streaming, for the load: first row, end of the stream. */
void times_streaming_begins(void);
void times_streaming_ends(void);
double times_load(void);
void times_print(FILE *json);

#endif
