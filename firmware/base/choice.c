/* The shipped parameters, overridden by the user's; see choice.h. */
#include "base/choice.h"

_Static_assert((int)FILTER_PARAMETERS_MAX <= (int)CHOICE_PARAMETERS_MAX, "room for a filter's parameters");

const filter_law_t *choice_law(const filter_choice_t *choice)
{
    return filter_listed((filter_kind_t)choice->filter);
}

/*
 * False: the filter refuses the user's parameters, for example ones that were set at a rate with other defaults; then
 * all are as shipped.
 */
static bool configure(const filter_choice_t *choice, filter_config_t *config, filter_kind_t kind, uint16_t rate_dhz)
{
    const filter_law_t *law = filter_listed(kind);
    uint8_t own = (uint8_t)kind == choice->filter ? choice->own : 0;
    for (bool legal = true;; legal = false) {
        filter_set_defaults(config, law, rate_dhz);
        const uint32_t *from = choice->parameters;
        for (int32_t *to = config->value; own != 0; to++, from++, own >>= 1) {
            if (own & 1u) {
                *to = (int32_t)*from;
            }
        }
        if (!legal || filter_judge(law, config) == FILTER_ACCEPTED) {
            return legal;
        }
    }
}

bool choice_legal(const filter_choice_t *choice, uint16_t rate_dhz)
{
    filter_config_t config;
    return configure(choice, &config, (filter_kind_t)choice->filter, rate_dhz);
}

uint32_t choice_value(const filter_choice_t *choice, uint16_t rate_dhz, uint8_t which)
{
    filter_config_t config;
    (void)configure(choice, &config, (filter_kind_t)choice->filter, rate_dhz);
    return (uint32_t)config.value[which];
}

void choice_begin(const filter_choice_t *choice, filter_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_config_t config;
    (void)configure(choice, &config, kind, rate_dhz);
    (void)filter_init(f, filter_listed(kind), &config); /* configure has judged it */
}

uint32_t choice_r_lsb2_q8(const filter_choice_t *choice)
{
    for (uint8_t which = 0, own = choice->own; own != 0; which++, own >>= 1) {
        if ((own & 1u) && filter_parameter(choice_law(choice), which) == &filter_parameter_r) {
            return choice->parameters[which];
        }
    }
    return 0;
}
