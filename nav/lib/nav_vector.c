/* Loops rather than unrolled lines: a line of float costs 40 bytes of flash per operation on the AVR. */
#include "nav_vector.h"

#include <stdint.h>

nav_real_t nav_dot(const nav_real_t a[3], const nav_real_t b[3])
{
    nav_real_t sum = a[0] * b[0];
    for (uint8_t i = 1; i < 3U; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

void nav_add_cross(nav_real_t out[3], const nav_real_t a[3], const nav_real_t b[3])
{
    uint8_t next = 1;
    uint8_t last = 2;
    for (uint8_t i = 0; i < 3U; i++) {
        out[i] += a[next] * b[last] - a[last] * b[next];
        next = last;
        last = i;
    }
}

void nav_add_scaled(nav_real_t out[3], nav_real_t factor, const nav_real_t a[3])
{
    for (uint8_t i = 0; i < 3U; i++) {
        out[i] += factor * a[i];
    }
}
