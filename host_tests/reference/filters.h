/* Filters of reference/robust.h with the library's start, limits and rules. */
#ifndef REFERENCE_FILTERS_H
#define REFERENCE_FILTERS_H

#include "reference/robust.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * Running from x0 with P11 = R and the library's spread of the rate; rate_max in LSB/s, 0: no limit. reacquire: samples
 * that restart what is beyond a gate of 3 sigma; 0: no gate.
 */
void reference_library(robust_reference_t *f, const char *name, double rate_hz, double r, double q, int reacquire,
                       double rate_max, double x0);

/* Prediction only. */
void reference_coast(robust_reference_t *f);

#ifdef __cplusplus
}
#endif
#endif
