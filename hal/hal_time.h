/*
 * Microseconds since start in 32 bits; wraps after 71.6 minutes, so compare with hal_time_reached only.
 *
 * The timer also wakes main every HAL_TICK_US, so main runs even when no other interrupt comes.
 */
#ifndef HAL_TIME_H
#define HAL_TIME_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_TICK_US 8192u
#define HAL_WAKE_LATE_US 4000u
#define HAL_WAKE_AHEAD_US 28000u /* how far ahead hal_wake_at can distinguish a time from one just past */

/* Starts the timer. Main, once. */
void hal_time_init(void);

/* Current time, us. Any context. */
uint32_t hal_time_us(void);

/* Current timer count, for hal_time_stamp_isr. Handlers. */
uint16_t hal_time_count_isr(void);

/*
 * *t_us = the time of that count, which is up to 32 ms old. Handlers; uses few registers, because a handler saves each
 * of them.
 */
void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count);

/*
 * Wakes main at this time. There is one alarm; a later call moves it. For a time more than 32.7 ms ahead main is also
 * woken every 32.768 ms before it, and likewise after a time that is past: so check the clock, do not rely on the
 * wake-up. Wakes at once if the time has just passed, less than HAL_WAKE_LATE_US ago. Main.
 */
void hal_wake_at(uint32_t t_us);

/* Counts in units of the port's HAL_LAP_US; wraps: for intervals of at most 16 ms. Main. */
uint8_t hal_time_lap(void);

/* now is at or after deadline, for times less than 35 minutes apart. Any context. */
static inline bool hal_time_reached(uint32_t now_us, uint32_t deadline_us)
{
    return (int32_t)(now_us - deadline_us) >= 0;
}

/* The port defines HAL_CPU_HZ, processor cycles per second (uint32_t), and HAL_LAP_US, the unit of hal_time_lap, us. */
#include "hal_time_port.h"

#endif
