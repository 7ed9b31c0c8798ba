/* The PC's side of flash.h, hal_pointer.h and hal_ram.h. */
#ifndef HAL_PORT_H
#define HAL_PORT_H

#include <stdint.h>

/* hal_ram.h */
#define HAL_RAM_CLEARED 0

/* hal_pointer.h */
#define HAL_POINTER(p) ((void)(p))

/* flash.h: program memory is ordinary memory here */
#define FLASH
#define FLASH_TEXT(words) (words)

static inline uint8_t flash_u8(const uint8_t *p)
{
    return *p;
}

static inline uint16_t flash_u16(const uint16_t *p)
{
    return *p;
}

static inline uint32_t flash_u32(const uint32_t *p)
{
    return *p;
}

static inline char flash_char(const char *p)
{
    return *p;
}

#endif
