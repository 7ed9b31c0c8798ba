/*
 * What a firmware sees on SDA when it leaves the sensor in the middle of a byte and clocks SCL by hand: a line of the
 * levels read at each clock with SCL high, for one case after another (system_injections.py). The TWI is turned off two
 * bits into DEVID, 0xE5. The last line is DEVID and the two registers behind it, both zero, read in one transfer.
 */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <util/delay.h>

#ifndef PROBE_TWBR
#define PROBE_TWBR 14 /* 363.6 kHz */
#endif

enum { SENSOR = 0x53, HALF_CLOCK_US = 5, CLOCKS = 10, CASES = 4 };
enum { CASE_CLOCKS, CASE_STOP, CASE_START, CASE_DRIVEN };

static void say(char character)
{
    while (!(UCSR0A & _BV(UDRE0))) {
    }
    UDR0 = (uint8_t)character;
}

static void twi(uint8_t control)
{
    TWCR = control | _BV(TWINT) | _BV(TWEN);
    while (!(TWCR & _BV(TWINT))) {
    }
}

static void twi_byte(uint8_t byte)
{
    TWDR = byte;
    twi(0);
}

static void ask_for_devid(void)
{
    twi(_BV(TWSTA));
    twi_byte(SENSOR << 1);
    twi_byte(0);
    twi(_BV(TWSTA));
    twi_byte(SENSOR << 1 | 1);
}

static void leave_in_byte(void)
{
    ask_for_devid();
    TWCR = _BV(TWINT) | _BV(TWEA) | _BV(TWEN);
    _delay_us(5.8); /* two bits of 2.75 us at 363.6 kHz */
    TWCR = 0;
}

static void clock(void)
{
    say(PINC & _BV(PC4) ? '1' : '0');
    DDRC |= _BV(PC5);
    _delay_us(HALF_CLOCK_US);
    DDRC &= (uint8_t)~_BV(PC5);
    _delay_us(HALF_CLOCK_US);
}

/* SDA falls while SCL is high: START; it rises again: STOP. */
static void pull_sda(uint8_t which)
{
    if (which == CASE_DRIVEN) {
        PORTC |= _BV(PC4);
    }
    if (which != CASE_CLOCKS) {
        DDRC |= _BV(PC4);
        _delay_us(HALF_CLOCK_US);
    }
    if (which == CASE_START) {
        DDRC |= _BV(PC5);
        _delay_us(HALF_CLOCK_US);
    }
    DDRC &= (uint8_t)~_BV(PC4);
    PORTC &= (uint8_t)~_BV(PC4);
    _delay_us(HALF_CLOCK_US);
    DDRC &= (uint8_t)~_BV(PC5);
}

static void say_read(void)
{
    ask_for_devid();
    for (uint8_t bytes = 3; bytes != 0; bytes--) {
        twi(bytes == 1 ? 0 : _BV(TWEA));
        say("0123456789ABCDEF"[TWDR >> 4]);
        say("0123456789ABCDEF"[TWDR & 15]);
    }
    TWCR = _BV(TWINT) | _BV(TWSTO) | _BV(TWEN);
}

int main(void)
{
    UCSR0A = _BV(U2X0);
    UBRR0 = 16;
    UCSR0B = _BV(TXEN0);
    TWBR = PROBE_TWBR;
    for (uint8_t which = 0; which < CASES; which++) {
        leave_in_byte();
        pull_sda(which);
        for (uint8_t clocks = 0; clocks < CLOCKS; clocks++) {
            clock();
        }
        say('\n');
    }
    say_read();
    _delay_ms(1);
    cli();
    sleep_enable();
    sleep_cpu();
}
