/* Counters that never wrap. */
#include "counters.h"

#include "fx.h"

uint32_t counters[COUNTERS];

void counters_start(void)
{
    for (uint8_t i = 0; i < COUNTERS; i++) {
        counters[i] = 0;
    }
}

FX_ONCE void count(uint8_t what)
{
    if (counters[what] != UINT32_MAX) {
        counters[what]++;
    }
}

void count_lost(uint32_t missing)
{
    uint32_t sum = counters[COUNT_LOST] + missing;
    counters[COUNT_LOST] = sum < missing ? UINT32_MAX : sum;
}
