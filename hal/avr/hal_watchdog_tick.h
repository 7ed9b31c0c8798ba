/* Internal to the AVR HAL: the timer tick counts the time since the last feed. */
#ifndef HAL_WATCHDOG_TICK_H
#define HAL_WATCHDOG_TICK_H

/* Called from the timer handler every HAL_TICK_US. */
void hal_watchdog_tick_isr(void);

#endif
