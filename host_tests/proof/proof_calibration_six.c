/* Six rests: any means that rests can have, from any legal calibration, round by round in any legal state. */
#include "calibration_bounds.h"

#include "fx.c"

#include "calibration.c"
#include "calibration_find.c"
#include "calibration_six.c"

static void any_means(int16_t means_lsb_q4[18])
{
    //@ loop unroll 18;
    for (uint8_t i = 0; i < 18U; i++) {
        means_lsb_q4[i] = ANY_S16(-MEAN_END, MEAN_END);
    }
}

static void any_slopes(calibration_t *c)
{
    for (uint8_t i = 0; i < 3U; i++) {
        c->offset_lsb_q4[i] = ANY_Z();
        c->scale_lsb_per_g_uq6[i] = ANY_U16(12000, SCALE_END);
        c->axes[i] = ANY_BOOL() ? ANY_S8(-3, -1) : ANY_S8(1, 3);
        c->level_q14[i] = ANY_S16(-LEVEL_END, LEVEL_END);
    }
}

static void any_six(calibration_six_t *six)
{
    any_slopes(&six->found);
    for (uint8_t i = 0; i < CALIBRATION_POSITIONS; i++) {
        six->known_q14[i] = ANY_U16(KNOWN_LEAST, 16384);
    }
    six->off_q14 = ANY_U16(0, 16384);
    six->where = ANY_U8(0, 5);
    six->round = ANY_U8(0, ROUNDS);
    six->verdict.why = ANY_U8(0, 6);
    six->verdict.where = ANY_U8(0, 5);
}

void proof_component_q14(void)
{
    int16_t means[18];
    calibration_t c;
    any_means(means);
    any_slopes(&c);
    for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
        (void)component_q14(&c, means, position);
    }
}

/*
 * What lies too far apart to be told from what lies near wraps into an offset that is not legal: its reading would have
 * to be beyond 1,900 LSB. Whole: calibration_over. Options: -no-warn-signed-downcast
 */
void proof_draw_line(void)
{
    int16_t means[18];
    uint16_t known_q14[2] = { ANY_U16(KNOWN_LEAST, 16384), ANY_U16(KNOWN_LEAST, 16384) };
    calibration_t c;
    any_means(means);
    any_slopes(&c);
    for (uint8_t axis = 0; axis < 3U; axis++) {
        (void)draw_line(&c, means, axis, known_q14);
    }
}

void proof_improve(void)
{
    int16_t means[18];
    calibration_six_t six;
    any_means(means);
    for (uint8_t position = 0; position < CALIBRATION_POSITIONS; position++) {
        any_six(&six);
        (void)improve(&six, means, position);
    }
}

/* Round by round. */
void proof_calibration_six_step(void)
{
    int16_t means[18];
    calibration_six_t six;
    any_means(means);
    for (uint8_t round = 0; round <= ROUNDS; round++) {
        any_six(&six);
        six.round = round;
        (void)calibration_six_step(&six, means);
    }
}

void proof_calibration_six_end(void)
{
    calibration_six_t six;
    calibration_t c;
    uint16_t residual_mg = 0;
    any_six(&six);
    any_slopes(&c);
    (void)calibration_six_end(&six, &c, &residual_mg);
    //@ check residual: residual_mg <= 1000;
}

/* From any legal calibration. */
void proof_calibration_six(void)
{
    int16_t means[18];
    calibration_t c;
    uint16_t residual_mg;
    any_means(means);
    any_slopes(&c);
    for (uint8_t i = 0; i < 3U; i++) {
        c.scale_lsb_per_g_uq6[i] = ANY_U16(12800, 21120);
    }
    calibration_six_t six;
    calibration_six_start(&six, &c);
    //@ check started: GOING_ON(&six) && six.where < 6;
    (void)calibration_six(&c, means, &residual_mg);
}
