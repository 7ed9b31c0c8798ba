/* Loops and not lines: a line of float costs 40 bytes of flash per operation on the AVR. */
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

/* Unlike the others in lines: it is called eight times a slot, and a loop took 400 cycles more. */
void nav_add_cross(nav_real_t out[3], const nav_real_t a[3], const nav_real_t b[3])
{
    out[0] += a[1] * b[2] - a[2] * b[1];
    out[1] += a[2] * b[0] - a[0] * b[2];
    out[2] += a[0] * b[1] - a[1] * b[0];
}

void nav_add_scaled(nav_real_t out[3], nav_real_t factor, const nav_real_t a[3])
{
    for (uint8_t i = 0; i < 3U; i++) {
        out[i] += factor * a[i];
    }
}
