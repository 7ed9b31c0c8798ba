/* Between two files of the chip's HAL: the clock's tick counts what is unfed. */
#ifndef HAL_WATCHDOG_TICK_H
#define HAL_WATCHDOG_TICK_H

/* Each HAL_TICK_US; the clock's handler. */
void hal_watchdog_tick_isr(void);

#endif
