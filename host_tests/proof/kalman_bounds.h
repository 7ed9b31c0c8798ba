/*
 * The bounds of kalman.h in ACSL, assumed before a call and proved after it, and the contracts of its parts; each that
 * an entry uses is itself proved on the body by an entry of proof_kalman.c.
 */
#ifndef KALMAN_BOUNDS_H
#define KALMAN_BOUNDS_H

#define CELLS
#include "eva.h"
#include "kalman.h"

#define ONE 0x10000000 /* in UQ4.28, of kf3.c and wide.h */
#define Q22_MOST 0x38000000

/* P / R: P11 < 52, P12 < 32, P22 < 30. */
#define WIDTH(q) ((q).p11 < 0x34000000 && (q).p12 < 0x80000000 && (q).p22 < 0x78000000)
#define COVARIANCE(f) WIDTH((f)->own.kalman.p)

/* -58..24 for q T^3 and the variance of the rate; the q T^5 of kf3 needs the rest. */
#define SCALED_LEAST (-77)
#define SCALED(v) ((v).mantissa >= 0x8000 && SCALED_LEAST <= (v).exponent <= 25)
/* R of a sample ends at R_END, the R_L of lrf at R_ANY; from 3 on, of which intervals prove 2 for R_L. */
#define R_LEAST 2
#define R_END 256000
#define R_ANY 0xFFFFFF
#ifndef R_MOST
#define R_MOST R_END
#endif
/* A run of three samples or more, or none. */
#define STEPS(v) ((v) == 0 || 2 <= (v) <= 8)
#define PARAMETERS(f)                                                                                     \
    (4 <= (f)->own.kalman.q22_uq26 <= Q22_MOST && 4 <= (f)->own.kalman.p22_start_uq26 <= Q22_MOST &&      \
     R_LEAST <= (f)->own.kalman.r_lsb2_q8 <= R_MOST && SCALED((f)->own.kalman.drive_lsb2) &&              \
     SCALED((f)->own.kalman.start_lsb2) && FLAG((f)->own.kalman.gated) && FLAG((f)->own.kalman.coarse) && \
     STEPS((f)->own.kalman.steps))
/* run never passes 8: a run of `steps` samples restarts with the next, or with steps 0 stays at 1. */
#define RUN(f) ((f)->own.kalman.run == 0 || (SAMPLE((f)->own.kalman.first_lsb) && 1 <= (f)->own.kalman.run <= 8))
#define RUNNING_KALMAN(f) (COVARIANCE(f) && RUN(f) && (f)->own.kalman.refused <= 5)
#ifndef FORCE
#define FORCE RUNNING_KALMAN
#endif
#ifndef KINDS
#define KINDS 2
#endif
#include "law.h"

/*@ requires WIDTH(k->p);
    requires 4 <= k->q22_uq26 <= Q22_MOST;
    assigns k->p.p11, k->p.p12, k->p.p22 \from k->p, k->q22_uq26;
    ensures WIDTH(k->p);
*/
static inline void grow(filter_kalman_t *k);

/*@ requires k->p.p11 < 0x34000000;
    assigns \result \from k->p.p11;
    ensures 1024 <= \result;
*/
static inline uint16_t variance_uq10(const filter_kalman_t *k);

/*
 * What a gate of gate_lsb2_uq6 leaves outside: size^2 > 1024 gate, where P11 + 1 is at least 1; sizes by four (when
 * coarse, 16 times as large). So that gate / size^2, of which soft's weight is made, is known to a factor of 16.
 */
#define FAR(f, k, from, to, gate)                                                                                     \
    ((f)->own.kalman.coarse == (k) && 256 * (from) <= (f)->size_lsb_uq16 && (f)->size_lsb_uq16 <= 256 * (to) + 255 && \
     (f)->own.kalman.gate_lsb2_uq6 < (gate))
#define FARTHER(f)                                                                                              \
    (FAR(f, 0, 1, 31, 1) || FAR(f, 0, 32, 127, 16) || FAR(f, 0, 128, 511, 256) || FAR(f, 0, 512, 2047, 4096) || \
     FAR(f, 0, 2048, 8704 * 256, 65536) || FAR(f, 1, 32, 511, 1) || FAR(f, 1, 512, 2047, 16) ||                 \
     FAR(f, 1, 2048, 8191, 256) || FAR(f, 1, 8192, 32767, 4096) || FAR(f, 1, 32768, 8704 * 256, 65536))
/*@ requires f->size_lsb_uq16 <= SIZE_END && f->own.kalman.p.p11 < 0x34000000 && FLAG(f->own.kalman.coarse);
    assigns f->own.kalman.limit_lsb2, \result \from f->size_lsb_uq16, f->own.kalman.p, f->own.kalman.coarse,
            f->own.kalman.gate_lsb2_uq6;
    ensures FLAG(\result);
    ensures \result == 1 || (\result == 0 && FARTHER(f));
*/
static bool within_gate(filter_t *f);

#define KALMAN_STATE                                                                                            \
    f->x_lsb_q16, f->rate_lsb, f->own.kalman.p.p11, f->own.kalman.p.p12, f->own.kalman.p.p22, f->size_lsb_uq16, \
        f->own.kalman.limit_lsb2, f->gain_uq16, f->flags
