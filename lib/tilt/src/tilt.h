/*
 * Roll and pitch from a gravity vector in fixed point.
 *
 * Axes as on the ADXL345 (datasheet p. 36): roll = atan2(y, z), pitch = atan2(-x, sqrt(y^2 + z^2)). No accelerometer
 * can distinguish tilt from sustained acceleration, and roll is undefined when y and z vanish.
 */
#ifndef TILT_H
#define TILT_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    int16_t roll_cdeg;   /* -17999..18000, 0.01 degree; the caller's last value is kept when undefined */
    int16_t pitch_cdeg;  /* -9000..9000 */
    bool roll_undefined; /* y and z too small to give a direction: |(y, z)| < TILT_ROLL_MIN_Q8 */
} tilt_t;

/* Below this |(y, z)| (LSB, Q8; 4 LSB = 16 mg) roll is not computed: noise alone would rotate it. */
#define TILT_ROLL_MIN_Q8 1024U

/*
 * Roll and pitch from filtered accelerations in LSB with 8 fraction bits, |each| <= 4608 * 256 (any int32 is safe).
 * out->roll_cdeg must hold the last roll on entry: it is kept if roll is undefined. (0, 0, 0) gives pitch 0, roll kept.
 * Error against double from the same inputs, |a| >= 0.25 g: roll <= 0.021, pitch <= 0.029 degree (0.015 found). Any
 * context; no float, no 64-bit products, no division helper, no table.
 */
void tilt_angles(tilt_t *out, const int32_t a_q8[3]);

/* atan2 in 0.01 degree, -17999..18000, of any two values; (0, 0) gives 0. Error <= 0.021 degree. Any context. */
int16_t tilt_atan2_cdeg(int32_t y, int32_t x);

/* floor(sqrt(v)), exact for every v (all 2^32 were tried). Any context. */
uint16_t tilt_isqrt32(uint32_t v);

/*
 * Whether |a|^2 is within 0.85..1.15 g of the nominal 256 LSB/g, from LSB in Q8. False: do not trust the tilt (flag 512
 * of the protocol).
 */
bool tilt_gravity_plausible(const int32_t a_q8[3]);

#ifdef __cplusplus
}
#endif
#endif
