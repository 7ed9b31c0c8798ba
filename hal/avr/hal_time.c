/*
 * Time from Timer1 at F_CPU / 8. Compare A fires every 8192 us, and its handler sets the next one; compare B is main's
 * alarm. The 16-bit counter runs freely, so the time is
 *   (microseconds at the last tick) + (counter - counter at the last tick) / HAL_COUNTS_PER_US.
 */
#include "hal_time.h"

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_drdy_tick.h"
#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_watchdog_tick.h"
#include "machine.h"

enum { COUNTS_PER_TICK = HAL_TICK_US * HAL_COUNTS_PER_US };

#ifndef HAL_TIME_START_US
#define HAL_TIME_START_US 0ul
#endif

volatile hal_tick_t hal_tick = { .us = HAL_TIME_START_US };

ISR(TIMER1_COMPA_vect)
{
    uint16_t count = OCR1A;
    hal_tick.count = count;
    OCR1A = (uint16_t)(count + COUNTS_PER_TICK);
    hal_tick.us += HAL_TICK_US;
    hal_watchdog_tick_isr();
    hal_drdy_tick_isr();
    hal_wake();
}

/* Compare B only wakes main: one instruction that changes no flags, so nothing is saved. */
ISR(TIMER1_COMPB_vect, ISR_NAKED)
{
    __asm__ volatile("sbi %[wake], 0\n\treti" : : [wake] "I"(_SFR_IO_ADDR(GPIOR0)));
}

void hal_time_init(void)
{
    TCCR1A = 0;
    TCNT1 = 0;
    OCR1A = COUNTS_PER_TICK;
    TIMSK1 = _BV(OCIE1A) | _BV(OCIE1B);
    TCCR1B = _BV(CS11);
    TCCR2B = _BV(CS22) | _BV(CS21) | _BV(CS20);
}

/* The counter starts at 0 with the clock and is never written, so each time has one count. */
void hal_wake_at(uint32_t t_us)
{
    uint16_t count = (uint16_t)((t_us - HAL_TIME_START_US) * HAL_COUNTS_PER_US);
    hal_irq_state_t state = hal_irq_save(); /* the timer's 16-bit registers share TEMP with the handlers' reads */
    OCR1B = count;
    if ((uint16_t)(TCNT1 - count) < HAL_WAKE_LATE_US * HAL_COUNTS_PER_US) {
        hal_wake();
    }
    hal_irq_restore(state);
}

/* A late tick only makes the difference larger: correct for up to 32 ms. */
uint32_t hal_time_us(void)
{
    const volatile hal_tick_t *tick = &hal_tick;
    MACHINE_POINTER(tick); /* each access then takes half the code */
    hal_irq_state_t state = hal_irq_save();
    uint16_t since = (uint16_t)(TCNT1 - tick->count);
    uint32_t now = tick->us + since / HAL_COUNTS_PER_US;
    hal_irq_restore(state);
    return now;
}
