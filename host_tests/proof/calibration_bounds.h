/* What holds of a calibration, and contracts of what is made of it. */
#ifndef CALIBRATION_BOUNDS_H
#define CALIBRATION_BOUNDS_H

#include "eva.h"
#include "fx_contracts.h"

#include "calibration_inside.h"

#define MEAN_END 32440    /* rest_mean_lsb_q4 */
#define LEVEL_END 18841   /* 1.15 g */
#define SCALE_END 25126   /* 10600 over the least two components */
#define KNOWN_LEAST 13824 /* sqrt(3/4) as filter_fx_isqrt32 tells it */

#define BETWEEN(v, low, high) ((low) <= (v) <= (high))
#define OF_ALL(v, low, high) (BETWEEN((v)[0], low, high) && BETWEEN((v)[1], low, high) && BETWEEN((v)[2], low, high))
#define NAMES(axis) (BETWEEN(axis, -3, -1) || BETWEEN(axis, 1, 3))
#define NAMED(c) (NAMES((c)->axes[0]) && NAMES((c)->axes[1]) && NAMES((c)->axes[2]))
#define SCALED(c) OF_ALL((c)->scale_lsb_per_g_uq6, 12800, 21120)
#define LEGAL(c) \
    (OF_ALL((c)->offset_lsb_q4, -1280, 1280) && SCALED(c) && NAMED(c) && OF_ALL((c)->level_q14, -LEVEL_END, LEVEL_END))
#define MEANS(m) OF_ALL(m, -MEAN_END, MEAN_END)

/* b from 2, for the quotient has 31 bits. */
/*@ requires -65535 <= a <= 65535 && b >= 2;
    assigns \result \from a, b;
*/
int32_t calibration_over(int32_t a, uint16_t b);

/*@ assigns \result \from a;
    ensures \result <= 1073741824;
*/
uint32_t calibration_square(int16_t a);

/*@ assigns \result \from v_q14[0..2];
    ensures \result <= 3221225472;
*/
static uint32_t length_square_q28(const int16_t v_q14[3]);

/*
 * What is good is legal: proved the other way round, as what is not legal is refused, in proof_calibration_check.c,
 * which must not take it from here.
 */
#ifndef TAKEN
#define TAKEN(c) LEGAL(c)
#endif
/*@ assigns \result \from *c;
    ensures \result.why == 0 || \result.why == 2 || \result.why == 3 || \result.why == 5 || \result.why == 6;
    ensures \result.why == 0 ==> TAKEN(c);
*/
calibration_verdict_t calibration_check(const calibration_t *c);

/*@ requires fits: b >= 12800 && 8 * a <= 15 * b && -8 * a <= 15 * b && -65533 <= a <= 65533;
    assigns \result \from a, b;
*/
static int16_t quotient_q14(int32_t a, uint16_t b);

/*@ assigns \result \from sum_q14, a_q8[0..2], row_q14[0..2]; */
static int32_t row_times(int32_t sum_q14, const int32_t a_q8[3], const int16_t row_q14[3]);

/*@ requires OF_ALL(c->offset_lsb_q4, -1280, 1280);
    assigns applied->bias_lsb_q14[0..2] \from *c, applied->matrix_q14[0..8];
    ensures \initialized(&applied->bias_lsb_q14[0..2]);
*/
static void prepare_bias(calibration_applied_t *applied, const calibration_t *c);

/*@ requires LEGAL(c) && ours < 3;
    requires BETWEEN(w_q14[0], -32768, 32767) && BETWEEN(w_q14[1], -32768, 32767) && BETWEEN(w_q14[2], -16384, 49151);
    assigns applied->matrix_q14[0..8] \from applied->matrix_q14[0..8], *c, w_q14[0..2], ours;
*/
static void prepare_column(calibration_applied_t *applied, const calibration_t *c, const int32_t w_q14[3],
                           uint8_t ours);

/*@ assigns out_q8[0..2] \from *applied, a_q8[0..2];
    ensures \initialized(&out_q8[0..2]);
*/
void calibration_apply(const calibration_applied_t *applied, const int32_t a_q8[3], int32_t out_q8[3]);

