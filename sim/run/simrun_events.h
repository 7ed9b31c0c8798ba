/* The one timer of simavr that steps the parts whose time has come. */
#ifndef SIMRUN_EVENTS_H
#define SIMRUN_EVENTS_H

#include <stdint.h>

/* A part with times of its own: `step` runs at the cycle that `next` gives. Parts due at once: in this order. */
void events_add(uint64_t (*next)(void), void (*step)(void));
/* Also at this cycle, and every millisecond: the end of the run is looked at. */
void events_end_at(uint64_t cycle);
/* The next time of some part has changed. */
void events_reschedule(void);

#endif
