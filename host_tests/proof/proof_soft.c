/* soft: see law.h. */
#define KEPT(f) (PARAMETERS(f) && (f)->own.kalman.of.gated.gate_sigma_q8 <= 4096)
#define REFUSED_WITH WIDTH
#define REFUSED_LEAVES WIDTH
#include "kalman_bounds.h"

/*@ requires farther: f->size_lsb_uq16 >= 256 && FARTHER(f);
    assigns \result \from f->size_lsb_uq16, f->own;
    ensures \result < 0x1000000;
*/
static inline uint32_t weight_uq20(const filter_t *f);

/*@ assigns \result \from w_uq24;
    ensures \result <= 0xFFFFFF;
*/
static inline uint32_t limited_uq24(uint32_t w_uq24);

/*@ requires TRACKED(f) && PARAMETERS(f) && f->collected == 5 && SAMPLE(z_lsb);
    requires RUN(f);
    requires WIDTH(f->own.kalman.p);
    requires reach: f->collected == 5 && REACH(f);
    assigns KALMAN_STATE, f->broken, f->own.kalman.run, f->own.kalman.first_lsb \from KALMAN_SEES, f->broken;
    ensures TRACKED(f) && FLAG(f->broken);
    ensures RUN(f);
    ensures WIDTH(f->own.kalman.p);
    ensures covariance: COVARIANCE(f);
*/
static void take_part(filter_t *f, int16_t z_lsb);

#include "soft.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
    f->own.kalman.of.gated.gate_sigma_q8 = ANY_U16(0, 4096);
    f->own.kalman.of.gated.share_uq16 = ANY_U16(0, UINT16_MAX);
}

static void weight_in(uint8_t bit, bool coarse, uint16_t gate_end_uq4)
{
    filter_t f;
    any_running(&f, &filter_law_soft, 0);
    uint32_t from = (uint32_t)256 << bit;
    f.size_lsb_uq16 = ANY_U32(from, (bit == 21) ? SIZE_END : from + (from - 1));
    f.own.kalman.coarse = coarse;
    f.own.kalman.gate_lsb2_uq4 = ANY_U16(0, gate_end_uq4);
    (void)weight_uq20(&f);
}

/* By powers of two of the size, fine and coarse. */
void proof_weight_uq20(void)
{
    static const uint16_t gate_end_uq4[] = { 0, 15, 255, 4095 };
    for (uint8_t bit = 0; bit < 22; bit++) {
        weight_in(bit, false, (bit < 6) ? 0 : (bit < 12) ? gate_end_uq4[(bit - 4) / 2] : UINT16_MAX);
        if (bit >= 4) {
            weight_in(bit, true, (bit < 10) ? 0 : (bit < 16) ? gate_end_uq4[(bit - 8) / 2] : UINT16_MAX);
        }
    }
}

void proof_limited_uq24(void)
{
    (void)limited_uq24(ANY_U32(0, 0xFFFFFF));
    (void)limited_uq24(ANY_U32(0x1000000, UINT32_MAX));
}

/*
 * By cells of the estimate. Whole: filter_kalman_refused. Options: -eva-split-return-function
 * filter_kalman_refused:full
 */
void proof_take_part(void)
{
    EACH_KIND(kind)
    {
        filter_t f;
        any_running(&f, &filter_law_soft, kind);
        //@ admit WIDTH(f.own.kalman.p);
        //@ admit REACH(&f);
        take_part(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

PROVE_LAW(soft)
