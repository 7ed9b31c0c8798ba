#include "bitexact/packed_states.h"

#include "state_bytes.h"

size_t state_bytes(unsigned kind)
{
    switch (kind) {
#define SIZE(F)           \
    case FILTER_KIND_##F: \
        return sizeof(F##_t);
        FILTER_LIST(SIZE)
#undef SIZE
    default:
        return 0;
    }
}
