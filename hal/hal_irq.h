/*
 * Critical sections. Everything an interrupt shares with main is one byte, or is touched between save and restore.
 *
 * Hold a section for 19 cycles at most, 1.2 us: an interrupt may wait for a handler, a section right after it and a
 * handler again (campaigns/faults/latency.py; make check-waits).
 */
#ifndef HAL_IRQ_H
#define HAL_IRQ_H

#include <stdint.h>

typedef uint8_t hal_irq_state_t;

/* Switches interrupts off; returns what they were. Any context. */
hal_irq_state_t hal_irq_save(void);

/* Puts them back. Any context. */
void hal_irq_restore(hal_irq_state_t state);

/* Switches them on. Main, once at start-up. */
void hal_irq_enable(void);

#include "hal_irq_port.h"

#endif
