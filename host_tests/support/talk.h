/* What suites of the whole firmware say to it and hear from it; what is not as it must be fails the test. */
#ifndef SUPPORT_TALK_H
#define SUPPORT_TALK_H

#include <stdbool.h>
#include <stddef.h>

#include "support/board.h"

/* Type a line and run for 400 ms: a save takes 0.3 s. */
void talk_type(const char *line);

/* The reply to a line, which must be the only one. */
const char *talk_answer(const char *line);

/* Type a command and run for so long: the index of the first note that it can be told by. */
size_t talk_typed(const char *command, double ms);

/* The note at an index is there and says this. */
void talk_assert_note(const char *expected, size_t at);

/* What is told of a measurement that something came into: its result, or that it was cut; one of them, once. */
void talk_assert_told_once(size_t note, const char *of);

/* Power on with a sensor at rest, until samples come. */
void talk_start(void);

/* Power comes back over the same EEPROM, D4 at GND with `strap`. */
void talk_power_cycle(bool strap);

/* Power on at rest with noise of 1.5 LSB for a minute, at this rate and with the clock so far off. */
void talk_start_noisy(double rate_hz, double ppm);

#endif
