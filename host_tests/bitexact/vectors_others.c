/* Paths of the noise estimate and of the angles. */
#include "fx.h"
#include "noise.h"
#include "tilt.h"
#include "vectors.h"

enum { NOISE, ANGLES, ATAN2, ISQRT, GRAVITY, OTHER_COUNT };

enum { ITEMS = 5 * VECTORS_BLOCK };

static const char names[OTHER_COUNT][24] IN_FLASH = { "noise", "tilt_angles", "tilt_atan2_cdeg", "tilt_isqrt32",
                                                      "tilt_gravity_plausible" };

static noise_t noise;
static tilt_t tilt;

uint8_t other_paths(void)
{
    return OTHER_COUNT;
}

vectors_path_t other_path(uint8_t which)
{
    return (vectors_path_t){ names[which], ITEMS };
}

/* A new estimate every 250 samples, any rate, both axes; sigma of 1 to 2^11 LSB; a gap now and then. */
static void noise_item(uint16_t index)
{
    uint32_t v = vectors_random();
    if (index % 250U == 0U) {
        filter_noise_init(&noise, (uint16_t)(50U + (v >> 8) % 39951U), (v & 1U) != 0U);
    } else if ((v & 0x3FU) == 0U) {
        filter_noise_gap(&noise);
    }
    int16_t z = (int16_t)((int32_t)(vectors_random() >> 16) - 32768);
    z = (int16_t)(z / (int16_t)(1 << ((index >> 5) & 14U)));
    vectors_input((uint16_t)z);
    vectors_output(filter_noise_update(&noise, z), 1);
    vectors_output(filter_noise_r_lsb2_q8(&noise), 4);
    vectors_state(&noise, sizeof noise);
}

/* Any number of any magnitude and sign, without an implementation-defined conversion or shift. */
static int32_t any_i32(void)
{
    uint32_t v = vectors_random();
    int32_t size = (int32_t)((v & 0x7FFFFFFFUL) >> (vectors_random() & 31U));
    size = ((v & 0x80000000UL) != 0U) ? -size : size;
    vectors_input((uint32_t)size);
    return size;
}

/* Around 1 g as a board has it, Q8. */
static int32_t acceleration_q8(void)
{
    int32_t a = (int32_t)(vectors_random() & 0x1FFFFUL) - 65536;
    vectors_input((uint32_t)a);
    return a;
}

static void angles_item(bool any)
{
    int32_t x = any ? any_i32() : acceleration_q8();
    int32_t y = any ? any_i32() : acceleration_q8();
    int32_t z = any ? any_i32() : acceleration_q8();
    tilt_angles(&tilt, (const int32_t[]){ x, y, z });
    vectors_output((uint16_t)tilt.roll_cdeg, 2);
    vectors_output((uint16_t)tilt.pitch_cdeg, 2);
    vectors_output(tilt.roll_undefined, 1);
    vectors_state(&tilt, sizeof tilt);
}

static void gravity_item(bool any)
{
    int32_t x = any ? any_i32() : acceleration_q8();
    int32_t y = any ? any_i32() : acceleration_q8();
    int32_t z = any ? any_i32() : acceleration_q8();
    vectors_output(tilt_gravity_plausible((const int32_t[]){ x, y, z }), 1);
}

void other_path_item(uint8_t which, uint16_t index)
{
    bool any = (index & 1U) != 0U;
    if (index == 0U) {
        tilt = (tilt_t){ 0, 0, false };
    }
    switch (which) {
    case NOISE:
        noise_item(index);
        break;
    case ANGLES:
        angles_item(any);
        break;
    case ATAN2: {
        int32_t y = any_i32();
        int32_t x = any_i32();
        vectors_output((uint16_t)tilt_atan2_cdeg(y, x), 2);
        break;
    }
    case ISQRT:
        vectors_output(tilt_isqrt32((uint32_t)any_i32()), 2);
        break;
    default:
        gravity_item(any);
        break;
    }
}
