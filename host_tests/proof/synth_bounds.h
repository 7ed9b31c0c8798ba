/*
 * What holds of the synthesised laws before and after every call, and states within it; see law.h. LAST_COUNT: the last
 * of the counts while the gains are those of the start; SPREAD: where no line is fitted 0, else 1 to 365.
 */
#ifndef SYNTH_BOUNDS_H
#define SYNTH_BOUNDS_H

#define RATE_END 603979776 /* 9216 LSB: the difference of two estimates */
#define LINE_Q16 14417920  /* 220 LSB per sample: the steepest line of the start */
#define AHEAD_Q16 33554432 /* 512 LSB: the line ends this near to the median */
#define MEMORY_Q16 1207959552 /* 18432 LSB */
#define X_CELLS NARROW_CELLS
#ifndef SPREAD
#define SPREAD(lsb) (1 <= (lsb) <= 365)
#endif

#define SYNTH_KEPT(f) (3 <= (f)->own.synth.r_lsb2_q8 <= 256000 && SPREAD((f)->own.synth.spread_lsb))
#define COUNT(f) (5 <= (f)->own.synth.count <= LAST_COUNT || (f)->own.synth.count == 255)
/* At the median of the start, the line still to be taken. */
#define AHEAD(f)                                                                                              \
    ((f)->own.synth.spread_lsb != 0 && SAMPLE_Q16((f)->x_lsb_q16) && WITHIN((f)->own.synth.ahead_lsb_q16, AHEAD_Q16) && \
     (f)->own.synth.count == 5 && WITHIN((f)->rate_lsb, LINE_Q16) && (f)->own.synth.memory_lsb_q16 == 0)
#define FORCE(f)                                                                                                 \
    (COUNT(f) && WITHIN((f)->own.synth.rate_before_lsb_q16, RATE_END) &&                                          \
     WITHIN((f)->own.synth.memory_lsb_q16, MEMORY_Q16) && ((f)->own.synth.ahead_lsb_q16 == 0 || AHEAD(f)))
#define ADMITTED(f) SPREAD((f)->own.synth.spread_lsb)
#define KINDS (LAST_COUNT - 2)
#include "law.h"
#include "synth.h"

/*@ requires 1 <= f->own.synth.spread_lsb <= 365;
    assigns f->rate_lsb, \result \from f->own;
    ensures line: WITHIN(f->rate_lsb, LINE_Q16) && WITHIN(\result, AHEAD_Q16);
*/
static int32_t fit_line(filter_t *f);

#include "synth_common.c"

/* Steady; the line ahead; then count by count, so that what a step makes of it stays one of few. */
static void any_synth(filter_t *f, uint8_t kind, int16_t least_spread_lsb, int16_t most_spread_lsb)
{
    filter_synth_t *s = &f->own.synth;
    s->rate_before_lsb_q16 = ANY_S32(-RATE_END, RATE_END);
    s->memory_lsb_q16 = ANY_S32(-MEMORY_Q16, MEMORY_Q16);
    s->ahead_lsb_q16 = 0;
    s->count = (kind == 0U) ? SYNTH_STEADY : (uint8_t)(SYNTH_FIRST_GAIN + kind - 2U);
    if (kind == 1U) {
        f->rate_lsb = ANY_S32(-LINE_Q16, LINE_Q16);
        f->x_lsb_q16 = ANY_S32(FILTER_Z_MIN_LSB * 65536L, FILTER_Z_MAX_LSB * 65536L);
        s->ahead_lsb_q16 = (most_spread_lsb == 0) ? 0 : ANY_S32(-AHEAD_Q16, AHEAD_Q16);
        s->memory_lsb_q16 = 0;
        s->count = SYNTH_FIRST_GAIN;
    }
    s->r_lsb2_q8 = ANY_U32(3, 256000);
    s->spread_lsb = ANY_S16(least_spread_lsb, most_spread_lsb);
    s->a1_uq16 = ANY_U16(0, UINT16_MAX);
    s->a1_negative = ANY_BOOL();
    s->b0_uq16 = ANY_U16(SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16);
}

#endif
