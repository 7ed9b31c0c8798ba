/* Plausibility of |a|: any three int32. The angles are not proved: their loops on the leading bit tie values together. */
#include "eva.h"

#include "tilt.h"

#include "fx.c"

#include "tilt.c"

void proof_tilt_gravity_plausible(void)
{
    (void)tilt_gravity_plausible(ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX));
}
