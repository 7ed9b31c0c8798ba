/*
 * Inside the driver: the one constant table of registers that it reads at the start, writes in standby and reads back.
 * Main only.
 */
#ifndef ADXL345_TABLE_H
#define ADXL345_TABLE_H

#include "adxl345.h"
#include "adxl345_registers.h"

/* FIFO_CTL while measuring, in every mode of the driver: no reset leaves a Samples field of 10. */
#define TABLE_FIFO_CTL (ADXL345_FIFO_STREAM | 0x0Au)

/*
 * Rows of the table. Those that configure the sensor come before TABLE_MEASURE, and from TABLE_READ_BACK on each
 * register must read back as its row says.
 */
enum {
    TABLE_DEVID,
    TABLE_WRITTEN,
    TABLE_READ_BACK = TABLE_WRITTEN + 3,
    TABLE_MEASURE = TABLE_READ_BACK + 8,
    TABLE_STANDBY
};

typedef struct {
    uint8_t reg;
    uint8_t value;
} table_row_t;

/* Register and value for this configuration. */
table_row_t adxl345_table_row(uint8_t at, const adxl345_config_t *config);

/* DATA_FORMAT while measuring with this configuration. */
uint8_t adxl345_table_format(const adxl345_config_t *config);

/* Half the nominal time between samples at a legal rate. */
uint16_t adxl345_table_half_period_us(uint16_t rate_dhz);

#endif
