/*
 * The watchdog's one feeding place. Each stage checks in; the dog is fed only when all have since the last time:
 *   sampling   the driver was polled, and is stopped or in a named state whose own deadline has not passed
 *   filtering  the queue got shorter or is empty, or a named pause is not over
 *   output     the transmit ring moved on, or nothing is due
 * What is still missing is noted, so that a watchdog reset can say which stage hung. Main only.
 */
#ifndef HEALTH_H
#define HEALTH_H

#include <stdbool.h>
#include <stdint.h>

/* Of health_pass, 1 s: the banner at 9600 baud takes 0.4 s; the ring at 9600 baud drains in 0.27 s. */
#define HEALTH_PASS_US 4000u
enum { HEALTH_HOLD_PASSES = 250 };

enum health_stage { HEALTH_SAMPLING = 1, HEALTH_FILTERING = 2, HEALTH_OUTPUT = 4, HEALTH_ALL = 7 };

void health_start(void);

/* The watchdog brought so many resets in a row that this run begins with safe settings, and it has not lasted yet. */
bool health_is_safe(void);

/* The stages report progress as it happens. */
void health_driver_polled(void);
void health_sample_filtered(void);

/* Filtering pauses on purpose for so many of the passes below at most (a change of the baud rate); 0: no longer. */
void health_pause_filtering(uint8_t passes);

/* To be called every HEALTH_PASS_US, which a person does not notice. */
void health_pass(uint32_t now_us);

#endif
