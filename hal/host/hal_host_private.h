/* Shared by the parts of the host's HAL. Each device has a time of its next event, HOST_NEVER if none, and a step. */
#ifndef HAL_HOST_PRIVATE_H
#define HAL_HOST_PRIVATE_H

#include "hal_host.h"

#define HOST_NEVER UINT64_MAX

/* hal_host.c: the clock */
extern uint64_t host_now;
extern hal_host_config_t host_config;
void host_drdy_changed(bool high);
void host_drdy_serve(void);

/* hal_host_eeprom.c */
void host_eeprom_power_on(void);
void host_eeprom_reset(void);

/* hal_host_i2c.c */
void hal_host_i2c_handler(void);
void host_i2c_power_on(void);
void host_i2c_begin(void);
uint64_t host_i2c_next(void);
void host_i2c_step(void);

/* hal_host_uart.c */
void host_uart_begin(void);
uint64_t host_uart_next(void);
void host_uart_step(void);

/* hal_host_sensor.c */
void host_sensor_begin(const stream_t *stream, bool loop);
uint64_t host_sensor_next(void);
void host_sensor_step(void);
/* After every bus write: the firmware may have changed the output data rate. */
void host_sensor_check_rate(void);

#endif
