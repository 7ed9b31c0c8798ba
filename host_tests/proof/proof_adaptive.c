/* adaptive: any int16, any state within its bounds; the same bounds afterwards. */
#include "adaptive_bounds.h"
#include "adaptive_states.h"
/*@ requires BOUND_BUT_NOISE(f); ensures NOISE(f); ensures BOUND_BUT_NOISE(f); */
void adaptive_set_noise(adaptive_t *f, uint32_t r_lsb2_q8);
/*@ ensures \result ==> BOUND(f); */
bool adaptive_init(adaptive_t *f, const adaptive_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void adaptive_reset(adaptive_t *f, int16_t z0_lsb);
bool adaptive_reset_step(adaptive_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t adaptive_update(adaptive_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t adaptive_coast(adaptive_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void adaptive_damp(adaptive_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void adaptive_hold(adaptive_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void adaptive_restart(adaptive_t *f);

#include "filter_common.c"
#include "fx.c"
/* Other entries prove a limit_x of their own. */
#define limit_x limit_estimate
#include "adaptive.c"
#include "adaptive_setup.c"

void proof_limit_estimate(void)
{
    adaptive_t f;
    f.flags = ANY_U8(0, 31);
    limit_estimate(&f, ANY_S32(S32_MIN, -X_MAX_Q16 - 1L));
    limit_estimate(&f, ANY_S32(-X_MAX_Q16, -1));
    limit_estimate(&f, ANY_S32(0, X_MAX_Q16 - 1L));
    limit_estimate(&f, ANY_S32(X_MAX_Q16, INT32_MAX));
}

/*
 * By upper halves of the mean, in ranges that narrow towards the end that it must not pass.
 * Options: -eva-domains octagon
 */
void proof_averaged(void)
{
    uint16_t width = 46;
    for (uint16_t from = 46; from <= 40704U; from = (uint16_t)(from + width)) {
        width = (uint16_t)((from < 20352U) ? from : (40706U - from) / 2U);
        uint16_t to = (uint16_t)(from + width - 1U);
        uint32_t mean = ANY_U32((uint32_t)from << 16, ((uint32_t)to << 16) + 65535U);
        (void)averaged(mean, ANY_U16(0, 40704), ANY_U16(from, to), ANY_U16(0, 32768));
    }
    for (uint16_t from = 25; from <= 23040U; from = (uint16_t)(from * 2U)) {
        uint32_t mean = ANY_U32((from == 25U) ? SCATTER_LEAST : (uint32_t)from << 16,
                                (from < 11520U) ? ((uint32_t)from << 17) - 1U : SCATTER_END);
        (void)averaged(mean, ANY_U16(0, UINT16_MAX), ANY_U16(from, (from < 16384U) ? 4U * from : UINT16_MAX),
                       ANY_U16(0, 8192));
    }
}

/* Each of mean, term and largest term below the least mean that is kept, and from it on. */
void proof_doubted(void)
{
    adaptive_t f;
    any_state(&f);
    //@ loop unroll 8;
    for (uint8_t i = 0; i < 8U; i++) {
        uint32_t mean = (i & 1U) ? ANY_U32(THIRD_LEAST, THIRD_END) : ANY_U32(0, THIRD_LEAST - 1);
        uint16_t term = (i & 2U) ? ANY_U16(46, 40704) : ANY_U16(0, 45);
        f.largest_lsb_uq8 = (i & 4U) ? ANY_U16(46, 40704) : ANY_U16(0, 45);
        f.small = ANY_U8(0, 5);
        (void)doubted(&f, mean, term, ANY_U16(0, UINT16_MAX));
    }
}

/* Uses: averaged, doubted */
void proof_identify(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_state(&f);
            any_weight(&f, weight, last);
            f.terms = 1;
            identify(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
            any_state(&f);
            any_weight(&f, weight, last);
            f.terms = ANY_U16(2, 2U * f.stage);
            identify(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
        }
    }
}

/* Uses: averaged */
void proof_disperse(void)
{
    adaptive_t f;
    any_run(&f);
    f.weight_uq16 = ANY_U16(64, 32768);
    disperse(&f, ANY_U16(0, 36864));
}

void proof_collect(void)
{
    adaptive_t f;
    for (uint8_t collected = 0; collected < FILTER_WARM_UP_SAMPLES; collected++) {
        any_start(&f, collected, collected);
        collect(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

/* Options: -eva-domains octagon */
void proof_judge(void)
{
    adaptive_t f;
    any_run(&f);
    f.flags = 0;
    (void)judge(&f, ANY_U32(0, SIZE_END));
}

/* What is left to the end of the format halved each time. Options: -eva-domains octagon */
void proof_average_innovation(void)
{
    adaptive_t f;
    any_run(&f);
    f.mean_lsb_q24 = ANY_S32(-MEAN_END, -1);
    average_innovation(&f, ANY_U32(0, SIZE_END));
    for (uint32_t left = 0x80000000U; left >= 0x10000U; left >>= 1) {
        any_run(&f);
        f.mean_lsb_q24 = ANY_S32((int32_t)(0x80000000U - left),
                                 (int32_t)(0x7FFFFFFFU - ((left == 0x10000U) ? 0U : left / 2U)));
        average_innovation(&f, ANY_U32(0, SIZE_END));
    }
}

/* k by ranges of 1 to 4: what is taken is less than its sixth. */
void proof_adapt(void)
{
    adaptive_t f;
    any_run(&f);
    f.k_uq32 = ANY_U32(0, 0x1FFFFU);
    adapt(&f, ANY_U16(0, 36864));
    for (uint32_t k = 2; k <= 39322U; k *= 4U) {
        any_run(&f);
        f.k_uq32 = ANY_U32(k << 16, (k < 8192U) ? (k << 18) - 1U : K_END);
        adapt(&f, ANY_U16(0, 36864));
    }
}

/* By the change, so that the test of the rate tells the sum. */
void proof_turn(void)
{
    adaptive_t f;
    any_told(&f);
    for (int32_t by = 0; by < RATE_END; by += 0x800000L) {
        f.rate_lsb_q24 = ANY_S32(-RATE_END, RATE_END);
        turn(&f, ANY_S32(by, by + 0x800000L));
    }
}

static void any_gained(uint32_t from_k, uint32_t to_k)
{
    adaptive_t f;
    any_run(&f);
    f.k_uq32 = ANY_U32(from_k << 16, (to_k << 16) + 65535U);
    (void)gained(&f, ANY_U32(0, 255));
    uint32_t to = 0;
    for (uint32_t from = 1; from < (SIZE_END >> 8); from = to + 1U) {
        to = from + from / 4U;
        if (to > (from | 0xFFFFU)) {
            to = from | 0xFFFFU; /* the product is one of halves */
        }
        f.rate_lsb_q24 = ANY_S32(-RATE_END, RATE_END);
        (void)gained(&f, ANY_U32(from << 8, (to < (SIZE_END >> 8)) ? (to << 8) + 255U : SIZE_END));
    }
}

/*
 * Uses: turn.
 * k and what is taken in ranges narrow enough for 2 w to exceed k w wherever in them they are.
 */
void proof_gained(void)
{
    any_gained(0, 0);
    for (uint32_t k = 1; k < 16384U; k *= 2U) {
        any_gained(k, 2U * k - 1U);
    }
    any_gained(16384, 20479);
    any_gained(20480, 25599);
    any_gained(25600, 31999);
    any_gained(32000, 39322);
}

/* Uses: limit_estimate, judge, average_innovation, adapt, gained, disperse */
void proof_step(void)
{
    adaptive_t f;
    any_run(&f);
    f.weight_uq16 = ANY_U16(64, 32768);
    step(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

static void legal_config(adaptive_config_t *config)
{
    config->r_lsb2_q8 = ANY_U32(3, 256000);
    config->identify = ANY_U16(0, 1);
    config->slow_ms = ANY_U16(10, 60000);
    config->fast_ms = ANY_U16(1, 60000);
    config->confirm_ms = ANY_U16(0, 10000);
    config->rate_max_lsb_s = ANY_U32(10, 1000000);
}

static void any_config(adaptive_config_t *config)
{
    config->rate_dhz = ANY_U16(0, UINT16_MAX);
    config->guard_sigma_q8 = ANY_U16(0, UINT16_MAX);
    config->r_lsb2_q8 = ANY_U32(0, UINT32_MAX);
    config->identify = ANY_U16(0, UINT16_MAX);
    config->slow_ms = ANY_U16(0, UINT16_MAX);
    config->fast_ms = ANY_U16(0, UINT16_MAX);
    config->confirm_ms = ANY_U16(0, UINT16_MAX);
    config->rate_max_lsb_s = ANY_U32(0, UINT32_MAX);
}

/* All, but one parameter only from `low` to `high`. */
#define INIT_WITH(parameter, any, low, high) \
    do {                                     \
        adaptive_config_t with;              \
        any_config(&with);                   \
        with.parameter = any(low, high);     \
        (void)adaptive_init(&f, &with);      \
    } while (0)

/*
 * Uses: fx_isqrt32, fx_normalise, rounded.
 * All legal configurations, by the rate, then all with one parameter below or above its range.
 */
void proof_adaptive_init(void)
{
    adaptive_t f;
    adaptive_config_t config;
    for (uint16_t rate = 50; rate <= 40000U; rate = (uint16_t)((rate < 256U) ? 256U : rate * 2U)) {
        legal_config(&config);
        config.rate_dhz = ANY_U16(rate, (rate < 256U) ? 255U : (rate < 32768U) ? 2U * rate - 1U : 40000U);
        config.guard_sigma_q8 = 0;
        (void)adaptive_init(&f, &config);
        config.guard_sigma_q8 = ANY_U16(256, 4096);
        (void)adaptive_init(&f, &config);
        if (rate >= 32768U) {
            break;
        }
    }
    INIT_WITH(rate_dhz, ANY_U16, 0, 49);
    INIT_WITH(rate_dhz, ANY_U16, 40001, UINT16_MAX);
    INIT_WITH(guard_sigma_q8, ANY_U16, 1, 255);
    INIT_WITH(guard_sigma_q8, ANY_U16, 4097, UINT16_MAX);
    INIT_WITH(r_lsb2_q8, ANY_U32, 0, 2);
    INIT_WITH(r_lsb2_q8, ANY_U32, 256001, UINT32_MAX);
    INIT_WITH(identify, ANY_U16, 2, UINT16_MAX);
    INIT_WITH(slow_ms, ANY_U16, 0, 9);
    INIT_WITH(slow_ms, ANY_U16, 60001, UINT16_MAX);
    INIT_WITH(fast_ms, ANY_U16, 0, 0);
    INIT_WITH(fast_ms, ANY_U16, 60001, UINT16_MAX);
    INIT_WITH(confirm_ms, ANY_U16, 10001, UINT16_MAX);
    INIT_WITH(rate_max_lsb_s, ANY_U32, 0, 9);
    INIT_WITH(rate_max_lsb_s, ANY_U32, 1000001, UINT32_MAX);
    adaptive_defaults(&config, ANY_U16(0, UINT16_MAX));
}

/* Uses: fx_isqrt32 */
void proof_adaptive_set_noise(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_run(&f);
            any_weight(&f, weight, last);
            adaptive_set_noise(&f, ANY_U32(0, UINT32_MAX));
            any_start(&f, 0, 4);
            any_weight(&f, weight, last);
            adaptive_set_noise(&f, ANY_U32(0, UINT32_MAX));
        }
    }
}

void proof_adaptive_reset(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_run(&f);
            any_weight(&f, weight, last);
            adaptive_reset(&f, ANY_Z());
            any_start(&f, 0, 4);
            any_weight(&f, weight, last);
            adaptive_reset(&f, ANY_Z());
        }
    }
}

void proof_adaptive_reset_step(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_run(&f);
            any_weight(&f, weight, last);
            (void)adaptive_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
        }
    }
}

/* Uses: collect, step, identify */
void proof_adaptive_update(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_run(&f);
            any_weight(&f, weight, last);
            (void)adaptive_update(&f, ANY_Z());
            any_start(&f, 0, 3);
            any_weight(&f, weight, last);
            (void)adaptive_update(&f, ANY_Z());
            any_start(&f, 4, 4);
            any_weight(&f, weight, last);
            (void)adaptive_update(&f, ANY_Z());
        }
    }
}

/* Uses: limit_estimate */
void proof_adaptive_coast(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_run(&f);
            any_weight(&f, weight, last);
            (void)adaptive_coast(&f);
            any_start(&f, 0, 4);
            any_weight(&f, weight, last);
            (void)adaptive_coast(&f);
        }
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_adaptive_gap(void)
{
    adaptive_t f;
    EACH_LAST(last)
    {
        EACH_WEIGHT(weight, last)
        {
            any_run(&f);
            any_weight(&f, weight, last);
            adaptive_damp(&f);
            any_start(&f, 0, 4);
            any_weight(&f, weight, last);
            adaptive_damp(&f);
            any_run(&f);
            any_weight(&f, weight, last);
            adaptive_gap(&f);
            adaptive_hold(&f);
            any_start(&f, 0, 4);
            any_weight(&f, weight, last);
            adaptive_hold(&f);
            any_run(&f);
            any_weight(&f, weight, last);
            adaptive_restart(&f);
            any_start(&f, 0, 4);
            any_weight(&f, weight, last);
            adaptive_restart(&f);
        }
    }
}

/* Uses: fx_normalise, rounded */
void proof_adaptive_probe(void)
{
    adaptive_t f;
    filter_probe_t probe;
    any_run(&f);
    adaptive_probe(&f, &probe);
    any_start(&f, 0, 4);
    adaptive_probe(&f, &probe);
    (void)adaptive_flags(&f);
}
