/* Defaults and the arithmetic of what the line carries. */
#include "settings.h"

#include "filter_any.h"
#include "flash.h"

settings_t settings;

static const uint32_t bauds[] FLASH = { 9600, 19200, 38400, 57600, 115200, 250000, 500000, 1000000 };

void settings_defaults(void)
{
    settings.baud = SETTINGS_BAUD_DEFAULT;
    settings.rate_dhz = 1000;
    settings.every = 1;
    settings.range_g = 16;
    settings.filter = FILTER_KIND_sprf;
    settings.mode = MODE_CSV;
}

bool settings_baud_valid(uint32_t baud)
{
    for (uint8_t i = 0; i < sizeof bauds / sizeof bauds[0]; i++) {
        if (flash_u32(&bauds[i]) == baud) {
            return true;
        }
    }
    return false;
}

/* Ten bits a byte: baud bytes in ten seconds; rate_dhz samples in ten seconds. */
uint16_t settings_smallest_every(uint32_t baud, uint16_t rate_dhz)
{
    uint32_t bytes_per_sample_each = (uint32_t)rate_dhz * SETTINGS_ROW_MAX;
    uint32_t carried = 0;
    uint16_t every = 0;
    while (carried < bytes_per_sample_each) {
        carried += baud;
        every++;
    }
    return every == 0 ? 1 : every;
}

uint16_t settings_every_in_force(void)
{
    uint16_t smallest = settings_smallest_every(settings.baud, settings.rate_dhz);
    return settings.every > smallest ? settings.every : smallest;
}
