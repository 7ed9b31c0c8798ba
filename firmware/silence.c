#include "silence.h"

/* 25 ms are 1/400 of the rate in 0.1 Hz. */
enum { QUARTER_DHZ = 400, HOLD_QUARTERS = 4, LONG_QUARTERS = 40, FAULT_FROM = SILENCE_FAULT_FROM };

static struct {
    uint16_t part_dhz; /* of 25 ms, in shares of the rate */
    uint8_t quarters;  /* times 25 ms without a sample, up to a second */
    uint8_t missing;   /* samples on end, up to FAULT_FROM */
} silence;

void silence_end(void)
{
    silence.missing = 0;
    silence.quarters = 0;
}

/* Step n is judged in its middle, (n - 1/2) / rate after the last sample, as the filters do (filter_missing). */
void silence_step(uint16_t rate_dhz)
{
    uint8_t passed = 0;
    silence.part_dhz = (uint16_t)(silence.part_dhz + QUARTER_DHZ);
    if (silence.missing == 0) {
        silence.part_dhz = QUARTER_DHZ / 2;
    }
    for (; silence.part_dhz >= rate_dhz; passed++) {
        silence.part_dhz = (uint16_t)(silence.part_dhz - rate_dhz);
    }
    silence.missing = (uint8_t)(silence.missing + (silence.missing < FAULT_FROM));
    silence.quarters = (uint8_t)(silence.quarters + passed);
    if (silence.quarters > LONG_QUARTERS) {
        silence.quarters = LONG_QUARTERS;
    }
}

uint8_t silence_samples(void)
{
    return silence.missing;
}

bool silence_holds(void)
{
    return silence.quarters >= HOLD_QUARTERS;
}

bool silence_long(void)
{
    return silence.quarters == LONG_QUARTERS;
}
