/*
 * What holds of the synthesised laws before and after every call, and states within it; see law.h. LAST_COUNT: the last
 * of the counts while the gains are those of the start.
 */
#ifndef SYNTH_BOUNDS_H
#define SYNTH_BOUNDS_H

#define RATE_END 603979776 /* 9216 LSB: the difference of two estimates */
#define TURN_END RATE_END
#define MEMORY_Q16 1207959552 /* 18432 LSB */
#define BENT_END 1835008000   /* 28000 LSB: both, and what their rounding in two halves adds */
#define CELLS
#define Z_CELL 512

#define SYNTH_KEPT(f) (3 <= (f)->own.synth.r_lsb2_q8 <= 256000)
#define COUNT(f) (5 <= (f)->own.synth.count <= LAST_COUNT || (f)->own.synth.count == 255)
#define FORCE(f)                                                         \
    (COUNT(f) && WITHIN((f)->own.synth.rate_before_lsb_q16, RATE_END) && \
     WITHIN((f)->own.synth.memory_lsb_q16, MEMORY_Q16))
#define ADMITTED COUNT
#ifndef KINDS
#define KINDS 1
#endif
#include "law.h"
#include "synth.h"

/*@ requires WITHIN(f->x_lsb_q16, X_MAX_Q16);
    requires WITHIN(f->rate_lsb, BENT_END);
    requires SAMPLE(z_lsb);
    requires f->size_lsb_uq16 <= SIZE_END && FLAG(f->negative);
    assigns f->x_lsb_q16, f->rate_lsb, f->size_lsb_uq16, f->negative, f->flags \from f->x_lsb_q16, f->rate_lsb,
            f->size_lsb_uq16, f->negative, f->flags, f->gain_uq16, z_lsb, what;
    ensures WITHIN(f->x_lsb_q16, X_MAX_Q16) && WITHIN(f->rate_lsb, RATE_END);
    ensures f->size_lsb_uq16 <= SIZE_END && FLAG(f->negative);
*/
void filter_synth_step(filter_t *f, int16_t z_lsb, uint8_t what);

#include "synth_common.c"

static void any_synth(filter_t *f)
{
    filter_synth_t *s = &f->own.synth;
    s->rate_before_lsb_q16 = ANY_S32(-RATE_END, RATE_END);
    s->memory_lsb_q16 = ANY_S32(-MEMORY_Q16, MEMORY_Q16);
    s->count = ANY_U8(SYNTH_FIRST_GAIN, SYNTH_STEADY);
    s->r_lsb2_q8 = ANY_U32(3, 256000);
    s->a1_uq16 = ANY_U16(0, UINT16_MAX);
    s->a1_negative = ANY_BOOL();
    s->b0_uq16 = ANY_U16(SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16);
}

#endif
