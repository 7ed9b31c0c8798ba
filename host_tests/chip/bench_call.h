/* One call, timed, and bytes out of the UART, for the programs of the benchmark only. */
#ifndef BENCH_CALL_H
#define BENCH_CALL_H

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>
#include <stdint.h>

#define NOINLINE __attribute__((noinline, noclone))

/* Timer 1 at the clock, the UART at 1 Mbaud. */
static void begin_measuring(void)
{
    UCSR0A = _BV(U2X0);
    UBRR0 = 1;
    UCSR0B = _BV(TXEN0);
    TCCR1B = _BV(CS10);
}

static uint16_t NOINLINE timed(void (*call)(void))
{
    TCNT1 = 0;
    call();
    return TCNT1;
}

static void put(char c)
{
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    UDR0 = (uint8_t)c;
}

static void put_text(const char *flash_text)
{
    for (char c = (char)pgm_read_byte(flash_text); c != '\0'; c = (char)pgm_read_byte(++flash_text)) {
        put(c);
    }
}

static void put_hex(uint16_t value)
{
    for (uint8_t i = 0; i < 4; i++, value = (uint16_t)(value << 4)) {
        uint8_t digit = (uint8_t)(value >> 12);
        put((char)(digit < 10 ? '0' + digit : 'a' + digit - 10));
    }
}

/* The simulator ends with the program: asleep, interrupts off. */
static void end_measuring(void)
{
    put_text(PSTR("\n=end\n"));
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    cli();
    sleep_enable();
    sleep_cpu();
}

#endif