/*@ requires axis < 3 && -MEAN_END <= lsb_q4 <= MEAN_END;
    requires 12000 <= c->scale_lsb_per_g_uq6[axis] <= SCALE_END;
    assigns \result \from c->offset_lsb_q4[axis], c->scale_lsb_per_g_uq6[axis], lsb_q4;
    ensures -32767 <= \result <= 32767;
*/
int16_t calibration_gravity_q14(const calibration_t *c, uint8_t axis, int16_t lsb_q4);

/*@ assigns *c, \result \from *c, *found;
    ensures \result.why == 0 || \result.why == 2 || \result.why == 3 || \result.why == 5 || \result.why == 6;
*/
calibration_verdict_t calibration_commit(calibration_t *c, const calibration_t *found);

/*@ requires MEANS(mean_lsb_q4);
    ensures \result < 6;
*/
uint8_t calibration_position(const int16_t mean_lsb_q4[3]);
/*@ requires SCALED(c) && NAMED(c) && MEANS(mean_lsb_q4); */
calibration_verdict_t calibration_tare(calibration_t *c, const int16_t mean_lsb_q4[3]);
/*@ requires SCALED(c) && MEANS(mean_lsb_q4); */
calibration_verdict_t calibration_single(calibration_t *c, const int16_t mean_lsb_q4[3]);

/* Six rests. */
#define ALL_MEANS(m) \
    (MEANS(m) && MEANS((m) + 3) && MEANS((m) + 6) && MEANS((m) + 9) && MEANS((m) + 12) && MEANS((m) + 15))
#define KNOWN(k) (OF_ALL(k, KNOWN_LEAST, 16384) && OF_ALL((k) + 3, KNOWN_LEAST, 16384))
#define SLOPES(c) OF_ALL((c)->scale_lsb_per_g_uq6, 12000, SCALE_END)
#define GOING_ON(s) (SLOPES(&(s)->found) && KNOWN((s)->known_q14) && (s)->round <= 6)

/*@ requires SLOPES(c) && ALL_MEANS(means) && position < 6;
    assigns \result \from *c, means[0..17], position;
    ensures \result == 0 || KNOWN_LEAST <= \result <= 16384;
*/
static uint16_t component_q14(const calibration_t *c, const int16_t *means, uint8_t position);

/*@ requires axis < 3 && ALL_MEANS(means) && SLOPES(c);
    requires BETWEEN(component_q14[0], KNOWN_LEAST, 16384) && BETWEEN(component_q14[1], KNOWN_LEAST, 16384);
    assigns c->scale_lsb_per_g_uq6[axis], c->offset_lsb_q4[axis], \result
      \from *c, means[0..17], axis, component_q14[0..1];
    ensures \result == 0 || \result == 1;
    ensures 12000 <= c->scale_lsb_per_g_uq6[axis] <= SCALE_END;
*/
static bool draw_line(calibration_t *c, const int16_t *means, uint8_t axis, const uint16_t component_q14[2]);

/*@ requires SLOPES(&six->found) && KNOWN(six->known_q14) && ALL_MEANS(means) && position < 6;
    requires six->off_q14 <= 16384 && six->where < 6;
    assigns six->known_q14[position], six->off_q14, six->where, \result \from *six, means[0..17], position;
    ensures six->off_q14 <= 16384 && six->where < 6;
    ensures \result == 0 || (\result == 1 && KNOWN(six->known_q14));
*/
static bool improve(calibration_six_t *six, const int16_t *means, uint8_t position);

/*@ requires GOING_ON(six) && ALL_MEANS(mean_lsb_q4) && six->where < 6;
    assigns *six, \result \from *six, mean_lsb_q4[0..17];
    ensures \initialized(&six->off_q14) && \initialized(&six->where) && \initialized(&six->verdict.why);
    ensures six->off_q14 <= 16384 && six->where < 6;
    ensures \result == 0 || (\result == 1 && GOING_ON(six));
*/
bool calibration_six_step(calibration_six_t *six, const int16_t mean_lsb_q4[18]);

static void any_calibration(calibration_t *c)
{
    for (uint8_t i = 0; i < 3U; i++) {
        c->offset_lsb_q4[i] = ANY_Z();
        c->scale_lsb_per_g_uq6[i] = ANY_U16(0, UINT16_MAX);
        c->axes[i] = ANY_S8(-128, 127);
        c->level_q14[i] = ANY_Z();
    }
}

#endif