#define KALMAN_SEES f->x_lsb_q16, f->rate_lsb, f->own, f->rate_max_lsb, f->flags, f->previous_lsb, z_lsb
/*@ requires SAMPLE(z_lsb);
    requires TRACKED(f) && PARAMETERS(f) && f->collected == 5;
    requires COVARIANCE(f);
    assigns KALMAN_STATE, f->negative, \result \from KALMAN_SEES, what;
    ensures TRACKED(f);
    ensures FLAG(\result) && FLAG(f->negative);
    ensures COVARIANCE(f);
*/
bool filter_kalman_step(filter_t *f, int16_t z_lsb, uint8_t what);

/*@ assigns \result \from w_uq24;
    ensures \result <= 0xFFFFFF;
*/
static inline uint32_t kalman_limited_uq24(uint32_t w_uq24);

/*@ requires TRACKED(f) && PARAMETERS(f) && f->collected == 5 && SAMPLE(z_lsb);
    requires RUN(f);
    requires COVARIANCE(f);
    assigns KALMAN_STATE, f->broken, f->own.kalman.run, f->own.kalman.first_lsb, \result \from KALMAN_SEES, f->broken;
    ensures TRACKED(f) && FLAG(f->broken);
    ensures RUN(f);
    ensures COVARIANCE(f);
    ensures FLAG(\result);
*/
bool filter_kalman_refused(filter_t *f, int16_t z_lsb);

/*@ requires SCALED(f->own.kalman.drive_lsb2) && SCALED(f->own.kalman.start_lsb2);
    requires R_LEAST <= r_lsb2_q8 <= R_ANY;
    assigns f->own.kalman.r_lsb2_q8, f->own.kalman.q22_uq26, f->own.kalman.p22_start_uq26 \from
            f->own.kalman.drive_lsb2, f->own.kalman.start_lsb2, r_lsb2_q8;
    ensures 4 <= f->own.kalman.q22_uq26 <= Q22_MOST && 4 <= f->own.kalman.p22_start_uq26 <= Q22_MOST;
    ensures R_LEAST <= f->own.kalman.r_lsb2_q8 <= R_ANY;
    ensures r_lsb2_q8 <= R_END ==> f->own.kalman.r_lsb2_q8 <= R_END;
*/
void filter_kalman_set_variance(filter_t *f, uint32_t r_lsb2_q8);

/*@ requires gate_sigma_q8 <= 4096 && R_LEAST <= f->own.kalman.r_lsb2_q8 <= R_END && f->rate_max_lsb <= X_MAX_Q16;
    assigns f->own.kalman.gated, f->own.kalman.coarse, f->own.kalman.gate_lsb2_uq6, f->own.kalman.agree_lsb \from
            gate_sigma_q8, f->own.kalman.r_lsb2_q8, f->rate_max_lsb;
    ensures FLAG(f->own.kalman.gated) && FLAG(f->own.kalman.coarse);
*/
static void set_gate(filter_t *f, uint16_t gate_sigma_q8);

/* With what any Kalman law's set_noise does (proof_kalman.c). */
/*@ requires 50 <= config->rate_dhz <= 40000 && 3 <= config->value[0] <= R_END && 1 <= config->value[1] <= 1000000000;
    requires rate_max_lsb_s <= 1000000;
    requires STEPS(f->own.kalman.steps) && FLAG(f->own.kalman.gated) && FLAG(f->own.kalman.coarse);
    assigns f->rate_max_lsb, f->own.kalman.drive_lsb2, f->own.kalman.start_lsb2, f->own.kalman.r_lsb2_q8,
            f->own.kalman.q22_uq26, f->own.kalman.p22_start_uq26, f->own.kalman.gated, f->own.kalman.coarse,
            f->own.kalman.gate_lsb2_uq6, f->own.kalman.agree_lsb \from *config, rate_max_lsb_s, f->own;
    ensures PARAMETERS(f) && f->rate_max_lsb <= X_MAX_Q16;
*/
void filter_kalman_set_up(filter_t *f, const filter_config_t *config, uint32_t rate_max_lsb_s);

#include "kalman.c"

/* Every field at every value of its bound. */
static void any_kalman(filter_t *f, uint8_t kind)
{
    filter_kalman_t *k = &f->own.kalman;
    k->p.p11 = ANY_U32(0, 0x33FFFFFF);
    k->p.p12 = ANY_U32(0, 0x7FFFFFFF);
    k->p.p22 = ANY_U32(0, 0x77FFFFFF);
    k->limit_lsb2 = ANY_U32(0, UINT32_MAX);
    k->run = (kind == 0U) ? 0 : ANY_U8(1, 8);
    k->first_lsb = (kind == 0U) ? ANY_Z() : ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    k->refused = ANY_U8(0, 5);
    k->q22_uq26 = ANY_U32(4, Q22_MOST);
    k->gate_lsb2_uq6 = ANY_U16(0, UINT16_MAX);
    k->gated = ANY_BOOL();
    k->coarse = ANY_BOOL();
    k->agree_lsb = ANY_U16(0, UINT16_MAX);
    k->p22_start_uq26 = ANY_U32(4, Q22_MOST);
    k->r_lsb2_q8 = ANY_U32(R_LEAST, R_MOST);
    k->drive_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    k->drive_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    k->start_lsb2.mantissa = ANY_U16(0x8000, UINT16_MAX);
    k->start_lsb2.exponent = ANY_S8(SCALED_LEAST, 25);
    k->steps = ANY_BOOL() ? 0 : ANY_U8(2, 8);
}

#endif
