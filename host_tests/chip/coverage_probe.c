/*
 * A program whose executed lines are known: coverage.py check compares its marks with what the tool finds.
 * Inlined functions, a branch never taken, a loop, an interrupt that never comes. The branches end differently: equal
 * ends are merged by the compiler and count for either. Ends by sleeping with interrupts off.
 */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

volatile uint8_t input;
volatile uint8_t output;

static inline uint8_t twice(uint8_t v)
{
    if (v > 100) {
        PORTB = 1;  /* not reached */
        return 200; /* not reached */
    }
    output = (uint8_t)(v + 1u);   /* ran */
    return (uint8_t)(output + v); /* ran */
}

static void __attribute__((noinline)) never(void)
{
    output = 77; /* not reached */
}

ISR(TIMER0_OVF_vect)
{
    output = 99; /* not reached */
}

int main(void)
{
    for (uint8_t i = 0; i < 3; i++) {
        input = twice(input); /* ran */
    }
    if (input == 123) {
        never(); /* not reached */
    } else {
        output = 5; /* ran */
    }
    switch (input) {
    case 200:
        output = 6; /* not reached */
        break;
    default:
        output = 7; /* ran */
        break;
    }
    cli();
    SMCR = _BV(SE);
    sleep_cpu(); /* ran */
    return 0;
}
