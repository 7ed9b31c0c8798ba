/* soft: see law.h. */
#define KEPT(f) (PARAMETERS(f) && (f)->own.kalman.of.gated.gate_sigma_q8 <= 4096)
#include "kalman_bounds.h"

/*@ requires farther: f->size_lsb_uq16 >= 256 && FARTHER(f);
    assigns \result \from f->size_lsb_uq16, f->own;
    ensures \result < 0x1000000;
*/
static inline uint32_t weight_uq24(const filter_t *f);

/*@ requires TRACKED(f) && PARAMETERS(f) && f->collected == 5 && SAMPLE(z_lsb);
    requires RUN(f);
    requires COVARIANCE(f);
    requires reach: f->collected == 5 && REACH(f);
    assigns KALMAN_STATE, f->broken, f->own.kalman.run, f->own.kalman.first_lsb \from KALMAN_SEES, f->broken;
    ensures TRACKED(f) && FLAG(f->broken);
    ensures RUN(f);
    ensures COVARIANCE(f);
*/
static void take_part(filter_t *f, int16_t z_lsb);

#include "soft.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
    f->own.kalman.of.gated.gate_sigma_q8 = ANY_U16(0, 4096);
    f->own.kalman.of.gated.share_uq16 = ANY_U16(0, UINT16_MAX);
}

static void weight_in(uint8_t bit, bool coarse, uint16_t gate_end_uq6)
{
    filter_t f;
    any_running(&f, &filter_law_soft, 0);
    uint32_t from = (uint32_t)256 << bit;
    f.size_lsb_uq16 = ANY_U32(from, (bit == 21) ? SIZE_END : from + (from - 1));
    f.own.kalman.coarse = coarse;
    f.own.kalman.gate_lsb2_uq6 = ANY_U16(0, gate_end_uq6);
    (void)weight_uq24(&f);
}

/* By powers of two of the size, fine and coarse. */
void proof_weight_uq24(void)
{
    static const uint16_t gate_end_uq6[] = { 0, 15, 255, 4095 };
    for (uint8_t bit = 0; bit < 22; bit++) {
        weight_in(bit, false, (bit < 5) ? 0 : (bit < 11) ? gate_end_uq6[(bit - 3) / 2] : UINT16_MAX);
        if (bit >= 5) {
            weight_in(bit, true, (bit < 9) ? 0 : (bit < 15) ? gate_end_uq6[(bit - 7) / 2] : UINT16_MAX);
        }
    }
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
        //@ admit REACH(&f);
        take_part(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

PROVE_LAW(soft)
