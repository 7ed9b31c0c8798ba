/* The angles: any int32 in, no overflow, every angle within its range. */
#include "eva.h"
#include "fx_contracts.h"

#include "tilt.h"

/*@ requires \valid(o) && \valid(a) && \separated(o, a);
    assigns *o, *a, \result \from opposite, adjacent;
    ensures \initialized(o) && \initialized(a);
    ensures *o <= 0x7FFF && *a <= 0x7FFF;
    ensures 0 <= \result <= 17;
*/
static uint8_t shorten_to_15_bits(uint32_t opposite, uint32_t adjacent, uint16_t *o, uint16_t *a);

/*@ requires 0 < large <= 0x7FFF;
    requires small <= 0x7FFF;
    assigns \result \from small, large;
*/
static uint16_t fraction_uq16(uint16_t small, uint16_t large);

#define ROLL(angle) (-17999 <= (angle) <= 18000)
#define PITCH(angle) (-9000 <= (angle) <= 9000)
/*@ ensures ROLL(\result); */
int16_t tilt_atan2_cdeg(int32_t y, int32_t x);
/*@ requires ROLL(out->roll_cdeg);
    ensures ROLL(out->roll_cdeg) && PITCH(out->pitch_cdeg);
    ensures out->roll_undefined == 0 || out->roll_undefined == 1;
*/
void tilt_angles(tilt_t *out, const int32_t a_q8[3]);

#include "fx.c"

#include "tilt.c"

static uint32_t any_of_length(uint8_t bits)
{
    if (bits == 0) {
        return 0;
    }
    uint32_t top = (uint32_t)1U << (bits - 1U);
    return ANY_U32(top, top + (top - 1U));
}

/* One call for each pair of lengths in bits: the loops look for the leading bit. */
void proof_shorten_to_15_bits(void)
{
    for (uint8_t i = 0; i <= 32; i++) {
        for (uint8_t j = 0; j <= 32; j++) {
            uint16_t o;
            uint16_t a;
            (void)shorten_to_15_bits(any_of_length(i), any_of_length(j), &o, &a);
        }
    }
}

/* Options: -eva-slevel 1 -eva-min-loop-unroll 4 */
void proof_fraction_uq16(void)
{
    (void)fraction_uq16(ANY_U16(0, 0x7FFF), ANY_U16(1, 0x7FFF));
}

void proof_tilt_atan2_cdeg(void)
{
    (void)tilt_atan2_cdeg(ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX));
}

void proof_tilt_angles(void)
{
    tilt_t tilt;
    tilt.roll_cdeg = ANY_S16(-17999, 18000);
    tilt_angles(&tilt, (const int32_t[]){ ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX),
                                          ANY_S32(S32_MIN, INT32_MAX) });
}

void proof_tilt_isqrt32(void)
{
    (void)tilt_isqrt32(ANY_U32(0, UINT32_MAX));
}

void proof_tilt_gravity_plausible(void)
{
    (void)tilt_gravity_plausible(
        (const int32_t[]){ ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX), ANY_S32(S32_MIN, INT32_MAX) });
}
