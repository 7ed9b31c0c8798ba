/* Parameters and random configurations of the filters of the list, for tests that know none of them by name. */
#include "support_filters.h"

/* Draws until a joint condition is met: a region that fills a tenth of the box is missed by one in 10^11. */
#define DRAWS_MAX 250U

uint32_t random32(uint32_t *state)
{
    uint32_t v = *state;
    v ^= v << 13;
    v ^= v >> 17;
    v ^= v << 5;
    *state = v;
    return v;
}

uint32_t random32_below(uint32_t *state, uint32_t end)
{
    return random32(state) % end;
}

uint8_t linked_kind(uint8_t kind)
{
    while (kind < (uint8_t)FILTER_KIND_COUNT && filter_any_descriptor((filter_kind_t)kind) == NULL) {
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

static void copy_from_flash(void *to, const void *from, uint8_t size)
{
    uint8_t *target = (uint8_t *)to;
    const uint8_t *source = (const uint8_t *)from;
    for (uint8_t i = 0; i < size; i++) {
        target[i] = fx_flash_u8(source + i);
    }
}

static filter_descriptor_t descriptor_of(filter_kind_t kind)
{
    filter_descriptor_t descriptor;
    copy_from_flash(&descriptor, filter_any_descriptor(kind), sizeof descriptor);
    return descriptor;
}

uint8_t parameter_count(filter_kind_t kind)
{
    return descriptor_of(kind).parameter_count;
}

filter_parameter_t parameter_at(filter_kind_t kind, uint8_t index)
{
    filter_parameter_t parameter;
    copy_from_flash(&parameter, descriptor_of(kind).parameters + index, sizeof parameter);
    return parameter;
}

void parameter_set(filter_any_config_t *config, const filter_parameter_t *parameter, uint32_t value)
{
    uint8_t *field = (uint8_t *)config + parameter->offset;
    for (uint8_t i = 0; i < parameter->size; i++, value >>= 8) { /* little-endian, PC and chip */
        field[i] = (uint8_t)value;
    }
}

uint32_t parameter_get(const filter_any_config_t *config, const filter_parameter_t *parameter)
{
    const uint8_t *field = (const uint8_t *)config + parameter->offset;
    bool negative = (int32_t)parameter->min < 0 && (field[parameter->size - 1U] & 0x80U) != 0U;
    uint32_t value = negative ? UINT32_MAX : 0U;
    for (uint8_t i = parameter->size; i-- > 0U;) {
        value = (value << 8) | field[i];
    }
    return value;
}

bool parameter_legal(const filter_parameter_t *parameter, uint32_t value)
{
    /* both from the lower end: right for signed and unsigned ranges */
    bool in_range = value - (uint32_t)parameter->min <= (uint32_t)parameter->max - (uint32_t)parameter->min;
    return in_range || (value == 0U && parameter->zero_means_off != 0U);
}

void config_set_rate(filter_any_config_t *config, uint16_t rate_dhz)
{
    uint8_t *field = (uint8_t *)config;
    field[0] = (uint8_t)rate_dhz;
    field[1] = (uint8_t)(rate_dhz >> 8);
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

void random_config(uint32_t *random, filter_kind_t kind, filter_any_config_t *config)
{
    filter_any_defaults(kind, config, (uint16_t)random_in(random, CONFIG_RATE_MIN_DHZ, CONFIG_RATE_MAX_DHZ));
    for (uint8_t i = 0; i < parameter_count(kind); i++) {
        filter_parameter_t parameter = parameter_at(kind, i);
        uint32_t value = random_in(random, (uint32_t)parameter.min, (uint32_t)parameter.max);
        if (parameter.zero_means_off != 0U && random32_below(random, 8) == 0U) {
            value = 0;
        }
        parameter_set(config, &parameter, value);
    }
}

bool init_random(filter_any_t *f, filter_kind_t kind, uint32_t *random, uint32_t *refused)
{
    for (uint8_t draw = 0; draw < DRAWS_MAX; draw++) {
        filter_any_config_t config;
        random_config(random, kind, &config);
        if (filter_any_init(f, kind, &config)) {
            return true;
        }
        if (!has_joint_condition(kind)) {
            return false;
        }
        (*refused)++;
    }
    return false;
}
