/* The chip's side of flash.h, hal_pointer.h and hal_ram.h. */
#ifndef HAL_PORT_H
#define HAL_PORT_H

#include <avr/pgmspace.h>
#include <stdint.h>

/* hal_ram.h */
#define HAL_RAM_CLEARED 1

/* hal_pointer.h */
#define HAL_POINTER(p) __asm__("" : "+b"(p))

/* flash.h */
#define FLASH PROGMEM
#define FLASH_TEXT(words) PSTR(words)

static inline uint8_t flash_u8(const uint8_t *p)
{
    return pgm_read_byte(p);
}

static inline uint16_t flash_u16(const uint16_t *p)
{
    return pgm_read_word(p);
}

static inline uint32_t flash_u32(const uint32_t *p)
{
    return pgm_read_dword(p);
}

static inline char flash_char(const char *p)
{
    return (char)pgm_read_byte(p);
}

#endif
