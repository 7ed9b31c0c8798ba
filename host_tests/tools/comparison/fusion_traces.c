/* Fusion over a stream of three axes, for ctypes: samples x 3 LSB in, gravity's direction out. */
#include "fusion_pc.h"

void trace_fusion(double rate_hz, int samples, const double *lsb, double *gravity);

void trace_fusion(double rate_hz, int samples, const double *lsb, double *gravity)
{
    fusion_t fusion;
    fusion_begin(&fusion, (float)rate_hz);
    for (int k = 0; k < samples; k++, lsb += 3, gravity += 3) {
        const int16_t sample[3] = { (int16_t)lsb[0], (int16_t)lsb[1], (int16_t)lsb[2] };
        gravity[0] = fusion_gravity(&fusion, sample, 0);
        const FusionVector found = FusionAhrsGetGravity(&fusion.ahrs);
        gravity[1] = (double)found.array[1];
        gravity[2] = (double)found.array[2];
    }
}
