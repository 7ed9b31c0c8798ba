/* The accelerometer's path of Fusion, its gyroscope at zero: all three axes in one call. */
#include "FusionAhrs.h"
#include "peer.h"

#include <math.h>

#define LSB_PER_G 265.0f /* of the stream's x */

PEER_FLOAT

static FusionAhrs filter;

void peer_start(void)
{
    FusionAhrsSettings settings = fusionAhrsDefaultSettings;
    settings.sampleRate = 100.0f;
    FusionAhrsInitialise(&filter);
    FusionAhrsSetSettings(&filter, &settings);
}

void peer_step(void)
{
    const FusionVector still = { .array = { 0.0f, 0.0f, 0.0f } };
    float across = z / LSB_PER_G;
    const FusionVector force = { .array = { across, 0.0f,
                                            sqrtf(across * across < 1.0f ? 1.0f - across * across : 0.0f) } };
    FusionAhrsUpdateNoMagnetometer(&filter, still, force);
    x = LSB_PER_G * FusionAhrsGetGravity(&filter).array[0];
}
