/* kf and lrf: see law.h. */
#define FACTOR_MIN 65536
#define FACTOR_MAX 67108864 /* 1024 */
#define KEPT(f) \
    (PARAMETERS(f) && ((f)->law != &filter_law_lrf || FACTOR_MIN <= (f)->own.kalman.of.factor_uq16 <= FACTOR_MAX))
#define R_MOST R_ANY
#define CONFIGURATIONS(law) ((law)->parameter_count == 2U ? 1U : 7937U)
#include "kalman_bounds.h"

#include "kf.c"

static void any_own(filter_t *f, uint8_t kind)
{
    any_kalman(f, kind);
    f->own.kalman.of.factor_uq16 = ANY_U32(FACTOR_MIN, FACTOR_MAX);
}

/* lrf's ratio by ratio, because intervals do not know that N^2 - 1 and N^2 are of the same N. */
static void narrow_config(filter_config_t *config, uint16_t number)
{
    config->value[LRF_RATIO_UQ8] = 256 + (int32_t)number;
}

PROVE_LAW(kf)
PROVE_LAW(lrf)
