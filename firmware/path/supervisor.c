/* Reports choices and leaves a bad axis out: see supervisor.h. */
#include "path/supervisor.h"

#if SUPERVISOR

#include "base/text.h"
#include "filter_list.h"
#include "fx.h"
#include "machine.h"
#include "tilt_partial.h"

enum { AXES = 3 };

static struct {
    uint8_t repeated[AXES]; /* readings in a row that repeat the one before; saturates */
    uint8_t negative;       /* one bit per axis: sign of its last estimate while its readings changed */
    uint8_t left_out;       /* 1 to 3: x, y, z; 0, as after a reset: none */
    uint16_t missing_q6;    /* component of the axis left out */
} supervisor;

/* On all axes: a change of filter starts with the last and ends with the first. */
static bool in_force(const tilt_axis_t *axes)
{
    return axes[0].filter.law == &filter_law_auto && axes[AXES - 1].filter.law == &filter_law_auto;
}

/* The signs are kept: for an axis that is already stuck, its last sign is the best guess. */
void supervisor_reset(void)
{
    for (uint8_t axis = 0; axis < AXES; axis++) {
        supervisor.repeated[axis] = 0;
    }
    supervisor.left_out = 0;
}

void supervisor_look(const int16_t before[3], const int16_t lsb[3])
{
    for (uint8_t axis = 0; axis < AXES; axis++) {
        uint8_t *repeated = &supervisor.repeated[axis];
        if (lsb[axis] != before[axis]) {
            *repeated = 0;
        } else if (*repeated != UINT8_MAX) {
            (*repeated)++;
        }
    }
}

static bool is_bad(uint8_t axis, const int16_t lsb[3], int16_t rail_high_lsb)
{
    uint8_t repeated = supervisor.repeated[axis];
    return repeated >= SUPERVISOR_REPEATED_SAMPLES ||
           (repeated >= SUPERVISOR_RAIL_SAMPLES && tilt_at_rail(lsb[axis], rail_high_lsb));
}

/* The only bad axis, while another one changes, as in left_out; 0: none, or more than one. */
static uint8_t bad_axis(const int16_t lsb[3], int16_t rail_high_lsb)
{
    uint8_t found = 0;
    bool changes = false;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        changes |= supervisor.repeated[axis] < SUPERVISOR_RAIL_SAMPLES;
        if (is_bad(axis, lsb, rail_high_lsb)) {
            if (found != 0) {
                return 0;
            }
            found = (uint8_t)(axis + 1);
        }
    }
    return changes ? found : 0;
}

/* The reading of an axis at 0 g, Q8. */
static int32_t offset_q8(const calibration_t *calibration, uint8_t axis)
{
    return (int32_t)calibration->offset_lsb_q4[axis] * 16;
}

static void note_signs(const tilt_axis_t axes[3], const calibration_t *calibration)
{
    for (uint8_t axis = 0; axis < AXES; axis++) {
        uint8_t bit = (uint8_t)(1u << axis);
        if (supervisor.repeated[axis] == 0) {
            supervisor.negative &= (uint8_t)~bit;
            if (axes[axis].filter.x_lsb_q16 < (int32_t)calibration->offset_lsb_q4[axis] * 4096) {
                supervisor.negative |= bit;
            }
        }
    }
}

/*
 * Without the bad axis' component the calibrated vector is perpendicular to that axis, whatever the mounting is:
 * returns what it lacks to 1 g.
 */
static uint16_t missing_of_q6(const supervisor_view_t *view, uint8_t bad)
{
    int32_t estimates_q8[AXES];
    for (uint8_t axis = 0; axis < AXES; axis++) {
        estimates_q8[axis] = tilt_axis_estimate_q8(&view->axes[axis]);
    }
    estimates_q8[bad] = offset_q8(view->calibration, bad);
    int32_t a_q8[AXES];
    calibration_apply(view->applied, estimates_q8, a_q8);
    return tilt_missing_q6(a_q8[0], a_q8[1], a_q8[2]);
}

void supervisor_sample(const supervisor_view_t *view)
{
    supervisor.left_out = 0;
    if (in_force(view->axes)) {
        note_signs(view->axes, view->calibration);
        supervisor.left_out = bad_axis(view->lsb, view->rail_high_lsb);
        if (supervisor.left_out != 0) {
            supervisor.missing_q6 = missing_of_q6(view, (uint8_t)(supervisor.left_out - 1));
        }
    }
}

/* The component missing to 1 g is that of the bad axis; its scale converts it to a reading. */
bool supervisor_complete(const calibration_t *calibration, int32_t estimates_q8[3])
{
    if (supervisor.left_out == 0) {
        return false;
    }
    uint8_t bad = (uint8_t)(supervisor.left_out - 1);
    /* Q6 x UQ6 of 256 LSB per g: Q8 */
    int32_t part_q8 = (int32_t)(fx_product_u16(supervisor.missing_q6, calibration->scale_lsb_per_g_uq6[bad]) >> 12);
    bool negative = (supervisor.negative & (uint8_t)(1u << bad)) != 0;
    estimates_q8[bad] = offset_q8(calibration, bad) + (negative ? -part_q8 : part_q8);
    return true;
}

/* Offset and scale error of an uncalibrated part at 1 g, 39 mg: typical 0 g offset 35 mg (data sheet p. 3). LSB. */
#define PART_ERROR_LSB 10ul

/* Sigma of the noisier of the remaining axes, LSB in Q8, including the error of the part. */
static uint16_t remaining_sigma_q8(const tilt_axis_t *axes)
{
    uint32_t p_lsb2_q8 = 0;
    for (uint8_t axis = 0; axis < AXES; axis++) {
        filter_probe_t probe;
        filter_probe(&axes[axis].filter, &probe);
        if (axis + 1 != supervisor.left_out && probe.p_lsb2_q8 > p_lsb2_q8) {
            p_lsb2_q8 = probe.p_lsb2_q8;
        }
    }
    return filter_fx_isqrt32((p_lsb2_q8 << 8) + (PART_ERROR_LSB * PART_ERROR_LSB << 16)); /* <= 1100 LSB^2 in Q16 */
}

static void say_axis(uint8_t axis)
{
    text_char((char)('x' + axis));
}

void supervisor_say(const tilt_axis_t axes[3])
{
    static const char names[AUTO_MEMBERS][8] IN_FLASH = { " slow", " middle", " fast" };
    if (!in_force(axes)) {
        return;
    }
    text_words(FLASH_TEXT(", chosen"));
    for (uint8_t axis = 0; axis < AXES; axis++) {
        text_char(' ');
        say_axis(axis);
        text_words(names[axes[axis].filter.own.bank.chosen]);
    }
    if (supervisor.left_out != 0) {
        text_words(FLASH_TEXT(", without "));
        say_axis((uint8_t)(supervisor.left_out - 1));
        text_words(FLASH_TEXT(" sigma cdeg "));
        text_u32(tilt_partial_sigma_cdeg(remaining_sigma_q8(axes), supervisor.missing_q6));
    }
}

#endif
