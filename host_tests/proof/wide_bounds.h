/*
 * The bounds of wide.h in ACSL and the contracts of its parts, proved by proof_wide.c. Clauses with a name are
 * relations that intervals do not keep; deliberate.txt says why they hold.
 */
#ifndef WIDE_BOUNDS_H
#define WIDE_BOUNDS_H

/* After a prediction; an update leaves none above 0x80000000. 33033, 137 and 9 of R. */
#define P11_END 2164850688
#define P12_END 2298478592
#define P22_END 2415919104
#define WIDE_P(f) ((f)->own.wide.p.p11 < P11_END && (f)->own.wide.p.p12 < P12_END && (f)->own.wide.p.p22 < P22_END)
#define WIDE_PARAMETERS(f)                                                                                            \
    (16 <= (f)->own.wide.q22_uq28 <= ONE && 16 <= (f)->own.wide.p22_start_uq28 <= ONE &&                              \
     3 <= (f)->own.wide.r_lsb2_q8 <= R_END && SCALED((f)->own.wide.drive_lsb2) && SCALED((f)->own.wide.start_lsb2) && \
     (f)->own.wide.per_r.mantissa >= 0x8000 && -28 <= (f)->own.wide.per_r.exponent <= -6)
/* Places of S, and its inverse. */
#define S_PLACES(f) ((f)->own.wide.variance % 256 <= 15)
#define S_KNOWN(f) ((f)->own.wide.inverse_uq16 >= 0x8000 && (f)->own.wide.variance >= 0x80000000)
#define FORCE WIDE_P
#ifndef KINDS
#define KINDS 1
#endif
#include "kalman_bounds.h"

/*@ requires 16 <= w->q22_uq28 <= ONE;
    requires w->p.p11 < P11_END && w->p.p12 < P12_END && w->p.p22 < P22_END;
    assigns w->p.p11, w->p.p12, w->p.p22, \result \from w->p, w->q22_uq28;
    ensures w->p.p11 < P11_END && w->p.p12 < P12_END && w->p.p22 < P22_END;
    ensures FLAG(\result);
*/
static bool grow_wide(filter_wide_t *w);

/*@ requires grows == 0 || *p < 0x10000000;
    requires *p < P22_END;
    assigns *p \from *p, left, fraction_uq16, grows;
    ensures *p <= 0x80000000;
*/
static void give_back(uint32_t *p, uint32_t left, uint16_t fraction_uq16, bool grows);

/*@ requires w->p.p12 < P12_END && w->p.p22 < P22_END && w2_uq24 <= 0xFFFFFF;
    assigns \result \from w->p, w2_uq24;
*/
static uint32_t left_of_p22(const filter_wide_t *w, uint32_t w2_uq24);

/*@ requires w->p.p11 < P11_END && w->p.p12 < P12_END && w->p.p22 < P22_END;
    requires w2_uq24 <= 0xFFFFFF && back_uq16 <= 0x7FFFF;
    assigns w->p.p11, w->p.p12, w->p.p22 \from w->p, w1_uq16, w2_uq24, back_uq16;
    ensures w->p.p11 < P11_END && w->p.p12 < P12_END && w->p.p22 < P22_END;
*/
static void correct_covariance(filter_wide_t *w, uint16_t w1_uq16, uint32_t w2_uq24, uint32_t back_uq16);

#define WIDE_ELEMENTS f->own.wide.p.p11, f->own.wide.p.p12, f->own.wide.p.p22
/*@ requires TRACKED(f) && WIDE_PARAMETERS(f) && f->collected == 5 && SAMPLE(z_lsb);
    requires WIDE_P(f);
    assigns f->x_lsb_q16, WIDE_ELEMENTS, f->size_lsb_uq16, f->own.wide.variance, f->own.wide.inverse_uq16, f->flags,
            f->negative, \result \from f->x_lsb_q16, f->rate_lsb, f->own, f->flags, z_lsb;
    ensures TRACKED(f) && FLAG(f->negative);
    ensures WIDE_P(f);
    ensures S_KNOWN(f);
    ensures places: S_PLACES(f);
    ensures reach: f->collected == 5 && REACH(f);
    ensures FLAG(\result);
*/
bool filter_wide_predict(filter_t *f, int16_t z_lsb);

