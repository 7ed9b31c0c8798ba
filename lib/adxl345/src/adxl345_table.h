/*
 * Inside the driver: the one constant table of registers that it writes, in standby, and reads back. Main only.
 */
#ifndef ADXL345_TABLE_H
#define ADXL345_TABLE_H

#include "adxl345.h"
#include "adxl345_registers.h"

/* What FIFO_CTL holds while measuring, in every mode of the driver: no reset leaves a Samples field of 10 behind. */
#define TABLE_FIFO_CTL (ADXL345_FIFO_STREAM | 0x0Au)

/* Rows of the table; from TABLE_READ_BACK on each register holds what its last row says. */
#define TABLE_ROWS 11u
#define TABLE_READ_BACK 3u

/* Register and value of a row for this configuration. */
uint8_t table_register(uint8_t row);
uint8_t table_value(uint8_t row, const adxl345_config_t *config);

/* What DATA_FORMAT holds while measuring with this configuration. */
uint8_t table_format(const adxl345_config_t *config);

/* Nominal time between samples at a legal rate. */
uint32_t table_period_us(uint16_t rate_dhz);

#endif
