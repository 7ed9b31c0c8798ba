/* A virtual ADXL345 and the bus transfers that its tests are made of. */
#ifndef SUPPORT_SENSOR_BUS_H
#define SUPPORT_SENSOR_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "adxl345_model.h"

enum {
    DEVID = 0x00,
    OFSX = 0x1E,
    ACT_TAP_STATUS = 0x2B,
    BW_RATE = 0x2C,
    POWER_CTL = 0x2D,
    INT_ENABLE = 0x2E,
    INT_MAP = 0x2F,
    INT_SOURCE = 0x30,
    DATA_FORMAT = 0x31,
    DATAX0 = 0x32,
    FIFO_CTL = 0x38,
    FIFO_STATUS = 0x39,
    ADDRESS_WRITE = 0xA6,
    ADDRESS_READ = 0xA7,
    MEASURE = 0x08,
    DATA_READY = 0x80,
    WATERMARK = 0x02,
    OVERRUN = 0x01,
    FULL_RES_16G = 0x0B
};

extern adxl345_model_t sensor_model;

/* What its callbacks told: edges of pin 1 and 2, triplets latched and the last of them; what went wrong, to be 0. */
typedef struct {
    unsigned rises[3], falls[3], latched, wrong;
    int16_t last[3];
} sensor_seen_t;
extern sensor_seen_t sensor_seen;

/* A new sensor with the callbacks above, nothing seen. */
void sensor_bus_begin(void);

/* Whole transfers at 0x53, a byte that is not acknowledged counts as wrong. */
void sensor_write(uint8_t address, uint8_t value);
uint8_t sensor_read(uint8_t address);
int16_t sensor_read_x(void); /* the six data bytes; returns x */

/* Up to and with the read address; then bytes with adxl345_model_read, or a word, low byte first. */
void sensor_begin_read(uint8_t address);
int16_t sensor_read_word(void);

/* DATA_FORMAT, FIFO_CTL, INT_ENABLE = DATA_READY, POWER_CTL = Measure. */
void sensor_measure(uint8_t format, uint8_t fifo_ctl);
bool sensor_tick(int x, int y, int z);

#endif
