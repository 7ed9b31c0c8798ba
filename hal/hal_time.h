/*
 * Microseconds since start in 32 bits; wraps after 71.6 minutes, so compare with hal_time_reached only.
 *
 * The timer also wakes main every HAL_TICK_US, so main looks around even when no other interrupt comes.
 */
#ifndef HAL_TIME_H
#define HAL_TIME_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_TICK_US 8192u
#define HAL_WAKE_LATE_US 4000u
#define HAL_WAKE_AHEAD_US 28000u /* hal_wake_at tells a moment so far ahead from one that has just passed */

/* Starts the timer. Main, once. */
void hal_time_init(void);

/* Now, us. Any context. */
uint32_t hal_time_us(void);

/* The timer now: for hal_time_stamp_isr. A handler. */
uint16_t hal_time_count_isr(void);

/*
 * *t_us = the time of that count, up to 32 ms ago. A handler; in few registers, because it saves each that it uses.
 */
void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count);

/*
 * Wakes main at this moment; one alarm, a later call moves it. For moments more than 32.7 ms ahead main is also woken
 * each 32.768 ms before, and the same after a moment that is past: so look at the clock, not at having been woken. At
 * once where it has just passed, less than HAL_WAKE_LATE_US ago. Main.
 */
void hal_wake_at(uint32_t t_us);

/* Counts the port's HAL_LAP_US, wraps: for times of at most 16 ms. Main. */
uint8_t hal_time_lap(void);

/* now is at or after deadline, for moments less than 35 minutes apart. Any context. */
static inline bool hal_time_reached(uint32_t now_us, uint32_t deadline_us)
{
    return (int32_t)(now_us - deadline_us) >= 0;
}

/* The port's HAL_CPU_HZ: cycles of the processor in a second (uint32_t); HAL_LAP_US: what hal_time_lap counts, us. */
#include "hal_time_port.h"

#endif
