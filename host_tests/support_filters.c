#include "support_filters.h"

#include "unity.h"

#include <math.h>

void random_seed(test_random_t *r, uint64_t seed)
{
    r->state = seed * 2654435769U + 88172645463325252U;
}

uint32_t random_u32(test_random_t *r)
{
    r->state ^= r->state >> 12;
    r->state ^= r->state << 25;
    r->state ^= r->state >> 27;
    return (uint32_t)((r->state * 2685821657736338717U) >> 32);
}

uint32_t random_below(test_random_t *r, uint32_t end)
{
    return (uint32_t)(((uint64_t)random_u32(r) * end) >> 32);
}

double random_uniform(test_random_t *r)
{
    return ((double)random_u32(r) + 0.5) / 4294967296.0;
}

double random_normal(test_random_t *r)
{
    double radius = sqrt(-2.0 * log(random_uniform(r)));
    return radius * cos(6.283185307179586 * random_uniform(r));
}

/* Log-uniform in min..max. */
static uint32_t random_decades(test_random_t *r, double min, double max)
{
    double v = min * exp(random_uniform(r) * log(max / min));
    return (uint32_t)(v < min ? min : (v > max ? max : v));
}

void random_config(test_random_t *r, filter_kind_t kind, filter_any_config_t *config)
{
    static const uint16_t runs[] = { 0, 3, 5, 9 };
    filter_any_defaults(kind, config, (uint16_t)random_decades(r, 50, 40000));
    config->kf.r_lsb2_q8 = random_decades(r, 3, 256000);
    config->kf.q_lsb2_s3 = random_decades(r, 1, 1e9);
    if (kind == FILTER_KIND_sprf) {
        config->sprf.gate_sigma_q8 = random_below(r, 8) == 0 ? 0 : (uint16_t)random_decades(r, 256, 4096);
        config->sprf.reacquire_samples = runs[random_below(r, 4)];
        config->sprf.rate_max_lsb_s = random_decades(r, 10, 1e6);
    }
}

int16_t as_sample(double lsb)
{
    double rounded = floor(lsb + 0.5);
    return (int16_t)fmax(-4096.0, fmin(4095.0, rounded));
}

void assert_bounds(const filter_any_t *f, int32_t x_lsb_q16)
{
    const two_state_t *s = &f->state.kf.core;
    const int32_t x_max = (int32_t)FILTER_X_MAX_LSB * 65536;
    TEST_ASSERT_TRUE(x_lsb_q16 >= -x_max && x_lsb_q16 <= x_max);
    TEST_ASSERT_EQUAL_INT32(x_lsb_q16, s->x_lsb_q16);
    TEST_ASSERT_TRUE(s->rate_max_lsb_q16 <= (uint32_t)x_max);
    TEST_ASSERT_TRUE(fx_abs32(s->rate_lsb_q16) <= s->rate_max_lsb_q16);
    if (!two_state_warming_up(s)) {
        TEST_ASSERT_TRUE(s->u.p.p11_uq28 < TWO_STATE_P11_END_UQ28);
        TEST_ASSERT_TRUE(s->u.p.p12_uq28 < 0x40000000U);
        TEST_ASSERT_TRUE(s->u.p.p22_uq28 < 0x30000000U);
    }
}
