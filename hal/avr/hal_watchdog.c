/*
 * Watchdog in reset mode, and the breadcrumb that survives a reset. The start-up hook runs before .data and .bss are
 * initialised: after a watchdog reset the watchdog is still on with its shortest period and must be stopped first.
 */
#include "hal_watchdog.h"

#include <avr/io.h>
#include <avr/wdt.h>

#include "hal_watchdog_tick.h"
#include "machine.h"

#define MARK 0x7117A117ul

static struct breadcrumb {
    uint32_t mark;
    volatile uint8_t unfed_ticks;
    uint8_t note;
    uint8_t repeats;
} breadcrumb __attribute__((section(".noinit")));

static uint8_t mcusr_at_start __attribute__((section(".noinit")));
static uint8_t cause;
static uint8_t note_at_start;

void hal_watchdog_early(void) __attribute__((naked, used, section(".init3")));
void hal_watchdog_early(void)
{
    mcusr_at_start = MCUSR;
    MCUSR = 0;
    wdt_disable();
}

void hal_watchdog_start(void)
{
    struct breadcrumb *b = &breadcrumb;
    MACHINE_POINTER(b); /* each access then takes half the code */
    bool intact = b->mark == MARK;
    __asm__("" : "+r"(intact)); /* or the compiler repeats the comparison at each use */
    cause = (uint8_t)hal_reset_classify(mcusr_at_start, intact, b->unfed_ticks);
    note_at_start = (intact && cause != HAL_RESET_POWER_ON) ? b->note : 0;
    b->mark = MARK;
    b->unfed_ticks = 0;
    b->note = 0;
    b->repeats = hal_reset_count((hal_reset_t)cause, intact, b->repeats);
    wdt_enable(WDTO_250MS);
}

void hal_watchdog_feed(void)
{
    wdt_reset();
    breadcrumb.unfed_ticks = 0;
}

void hal_watchdog_note(uint8_t note)
{
    breadcrumb.note = note;
}

hal_reset_t hal_reset_cause(void)
{
    return (hal_reset_t)cause;
}

uint8_t hal_reset_note(void)
{
    return note_at_start;
}

uint8_t hal_reset_repeats(void)
{
    return breadcrumb.repeats;
}

void hal_reset_settled(void)
{
    breadcrumb.repeats = 0;
}

void hal_watchdog_tick_isr(void)
{
    uint8_t ticks = breadcrumb.unfed_ticks;
    if (ticks != UINT8_MAX) {
        breadcrumb.unfed_ticks = (uint8_t)(ticks + 1u);
    }
}
