/* See gravity.h. */
#include "path/gravity.h"

#include "tilt.h"

enum { NO_GRAVITY_S = 10 };

static uint8_t without_s; /* seconds, up to NO_GRAVITY_S */

void gravity_forget(void)
{
    without_s = 0;
}

void gravity_second(const int32_t a_q8[3])
{
    if (tilt_gravity_possible(a_q8)) {
        without_s = 0;
    } else if (without_s != NO_GRAVITY_S) {
        without_s++;
    }
}

bool gravity_absent(void)
{
    return without_s == NO_GRAVITY_S;
}
