/* synth: any int16, any state within its bounds; the same bounds afterwards. */
#include "eva.h"
#include "fx_contracts.h"

#include "synth.h"

#define X_MAX_Q16 301989888 /* 4608 LSB */
#define WITHIN_X(x) (-X_MAX_Q16 <= (x) <= X_MAX_Q16)
#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define SAMPLE_Q16(x) (-4096 * 65536 <= (x) <= 4095 * 65536)
#define FIVE(lsb) (SAMPLE((lsb)[0]) && SAMPLE((lsb)[1]) && SAMPLE((lsb)[2]) && SAMPLE((lsb)[3]) && SAMPLE((lsb)[4]))
#define NOISE(f) (3 <= (f)->r_lsb2_q8 <= 256000 && 1 <= (f)->spread_lsb <= 365)
/* The flags say so until there are estimates. */
#define STARTING(f)                                                                                \
    ((f)->collected < 5 && ((f)->flags & FILTER_WARMING_UP) != 0 && FIVE((f)->u.start.seen_lsb) && \
     FIVE((f)->u.start.ascending_lsb))
#define ESTIMATES(f) \
    (WITHIN_X((f)->u.run.x_lsb_q16[0]) && WITHIN_X((f)->u.run.x_lsb_q16[1]) && WITHIN_X((f)->u.run.x_lsb_q16[2]))
/* The median of the start is there as long as the flags say so. */
#define MEDIAN(f) (((f)->flags & FILTER_WARMING_UP) == 0 || SAMPLE_Q16((f)->u.run.median_lsb_q16))
/* Behind the start, and after a reset, the flags never say that it is under way. */
#define RUNNING(f)   \
    (ESTIMATES(f) && \
     ((5 <= (f)->collected <= 63 && MEDIAN(f)) || ((f)->collected == 255 && (f)->flags < FILTER_WARMING_UP)))
/* All but what synth_set_noise sets, because synth_init calls it. */
#define BUT_NOISE(f)                                                                                    \
    (656 <= (f)->b0_uq16 && (f)->motion_lsb <= 320 && (f)->flags < 32 && (STARTING(f) || RUNNING(f)) && \
     -8704 * 65536 <= (f)->innovation_lsb_q16 <= 8704 * 65536)
#define BOUND(f) (BUT_NOISE(f) && NOISE(f))

