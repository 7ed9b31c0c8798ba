/* Counters that saturate. */
#include "base/counters.h"

#include "machine.h"

static uint32_t counters[COUNTERS];

void counters_start(void)
{
    for (uint8_t i = 0; i < COUNTERS; i++) {
        counters[i] = 0;
    }
}

uint32_t counted(uint8_t what)
{
    return counters[what];
}

void count(uint8_t what)
{
    uint32_t *counter = &counters[what];
    MACHINE_POINTER(counter);
    uint32_t now = *counter;
    if (now != UINT32_MAX) {
        *counter = now + 1u;
    }
}

void count_lost(uint32_t missing)
{
    uint32_t *lost = &counters[COUNT_LOST];
    MACHINE_POINTER(lost);
    uint32_t sum = *lost + missing;
    if (sum < missing) {
        sum = UINT32_MAX;
    }
    *lost = sum;
}
