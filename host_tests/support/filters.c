/* Parameters and random configurations of the filters of the list, for tests that know none of them by name. */
#include "support/filters.h"

/* Draws until a joint condition is met: a region that fills a tenth of the box is missed by one in 10^11. */
#define DRAWS_MAX 250U

uint8_t linked_kind(uint8_t kind)
{
    while (kind < (uint8_t)FILTER_KIND_COUNT && filter_listed((filter_kind_t)kind) == NULL) {
        kind++;
    }
    return kind;
}

uint8_t any_kind(uint32_t number)
{
    uint8_t linked[FILTER_KIND_COUNT] = { 0 };
    uint8_t count = 0;
    FOR_EACH_KIND(kind)
    {
        linked[count] = kind;
        count++;
    }
    return linked[number % count];
}

filter_kind_t kind_of(const filter_t *f)
{
    uint8_t kind = linked_kind(0);
    while (kind < (uint8_t)FILTER_KIND_COUNT && filter_listed((filter_kind_t)kind) != f->law) {
        kind = linked_kind((uint8_t)(kind + 1U));
    }
    return (filter_kind_t)kind;
}

uint8_t parameter_count(filter_kind_t kind)
{
    return filter_parameter_count(filter_listed(kind));
}

filter_parameter_t parameter_at(filter_kind_t kind, uint8_t index)
{
    filter_parameter_t parameter = { 0 };
    const uint8_t *from = (const uint8_t *)filter_parameter(filter_listed(kind), index);
    uint8_t *to = (uint8_t *)&parameter;
    for (uint8_t i = 0; i < sizeof parameter; i++) {
        to[i] = flash_u8(from + i);
    }
    return parameter;
}

const char *parameter_name(filter_kind_t kind, uint8_t index)
{
    static char name[16];
    const char *from = filter_parameter_words(filter_parameter(filter_listed(kind), index));
    for (uint8_t i = 0; i < sizeof name - 1U; i++) {
        name[i] = (char)flash_u8((const uint8_t *)from + i);
        if (name[i] == '\0') {
            break;
        }
    }
    return name;
}

bool parameter_legal(const filter_parameter_t *parameter, int32_t value)
{
    return (value >= parameter->min && value <= parameter->max) || (value == 0 && parameter->zero_means_off != 0U);
}

bool init_default(filter_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_config_t config = filter_defaults(filter_listed(kind), rate_dhz);
    return filter_init(f, filter_listed(kind), &config) == FILTER_ACCEPTED;
}

int32_t estimate_of(const filter_t *f)
{
    filter_probe_t probe = { 0 };
    filter_probe(f, &probe);
    return probe.x_lsb_q16;
}

/*
 * One in eight an end, one in four anywhere; else the distance from the number of the range that is nearest to zero is
 * spread over the decades, to either side of a zero within.
 */
static uint32_t random_in(uint32_t *random, uint32_t min, uint32_t max)
{
    uint8_t how = (uint8_t)(random32(random) >> 24);
    if (how < 32U) {
        return (how < 16U) ? min : max;
    }
    uint32_t distance = random32(random);
    if (how < 96U) {
        return min + distance % (max - min + 1U);
    }
    distance >>= how & 31U;
    if ((int32_t)min >= 0) {
        return min + distance % (max - min + 1U);
    }
    return (how & 32U) != 0U ? distance % (max + 1U) : 0U - distance % (1U - min);
}

void random_config(uint32_t *random, filter_kind_t kind, filter_config_t *config)
{
    uint16_t rate_dhz = (uint16_t)random_in(random, FILTER_RATE_MIN_DHZ, FILTER_RATE_MAX_DHZ);
    *config = filter_defaults(filter_listed(kind), rate_dhz);
    for (uint8_t i = 0; i < parameter_count(kind); i++) {
        filter_parameter_t parameter = parameter_at(kind, i);
        config->value[i] = (int32_t)random_in(random, (uint32_t)parameter.min, (uint32_t)parameter.max);
        if (parameter.zero_means_off != 0U && random32_below(random, 8) == 0U) {
            config->value[i] = 0;
        }
    }
}

bool init_random(filter_t *f, filter_kind_t kind, uint32_t *random, uint32_t *refused)
{
    for (uint8_t draw = 0; draw < DRAWS_MAX; draw++) {
        filter_config_t config;
        random_config(random, kind, &config);
        if (filter_init(f, filter_listed(kind), &config) == FILTER_ACCEPTED) {
            return true;
        }
        if (!law_facts(kind).joint_condition) {
            return false;
        }
        (*refused)++;
    }
    return false;
}
