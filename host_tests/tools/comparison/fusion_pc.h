/*
 * The accelerometer's path of Fusion (x-io, MIT), its gyroscope at zero and its settings as delivered, on the PC: the
 * direction of gravity. The library is in no folder of this repository (PEERS=folder).
 */
#ifndef FUSION_PC_H
#define FUSION_PC_H

#include "FusionAhrs.h"

#include <stdint.h>

#define FUSIONS 1U

typedef struct {
    FusionAhrs ahrs;
} fusion_t;

static inline void fusion_begin(fusion_t *fusion, float rate_hz)
{
    FusionAhrsSettings settings = fusionAhrsDefaultSettings;
    settings.sampleRate = rate_hz;
    FusionAhrsInitialise(&fusion->ahrs);
    FusionAhrsSetSettings(&fusion->ahrs, &settings);
}

/* One sample of three axes in; an axis of gravity's direction, 1 where it points along it. */
static inline double fusion_gravity(fusion_t *fusion, const int16_t lsb[3], int axis)
{
    const FusionVector still = { .array = { 0.0f, 0.0f, 0.0f } };
    const FusionVector force = { .array = { (float)lsb[0] / 265.0f, (float)lsb[1] / 265.0f, (float)lsb[2] / 256.0f } };
    FusionAhrsUpdateNoMagnetometer(&fusion->ahrs, still, force);
    return (double)FusionAhrsGetGravity(&fusion->ahrs).array[axis];
}

#endif
