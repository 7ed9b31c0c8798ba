/*
 * What holds of a filter before and after every call, any state of it, and the proofs that are the same for every law:
 * of each of a law's functions, for any legal configuration and any state. The tracker takes the laws by contracts that
 * say this (proof_tracker.c).
 *
 * A file that includes this defines FORCE(f), what holds of the law's own state while the filter runs, KEPT(f), what
 * holds of it always, and any_own(f, kind), any values of both, in KINDS parts that are tried one by one; where those
 * are more than FORCE, what an admit shall take of them, in parts for each `||`, is ADMITTED(f).
 */
#ifndef LAW_H
#define LAW_H

#include "eva.h"
#include "fx_contracts.h"
#include "tracker.h"

#define X_MAX_Q16 301989888 /* 4608 LSB */
#define SIZE_END 570425344  /* 8704 LSB */
#ifndef RATE_END
#define RATE_END X_MAX_Q16
#endif

#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define SAMPLE_Q16(x) (-268435456 <= (x) <= 268369920)
#define WITHIN(v, end) (-(end) <= (v) <= (end))
#define FLAG(v) ((v) == 0 || (v) == 1)
#define TRACKED(f)                                                                                             \
    (WITHIN((f)->x_lsb_q16, X_MAX_Q16) && WITHIN((f)->rate_lsb, RATE_END) && (f)->size_lsb_uq16 <= SIZE_END && \
     (f)->rate_max_lsb <= RATE_END && SAMPLE((f)->previous_lsb) && 50 <= (f)->rate_dhz <= 40000)

/* So many samples of the start are there. */
#define SEEN(f, n) ((f)->collected <= (n) || SAMPLE((f)->own.start.ascending_lsb[n]))
#define STARTING(f) ((f)->collected < 5 && (f)->rate_lsb == 0 && SEEN(f, 0) && SEEN(f, 1) && SEEN(f, 2) && SEEN(f, 3))

/*
 * Where a law says CELLS the estimate behind its clamp is known by cells of 512 LSB, and the innovation with it as one
 * towards a sample from -4096 to 4095 LSB: a correction moves x towards it, and what intervals add is a cell's width.
 */
#define CELL(v, k) (33554432 * (k) <= (v) < 33554432 * ((k) + 1))
#define BACK(f, k) (CELL((f)->x_lsb_q16, k) && (f)->negative == 1 && (f)->size_lsb_uq16 < (512 * (k) + 4608) * 65536)
#define FORTH(f, k) (CELL((f)->x_lsb_q16, k) && (f)->negative == 0 && (f)->size_lsb_uq16 <= (4095 - 512 * (k)) * 65536)
#define REACH(f)                                                                                                      \
    (BACK(f, -8) || BACK(f, -7) || BACK(f, -6) || BACK(f, -5) || BACK(f, -4) || BACK(f, -3) || BACK(f, -2) ||         \
     BACK(f, -1) || BACK(f, 0) || BACK(f, 1) || BACK(f, 2) || BACK(f, 3) || BACK(f, 4) || BACK(f, 5) || BACK(f, 6) || \
     BACK(f, 7) || BACK(f, 8) || ((f)->x_lsb_q16 == X_MAX_Q16 && (f)->negative == 1) || FORTH(f, -9) ||               \
     FORTH(f, -8) || FORTH(f, -7) || FORTH(f, -6) || FORTH(f, -5) || FORTH(f, -4) || FORTH(f, -3) || FORTH(f, -2) ||  \
     FORTH(f, -1) || FORTH(f, 0) || FORTH(f, 1) || FORTH(f, 2) || FORTH(f, 3) || FORTH(f, 4) || FORTH(f, 5) ||        \
     FORTH(f, 6) || FORTH(f, 7))
#ifdef CELLS
#define BOUNDED(v)                                                                                                     \
    (CELL(v, -9) || CELL(v, -8) || CELL(v, -7) || CELL(v, -6) || CELL(v, -5) || CELL(v, -4) || CELL(v, -3) ||          \
     CELL(v, -2) || CELL(v, -1) || CELL(v, 0) || CELL(v, 1) || CELL(v, 2) || CELL(v, 3) || CELL(v, 4) || CELL(v, 5) || \
     CELL(v, 6) || CELL(v, 7) || CELL(v, 8) || (v) == X_MAX_Q16)
#define MET REACH
#else
#define BOUNDED(v) WITHIN(v, X_MAX_Q16)
#define MET(f) FLAG((f)->negative)
#endif

/*@ assigns f->flags, \result \from f->flags, x_lsb_q16;
    ensures WITHIN(\result, X_MAX_Q16);
    ensures BOUNDED(\result);
*/
static inline int32_t tracker_bounded(filter_t *f, int32_t x_lsb_q16);

/*@ requires WITHIN(f->x_lsb_q16, X_MAX_Q16) && SAMPLE(z_lsb);
    assigns f->size_lsb_uq16, f->negative \from f->x_lsb_q16, z_lsb;
    ensures f->size_lsb_uq16 <= SIZE_END && FLAG(f->negative);
    ensures reach: MET(f);
*/
void filter_tracker_meet(filter_t *f, int16_t z_lsb);

