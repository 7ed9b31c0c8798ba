/* Shipped parameters with the user's on top; see parameters.h. */
#include "parameters.h"

#include "calibration.h"
#include "fx.h"
#include "settings.h"
#include "text.h"

/* The ranges of calibration_check, which has the last word: a level is up to 1.15 g long. */
enum { OFFSET, SCALE, LEVEL, VECTORS };
static const filter_parameter_t vectors[VECTORS] FX_FLASH = {
    [OFFSET] = { "offset", "LSB", 4, 0, -CALIBRATION_OFFSET_MAX_LSB_Q4, CALIBRATION_OFFSET_MAX_LSB_Q4, 0 },
    [SCALE] = { "scale", "LSB/g", 6, 0, CALIBRATION_SCALE_MIN_UQ6, CALIBRATION_SCALE_MAX_UQ6, 0 },
    [LEVEL] = { "level", "", 14, 0, -18841, 18841, 0 },
};

_Static_assert(CALIBRATION_SCALE_MAX_UQ6 <= INT16_MAX, "a vector's numbers are of 16 bits with sign");
_Static_assert((int)FILTER_PARAMETERS_MAX <= (int)SETTINGS_PARAMETERS_MAX, "the settings hold a filter's parameters");

static const filter_law_t *law_in_force(void)
{
    return filter_listed((filter_kind_t)settings.filter);
}

uint8_t parameters_count(void)
{
    return (uint8_t)(VECTORS + filter_parameter_count(law_in_force()));
}

const filter_parameter_t *parameters_at(uint8_t which)
{
    return which < VECTORS ? &vectors[which] : filter_parameter(law_in_force(), (uint8_t)(which - VECTORS));
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
static filter_config_t configuration(filter_kind_t kind, uint16_t rate_dhz)
{
    const filter_law_t *law = filter_listed(kind);
    filter_config_t config = filter_defaults(law, rate_dhz);
    uint8_t own = (uint8_t)kind == settings.filter ? settings.own : 0;
    for (uint8_t which = 0; which < FILTER_PARAMETERS_MAX; which++, own >>= 1) {
        if (own & 1u) {
            config.value[which] = (int32_t)settings.parameters[which];
        }
    }
    if (filter_judge(law, &config) == FILTER_ACCEPTED) {
        return config;
    }
    return filter_defaults(law, rate_dhz); /* the user's were set beside those of another rate */
}

static filter_config_t configuration_in_force(void)
{
    return configuration((filter_kind_t)settings.filter, settings.rate_dhz);
}

static int16_t *vector_in(calibration_t *calibration, uint8_t which)
{
    switch (which) {
    case OFFSET:
        return calibration->offset_lsb_q4;
    case SCALE:
        return (int16_t *)calibration->scale_lsb_per_g_uq6;
    default:
        return calibration->level_q14;
    }
}

uint32_t parameters_value(uint8_t which, uint8_t number)
{
    if (which < VECTORS) {
        return (uint32_t)(int32_t)vector_in(&settings.calibration, which)[number];
    }
    return (uint32_t)configuration_in_force().value[which - VECTORS];
}

static bool set_vector(uint8_t which, const uint32_t values[PARAMETERS_AXES])
{
    calibration_t wanted = settings.calibration;
    int16_t *vector = vector_in(&wanted, which);
    for (uint8_t number = 0; number < PARAMETERS_AXES; number++) {
        if (!filter_in_range(&vectors[which], (int32_t)values[number])) {
            return false;
        }
        vector[number] = (int16_t)values[number];
    }
    return settings_calibrate(&wanted);
}

bool parameters_set(uint8_t which, const uint32_t values[PARAMETERS_AXES])
{
    if (which < VECTORS) {
        return set_vector(which, values);
    }
    which = (uint8_t)(which - VECTORS);
    filter_config_t config = configuration_in_force();
    config.value[which] = (int32_t)values[0];
    if (filter_judge(law_in_force(), &config) != FILTER_ACCEPTED) {
        return false;
    }
    settings.parameters[which] = values[0];
    settings.own = (uint8_t)(settings.own | 1u << which);
    return true;
}

void parameters_start(filter_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_config_t config = configuration(kind, rate_dhz);
    (void)filter_init(f, filter_listed(kind), &config); /* judged there */
}

uint32_t parameters_r_lsb2_q8(void)
{
    for (uint8_t which = 0, own = settings.own; own != 0; which++, own >>= 1) {
        const char *name = filter_parameter(law_in_force(), which)->name;
        if ((own & 1u) && flash_char(name) == 'r' && flash_char(name + 1) == '\0') {
            return settings.parameters[which];
        }
    }
    return 0;
}
