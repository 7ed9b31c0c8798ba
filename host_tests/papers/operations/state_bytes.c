#include "bitexact/packed_states.h"

#include "state_bytes.h"

#define BYTES(member) sizeof(((const filter_t *)0)->member)

/* Whatever the law, with a pointer to it of the AVR's two bytes. */
#define TRACKER_BYTES (sizeof(filter_t) - BYTES(own) - BYTES(law) + 2U)

size_t state_bytes(enum own_state own)
{
    switch (own) {
    case OWN_KALMAN:
        return TRACKER_BYTES + BYTES(own.kalman);
    case OWN_WIDE:
        return TRACKER_BYTES + BYTES(own.wide);
    default:
        return TRACKER_BYTES + BYTES(own.mixture);
    }
}
