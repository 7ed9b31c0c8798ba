/*
 * Critical sections. Everything that an interrupt shares with main is one byte, or is accessed between save and
 * restore.
 *
 * A section may last 19 cycles at most, 1.2 us: an interrupt may have to wait for a handler, a section right after it
 * and another handler (campaigns/faults/latency.py; make check-waits).
 */
#ifndef HAL_IRQ_H
#define HAL_IRQ_H

#include <stdint.h>

typedef uint8_t hal_irq_state_t;

/* Disables interrupts; returns the state before. Any context. */
hal_irq_state_t hal_irq_save(void);

/* Restores that state. Any context. */
void hal_irq_restore(hal_irq_state_t state);

/* Enables interrupts. Main, once at start-up. */
void hal_irq_enable(void);

#include "hal_irq_port.h"

#endif
