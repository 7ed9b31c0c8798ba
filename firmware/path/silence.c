#include "path/silence.h"

/* 25 ms are 1/400 of the rate in 0.1 Hz. */
enum { HALF_QUARTER_DHZ = 200, HOLD_QUARTERS = 4, LONG_QUARTERS = 40 };

static struct {
    uint16_t part_dhz; /* position within 25 ms at a missing sample, in units of 25 ms / rate */
    uint8_t quarters;  /* periods of 25 ms without a sample, up to a second */
    uint8_t missing;   /* samples in a row, up to SILENCE_FAULT_FROM */
} silence;

void silence_end(void)
{
    silence.missing = 0;
    silence.quarters = 0;
    silence.part_dhz = 0;
}

/* Step n is judged at its middle, (n - 1/2) / rate after the last sample, as in the filters (filter_missing). */
void silence_step(uint16_t rate_dhz)
{
    uint16_t part_dhz = (uint16_t)(silence.part_dhz + HALF_QUARTER_DHZ);
    uint8_t quarters = silence.quarters;
    for (; part_dhz >= rate_dhz; part_dhz = (uint16_t)(part_dhz - rate_dhz)) {
        if (quarters != LONG_QUARTERS) {
            quarters++;
        }
    }
    silence.part_dhz = (uint16_t)(part_dhz + HALF_QUARTER_DHZ);
    silence.quarters = quarters;
    if (silence.missing != SILENCE_FAULT_FROM) {
        silence.missing++;
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
