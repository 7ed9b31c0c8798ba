/* Random numbers without double, on the PC and on the chip. */
#include "support/filters.h"

uint32_t random32(uint32_t *state)
{
    uint32_t v = *state;
    v ^= v << 13;
    v ^= v >> 17;
    v ^= v << 5;
    *state = v;
    return v;
}

uint32_t random32_below(uint32_t *state, uint32_t end)
{
    return random32(state) % end;
}
