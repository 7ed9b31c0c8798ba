/*
 * Timer1 runs at F_CPU / 8, Timer2 at F_CPU / 1024. A count of Timer1 must be 1 us or 0.5 us, which leaves two clocks:
 * 16 MHz (UNO, Nano, Pro Mini 5 V) and 8 MHz (Pro Mini 3.3 V).
 */
#ifndef HAL_TIME_PORT_H
#define HAL_TIME_PORT_H

#include <avr/io.h>

#include "hal_body.h"
#include "hal_time.h"

#if F_CPU != 16000000 && F_CPU != 8000000
#error "F_CPU: this firmware knows processors of 16 MHz and of 8 MHz"
#endif

#ifndef HAL_CPU_HZ /* a test image sets a slower one */
#define HAL_CPU_HZ F_CPU
#endif
#define HAL_LAP_US ((uint8_t)(1024000000ul / F_CPU)) /* one count of Timer2 */
enum { HAL_COUNTS_PER_US = F_CPU / 8000000 };        /* Timer1 */

typedef struct {
    uint32_t us;    /* at the last tick of Timer1 */
    uint16_t count; /* its counter then */
} hal_tick_t;

extern volatile hal_tick_t hal_tick;

HAL_BODY uint16_t hal_time_count_isr(void)
{
    return TCNT1;
}

/*
 * *t_us = hal_tick.us + (uint16_t)(count - hal_tick.count) / HAL_COUNTS_PER_US; a late tick only makes the difference
 * larger: correct for up to 32 ms. Hand-written, one byte at a time: the compiler would make the handler save four more
 * registers, 16 cycles. The instructions between the additions leave the carry unchanged.
 */
#if F_CPU == 16000000
#define HAL_COUNTS_TO_US "lsr %B[count]\n\tror %A[count]\n\t"
#else
#define HAL_COUNTS_TO_US ""
#endif
HAL_BODY void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count)
{
    uint8_t byte;
    __asm__ volatile("lds %[byte], %[tick]\n\t"
                     "sub %A[count], %[byte]\n\t"
                     "lds %[byte], %[tick]+1\n\t"
                     "sbc %B[count], %[byte]\n\t" HAL_COUNTS_TO_US "lds %[byte], %[us]\n\t"
                     "add %A[count], %[byte]\n\t"
                     "st %a[to], %A[count]\n\t"
                     "lds %[byte], %[us]+1\n\t"
                     "adc %B[count], %[byte]\n\t"
                     "std %a[to]+1, %B[count]\n\t"
                     "ldi %B[count], 0\n\t"
                     "lds %[byte], %[us]+2\n\t"
                     "adc %[byte], %B[count]\n\t"
                     "std %a[to]+2, %[byte]\n\t"
                     "lds %[byte], %[us]+3\n\t"
                     "adc %[byte], %B[count]\n\t"
                     "std %a[to]+3, %[byte]"
                     : [count] "+d"(count), [byte] "=&r"(byte)
                     : [to] "b"(t_us), [us] "i"(&hal_tick.us), [tick] "i"(&hal_tick.count)
                     : "memory");
}

HAL_BODY uint8_t hal_time_lap(void)
{
    return TCNT2;
}

#endif