/*@ ensures \result ==> BOUND(f); */
bool synth_init(synth_t *f, const synth_config_t *config);
/*@ requires BUT_NOISE(f); ensures BOUND(f); */
void synth_set_noise(synth_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void synth_reset(synth_t *f, int16_t z0_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_update(synth_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t synth_coast(synth_t *f);

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

/*@ requires FIVE(f->u.start.seen_lsb) && SAMPLE(f->u.start.ascending_lsb[2]) && 1 <= f->spread_lsb <= 365;
    assigns f->u.run, \result \from f->u.start, f->spread_lsb;
    ensures ESTIMATES(f);
    ensures SAMPLE_Q16(f->u.run.median_lsb_q16) && SAMPLE_Q16(\result);
*/
static int32_t fit_start(synth_t *f);

#include "filter_common.c"
#include "fx.c"

#include "synth.c"

static void any_common(synth_t *f)
{
    f->innovation_lsb_q16 = ANY_S32(-8704L * 65536, 8704L * 65536);
    f->r_lsb2_q8 = ANY_U32(3, 256000);
    f->a1_uq16 = ANY_U16(0, UINT16_MAX);
    f->b0_uq16 = ANY_U16(656, UINT16_MAX);
    f->gain_uq16 = ANY_U16(0, UINT16_MAX);
    f->motion_lsb = ANY_U16(0, 320);
    f->spread_lsb = ANY_S16(1, 365);
    f->a1_negative = ANY_BOOL();
    f->flags = ANY_U8(0, 31);
}

static void any_start(synth_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        f->u.start.seen_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
        f->u.start.ascending_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
    f->flags = ANY_U8(FILTER_WARMING_UP, 31);
    f->collected = ANY_U8(from_collected, to_collected);
}

static void any_run(synth_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_common(f);
    for (uint8_t i = 0; i < 3; i++) {
        f->u.run.x_lsb_q16[i] = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    }
    f->u.run.median_lsb_q16 = ANY_S32(FILTER_Z_MIN_LSB * 65536L, FILTER_Z_MAX_LSB * 65536L);
    f->collected = ANY_U8(from_collected, to_collected);
}

/* As after a reset and behind the start: nothing is known of the median. */
static void any_later_run(synth_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_run(f, from_collected, to_collected);
    f->u.run.median_lsb_q16 = ANY_S32(S32_MIN, INT32_MAX);
    f->flags = ANY_U8(0, FILTER_WARMING_UP - 1);
}

void proof_limit_x(void)
{
    for (int16_t cell = -128; cell < 128; cell++) {
        int32_t from_q16 = (int32_t)cell * CELL_Q16;
        int32_t x_q16 = ANY_S32(from_q16, from_q16 + (CELL_Q16 - 1));
        (void)limit_x(&x_q16);
    }
}

/*
 * By intervals of the median: near an end of the range the other samples can be far from it to one side only, which
 * keeps the line within the bound even though intervals take mean and slope for independent.
 */
void proof_fit_start(void)
{
    for (int16_t from_lsb = FILTER_Z_MIN_LSB; from_lsb <= FILTER_Z_MAX_LSB; from_lsb += 32) {
        synth_t f;
        any_start(&f, FILTER_WARM_UP_SAMPLES, FILTER_WARM_UP_SAMPLES);
        f.u.start.ascending_lsb[2] = ANY_S16(from_lsb, from_lsb + 31);
        (void)fit_start(&f);
    }
}

static void init_with(uint16_t rate_dhz, uint16_t b0_uq16, int32_t a1_q16, uint32_t r_lsb2_q8)
{
    synth_t f;
    synth_config_t config = { rate_dhz, b0_uq16, a1_q16, r_lsb2_q8 };
    (void)synth_init(&f, &config);
}

/* Uses: fx_isqrt32. A box that holds all legal configurations, then all with one parameter below or above it. */
void proof_synth_init(void)
{
    uint16_t rate_dhz = ANY_U16(0, UINT16_MAX);
    uint16_t b0_uq16 = ANY_U16(0, UINT16_MAX);
    int32_t a1_q16 = ANY_S32(S32_MIN, INT32_MAX);
    uint32_t r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    init_with(ANY_U16(50, 40000), ANY_U16(656, UINT16_MAX), ANY_S32(-65535, 65535), ANY_U32(3, 256000));
    init_with(ANY_U16(0, 49), b0_uq16, a1_q16, r_lsb2_q8);
    init_with(ANY_U16(40001, UINT16_MAX), b0_uq16, a1_q16, r_lsb2_q8);
    init_with(rate_dhz, ANY_U16(0, 655), a1_q16, r_lsb2_q8);
    init_with(rate_dhz, b0_uq16, ANY_S32(S32_MIN, -65536), r_lsb2_q8);
    init_with(rate_dhz, b0_uq16, ANY_S32(65536, INT32_MAX), r_lsb2_q8);
    init_with(rate_dhz, b0_uq16, a1_q16, ANY_U32(0, 2));
    init_with(rate_dhz, b0_uq16, a1_q16, ANY_U32(256001, UINT32_MAX));
    synth_config_t config;
    synth_defaults(&config, ANY_U16(50, 40000));
    synth_paper(&config, ANY_U16(50, 40000));
}

/* Uses: fx_isqrt32 */
void proof_synth_set_noise(void)
{
    synth_t f;
    any_start(&f, 0, 4);
    synth_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_run(&f, 5, 63);
    synth_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_later_run(&f, 5, 63);
    synth_set_noise(&f, ANY_U32(0, UINT32_MAX));
    any_later_run(&f, 255, 255);
    synth_set_noise(&f, ANY_U32(0, UINT32_MAX));
}

void proof_synth_reset(void)
{
    synth_t f;
    any_start(&f, 0, 4);
    synth_reset(&f, ANY_Z());
    any_run(&f, 5, 63);
    synth_reset(&f, ANY_Z());
    any_later_run(&f, 5, 63);
    synth_reset(&f, ANY_Z());
    any_later_run(&f, 255, 255);
    synth_reset(&f, ANY_Z());
}

/* Uses: limit_x, fit_start. Options: -eva-split-return-function extrapolate:full,next_gain_uq16:full,step:full */
void proof_synth_update(void)
{
    synth_t f;
    any_start(&f, 0, 3);
    (void)synth_update(&f, ANY_Z());
    any_start(&f, 4, 4);
    (void)synth_update(&f, ANY_Z());
    any_run(&f, 5, 63);
    (void)synth_update(&f, ANY_Z());
    any_later_run(&f, 5, 63);
    (void)synth_update(&f, ANY_Z());
    any_later_run(&f, 255, 255);
    (void)synth_update(&f, ANY_Z());
}

/* Uses: limit_x */
void proof_synth_coast(void)
{
    synth_t f;
    any_start(&f, 0, 4);
    (void)synth_coast(&f);
    any_run(&f, 5, 63);
    (void)synth_coast(&f);
    any_later_run(&f, 5, 63);
    (void)synth_coast(&f);
    any_later_run(&f, 255, 255);
    (void)synth_coast(&f);
}

/* Uses: fx_normalise, rounded. Any gain and extrapolation within its range, stable or not. */
void proof_synth_noise_gain_uq16(void)
{
    (void)synth_noise_gain_uq16(ANY_U16(656, UINT16_MAX), ANY_S32(-65535, 65535));
}

/* Uses: fx_normalise, rounded */
void proof_synth_probe(void)
{
    synth_t f;
    filter_probe_t probe;
    any_start(&f, 0, 4);
    synth_probe(&f, &probe);
    any_run(&f, 5, 63);
    synth_probe(&f, &probe);
    any_later_run(&f, 5, 63);
    synth_probe(&f, &probe);
    any_later_run(&f, 255, 255);
    synth_probe(&f, &probe);
    (void)synth_flags(&f);
}
