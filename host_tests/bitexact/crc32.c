#include "crc32.h"

#include "fx.h"

/* Rest of a byte: the sum of its bits' rests, because the CRC is linear. */
#define BIT(i, b, rest) (((i) & (b)) != 0 ? (rest) : 0UL)
#define REST(i)                                                                             \
    (BIT(i, 0x01, 0x77073096UL) ^ BIT(i, 0x02, 0xEE0E612CUL) ^ BIT(i, 0x04, 0x076DC419UL) ^ \
     BIT(i, 0x08, 0x0EDB8832UL) ^ BIT(i, 0x10, 0x1DB71064UL) ^ BIT(i, 0x20, 0x3B6E20C8UL) ^ \
     BIT(i, 0x40, 0x76DC4190UL) ^ BIT(i, 0x80, 0xEDB88320UL))
#define REST4(i) REST(i), REST((i) + 1), REST((i) + 2), REST((i) + 3)
#define REST16(i) REST4(i), REST4((i) + 4), REST4((i) + 8), REST4((i) + 12)
#define REST64(i) REST16(i), REST16((i) + 16), REST16((i) + 32), REST16((i) + 48)

static const uint32_t rests[256] IN_FLASH = { REST64(0), REST64(64), REST64(128), REST64(192) };

/* 40 cycles on the chip. */
MACHINE_INLINE uint32_t step(uint32_t crc, uint8_t value)
{
    return (crc >> 8) ^ flash_u32(&rests[(uint8_t)((uint8_t)crc ^ value)]);
}

uint32_t crc32_u8(uint32_t crc, uint8_t value)
{
    return step(crc, value);
}

uint32_t crc32_u16(uint32_t crc, uint16_t value)
{
    return step(step(crc, (uint8_t)value), (uint8_t)(value >> 8));
}

uint32_t crc32_u32(uint32_t crc, uint32_t value)
{
    crc = step(crc, (uint8_t)value);
    crc = step(crc, (uint8_t)(value >> 8));
    crc = step(crc, (uint8_t)(value >> 16));
    return step(crc, (uint8_t)(value >> 24));
}
