/* A filter of robust_peers.h on one axis of the sensor: kf's defaults, the firmware's noise estimate. PC only. */
#ifndef SUPPORT_ROBUST_AXIS_H
#define SUPPORT_ROBUST_AXIS_H

#include "noise.h"
#include "support/robust_peers.h"

typedef struct {
    robust_peer_t peer;
    noise_t noise;
} robust_axis_t;

/* axis: 2 is the noisier z. */
void robust_axis_begin(robust_axis_t *of, robust_kind_t kind, uint16_t rate_dhz, int axis);

/* One sample in, the estimate out. */
double robust_axis_sample(robust_axis_t *of, int16_t z_lsb);

#endif
