#include "support/random.h"

#include <math.h>

void random_seed(test_random_t *r, uint64_t seed)
{
    r->state = seed * 2654435769U + 88172645463325252U;
}

uint32_t random_u32(test_random_t *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (uint32_t)((r->state * 2685821657736338717U) >> 32);
}

uint32_t random_below(test_random_t *r, uint32_t end)
{
    return (uint32_t)(((uint64_t)random_u32(r) * end) >> 32);
}

double random_uniform(test_random_t *r)
{
    return ((double)random_u32(r) + 0.5) / 4294967296.0;
}

double random_normal(test_random_t *r)
{
    double radius = sqrt(-2.0 * log(random_uniform(r)));
    return radius * cos(6.283185307179586 * random_uniform(r));
}

int16_t as_sample(double lsb)
{
    double rounded = floor(lsb + 0.5);
    return (int16_t)fmax(-4096.0, fmin(4095.0, rounded));
}
