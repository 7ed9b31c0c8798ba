/* Square root of nav/lib's number type, rounded as IEEE 754 requires: the only call to the maths library. */
#ifndef NAV_ROOT_H
#define NAV_ROOT_H

#include "nav_real.h"

#include <math.h>

static inline nav_real_t nav_root(nav_real_t square)
{
#ifdef NAV_DOUBLE
    return sqrt(square);
#else
    return sqrtf(square);
#endif
}

#endif
