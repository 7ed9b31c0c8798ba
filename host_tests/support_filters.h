/*
 * What the tests of lib/filters share: random numbers with a fixed seed, streams through filters, text of a golden row.
 */
#ifndef SUPPORT_FILTERS_H
#define SUPPORT_FILTERS_H

#include "filter_any.h"

#include <stdbool.h>
#include <stddef.h>
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

/* Any legal configuration of a filter. */
void random_config(test_random_t *r, filter_kind_t kind, filter_any_config_t *config);

/* Rounded to int16 as a sensor would, saturated to 13 bit. */
int16_t as_sample(double lsb);

/* Fails the running test when a state of the filter is outside the bounds that filter.h and two_state.h promise. */
void assert_bounds(const filter_any_t *f, int32_t x_lsb_q16);

#endif
