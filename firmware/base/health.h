/*
 * The only place that feeds the watchdog. Each stage checks in; the watchdog is fed only when all have done so since
 * the last feed:
 *   sampling   the driver was polled, and is stopped or in a named state whose own deadline has not passed
 *   filtering  the queue got shorter or is empty, or a named pause is not over
 *   output     the transmit ring has advanced, or nothing is due
 * Missing stages are noted, so that a watchdog reset can report which one hung. Main only.
 */
#ifndef HEALTH_H
#define HEALTH_H

#include <stdbool.h>
#include <stdint.h>

/* Calls of health_pass, 1 s: the banner at 9600 baud takes 0.4 s; the ring at 9600 baud drains in 0.27 s. */
#define HEALTH_PASS_US 4000u
enum { HEALTH_HOLD_PASSES = 250 };

enum health_stage { HEALTH_SAMPLING = 1, HEALTH_FILTERING = 2, HEALTH_OUTPUT = 4, HEALTH_ALL = 7 };

void health_start(void);

/* There were so many watchdog resets in a row that this run started with safe settings, and it is not stable yet. */
bool health_is_safe(void);

/* The stages report progress as it happens. */
void health_driver_polled(void);
void health_sample_filtered(void);

/*
 * Filtering pauses on purpose for at most this many calls of health_pass (a change of the baud rate); 0 ends the pause.
 */
void health_pause_filtering(uint8_t passes);

/* Call every HEALTH_PASS_US, a delay that a person does not notice. */
void health_pass(uint32_t now_us);

#endif
