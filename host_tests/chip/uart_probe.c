/*
 * Runs on the ATmega328P (simavr): a byte is sent, another after a time in which the first frame ends, and the divider
 * is changed as soon as the line says that it is idle. simrun ends the run if a byte is still on its way then.
 */
#include <avr/sleep.h>
#include <util/delay_basic.h>

#include "hal_irq.h"
#include "hal_uart.h"

/* In cycles: eight times 17 a bit, ten bits. Steps of three, from before the frame's end to after it. */
enum { BAUD = 115200, FRAME = 10 * 8 * 17, FIRST = FRAME / 3 - 60, STEPS = 80 };

static void send(char byte)
{
    hal_uart_tx_stage((uint8_t)byte);
    hal_uart_tx_commit();
}

/* The first byte may still be on its way. */
static void sent_and_changed(uint16_t wait, uint8_t bytes)
{
    send('a');
    _delay_loop_1((uint8_t)(wait / 2));
    _delay_loop_1((uint8_t)(wait - wait / 2));
    for (uint8_t i = 0; i < bytes; i++) {
        hal_uart_tx_stage('b');
    }
    hal_uart_tx_commit();
    if (bytes == 3) {
        send('c'); /* while the buffer is taken */
    }
    while (!hal_uart_tx_idle()) {
    }
    hal_uart_init(BAUD);
}

int main(void)
{
    hal_uart_init(BAUD);
    hal_irq_enable();
    for (uint8_t bytes = 1; bytes <= 3; bytes++) {
        for (uint16_t wait = FIRST; wait < FIRST + STEPS; wait++) {
            sent_and_changed(wait, bytes);
        }
    }
    send('\n');
    while (!hal_uart_tx_idle()) {
    }
    cli();
    sleep_enable();
    sleep_cpu();
    for (;;) {
    }
}
