/* Shipped parameters with the user's on top; see parameters.h. */
#include "parameters.h"

#include "calibration.h"
#include "filter_parameter.h"
#include "fx.h"
#include "settings.h"
#include "text.h"

/* The ranges of calibration_check, which has the last word: a level is up to 1.15 g long. */
static const filter_parameter_t vectors[] FX_FLASH = {
    { "offset", "LSB", offsetof(calibration_t, offset_lsb_q4), 2, 4, 0, 1, -CALIBRATION_OFFSET_MAX_LSB_Q4,
      CALIBRATION_OFFSET_MAX_LSB_Q4 },
    { "scale", "LSB/g", offsetof(calibration_t, scale_lsb_per_g_uq6), 2, 6, 0, 0, CALIBRATION_SCALE_MIN_UQ6,
      CALIBRATION_SCALE_MAX_UQ6 },
    { "level", "", offsetof(calibration_t, level_q14), 2, 14, 0, 1, -18841, 18841 },
};

enum { VECTORS = sizeof vectors / sizeof vectors[0] };

static const filter_descriptor_t *descriptor(void)
{
    return filter_any_descriptor((filter_kind_t)settings.filter);
}

uint8_t parameters_count(void)
{
    return (uint8_t)(VECTORS + fx_flash_u8(&descriptor()->parameter_count));
}

static const filter_parameter_t *of_filter(uint8_t which)
{
    return (const filter_parameter_t *)fx_flash_pointer(&descriptor()->parameters) + which;
}

const filter_parameter_t *parameters_at(uint8_t which)
{
    return which < VECTORS ? &vectors[which] : of_filter((uint8_t)(which - VECTORS));
}

uint8_t parameters_numbers(uint8_t which)
{
    return which < VECTORS ? PARAMETERS_AXES : 1;
}

uint8_t parameters_find(const char *name)
{
    uint8_t which = parameters_count();
    while (which != 0) {
        which--;
        if (text_equal(name, parameters_at(which)->name)) {
            return which;
        }
    }
    return PARAMETERS_NONE;
}

/* A filter's configuration at a rate; as the user wants it, if it is the one in force. */
static void configuration(filter_any_config_t *config, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_any_defaults(kind, config, rate_dhz);
    uint8_t own = (uint8_t)kind == settings.filter ? settings.own : 0;
    for (uint8_t which = 0; own != 0; which++, own >>= 1) {
        if (own & 1u) {
            filter_parameter_set(config, of_filter(which), settings.parameters[which]);
        }
    }
    if (!filter_any_together(kind, config)) { /* the user's were set beside those of another rate */
        filter_any_defaults(kind, config, rate_dhz);
    }
}

/* The number of a vector in its calibration: its fields are of 16 bits. */
static void *place_in(calibration_t *calibration, uint8_t number)
{
    return (uint8_t *)calibration + 2u * number;
}

uint32_t parameters_value(uint8_t which, uint8_t number)
{
    const filter_parameter_t *parameter = parameters_at(which);
    if (which < VECTORS) {
        return filter_parameter_get(place_in(&settings.calibration, number), parameter);
    }
    filter_any_config_t config;
    configuration(&config, (filter_kind_t)settings.filter, settings.rate_dhz);
    return filter_parameter_get(&config, parameter);
}

static bool set_vector(const filter_parameter_t *parameter, const uint32_t values[PARAMETERS_AXES])
{
    calibration_t wanted = settings.calibration;
    for (uint8_t number = 0; number < PARAMETERS_AXES; number++) {
        filter_parameter_set(place_in(&wanted, number), parameter, values[number]);
    }
    return settings_calibrate(&wanted);
}

static bool set_parameter(uint8_t which, uint32_t value)
{
    filter_any_config_t config;
    configuration(&config, (filter_kind_t)settings.filter, settings.rate_dhz);
    filter_parameter_set(&config, of_filter(which), value);
    if (!filter_any_together((filter_kind_t)settings.filter, &config)) {
        return false;
    }
    settings.parameters[which] = value;
    settings.own = (uint8_t)(settings.own | 1u << which);
    return true;
}

bool parameters_set(uint8_t which, const uint32_t values[PARAMETERS_AXES])
{
    const filter_parameter_t *parameter = parameters_at(which);
    for (uint8_t number = parameters_numbers(which); number != 0;) {
        number--;
        if (!filter_parameter_in_range(parameter, values[number])) {
            return false;
        }
    }
    return which < VECTORS ? set_vector(parameter, values) : set_parameter((uint8_t)(which - VECTORS), values[0]);
}

void parameters_start(filter_any_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_any_config_t config;
    configuration(&config, kind, rate_dhz);
    filter_any_configure(f, kind, &config);
}

uint32_t parameters_r_lsb2_q8(void)
{
    for (uint8_t which = 0, own = settings.own; own != 0; which++, own >>= 1) {
        const char *name = of_filter(which)->name;
        if ((own & 1u) && flash_char(name) == 'r' && flash_char(name + 1) == '\0') {
            return settings.parameters[which];
        }
    }
    return 0;
}
