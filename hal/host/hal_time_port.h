/* A test may change the processor clock that the firmware sees. */
#ifndef HAL_TIME_PORT_H
#define HAL_TIME_PORT_H

#include <stdint.h>

#define HAL_CPU_HZ hal_host_cpu_hz()
#define HAL_LAP_US 64u

/* What the firmware reads as HAL_CPU_HZ. */
uint32_t hal_host_cpu_hz(void);

#endif
