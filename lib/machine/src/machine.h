/*
 * What code says to the compiler of one machine, for libraries, HAL and firmware: what lies in program memory, what is
 * copied into its callers and what is not, what the optimiser may know. The only header that asks which machine it is,
 * beside the arithmetic of fx.h; elsewhere than on an 8-bit AVR constants are where they are and fences are nothing.
 *
 * Program memory: on the chip every plain const and every string literal would occupy the 2 KB of RAM.
 *
 *   static const uint16_t table[] IN_FLASH = { ... };   place a constant; read it through flash_* only
 *   FLASH_TEXT("words")                                 a string literal there, a flash_text_t (inside a function)
 *   FLASH_FUNCTION(&descriptor->member)                 a pointer to a function that lies there
 */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Copied into its callers whatever the optimiser's opinion: for one hot caller, or for what an interrupt runs, which
 * would save every register that a function called may use, 60 cycles.
 */
#define MACHINE_INLINE static inline __attribute__((always_inline))

/* Not copied, by link-time optimisation either: a rare or heavy part, for which its callers shall save no registers. */
#define MACHINE_APART __attribute__((noinline))

typedef const char *flash_text_t;

#ifdef __AVR__
#include <avr/pgmspace.h>

/* The compiler forgets what it knows of v, an integer in a register. */
#define MACHINE_FENCE(v) __asm__("" : "+r"(v))

/*
 * The compiler forgets what the pointer p points at and keeps p in registers: each access to the thing is two bytes
 * instead of four, where a function makes many.
 */
#define MACHINE_POINTER(p) __asm__("" : "+b"(p))

/*
 * 1: every static variable is 0 when the program begins, and it begins but once; what would set them to 0 is left out.
 * On the PC 0: tests begin it again and again.
 */
#define MACHINE_RAM_CLEARED 1

#define IN_FLASH PROGMEM
#define FLASH_TEXT(words) PSTR(words)
#define FLASH_FUNCTION(place) ((__typeof__(*(place)))(uintptr_t)pgm_read_word(place))

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

static inline char flash_char(flash_text_t p)
{
    return (char)pgm_read_byte(p);
}

static inline const void *flash_pointer(const void *p)
{
    return pgm_read_ptr(p);
}
#else
#define MACHINE_FENCE(v) ((void)0)
#define MACHINE_POINTER(p) ((void)(p))
#define MACHINE_RAM_CLEARED 0

#define IN_FLASH
#define FLASH_TEXT(words) (words)
#define FLASH_FUNCTION(place) (*(place))

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

static inline char flash_char(flash_text_t p)
{
    return *p;
}

static inline const void *flash_pointer(const void *p)
{
    return *(const void *const *)p;
}
#endif

#ifdef __cplusplus
}
#endif

#endif
