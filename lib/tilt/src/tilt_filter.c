/* From readings to roll and pitch: see tilt_filter.h. */
#include "tilt_filter.h"

enum { BITS_MIN = 8, FILTER_BITS = 13, BITS_MAX = 16 };

calibration_verdict_t tilt_filter_calibrate(tilt_filter_t *t, const calibration_t *calibration)
{
    return calibration_prepare(&t->calibration, calibration);
}

/* False: not legal, nothing is changed. */
static bool set_scale(tilt_filter_t *t, uint16_t xy_uq6, uint16_t z_uq6)
{
    calibration_t plain;
    calibration_plain(&plain, xy_uq6, z_uq6);
    return tilt_filter_calibrate(t, &plain).why == (uint8_t)CALIBRATION_GOOD;
}

static int16_t highest_of(uint8_t bits)
{
    return (int16_t)((1U << (bits - 1U)) - 1U);
}

bool tilt_filter_sensor(tilt_filter_t *t, uint8_t bits, uint16_t xy_lsb_per_g, uint16_t z_lsb_per_g)
{
    uint32_t xy_uq6 = (uint32_t)xy_lsb_per_g << 6;
    uint32_t z_uq6 = (uint32_t)z_lsb_per_g << 6;
    uint8_t shift = 0;
    while (bits > (uint8_t)FILTER_BITS || xy_uq6 > CALIBRATION_SCALE_MAX_UQ6 || z_uq6 > CALIBRATION_SCALE_MAX_UQ6) {
        xy_uq6 >>= 1;
        z_uq6 >>= 1;
        bits--;
        shift++;
    }
    /* not too many bits given, and enough left */
    if (bits + shift > BITS_MAX || bits < (uint8_t)BITS_MIN || !set_scale(t, (uint16_t)xy_uq6, (uint16_t)z_uq6)) {
        return false;
    }
    t->shift = shift;
    t->rail_high_lsb = highest_of(bits);
    return true;
}

filter_answer_t tilt_filter_use(tilt_filter_t *t, const filter_law_t *law, const filter_config_t *config)
{
    filter_config_t wanted = (config != NULL) ? *config : filter_defaults(law, t->rate_dhz);
    wanted.rate_dhz = t->rate_dhz;
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES; axis++) {
        tilt_axis_t *a = &t->axes[axis];
        int32_t x_lsb_q16 = a->filter.x_lsb_q16;
        filter_answer_t answer = filter_init(&a->filter, law, &wanted);
        if (answer != FILTER_ACCEPTED) {
            return answer; /* for the first axis; the same for all */
        }
        a->filter.x_lsb_q16 = x_lsb_q16; /* until the next sample */
        tilt_axis_begin(a, t->rate_dhz, axis == 2U);
    }
    t->flags = TILT_WARMING_UP;
    return FILTER_ACCEPTED;
}

bool tilt_filter_begin_with(tilt_filter_t *t, uint16_t rate_hz, const filter_law_t *law)
{
    bool legal = true;
    if (rate_hz < (uint16_t)TILT_FILTER_RATE_MIN_HZ) {
        rate_hz = TILT_FILTER_RATE_MIN_HZ;
        legal = false;
    } else if (rate_hz > (uint16_t)TILT_FILTER_RATE_MAX_HZ) {
        rate_hz = TILT_FILTER_RATE_MAX_HZ;
        legal = false;
    }
    t->rate_dhz = (uint16_t)(rate_hz * 10U);
    t->angles.roll_cdeg = 0;
    t->angles.pitch_cdeg = 0;
    t->angles.roll_undefined = false;
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES; axis++) {
        t->a_q8[axis] = 0;
        t->axes[axis].filter.x_lsb_q16 = 0;
    }
    t->shift = 0;
    t->rail_high_lsb = highest_of(FILTER_BITS);
    (void)set_scale(t, CALIBRATION_SCALE_3V3_XY_UQ6, CALIBRATION_SCALE_3V3_Z_UQ6);
    (void)tilt_filter_use(t, law, NULL); /* the defaults are legal at every rate */
    return legal;
}

/* A reading in the 13 bits that the filters take, rounded half up. */
static int16_t in_13_bits(const tilt_filter_t *t, int16_t reading)
{
    if (t->shift == 0U) {
        return reading;
    }
    return (int16_t)((((int32_t)reading >> (t->shift - 1U)) + 1) >> 1);
}

/* Accelerations and angles from the filters' estimates, fraction bits included. */
static void find_angles(tilt_filter_t *t)
{
    int32_t estimates_q8[TILT_FILTER_AXES];
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES; axis++) {
        estimates_q8[axis] = tilt_axis_estimate_q8(&t->axes[axis]);
    }
    calibration_apply(&t->calibration, estimates_q8, t->a_q8);
    tilt_angles(&t->angles, t->a_q8);
    if (t->angles.roll_undefined) {
        t->flags |= TILT_ROLL_UNDEFINED;
    }
    if (!tilt_gravity_plausible(t->a_q8)) {
        t->flags |= TILT_NOT_GRAVITY;
    }
}

static void update_axis(tilt_filter_t *t, uint8_t axis, int16_t reading)
{
    tilt_axis_t *a = &t->axes[axis];
    t->flags |= tilt_axis_update(a, in_13_bits(t, reading), t->rail_high_lsb, false);
    if ((a->filter.flags & FILTER_SWITCHED) != 0U) {
        t->flags |= TILT_SWITCHED;
    }
}

void tilt_filter_update(tilt_filter_t *t, int16_t ax, int16_t ay, int16_t az)
{
    t->flags = 0;
    update_axis(t, 0, ax);
    update_axis(t, 1, ay);
    update_axis(t, 2, az);
    find_angles(t);
}

void tilt_filter_missing(tilt_filter_t *t)
{
    t->flags = 0;
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES; axis++) {
        t->flags |= tilt_axis_missing(&t->axes[axis]);
    }
    find_angles(t);
}
