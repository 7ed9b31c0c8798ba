/* What the driver writes into the sensor, and the codes of rates and ranges. */
#include "adxl345_table.h"

#include "flash.h"
#include "hal_pointer.h"

typedef struct {
    uint8_t reg;
    uint8_t value; /* BW_RATE and DATA_FORMAT: from rate and range */
} setting_t;

/*
 * Standby first, interrupt off before it is reconfigured (p. 20), bypass to clear the FIFO (p. 21); Measure is set
 * after the read-back. Offsets are cleared because the sensor may have kept another program's.
 */
static const setting_t table[] FLASH = {
    { ADXL345_POWER_CTL, 0 },
    { ADXL345_INT_ENABLE, 0 },
    { ADXL345_FIFO_CTL, ADXL345_FIFO_BYPASS },
    { ADXL345_BW_RATE, 0 },
    { ADXL345_DATA_FORMAT, 0 },
    { ADXL345_OFSX, 0 },
    { ADXL345_OFSY, 0 },
    { ADXL345_OFSZ, 0 },
    { ADXL345_INT_MAP, 0 },
    { ADXL345_FIFO_CTL, TABLE_FIFO_CTL },
    { ADXL345_INT_ENABLE, ADXL345_INT_DATA_READY },
};

_Static_assert(sizeof table / sizeof table[0] == TABLE_ROWS, "TABLE_ROWS");

enum { RATE_CODE_12_5_HZ = 7 }; /* p. 14 */

static uint8_t rate_code(uint16_t rate_dhz)
{
    uint8_t code = RATE_CODE_12_5_HZ;
    for (uint16_t at = 125; at < rate_dhz; at = (uint16_t)(at * 2u)) {
        code++;
    }
    return code;
}

static uint8_t range_code(uint8_t range_g)
{
    uint8_t code = 0;
    for (uint8_t at = 2; at < range_g; at = (uint8_t)(at * 2u)) {
        code++;
    }
    return code;
}

HAL_APART uint8_t table_format(const adxl345_config_t *config)
{
    uint8_t force = config->self_test ? ADXL345_FORMAT_SELF_TEST : 0;
    return (uint8_t)(ADXL345_FORMAT_FULL_RES | force | range_code(config->range_g));
}

uint32_t table_period_us(uint16_t rate_dhz)
{
    return 80000ul >> (rate_code(rate_dhz) - RATE_CODE_12_5_HZ);
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

uint8_t table_register(uint8_t row)
{
    return flash_u8(&table[row].reg);
}

uint8_t table_value(uint8_t row, const adxl345_config_t *config)
{
    uint8_t reg = flash_u8(&table[row].reg);
    uint8_t value = flash_u8(&table[row].value);
    if (reg == ADXL345_BW_RATE) {
        value = rate_code(config->rate_dhz);
    } else if (reg == ADXL345_DATA_FORMAT) {
        value = table_format(config);
    }
    return value;
}
