/* What holds of the synthesised filters before and after every call, and states within it. */
#ifndef SYNTH_BOUNDS_H
#define SYNTH_BOUNDS_H

#include "eva.h"
#include "fx_contracts.h"

#include "synth_common.h"

#define X_MAX_Q16 301989888 /* 4608 LSB */
#define WITHIN_X(x) (-X_MAX_Q16 <= (x) <= X_MAX_Q16)
#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define SAMPLE_Q16(x) (-4096 * 65536 <= (x) <= 4095 * 65536)
#define FIVE(lsb) (SAMPLE((lsb)[0]) && SAMPLE((lsb)[1]) && SAMPLE((lsb)[2]) && SAMPLE((lsb)[3]) && SAMPLE((lsb)[4]))
#define SPREAD(s) ((s)->motion_lsb <= 320 && 1 <= (s)->spread_lsb <= 365)
/* The flags say so until there are estimates. */
#define STARTING(c)                                                                                \
    ((c)->collected < 5 && ((c)->flags & FILTER_WARMING_UP) != 0 && FIVE((c)->u.start.seen_lsb) && \
     FIVE((c)->u.start.ascending_lsb))
#define ESTIMATES(c) \
    (WITHIN_X((c)->u.run.x_lsb_q16[0]) && WITHIN_X((c)->u.run.x_lsb_q16[1]) && WITHIN_X((c)->u.run.x_lsb_q16[2]))
/* The median of the start is there as long as the flags say so. */
#define MEDIAN(c) (((c)->flags & FILTER_WARMING_UP) == 0 || SAMPLE_Q16((c)->u.run.median_lsb_q16))
/* Behind the start, whose last step is the filter's own, and after a reset the flags never say that it is under way. */
#define RUNNING(c, last) \
    (ESTIMATES(c) &&     \
     ((5 <= (c)->collected <= (last) && MEDIAN(c)) || ((c)->collected == 255 && (c)->flags < FILTER_WARMING_UP)))
#define CORE_BUT_NOISE(c, last) \
    ((c)->flags < 32 && (STARTING(c) || RUNNING(c, last)) && -8704 * 65536 <= (c)->innovation_lsb_q16 <= 8704 * 65536)
#define CORE(c, last) (CORE_BUT_NOISE(c, last) && 3 <= (c)->r_lsb2_q8 <= 256000)

/*
 * 256 LSB each. x_e + b0 (z - x_e) lies between x_e and z, which intervals do not know: they add a cell's width, so
 * that with z within 4096 LSB any width below 512 is enough.
 */
#define CELL_Q16 16777216
#define CELL(k) (CELL_Q16 * (k) <= *x_lsb_q16 < CELL_Q16 * ((k) + 1))
/*@ requires \valid(x_lsb_q16);
    assigns *x_lsb_q16, \result \from *x_lsb_q16;
    ensures CELL(-18) || CELL(-17) || CELL(-16) || CELL(-15) || CELL(-14) || CELL(-13) || CELL(-12) || CELL(-11) ||
            CELL(-10) || CELL(-9) || CELL(-8) || CELL(-7) || CELL(-6) || CELL(-5) || CELL(-4) || CELL(-3) || CELL(-2) ||
            CELL(-1) || CELL(0) || CELL(1) || CELL(2) || CELL(3) || CELL(4) || CELL(5) || CELL(6) || CELL(7) ||
            CELL(8) || CELL(9) || CELL(10) || CELL(11) || CELL(12) || CELL(13) || CELL(14) || CELL(15) || CELL(16) ||
            CELL(17) || *x_lsb_q16 == X_MAX_Q16;
    ensures \result == 0 || \result == 1;
*/
static inline bool limit_x(int32_t *x_lsb_q16);

/*@ requires FIVE(c->u.start.seen_lsb) && SAMPLE(c->u.start.ascending_lsb[2]) && 1 <= spread_lsb <= 365;
    assigns c->u.run, \result \from c->u.start, spread_lsb;
    ensures ESTIMATES(c) && SAMPLE_Q16(c->u.run.median_lsb_q16) && SAMPLE_Q16(\result);
*/
static int32_t fit_line(synth_core_t *c, int16_t spread_lsb);

static void any_core(synth_core_t *c)
{
    c->innovation_lsb_q16 = ANY_S32(-8704L * 65536, 8704L * 65536);
    c->r_lsb2_q8 = ANY_U32(3, 256000);
    c->gain_uq16 = ANY_U16(0, UINT16_MAX);
    c->flags = ANY_U8(0, 31);
}

static void any_spread(synth_spread_t *spread)
{
    spread->motion_lsb = ANY_U16(0, 320);
    spread->spread_lsb = ANY_S16(1, 365);
}

static void any_core_start(synth_core_t *c, uint8_t from_collected, uint8_t to_collected)
{
    any_core(c);
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        c->u.start.seen_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
        c->u.start.ascending_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    c->flags = ANY_U8(FILTER_WARMING_UP, 31);
    c->collected = ANY_U8(from_collected, to_collected);
}

static void any_core_run(synth_core_t *c, uint8_t from_collected, uint8_t to_collected)
{
    any_core(c);
    for (uint8_t i = 0; i < 3; i++) {
        c->u.run.x_lsb_q16[i] = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    }
    c->u.run.median_lsb_q16 = ANY_S32(FILTER_Z_MIN_LSB * 65536L, FILTER_Z_MAX_LSB * 65536L);
    c->collected = ANY_U8(from_collected, to_collected);
}

/* As after a reset and behind the start: nothing is known of the median. */
static void any_core_later(synth_core_t *c, uint8_t from_collected, uint8_t to_collected)
{
    any_core_run(c, from_collected, to_collected);
    c->u.run.median_lsb_q16 = ANY_S32(S32_MIN, INT32_MAX);
    c->flags = ANY_U8(0, FILTER_WARMING_UP - 1);
}

/* The kinds of state that are tried apart: together all that CORE(c, last) admits. */
enum { CORE_KINDS = 5 };

static void any_core_of_kind(synth_core_t *c, uint8_t kind, uint8_t last)
{
    if (kind == 0U) {
        any_core_start(c, 0, FILTER_WARM_UP_SAMPLES - 2);
    } else if (kind == 1U) {
        any_core_start(c, FILTER_WARM_UP_SAMPLES - 1, FILTER_WARM_UP_SAMPLES - 1);
    } else if (kind == 2U) {
        any_core_run(c, FILTER_WARM_UP_SAMPLES, last);
    } else if (kind == 3U) {
        any_core_later(c, FILTER_WARM_UP_SAMPLES, last);
    } else {
        any_core_later(c, SYNTH_STEADY, SYNTH_STEADY);
    }
}

#endif
