/*
 * Offsets and scales from six rests, each up to 20 degrees from its axis.
 *
 * Each of the six readings must have the length of 1 g. So for an axis the component in its two positions is +-sqrt(1 -
 * b^2 - c^2), with b, c of the other axes from the offsets and scales known so far. Two readings define a line: its
 * slope is the scale, its reading at 0 the offset. Each round improves b and c by a factor of four or more: at 20
 * degrees six rounds leave 0.005 LSB, at 15 degrees 0.0002 (600 parts each, half of them tilted the worst way).
 */
#include "calibration.h"
#include "calibration_inside.h"
#include "fx.h"

#define ONE_Q28 (1UL << 28)
#define ACROSS_MAX_Q28 (ONE_Q28 / 4U) /* sin(30 degrees)^2: at 20 degrees off it stays below this in every round */

enum { ROUNDS = 6, RESIDUAL_MAX_Q14 = 160 };
enum { HALF_MG_OF_Q14_UQ16 = 8000 }; /* 1000 / 2^14 mg, in halves */

/*
 * Two readings of an axis, Q4, are 6,014 to 10,560 apart for legal scales and 20 degrees. Others cannot become legal,
 * and the numbers that follow would not fit.
 */
enum { APART_MIN_Q4 = 6000, APART_MAX_Q4 = 10600 };

/* The six means: x, y, z of each position in turn. */
typedef const int16_t *means_t;

/* Component of gravity along the axis of a position, from the two others; 0 if those leave too little. */
static uint16_t component_q14(const calibration_t *c, means_t means, uint8_t position)
{
    uint32_t across_q28 = 0;
    for (uint8_t axis = 0; axis < 3U; axis++) {
        if (axis != position >> 1) {
            across_q28 += calibration_square(calibration_gravity_q14(c, axis, means[3U * position + axis]));
        }
    }
    return across_q28 > ACROSS_MAX_Q28 ? 0U : filter_fx_isqrt32(ONE_Q28 - across_q28);
}

/* Line through the two readings of an axis at its components, plus and minus; false if it is not a legal scale. */
static bool draw_line(calibration_t *c, means_t means, uint8_t axis, const uint16_t component_q14[2])
{
    int16_t upper_q4 = means[7U * axis];
    uint16_t apart_q4 = (uint16_t)((uint16_t)upper_q4 - (uint16_t)means[7U * axis + 3U]);
    if (apart_q4 < APART_MIN_Q4 || apart_q4 > APART_MAX_Q4) {
        return false;
    }
    uint16_t scale_uq6 = (uint16_t)calibration_over(apart_q4, (uint16_t)(component_q14[0] + component_q14[1]));
    c->scale_lsb_per_g_uq6[axis] = scale_uq6;
    uint16_t rise_q4 = filter_fx_mul16_uq16(scale_uq6, component_q14[0]);
    c->offset_lsb_q4[axis] = (int16_t)((uint16_t)upper_q4 - rise_q4);
    return true;
}

void calibration_six_start(calibration_six_t *six, const calibration_t *c)
{
    six->found = *c;
    for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
        six->known_q14[position] = CALIBRATION_ONE_Q14;
    }
    six->where = 0;
    six->round = 0;
}

/* Updates a position's component from the offsets and scales of this round. */
static bool improve(calibration_six_t *six, means_t means, uint8_t position)
{
    uint16_t better_q14 = component_q14(&six->found, means, position);
    int16_t change_q14 = (int16_t)((int16_t)better_q14 - (int16_t)six->known_q14[position]);
    uint16_t size_q14 = (uint16_t)(change_q14 < 0 ? -change_q14 : change_q14);
    if (size_q14 > six->off_q14) {
        six->off_q14 = size_q14;
        six->where = position;
    }
    six->known_q14[position] = better_q14;
    return better_q14 != 0U;
}

/* Three lines, then six components. */
bool calibration_six_step(calibration_six_t *six, const int16_t means[3 * CALIBRATION_POSITIONS])
{
    six->off_q14 = 0;
    for (uint8_t axis = 0; axis < 3U; axis++) {
        six->verdict = calibration_verdict(CALIBRATION_SCALE, axis);
        if (!draw_line(&six->found, means, axis, &six->known_q14[2U * axis])) {
            return false;
        }
    }
    for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
        six->verdict = calibration_verdict(CALIBRATION_TILTED, position);
        if (!improve(six, means, position)) {
            return false;
        }
    }
    six->verdict.why = (uint8_t)CALIBRATION_GOOD;
    return six->round++ != ROUNDS;
}

calibration_verdict_t calibration_six_end(const calibration_six_t *six, calibration_t *c, uint16_t *residual_mg)
{
    if (six->verdict.why != (uint8_t)CALIBRATION_GOOD) {
        return six->verdict;
    }
    *residual_mg = (uint16_t)((filter_fx_high_u16(six->off_q14, HALF_MG_OF_Q14_UQ16) + 1U) >> 1);
    if (six->off_q14 > RESIDUAL_MAX_Q14) {
        return calibration_verdict(CALIBRATION_RESIDUAL, six->where);
    }
    return calibration_commit(c, &six->found);
}

calibration_verdict_t calibration_six(calibration_t *c, const int16_t means[3 * CALIBRATION_POSITIONS],
                                      uint16_t *residual_mg)
{
    calibration_six_t six;
    calibration_six_start(&six, c);
    while (calibration_six_step(&six, means)) {
    }
    return calibration_six_end(&six, c, residual_mg);
}
