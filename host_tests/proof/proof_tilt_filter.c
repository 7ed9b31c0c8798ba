/*
 * The facade: any readings, any law, any order of calls. Of the filter only what proof_tracker.c proves of every law
 * that filter_init has accepted: its estimate stays within 4608 LSB.
 */
#include "calibration_bounds.h"

#include "tilt_filter.h"

#define X_MAX_Q16 301989888 /* 4608 LSB */
#define ESTIMATE(f) (-X_MAX_Q16 <= (f)->x_lsb_q16 <= X_MAX_Q16)

/* Untouched where it is refused, which the shipped values are not (law.h). */
/*@ assigns f->x_lsb_q16, f->flags, f->quarters, f->own, \result \from *config;
    ensures \initialized(&f->x_lsb_q16) && \initialized(&f->flags) && \initialized(&f->quarters) && ESTIMATE(f);
    ensures \result == 0 || \result == 1 || 2 <= \result <= 9;
*/
filter_answer_t filter_init(filter_t *f, const filter_law_t *law, const filter_config_t *config);
/*@ assigns f->own \from r_lsb2_q8; */
void filter_set_noise(filter_t *f, uint32_t r_lsb2_q8);
/*@ assigns \result \from f->own; */
uint32_t filter_own_noise_lsb2_q8(const filter_t *f);
/*@ assigns f->x_lsb_q16, f->flags, f->quarters, f->own, \result \from f->x_lsb_q16, f->flags, f->quarters, z_lsb;
    ensures ESTIMATE(f);
*/
int32_t filter_update(filter_t *f, int16_t z_lsb);
/*@ assigns f->x_lsb_q16, f->flags, f->quarters, f->own, \result \from f->x_lsb_q16, f->flags, f->quarters;
    ensures ESTIMATE(f);
*/
int32_t filter_missing(filter_t *f);
/*@ assigns f->flags, f->own \from f->flags; */
void filter_restart(filter_t *f);
/*@ assigns \result \from rate_dhz; */
filter_config_t filter_defaults(const filter_law_t *law, uint16_t rate_dhz);

#define ROLL(angle) (-17999 <= (angle) <= 18000)
/*@ requires ROLL(out->roll_cdeg);
    assigns out->roll_cdeg, out->pitch_cdeg, out->roll_undefined \from out->roll_cdeg, a_q8[0..2];
    ensures ROLL(out->roll_cdeg) && -9000 <= out->pitch_cdeg <= 9000;
    ensures out->roll_undefined == 0 || out->roll_undefined == 1;
*/
void tilt_angles(tilt_t *out, const int32_t a_q8[3]);
/*@ assigns \result \from a_q8[0..2];
    ensures \result == 0 || \result == 1;
*/
bool tilt_gravity_plausible(const int32_t a_q8[3]);

#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define NOISE(n)                                                                                         \
    ((n)->floor_lsb2_q16 <= 65535 * 223 && (n)->mean_lsb2_q16 <= 43690667 && (n)->r_lsb2_q8 <= 256000 && \
     (n)->filled <= 5)
#define AXIS(a) (ESTIMATE(&(a)->filter) && NOISE(&(a)->noise) && (a)->away <= 3)
#define HIGHEST(lsb) (127 <= (lsb) <= 4095)
#define FACADE(t)                                                                                        \
    (AXIS(&(t)->axes[0]) && AXIS(&(t)->axes[1]) && AXIS(&(t)->axes[2]) && ROLL((t)->angles.roll_cdeg) && \
     (t)->shift <= 15 && HIGHEST((t)->rail_high_lsb))

/*@ requires AXIS(a) && HIGHEST(rail_high_lsb);
    assigns a->filter.x_lsb_q16, a->filter.flags, a->filter.quarters, a->filter.own, a->noise, a->away, \result
      \from a->filter.x_lsb_q16, a->filter.flags, a->filter.quarters, a->filter.identifies, a->noise, a->away, lsb,
        rail_high_lsb, own_r;
    ensures AXIS(a);
*/
uint8_t tilt_axis_update(tilt_axis_t *a, int16_t lsb, int16_t rail_high_lsb, bool own_r);

#include "fx.c"

#include "tracker.c"

#include "noise.c"

