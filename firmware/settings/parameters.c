/* Shipped parameters with the user's on top; see parameters.h. */
#include "settings/parameters.h"

#include "fx.h"
#include "settings/settings.h"

static const filter_law_t *law_in_force(void)
{
    return filter_listed((filter_kind_t)settings.filter);
}

/*
 * What the user wants of the filter in force, what is shipped of another. False: the filter does not take that, as
 * where it was set beside what another rate has; then all are as shipped.
 */
static bool configure(filter_config_t *config, filter_kind_t kind, uint16_t rate_dhz)
{
    const filter_law_t *law = filter_listed(kind);
    uint8_t own = (uint8_t)kind == settings.filter ? settings.own : 0;
    for (bool legal = true;; legal = false) {
        *config = filter_defaults(law, rate_dhz);
        for (uint8_t which = 0; own != 0; which++, own >>= 1) {
            if (own & 1u) {
                config->value[which] = (int32_t)settings.parameters[which];
            }
        }
        if (!legal || filter_judge(law, config) == FILTER_ACCEPTED) {
            return legal;
        }
    }
}

bool parameters_legal(void)
{
    filter_config_t config;
    return configure(&config, (filter_kind_t)settings.filter, settings.rate_dhz);
}

uint32_t parameters_value(uint8_t which)
{
    filter_config_t config;
    (void)configure(&config, (filter_kind_t)settings.filter, settings.rate_dhz);
    return (uint32_t)config.value[which];
}

void parameters_start(filter_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_config_t config;
    (void)configure(&config, kind, rate_dhz);
    (void)filter_init(f, filter_listed(kind), &config); /* judged there */
}

uint32_t parameters_r_lsb2_q8(void)
{
    for (uint8_t which = 0, own = settings.own; own != 0; which++, own >>= 1) {
        if ((own & 1u) && filter_parameter(law_in_force(), which) == &filter_parameter_r) {
            return settings.parameters[which];
        }
    }
    return 0;
}
