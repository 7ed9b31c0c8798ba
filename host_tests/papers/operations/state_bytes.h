/*
 * Bytes of a filter's state as the AVR lays it, without gaps: the tracker's and those of the law's own. Worked out
 * apart, where the integers are plain ones.
 */
#ifndef STATE_BYTES_H
#define STATE_BYTES_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The laws of paper 002 have one of these for their own (filter_state.h). */
enum own_state { OWN_KALMAN, OWN_WIDE, OWN_MIXTURE };

size_t state_bytes(enum own_state own);

#ifdef __cplusplus
}
#endif

#endif
