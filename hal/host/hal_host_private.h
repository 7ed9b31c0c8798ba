/*
 * Shared by the parts of the host's HAL. The clock is the lowest of them and knows the others only through the table
 * that hal_host.c, the highest, passes to it.
 */
#ifndef HAL_HOST_PRIVATE_H
#define HAL_HOST_PRIVATE_H

#include "hal_host.h"

#define HOST_NEVER UINT64_MAX

enum { HOST_CYCLES_PER_US = 16 };

/* A part of the board that acts by itself as time passes. */
typedef struct {
    uint64_t (*next)(void); /* cycle of its next event, HOST_NEVER: none; NULL: it runs after each event */
    void (*step)(void);     /* runs at that cycle or later */
} host_part_t;

/* hal_host_clock.c: time, and the sleep during which it passes */
/* Power-on with a copy of this configuration; these parts, in this order if several are due, stay the caller's. */
void host_clock_begin(const hal_host_config_t *config, const host_part_t *parts, size_t count);
/* What host_clock_begin got, for the parts to read. */
const hal_host_config_t *host_config(void);
void host_clock_reset(void);
/* Main itself takes this long: what becomes due meanwhile waits for its sleep. */
void host_clock_spend(uint64_t cycles);
/* Time stops until host_clock_reset, and a sleep ends at once. */
void host_clock_stop(void);

/* hal_host_eeprom.c */
void host_eeprom_power_on(void);
void host_eeprom_reset(void);

/* hal_host_sensor.c: the sensor and its INT1 line */
void host_sensor_begin(const stream_t *stream, bool loop);
uint64_t host_sensor_next(void);
void host_sensor_step(void);
/* After every bus write: the firmware may have changed the output data rate. */
void host_sensor_check_rate(void);
void host_drdy_reset(void);
void host_drdy_tick(void);
/* Runs the handler of a pending edge, unless it is blocked. */
void host_drdy_serve(void);
/* An edge waits until it is blocked no more; returns whether it was. */
bool host_drdy_block(bool blocked);

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

#endif