#include "calibration.c"
#include "tilt_axis.c"
#include "tilt_filter.c"

static void any_axis(tilt_axis_t *a)
{
    a->filter.x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    a->filter.flags = ANY_U8(0, UINT8_MAX);
    a->filter.quarters = ANY_U8(0, UINT8_MAX);
    a->filter.identifies = ANY_BOOL();
    a->noise.floor_lsb2_q16 = ANY_U32(0, 65535UL * 223U);
    a->noise.mean_lsb2_q16 = ANY_U32(0, MEAN_MAX_LSB2_Q16);
    a->noise.r_lsb2_q8 = ANY_U32(0, 256000);
    for (uint8_t i = 0; i < HISTORY; i++) {
        a->noise.history_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    a->noise.filled = ANY_U8(0, HISTORY);
    a->noise.spaced = ANY_BOOL();
    a->noise.terms = ANY_U8(0, UINT8_MAX);
    a->away = ANY_U8(0, 3);
}

static void any_facade(tilt_filter_t *t)
{
    t->angles.roll_cdeg = ANY_S16(-17999, 18000);
    t->angles.pitch_cdeg = ANY_S16(-9000, 9000);
    t->angles.roll_undefined = ANY_BOOL();
    t->rate_dhz = ANY_U16(50, 40000);
    t->rail_high_lsb = ANY_S16(127, 4095);
    t->shift = ANY_U8(0, 15);
    for (uint8_t i = 0; i < 9U; i++) {
        t->calibration.matrix_q14[i] = ANY_Z();
    }
    for (uint8_t i = 0; i < (uint8_t)TILT_FILTER_AXES; i++) {
        t->calibration.bias_lsb_q14[i] = ANY_S32(S32_MIN, INT32_MAX);
        any_axis(&t->axes[i]);
    }
}

static const filter_law_t any_law;

/* Options: -eva-split-return-function tilt_at_rail:full */
void proof_tilt_axis_update(void)
{
    for (uint8_t away = 0; away <= 3U; away++) {
        tilt_axis_t a;
        any_axis(&a);
        a.away = away;
        (void)tilt_axis_update(&a, ANY_Z(), ANY_S16(127, 4095), ANY_BOOL());
    }
}

void proof_tilt_axis(void)
{
    tilt_axis_t a;
    any_axis(&a);
    (void)tilt_axis_missing(&a);
    //@ check missing: AXIS(&a);
    tilt_axis_begin(&a, ANY_U16(50, 40000), ANY_BOOL());
    //@ check begun: AXIS(&a);
}

/* From nothing: the shipped values are legal at every rate. */
void proof_tilt_filter_begin_with(void)
{
    tilt_filter_t t;
    any_facade(&t);
    (void)tilt_filter_begin_with(&t, ANY_U16(0, UINT16_MAX), &any_law);
    //@ check rate: 50 <= t.rate_dhz <= 40000;
    //@ check facade: FACADE(&t);
    (void)tilt_filter_begin(&t, ANY_U16(0, UINT16_MAX));
    //@ check adaptive: FACADE(&t);
    any_facade(&t);
    filter_config_t config;
    config.rate_dhz = ANY_U16(0, UINT16_MAX);
    (void)tilt_filter_use(&t, &any_law, &config);
    //@ check used: FACADE(&t);
}

/* Bits by bits: what is shifted comes of them. */
void proof_tilt_filter_sensor(void)
{
    for (uint16_t bits = 0; bits <= UINT8_MAX; bits++) {
        tilt_filter_t t;
        any_facade(&t);
        (void)tilt_filter_sensor(&t, (uint8_t)bits, ANY_U16(0, UINT16_MAX), ANY_U16(0, UINT16_MAX));
        //@ check facade: FACADE(&t);
    }
}

void proof_tilt_filter_update(void)
{
    for (uint8_t shift = 0; shift <= 15U; shift++) {
        tilt_filter_t t;
        any_facade(&t);
        t.shift = shift;
        tilt_filter_update(&t, ANY_Z(), ANY_Z(), ANY_Z());
        //@ check facade: FACADE(&t);
    }
}

void proof_tilt_filter_missing(void)
{
    tilt_filter_t t;
    any_facade(&t);
    tilt_filter_missing(&t);
    //@ check facade: FACADE(&t);
}
