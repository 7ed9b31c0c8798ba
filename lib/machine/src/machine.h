/*
 * What is specific to one machine's compiler, for libraries, HAL and firmware: placement in program memory, inlining,
 * and what the optimiser may know. Apart from the arithmetic of fx.h this is the only header that asks which machine it
 * compiles for. Except on an 8-bit AVR, constants stay where they are and fences do nothing.
 *
 * Program memory: on the chip every plain const and every string literal would occupy the 2 KB of RAM.
 *
 *   static const uint16_t table[] IN_FLASH = { ... };   place a constant; read it through flash_* only
 *   FLASH_TEXT("words")                                 a string literal there, a flash_text_t (inside a function)
 *   FLASH_FUNCTION(&descriptor->member)                 a function pointer stored there
 */
#ifndef MACHINE_H
#define MACHINE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Always inlined: for a single hot caller, or for code that an interrupt runs. A call from an interrupt handler would
 * make it save every register that the callee may use, 60 cycles.
 */
#define MACHINE_INLINE static inline __attribute__((always_inline))

/*
 * Never inlined, not by link-time optimisation either: a rare or heavy part whose registers its callers should not
 * save.
 */
#define MACHINE_APART __attribute__((noinline))

typedef const char *flash_text_t;

#ifdef __AVR__
#include <avr/pgmspace.h>

/* Makes the compiler forget what it knows of v, an integer in a register. */
#define MACHINE_FENCE(v) __asm__("" : "+r"(v))

/*
 * Makes the compiler forget what the pointer p points at and keeps p in registers: each access then takes two bytes
 * instead of four. For functions with many accesses through p.
 */
#define MACHINE_POINTER(p) __asm__("" : "+b"(p))

/*
 * 1: every static variable is 0 at program start, and the program starts only once, so code that would zero them is
 * left out. 0 on the PC, where tests start it repeatedly.
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
