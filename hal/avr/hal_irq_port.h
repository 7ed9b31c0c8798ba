/* Interrupts of the ATmega328P: bit I of SREG. */
#ifndef HAL_IRQ_PORT_H
#define HAL_IRQ_PORT_H

#include <avr/interrupt.h>
#include <avr/io.h>

#include "hal_body.h"
#include "hal_irq.h"

HAL_BODY hal_irq_state_t hal_irq_save(void)
{
    hal_irq_state_t state;
    __asm__ volatile("in %0, __SREG__\n\tcli" : "=r"(state)::"memory");
    return state;
}

HAL_BODY void hal_irq_restore(hal_irq_state_t state)
{
    __asm__ volatile("out __SREG__, %0" ::"r"(state) : "memory");
}

HAL_BODY void hal_irq_enable(void)
{
    sei();
}

#endif
