/* Roll and pitch with the functions of the C library. */
#include <math.h>

#include "float_filters.h"

#define DEGREES 57.29578f

void float_angles(float *roll, float *pitch, float x, float y, float z)
{
    *roll = (float)atan2f(y, z) * DEGREES;
    *pitch = (float)atan2f(-x, (float)sqrtf(y * y + z * z)) * DEGREES;
}