#ifndef TURN_END
#define TURN_END X_MAX_Q16 /* the largest limit of the rate that the laws of a file have */
#endif

/*@ requires WITHIN(f->rate_lsb, 3 * X_MAX_Q16) && f->rate_max_lsb <= TURN_END && 0 <= step_lsb <= 2 * X_MAX_Q16;
    assigns f->rate_lsb, f->flags \from f->rate_lsb, f->rate_max_lsb, f->negative, f->flags, step_lsb;
    ensures WITHIN(f->rate_lsb, TURN_END);
*/
void filter_tracker_turn(filter_t *f, int32_t step_lsb);

/*@ requires \valid_read(p);
    assigns \result \from *p;
    ensures same: \result == *p;
*/
static int32_t flash_i32(const int32_t *p);

/*@ assigns \result \from r_lsb2_q8;
    ensures 3 <= \result <= 256000;
*/
uint32_t filter_tracker_limited_r(uint32_t r_lsb2_q8);

#include "fx.c"
#include "parameters.c"
#include "tracker.c"

/* Any values of what the tracker holds, of a filter that runs. */
static void any_tracked(filter_t *f, const filter_law_t *law)
{
    f->law = law;
    f->x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    f->flags = ANY_U8(0, UINT8_MAX);
    f->collected = FILTER_RUNNING;
    f->rate_lsb = ANY_S32(-RATE_END, RATE_END);
    f->size_lsb_uq16 = ANY_U32(0, SIZE_END);
    f->rate_max_lsb = ANY_U32(0, RATE_END);
    f->gain_uq16 = ANY_U16(0, UINT16_MAX);
    f->previous_lsb = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    f->negative = ANY_BOOL();
    f->broken = ANY_BOOL();
    f->identifies = ANY_BOOL();
    f->quarters = ANY_U8(0, 4);
    f->quarter_dhz = ANY_U16(0, 39999);
    f->rate_dhz = ANY_U16(50, 40000);
}

/* So many samples of the start, and anything in the place of the others. */
static void any_samples(filter_t *f, uint8_t collected)
{
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        f->own.start.ascending_lsb[i] = (i < collected) ? ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB) : ANY_Z();
    }
    f->collected = collected;
    f->rate_lsb = 0;
    f->size_lsb_uq16 = 0;
    f->gain_uq16 = 0;
}

#ifdef FORCE

/* A law's step by this name: said here, because behind its call several states are taken for one. */
/*@ ensures force: FORCE(f); */
static void step(filter_t *f, int16_t z_lsb, uint8_t what);

static void any_own(filter_t *f, uint8_t kind);
#ifndef ADMITTED
#define ADMITTED FORCE
#endif

/* Of filter.c, the rest of which would bring names that the laws have too. */
void filter_set_noise(filter_t *f, uint32_t r_lsb2_q8)
{
    LAW_OF(f, set_noise)(f, filter_tracker_limited_r(r_lsb2_q8));
}

static void any_running(filter_t *f, const filter_law_t *law, uint8_t kind)
{
    any_tracked(f, law);
    any_own(f, kind);
}

static void any_starting(filter_t *f, const filter_law_t *law, uint8_t kind, uint8_t collected)
{
    any_running(f, law, kind);
    any_samples(f, collected);
    f->x_lsb_q16 = ANY_S32(FILTER_Z_MIN_LSB * 65536L, FILTER_Z_MAX_LSB * 65536L);
}

#define EACH_KIND(kind) for (uint8_t kind = 0; kind < (KINDS); kind++)

/* The values of a legal configuration: each within its range or, where that is legal, 0; at first without it. */
static void any_config(filter_config_t *config, const filter_law_t *law, bool off)
{
    config->rate_dhz = ANY_U16(FILTER_RATE_MIN_DHZ, FILTER_RATE_MAX_DHZ);
    //@ loop unroll 8;
    for (uint8_t i = 0; i < FILTER_PARAMETERS_MAX; i++) {
        config->value[i] = 0;
        if (i < law->parameter_count) {
            const filter_parameter_t *p = law->parameters[i];
            if (p->zero_means_off == 0U || !off) {
                config->value[i] = ANY_S32(p->min, p->max);
            }
        }
    }
}

static bool any_is_optional(const filter_law_t *law)
{
    for (uint8_t i = 0; i < law->parameter_count; i++) {
        if (law->parameters[i]->zero_means_off != 0U) {
            return true;
        }
    }
    return false;
}

static void set_up_with(const filter_law_t *law, const filter_config_t *config)
{
    filter_t f = { 0 };
    f.law = law;
    f.rate_dhz = config->rate_dhz;
    if (law->together == NULL || law->together(config)) {
        law->set_up(&f, config);
        //@ check tracked: TRACKED(&f);
        //@ check kept: KEPT(&f);
    }
}

