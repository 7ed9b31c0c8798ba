/* kf and lrf: see law.h. */
#define FACTOR_MIN 65536
#define FACTOR_MAX 67108864 /* 1024 */
#define KEPT(f) (PARAMETERS(f) && ((f)->law != &filter_law_lrf || FACTOR_MIN <= (f)->own.kalman.of.factor_uq16 <= FACTOR_MAX))
#define R_MOST R_ANY
#include "kalman_bounds.h"

#include "kf.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
    f->own.kalman.of.factor_uq16 = ANY_U32(FACTOR_MIN, FACTOR_MAX);
}

/* Uses: kalman_set_up */
PROVE(set_up, kf)
/* Options: -no-warn-signed-downcast */
PROVE(defaults, kf)
/* Uses: kalman_set_variance */
PROVE(set_noise, kf)
PROVE(start, kf)
/* Uses: kalman_step */
PROVE(step, kf)
PROVE(fade, kf)
PROVE(report, kf)
/* Uses: kalman_set_up. Ratio by ratio, because intervals do not know that N^2 - 1 and N^2 are of the same N. */
void proof_lrf_set_up(void)
{
    filter_t f;
    filter_config_t config;
    any_running(&f, &filter_law_lrf, 0);
    any_config(&config, &filter_law_lrf, false);
    for (uint16_t ratio_uq8 = 256; ratio_uq8 <= 8192U; ratio_uq8++) {
        config.value[LRF_RATIO_UQ8] = ratio_uq8;
        lrf_set_up(&f, &config);
        //@ check kept: KEPT(&f);
    }
}

/* Options: -no-warn-signed-downcast */
PROVE(defaults, lrf)
/* Uses: fx_normalise, rounded, kalman_set_variance */
PROVE(set_noise, lrf)
PROVE(start, lrf)
/* Uses: kalman_step */
PROVE(step, lrf)
PROVE(fade, lrf)
PROVE(report, lrf)
