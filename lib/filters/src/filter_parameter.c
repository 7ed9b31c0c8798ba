/* Fields of any configuration by their descriptors; see filter_parameter.h. */
#include "filter_parameter.h"

#include "fx.h"

/* Little-endian on PC and chip. */
uint32_t filter_parameter_get(const void *config, const filter_parameter_t *parameter)
{
    const uint8_t *bytes = (const uint8_t *)config + fx_flash_u8(&parameter->offset);
    uint8_t size = fx_flash_u8(&parameter->size);
    bool negative = fx_flash_u8(&parameter->is_signed) != 0U && (bytes[size - 1U] & 0x80U) != 0U;
    uint32_t value = negative ? UINT32_MAX : 0U;
    while (size != 0U) {
        size--;
        value = (value << 8) | bytes[size];
    }
    return value;
}

void filter_parameter_set(void *config, const filter_parameter_t *parameter, uint32_t value)
{
    uint8_t *byte = (uint8_t *)config + fx_flash_u8(&parameter->offset);
    for (uint8_t left = fx_flash_u8(&parameter->size); left != 0U; left--) {
        *byte++ = (uint8_t)value;
        value >>= 8;
    }
}

bool filter_parameter_in_range(const filter_parameter_t *parameter, uint32_t value)
{
    uint32_t min = fx_flash_u32((const uint32_t *)&parameter->min);
    uint32_t max = fx_flash_u32((const uint32_t *)&parameter->max);
    if (value == 0U && fx_flash_u8(&parameter->zero_means_off) != 0U) {
        return true;
    }
    return value - min <= max - min; /* from the lower end: right for signed and unsigned ranges */
}
