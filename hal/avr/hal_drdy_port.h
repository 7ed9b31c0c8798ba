/* INT0 is pin PD2 = D2. */
#ifndef HAL_DRDY_PORT_H
#define HAL_DRDY_PORT_H

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_body.h"
#include "hal_drdy.h"

/* The conditions are tested here, not in a function: its result would be a byte to test, six cycles more. */
#define HAL_DRDY_ISR()                                            \
    static inline __attribute__((always_inline)) void edge(void); \
    ISR(INT0_vect)                                                \
    {                                                             \
        uint8_t left = (uint8_t)(GPIOR1 - 1u);                    \
        GPIOR1 = left;                                            \
        if (left == 0) {                                          \
            EIMSK = left;                                         \
            GPIOR2 = HAL_DRDY_DEAF_TICKS;                         \
        } else if (GPIOR2 == 0 && (PIND & _BV(PD2)) != 0) {       \
            edge();                                               \
        }                                                         \
    }                                                             \
    static inline void edge(void)

/*
 * GPIOR1: edges left in this tick. GPIOR2: ticks until D2 is trusted again. Each takes one cycle to read and one to
 * write.
 */
HAL_BODY void hal_drdy_enable(void)
{
    EICRA = _BV(ISC01) | _BV(ISC00);
    EIFR = _BV(INTF0);
    EIMSK = _BV(INT0);
}

HAL_BODY bool hal_drdy_flickers(void)
{
    return GPIOR2 != 0;
}

HAL_BODY bool hal_drdy_high(void)
{
    return !hal_drdy_flickers() && (PIND & _BV(PD2)) != 0;
}

#endif
