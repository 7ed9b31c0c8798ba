/* Random numbers of the tests on the PC: fixed seeds, uniform and normal, in double. */
#ifndef SUPPORT_RANDOM_H
#define SUPPORT_RANDOM_H

#include <stdint.h>

/* xorshift64*: same sequence everywhere. */
typedef struct {
    uint64_t state;
} test_random_t;

void random_seed(test_random_t *r, uint64_t seed);
uint32_t random_u32(test_random_t *r);
uint32_t random_below(test_random_t *r, uint32_t end);
double random_uniform(test_random_t *r);
double random_normal(test_random_t *r);

/* Rounded to int16 as a sensor would, saturated to 13 bit. */
int16_t as_sample(double lsb);

#endif
