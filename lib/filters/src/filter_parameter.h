/*
 * One parameter of a configuration, read, changed and judged through its descriptor (filter_parameter_t in filter.h).
 * Values are as stored: fixed point with the descriptor's fraction bits, 32 bits, signed ones in two's complement.
 */
#ifndef FILTER_PARAMETER_H
#define FILTER_PARAMETER_H

#include "filter.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The stored value of the field; config: the F_config_t that the descriptor belongs to. Any context. */
uint32_t filter_parameter_get(const void *config, const filter_parameter_t *parameter);

/* Puts a stored value into the field, which holds it: in range, see below. */
void filter_parameter_set(void *config, const filter_parameter_t *parameter, uint32_t value);

/* The value is 0 where that switches the feature off, or within min..max. */
bool filter_parameter_in_range(const filter_parameter_t *parameter, uint32_t value);

#ifdef __cplusplus
}
#endif
#endif
