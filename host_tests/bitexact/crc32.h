/* CRC-32 (IEEE 802.3) over values as little-endian bytes, the same on any machine; a table of 16 in program memory. */
#ifndef CRC32_H
#define CRC32_H

#include <stdint.h>

#define CRC32_START 0xFFFFFFFFUL

uint32_t crc32_u8(uint32_t crc, uint8_t value);
uint32_t crc32_u16(uint32_t crc, uint16_t value);
uint32_t crc32_u32(uint32_t crc, uint32_t value);

/* What is compared and printed. */
static inline uint32_t crc32_value(uint32_t crc)
{
    return ~crc;
}

#endif
