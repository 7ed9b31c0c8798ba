/* On the PC all of hal_sleep.h is in hal_host_clock.c. */
#ifndef HAL_SLEEP_PORT_H
#define HAL_SLEEP_PORT_H

#endif
