/* Bytes of a filter's state as the AVR lays it, without gaps: worked out apart, where the integers are plain ones. */
#ifndef STATE_BYTES_H
#define STATE_BYTES_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* kind: filter_kind_t; 0 when there is none such. */
size_t state_bytes(unsigned kind);

#ifdef __cplusplus
}
#endif

#endif