/* Of a parameter that the parts of a law need in pieces: so many, and a piece of it. */
#ifndef CONFIGURATIONS
#define CONFIGURATIONS(law) 1
static void narrow_config(filter_config_t *config, uint16_t number)
{
    (void)config;
    (void)number;
}
#else
static void narrow_config(filter_config_t *config, uint16_t number);
#endif

static void prove_set_up(const filter_law_t *law)
{
    filter_config_t config;
    for (uint32_t from = 32; from <= 32768U; from *= 2U) { /* shipped values, each in its range */
        config = filter_defaults(
            law, ANY_U16((from < 50U) ? 50U : (uint16_t)from, (from < 32768U) ? (uint16_t)(2U * from - 1U) : 40000U));
        filter_answer_t shipped = filter_judge(law, &config);
        //@ check shipped == FILTER_ACCEPTED || shipped == FILTER_REFUSED_TOGETHER;
    }
    bool optional = any_is_optional(law);
    for (uint8_t off = 0; off <= (uint8_t)optional; off++) {
        any_config(&config, law, off != 0U);
        //@ loop unroll 8000;
        for (uint16_t number = 0; number < CONFIGURATIONS(law); number++) {
            narrow_config(&config, number);
            set_up_with(law, &config);
        }
    }
}

static void prove_set_noise(const filter_law_t *law)
{
    EACH_KIND(kind)
    {
        filter_t f;
        any_running(&f, law, kind);
        //@ admit ADMITTED(&f);
        law->set_noise(&f, ANY_U32(FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8));
        //@ check running: TRACKED(&f) && KEPT(&f) && f.collected == 5;
        //@ check force: FORCE(&f);
        if (law->own_noise != NULL) {
            (void)law->own_noise(&f);
        }
        any_starting(&f, law, kind, 4);
        f.collected = ANY_U8(0, 4);
        law->set_noise(&f, ANY_U32(FILTER_R_MIN_LSB2_Q8, FILTER_R_MAX_LSB2_Q8));
        //@ check starting: TRACKED(&f) && KEPT(&f) && STARTING(&f);
    }
}

/* Behind five samples, or the first alone where the law begins with it; settled, behind anything. */
static void prove_start(const filter_law_t *law)
{
    EACH_KIND(kind)
    {
        filter_t f;
        for (uint8_t settled = 0; settled < 2U; settled++) {
            any_starting(&f, law, kind, (settled != 0U) ? 0 : ((law->traits & LAW_FIRST_SAMPLE) != 0U) ? 1 : 5);
            f.collected = FILTER_RUNNING;
            law->start(&f, settled != 0U);
            //@ check running: TRACKED(&f) && KEPT(&f) && f.collected == 5;
            //@ check force: FORCE(&f);
        }
    }
}

/* A sample's cells, where a law tells the innovation's sign apart from its size. */
#ifndef Z_CELL
#define Z_CELL 8192
#endif

static void prove_step(const filter_law_t *law)
{
    EACH_KIND(kind)
    {
        for (uint8_t what = STEP_MISSING; what <= (uint8_t)STEP_SETTLE; what++) {
            for (int16_t z_lsb = FILTER_Z_MIN_LSB; z_lsb <= FILTER_Z_MAX_LSB; z_lsb += Z_CELL) {
                filter_t f;
                any_running(&f, law, kind);
                //@ admit ADMITTED(&f);
                law->step(&f, ANY_S16(z_lsb, z_lsb + (Z_CELL - 1)), what);
                //@ check running: TRACKED(&f) && KEPT(&f) && f.collected == 5;
                //@ check force: law->step == &step || FORCE(&f);
            }
        }
    }
}

/* What the tracker halves and what the law does of it. */
static void prove_fade(const filter_law_t *law)
{
    EACH_KIND(kind)
    {
        filter_t f;
        any_running(&f, law, kind);
        //@ admit ADMITTED(&f);
        filter_tracker_fade(&f, true);
        //@ check first: TRACKED(&f) && KEPT(&f) && f.collected == 5;
        //@ check first_force: FORCE(&f);
        any_running(&f, law, kind);
        //@ admit ADMITTED(&f);
        filter_tracker_damp(&f);
        //@ check later: TRACKED(&f) && KEPT(&f) && f.collected == 5;
        //@ check later_force: FORCE(&f);
    }
}

static void prove_report(const filter_law_t *law)
{
    EACH_KIND(kind)
    {
        filter_t f;
        filter_probe_t probe = { 0 };
        any_running(&f, law, kind);
        //@ admit ADMITTED(&f);
        law->report(&f, &probe);
        any_starting(&f, law, kind, 4);
        f.collected = ANY_U8(0, 4);
        law->report(&f, &probe);
    }
}

static void prove_law(const filter_law_t *law)
{
    prove_set_up(law);
    prove_set_noise(law);
    prove_start(law);
    prove_step(law);
    prove_fade(law);
    prove_report(law);
}

#define PROVE_LAW(name)                \
    void proof_law_##name(void)        \
    {                                  \
        prove_law(&filter_law_##name); \
    }

#endif
#endif
