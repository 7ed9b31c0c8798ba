/*
 * What the chip in wokwi/ uses of Wokwi's chip API, for tests on the PC: written from its documentation
 * (docs.wokwi.com/chips-api: gpio, i2c, time, attributes), not a copy of the header that Wokwi's compiler has.
 */
#ifndef WOKWI_API_H
#define WOKWI_API_H

#include <stdbool.h>
#include <stdint.h>

#define timer_t wokwi_timer_t /* the C library has one */

enum { LOW, HIGH };
enum { INPUT, OUTPUT, INPUT_PULLUP, OUTPUT_LOW = 16 };

typedef int32_t pin_t;
typedef uint32_t timer_t;
typedef uint32_t i2c_dev_t;

typedef struct {
    void *user_data;
    void (*callback)(void *user_data);
} timer_config_t;

typedef struct {
    void *user_data;
    uint32_t address; /* 7 bits */
    pin_t scl, sda;
    bool (*connect)(void *user_data, uint32_t address, bool read); /* returns ACK */
    uint8_t (*read)(void *user_data);
    bool (*write)(void *user_data, uint8_t data); /* returns ACK */
    void (*disconnect)(void *user_data);
} i2c_config_t;

void chip_init(void);

pin_t pin_init(const char *name, uint32_t mode);
void pin_write(pin_t pin, uint32_t value);
uint32_t attr_init(const char *name, uint32_t default_value);
uint32_t attr_init_float(const char *name, float default_value);
uint32_t attr_read(uint32_t attribute);
float attr_read_float(uint32_t attribute);
timer_t timer_init(const timer_config_t *config);
void timer_start_ns(timer_t timer, uint64_t nanos, bool repeat);
void timer_stop(timer_t timer);
i2c_dev_t i2c_init(const i2c_config_t *config);

#endif
