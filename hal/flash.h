/*
 * Constants in program memory: on AVR every plain const and every string literal would occupy the 2 KB RAM.
 *
 *   static const uint8_t table[] FLASH = { ... };       place
 *   FLASH_TEXT("words")                                  a string literal in program memory, type flash_text_t (inside
 *                                                        a function)
 *   uint8_t flash_u8(const uint8_t *p)                   read one value
 *   uint16_t flash_u16(const uint16_t *p)
 *   uint32_t flash_u32(const uint32_t *p)
 *   char flash_char(flash_text_t p)
 */
#ifndef FLASH_H
#define FLASH_H

#include <stdint.h>

typedef const char *flash_text_t;

#include "hal_port.h"

#endif
