#include "output.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

void output_start(void)
{
    UCSR0A = _BV(U2X0);
    UCSR0B = _BV(TXEN0);
    UBRR0 = 1; /* 16 MHz / 8 / 2 */
}

void output_char(char c)
{
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    UDR0 = (uint8_t)c;
}

void output_end(void)
{
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    cli();
    sleep_enable();
    for (;;) {
        sleep_cpu();
    }
}
