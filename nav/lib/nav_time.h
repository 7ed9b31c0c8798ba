/* Times of nav/lib: microseconds in 32 bits that wrap; differences are taken the shorter way round. */
#ifndef NAV_TIME_H
#define NAV_TIME_H

#include "nav_real.h"

#include <stdint.h>

/* to - from, microseconds. */
static inline int32_t nav_time_from(uint32_t from_us, uint32_t to_us)
{
    return (int32_t)(to_us - from_us);
}

/* to - from in seconds; to is not before from. */
static inline nav_real_t nav_seconds(uint32_t from_us, uint32_t to_us)
{
    return (nav_real_t)(to_us - from_us) * NAV_R(1e-6);
}

#endif
