/* In the place of fusion_pc.h where its library is not there. */
#ifndef FUSION_NONE_H
#define FUSION_NONE_H

#include <stdint.h>

#define FUSIONS 0U

typedef struct {
    char nothing;
} fusion_t;

static inline void fusion_begin(fusion_t *fusion, float rate_hz)
{
    (void)rate_hz;
    fusion->nothing = 0;
}

static inline double fusion_gravity(const fusion_t *fusion, const int16_t lsb[3], int axis)
{
    (void)fusion;
    return lsb[axis];
}

#endif
