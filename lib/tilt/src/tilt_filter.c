/* From readings to roll and pitch: see tilt_filter.h. */
#include "tilt_filter.h"

#include <stddef.h>

enum { SENSOR_BITS = 13 };

static void apply_scale(tilt_filter_t *t, uint16_t xy_uq6, uint16_t z_uq6)
{
    calibration_t plain;
    calibration_plain(&plain, xy_uq6, z_uq6);
    (void)calibration_prepare(&t->calibration, &plain);
}

/* The law's shipped values, or the caller's, at the facade's rate and with the R in force. */
static filter_answer_t begin_axis(tilt_filter_t *t, uint8_t axis, const filter_law_t *law,
                                  const filter_config_t *wanted)
{
    filter_config_t config = filter_defaults(law, t->rate_dhz);
    if (wanted != NULL) {
        config = *wanted;
        config.rate_dhz = t->rate_dhz;
    }
    filter_answer_t answer = filter_init(&t->filters[axis], law, &config);
    if (answer == FILTER_ACCEPTED) {
        noise_init(&t->noise[axis], t->rate_dhz, axis == 2U);
        filter_set_noise(&t->filters[axis], noise_r_lsb2_q8(&t->noise[axis]));
    }
    return answer;
}

filter_answer_t tilt_filter_use(tilt_filter_t *t, const filter_law_t *law, const filter_config_t *config)
{
    filter_answer_t answer = FILTER_ACCEPTED;
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES && answer == FILTER_ACCEPTED; axis++) {
        answer = begin_axis(t, axis, law, config);
    }
    return answer;
}

void tilt_filter_begin(tilt_filter_t *t, uint16_t rate_hz)
{
    t->angles = (tilt_t){ 0, 0, false };
    t->flags = FILTER_WARMING_UP;
    t->shift = 0;
    t->rail_high_lsb = FILTER_Z_MAX_LSB;
    t->rate_dhz = (uint16_t)(rate_hz * 10U);
    apply_scale(t, CALIBRATION_SCALE_3V3_XY_UQ6, CALIBRATION_SCALE_3V3_Z_UQ6);
    (void)tilt_filter_use(t, &filter_law_adaptive, NULL);
}

bool tilt_filter_sensor(tilt_filter_t *t, uint8_t bits, uint16_t xy_lsb_per_g, uint16_t z_lsb_per_g)
{
    if (bits < 8U || bits > 16U) {
        return false;
    }
    uint8_t shift = (uint8_t)((bits > (uint8_t)SENSOR_BITS) ? bits - (uint8_t)SENSOR_BITS : 0);
    uint32_t xy_uq6 = ((uint32_t)xy_lsb_per_g << 6) >> shift;
    uint32_t z_uq6 = ((uint32_t)z_lsb_per_g << 6) >> shift;
    if (xy_uq6 < CALIBRATION_SCALE_MIN_UQ6 || xy_uq6 > CALIBRATION_SCALE_MAX_UQ6 || z_uq6 < CALIBRATION_SCALE_MIN_UQ6 ||
        z_uq6 > CALIBRATION_SCALE_MAX_UQ6) {
        return false;
    }
    t->shift = shift;
    t->rail_high_lsb = (int16_t)((1L << ((bits > (uint8_t)SENSOR_BITS) ? SENSOR_BITS - 1 : bits - 1)) - 1L);
    apply_scale(t, (uint16_t)xy_uq6, (uint16_t)z_uq6);
    return true;
}

/* A reading in the 13 bit that the filters take, rounded. */
static int16_t shifted(const tilt_filter_t *t, int16_t reading)
{
    if (t->shift == 0U) {
        return reading;
    }
    int32_t half = (int32_t)1 << (t->shift - 1U);
    return (int16_t)(((int32_t)reading + half) >> t->shift);
}

static void update_axis(tilt_filter_t *t, uint8_t axis, int16_t z_lsb)
{
    filter_t *f = &t->filters[axis];
    if (z_lsb >= t->rail_high_lsb || z_lsb <= (int16_t)(-t->rail_high_lsb - 1)) {
        t->flags |= TILT_FILTER_CLIPPED;
        noise_gap(&t->noise[axis]);
        (void)filter_missing(f);
        return;
    }
    if (noise_update(&t->noise[axis], z_lsb)) {
        filter_set_noise(f, noise_r_lsb2_q8(&t->noise[axis]));
    }
    (void)filter_update(f, z_lsb);
}

/* Accelerations and angles from the filters' estimates with their fraction. */
static void find_angles(tilt_filter_t *t)
{
    int32_t estimates_q8[TILT_FILTER_AXES];
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES; axis++) {
        t->flags |= t->filters[axis].flags;
        estimates_q8[axis] = (t->filters[axis].x_lsb_q16 + 128) >> 8;
    }
    calibration_apply(&t->calibration, estimates_q8, t->a_q8);
    tilt_angles(&t->angles, t->a_q8);
    if (!tilt_gravity_plausible(t->a_q8)) {
        t->flags |= TILT_FILTER_NOT_GRAVITY;
    }
}

void tilt_filter_update(tilt_filter_t *t, int16_t x, int16_t y, int16_t z)
{
    t->flags = 0;
    update_axis(t, 0, shifted(t, x));
    update_axis(t, 1, shifted(t, y));
    update_axis(t, 2, shifted(t, z));
    find_angles(t);
}

void tilt_filter_missing(tilt_filter_t *t)
{
    t->flags = 0;
    for (uint8_t axis = 0; axis < (uint8_t)TILT_FILTER_AXES; axis++) {
        noise_gap(&t->noise[axis]);
        (void)filter_missing(&t->filters[axis]);
    }
    find_angles(t);
}
