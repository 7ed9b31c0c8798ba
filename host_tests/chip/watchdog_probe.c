/*
 * Runs on the ATmega328P (simavr): starts as a firmware that takes its time, says why, and hangs until the watchdog
 * bites; ends at its third start.
 */
#include <avr/sleep.h>
#include <util/delay.h>

#include "hal_irq.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "hal_watchdog_tick.h"

enum { STARTS = 3, SLOW_START_MS = 20 };

int main(void)
{
    static uint8_t starts __attribute__((section(".noinit")));
    _delay_ms(SLOW_START_MS);
    hal_watchdog_start();
    hal_uart_init(115200);
    hal_irq_enable();
    starts = hal_reset_cause() == HAL_RESET_WATCHDOG ? (uint8_t)(starts + 1u) : 1;
    hal_uart_tx_stage((uint8_t)('0' + hal_reset_cause()));
    hal_uart_tx_commit();
    while (!hal_uart_tx_idle() || starts < STARTS) {
        hal_watchdog_tick_isr();
    }
    cli();
    sleep_enable();
    sleep_cpu();
    for (;;) {
    }
}
