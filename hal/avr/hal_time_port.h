/* Timer1 at 2 MHz, Timer2 at 15.6 kHz. */
#ifndef HAL_TIME_PORT_H
#define HAL_TIME_PORT_H

#include <avr/io.h>

#include "hal_body.h"
#include "hal_time.h"

#ifndef HAL_CPU_HZ /* a test image tells a slower one */
#define HAL_CPU_HZ F_CPU
#endif

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
 * *t_us = hal_tick.us + (uint16_t)(count - hal_tick.count) / 2; a late tick only makes the difference longer: right for
 * 32 ms. By hand, a byte at a time: the compiler would have the handler save four registers more, 16 cycles.
 * What lies between the additions leaves the carry as it is.
 */
HAL_BODY void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count)
{
    uint8_t byte;
    __asm__ volatile("lds %[byte], %[tick]\n\t"
                     "sub %A[count], %[byte]\n\t"
                     "lds %[byte], %[tick]+1\n\t"
                     "sbc %B[count], %[byte]\n\t"
                     "lsr %B[count]\n\t"
                     "ror %A[count]\n\t"
                     "lds %[byte], %[us]\n\t"
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
