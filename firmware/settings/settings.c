/* Defaults, and the arithmetic of what the line can carry and the processor has time for. */
#include "settings/settings.h"

#include "filter_list.h"
#include "hal_time.h"
#include "machine.h"
#include "settings/settings_words.h"

static settings_t kept;
static settings_cycles_t cycles;

enum { AXES = 3 };

settings_t *settings(void)
{
    return &kept;
}

void settings_defaults(void)
{
    calibration_plain(&settings()->calibration, CALIBRATION_SCALE_3V3_XY_UQ6, CALIBRATION_SCALE_3V3_Z_UQ6);
    settings_defaults_beside_calibration();
}

void settings_defaults_beside_calibration(void)
{
    settings()->version = SETTINGS_VERSION;
    settings()->length = SETTINGS_KEPT_BYTES;
    settings()->baud = SETTINGS_BAUD_DEFAULT;
    settings()->rate_dhz = SETTINGS_RATE_DEFAULT_DHZ;
    settings()->every = 1;
    settings()->range_g = 16;
    settings_take_filter(0); /* the image's first one */
    settings()->mode = MODE_CSV;
    settings()->address = 0;
    settings()->i2c = 0;
}

uint8_t settings_filter_mark(uint8_t filter)
{
    flash_text_t name = settings_word(filter);
    uint8_t mark = 0;
    for (char c = flash_char(name); c != '\0'; c = flash_char(name)) {
        mark = (uint8_t)(mark * 2u + (uint8_t)c);
        name++;
    }
    return mark;
}

void settings_take_filter(uint8_t filter)
{
    settings()->choice.filter = filter;
    settings()->choice.mark = settings_filter_mark(filter);
    settings()->choice.own = 0;
}

MACHINE_APART uint16_t settings_filter_cycles(uint8_t filter)
{
    return (uint16_t)(AXES * filter_worst_cycles(filter_listed((filter_kind_t)filter)));
}

MACHINE_APART uint32_t settings_left_cycles(uint16_t rate_dhz)
{
    uint32_t period = HAL_CPU_HZ * 10u / rate_dhz;
    return period > SETTINGS_REST_CYCLES ? period - SETTINGS_REST_CYCLES : 0;
}

bool settings_fit(uint8_t filter, uint16_t rate_dhz)
{
    uint16_t takes = settings_filter_cycles(filter);
    uint32_t left = settings_left_cycles(rate_dhz);
    if (takes < left) {
        return true;
    }
    cycles = (settings_cycles_t){ takes, (uint16_t)left };
    return false;
}

const settings_cycles_t *settings_cycles(void)
{
    return &cycles;
}

/* Rounded up; wanted is at least 1. */
static uint16_t quotient(uint32_t wanted, uint32_t each)
{
    return (uint16_t)((wanted - 1u) / each + 1u);
}

/* Ten bits a byte: baud bytes in ten seconds; rate_dhz samples in ten seconds. */
uint16_t settings_smallest_every(uint32_t baud, uint16_t rate_dhz)
{
    return quotient((uint32_t)rate_dhz * SETTINGS_ROW_MAX, baud);
}

/* A loaded rate may be too fast for this image's filter: it is replaced by the default, which suits every filter. */
MACHINE_APART void settings_follow(void)
{
    uint16_t takes = settings_filter_cycles(settings()->choice.filter);
    uint32_t left;
    for (;;) {
        left = settings_left_cycles(settings()->rate_dhz);
        if (left > takes) {
            break;
        }
        settings()->rate_dhz = SETTINGS_RATE_DEFAULT_DHZ;
    }
    uint16_t carried = settings_smallest_every(settings()->baud, settings()->rate_dhz);
    uint16_t computed = quotient(SETTINGS_ROW_CYCLES, left - takes);
    settings()->line_is_slower = carried >= computed;
    settings()->every_smallest = settings()->line_is_slower ? carried : computed;
}

uint16_t settings_every_in_force(void)
{
    return settings()->every > settings()->every_smallest ? settings()->every : settings()->every_smallest;
}
