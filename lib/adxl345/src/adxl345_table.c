/* The registers that the driver writes to the sensor, and the codes of rates and ranges. */
#include "adxl345_table.h"

#include "machine.h"

/*
 * Standby first, interrupt off before it is reconfigured (p. 20), bypass to clear the FIFO (p. 21); Measure is set
 * after the read-back. Offsets are cleared because the sensor may still hold those of another program. BW_RATE and
 * DATA_FORMAT follow from the configuration.
 */
static const table_row_t table[] IN_FLASH = {
    [TABLE_DEVID] = { ADXL345_DEVID, ADXL345_DEVID_VALUE },
    [TABLE_WRITTEN] = { ADXL345_POWER_CTL, 0 },
    { ADXL345_INT_ENABLE, 0 },
    { ADXL345_FIFO_CTL, ADXL345_FIFO_BYPASS },
    [TABLE_READ_BACK] = { ADXL345_BW_RATE, 0 },
    { ADXL345_DATA_FORMAT, 0 },
    { ADXL345_OFSX, 0 },
    { ADXL345_OFSY, 0 },
    { ADXL345_OFSZ, 0 },
    { ADXL345_INT_MAP, 0 },
    { ADXL345_FIFO_CTL, TABLE_FIFO_CTL },
    { ADXL345_INT_ENABLE, ADXL345_INT_DATA_READY },
    [TABLE_MEASURE] = { ADXL345_POWER_CTL, ADXL345_POWER_MEASURE },
    [TABLE_STANDBY] = { ADXL345_POWER_CTL, 0 },
};

enum { RATE_CODE_12_5_HZ = 7 }; /* p. 14 */

static uint8_t rate_code(uint16_t rate_dhz)
{
    uint8_t code = RATE_CODE_12_5_HZ;
    for (uint16_t at = 125; at < rate_dhz; at = (uint16_t)(at * 2u)) {
        code++;
    }
    return code;
}

/* 0 to 3 for 2, 4, 8 and 16 g (p. 27). */
static uint8_t range_code(uint8_t range_g)
{
    return (uint8_t)((uint8_t)(range_g >> 2) - (uint8_t)(range_g >> 4));
}

MACHINE_APART uint8_t adxl345_table_format(const adxl345_config_t *config)
{
    uint8_t force = config->self_test ? ADXL345_FORMAT_SELF_TEST : 0;
    return (uint8_t)(ADXL345_FORMAT_FULL_RES | force | range_code(config->range_g));
}

uint16_t adxl345_table_half_period_us(uint16_t rate_dhz)
{
    return (uint16_t)(UINT32_C(5000000) / rate_dhz); /* exact at every legal rate */
}

bool adxl345_config_valid(const adxl345_config_t *config)
{
    bool rate_ok = false;
    for (uint16_t at = 125; at <= 8000; at = (uint16_t)(at * 2u)) {
        rate_ok = rate_ok || at == config->rate_dhz;
    }
    uint8_t range = config->range_g;
    return rate_ok && (range == 2 || range == 4 || range == 8 || range == 16);
}

table_row_t adxl345_table_row(uint8_t at, const adxl345_config_t *config)
{
    const uint8_t *p = &table[at].reg;
    table_row_t row;
    row.reg = flash_u8(p++);
    row.value = flash_u8(p);
    if (row.reg == ADXL345_BW_RATE) {
        row.value = rate_code(config->rate_dhz);
    } else if (row.reg == ADXL345_DATA_FORMAT) {
        row.value = adxl345_table_format(config);
    }
    return row;
}
