/*
 * Programs that do what a firmware must not, one per CASE, to see that simrun notices each and tells them apart.
 * Warnings are not for these.
 */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <stdint.h>

volatile uint8_t bytes[16];

#ifndef CASE
#define CASE 1
#endif

#if CASE == 4
static uint8_t __attribute__((noinline)) deeper(uint8_t n)
{
    volatile uint8_t frame[50];
    frame[n & 31u] = n;
    return (uint8_t)(deeper((uint8_t)(n + 1u)) + frame[n & 31u]);
}
#endif

#if CASE == 8
static void __attribute__((constructor)) start_ahead_of_a_stop(void) /* ahead of main too */
{
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTA);
    for (volatile uint8_t wait = 0; wait != 255; wait++) {
    }
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO);
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTA);
}
#endif

#if CASE == 9
EMPTY_INTERRUPT(TWI_vect)

static void __attribute__((constructor)) start_and_never_answer(void)
{
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWIE) | _BV(TWSTA);
    sei();
}
#endif

int main(void)
{
#if CASE == 1
    ((void (*)(void))0x3000)();
#elif CASE == 2
    for (uint16_t address = 0x0800;; address++) {
        *(volatile uint8_t *)address = 1;
    }
#elif CASE == 3
    __asm__ volatile(".word 0x0001");
#elif CASE == 4
    bytes[0] = deeper(1);
#elif CASE == 5
    UCSR0B = _BV(TXEN0);
    UBRR0 = 8;
    for (uint8_t i = 0; i < 10; i++) {
        UDR0 = i;
    }
#elif CASE == 6
    MCUSR = 0;
    /* not the shortest, which a reset leaves in force: that alone is a fault to simrun */
    wdt_enable(WDTO_30MS);
#elif CASE == 7
    cli();
    sleep_enable();
    sleep_cpu();
#endif
    for (;;) {
    }
}
