/*
 * Filters for tests that need one and no particular one, by their role; which they are follows from the list and the
 * descriptors, as in mk/scripts/laws.py.
 */
#ifndef SUPPORT_ROLES_H
#define SUPPORT_ROLES_H

#include "filter_list.h"

/* What an image starts with. */
#define DEFAULT_KIND ((filter_kind_t)0)

/* A Kalman filter without a gate, and one with it. */
filter_kind_t plain_kind(void);
filter_kind_t robust_kind(void);

/* Those with the fewest and the most cycles. */
filter_kind_t light_kind(void);
filter_kind_t slowest_kind(void);

/* The first of the list that has a parameter of this name; FILTER_KIND_COUNT: none has. */
filter_kind_t kind_with(const char *parameter);

/* Place of a parameter in filter_config_t.value; FILTER_PARAMETERS_MAX: the filter has none of this name. */
uint8_t parameter_named(filter_kind_t kind, const char *name);

/* The text with {default}, {plain}, {robust}, {light}, {slowest} as names; valid until the next but seven. */
const char *by_role(const char *text);

#endif