/*@ requires TRACKED(f) && WIDE_PARAMETERS(f) && f->own.wide.inverse_uq16 >= 0x8000;
    requires places: S_PLACES(f);
    assigns \result \from f->size_lsb_uq16, f->own;
*/
uint16_t filter_wide_distance_uq8(const filter_t *f);

/*@ requires TRACKED(f) && WIDE_PARAMETERS(f) && f->collected == 5 && back_uq16 <= 0x7FFFF;
    requires WIDE_P(f);
    requires f->own.wide.inverse_uq16 >= 0x8000;
    requires places: S_PLACES(f);
    requires reach: f->collected == 5 && REACH(f);
    assigns f->x_lsb_q16, f->rate_lsb, WIDE_ELEMENTS, f->gain_uq16, f->flags \from f->x_lsb_q16, f->rate_lsb,
            f->size_lsb_uq16, f->negative, f->rate_max_lsb, f->own, f->flags, loss_uq16, back_uq16;
    ensures TRACKED(f);
    ensures WIDE_P(f);
*/
void filter_wide_correct(filter_t *f, uint16_t loss_uq16, uint32_t back_uq16);

/*@ requires SCALED(f->own.wide.drive_lsb2) && SCALED(f->own.wide.start_lsb2) && 3 <= r_lsb2_q8 <= R_END;
    assigns f->own.wide.r_lsb2_q8, f->own.wide.per_r, f->own.wide.q22_uq28, f->own.wide.p22_start_uq28 \from
            f->own.wide.drive_lsb2, f->own.wide.start_lsb2, r_lsb2_q8;
    ensures 16 <= f->own.wide.p22_start_uq28 <= ONE;
    ensures 16 <= f->own.wide.q22_uq28 <= ONE && 3 <= f->own.wide.r_lsb2_q8 <= R_END;
    ensures f->own.wide.per_r.mantissa >= 0x8000 && -28 <= f->own.wide.per_r.exponent <= -6;
*/
void filter_wide_set_noise(filter_t *f, uint32_t r_lsb2_q8);

/*@ requires WIDE_PARAMETERS(f);
    requires places: f->collected != 5 || f->own.wide.variance == 0 || S_PLACES(f);
    assigns out->p_lsb2_q8, out->gate_lsb2_q8 \from f->own, f->collected;
*/
void filter_wide_report(const filter_t *f, filter_probe_t *out);

/* kalman.c has one of that name. */
#define grow grow_wide
#include "wide.c"
#undef grow

/* Every field at every value of its bound; the law's step makes S first. */
static void any_wide(filter_t *f)
{
    filter_wide_t *w = &f->own.wide;
    w->p.p11 = ANY_U32(0, P11_END - 1);
    w->p.p12 = ANY_U32(0, P12_END - 1);
    w->p.p22 = ANY_U32(0, P22_END - 1);
    w->variance = ANY_U32(0, UINT32_MAX);
    w->inverse_uq16 = ANY_U16(0, UINT16_MAX);
    w->gate2_uq8 = ANY_U16(0, UINT16_MAX);
    w->q22_uq28 = ANY_U32(16, ONE);
    w->p22_start_uq28 = ANY_U32(16, ONE);
    w->r_lsb2_q8 = ANY_U32(3, R_END);
    w->per_r.mantissa = ANY_U16(0x8000, UINT16_MAX);
    w->per_r.exponent = ANY_S8(-28, -6);
    w->drive_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    w->drive_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    w->start_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    w->start_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
}

/* With S of so many places. */
static void any_update(filter_t *f, uint8_t places)
{
    any_tracked(f, NULL);
    any_wide(f);
    f->own.wide.variance = (ANY_U32(0x800000, 0xFFFFFF) * 256U) + places;
    f->own.wide.inverse_uq16 = ANY_U16(0x8000, UINT16_MAX);
}

#endif
