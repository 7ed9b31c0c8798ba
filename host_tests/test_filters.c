/* Generic properties, over the list of filters: what every filter of lib/filters promises, whatever its rule. */
#include "support_filters.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

#define SEED 20021

void setUp(void) {}

void tearDown(void) {}

static void make(filter_any_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    filter_any_config_t config;
    filter_any_defaults(kind, &config, rate_dhz);
    TEST_ASSERT_TRUE(filter_any_init(f, kind, &config));
}

static void names_find_their_kind(void)
{
    TEST_ASSERT_EQUAL_INT(FILTER_KIND_kf, filter_any_find("kf"));
    TEST_ASSERT_EQUAL_INT(FILTER_KIND_sprf, filter_any_find("sprf"));
    TEST_ASSERT_EQUAL_INT(FILTER_KIND_COUNT, filter_any_find("spr"));
    TEST_ASSERT_EQUAL_INT(FILTER_KIND_COUNT, filter_any_find("sprfx"));
    TEST_ASSERT_EQUAL_INT(FILTER_KIND_COUNT, filter_any_find(""));
}

/* Sensor rates, and both ends of the legal range of rates. */
static void defaults_are_legal_at_every_rate(void)
{
    static const uint16_t rates[] = { 50, 125, 250, 500, 1000, 2000, 4000, 8000, 40000 };
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
            filter_any_t f;
            make(&f, (filter_kind_t)kind, rates[i]);
        }
    }
}

static void unknown_kind_is_refused_and_harmless(void)
{
    filter_any_t f = { .kind = FILTER_KIND_COUNT };
    filter_any_config_t config;
    filter_any_defaults(FILTER_KIND_kf, &config, 1000);
    TEST_ASSERT_FALSE(filter_any_init(&f, FILTER_KIND_COUNT, &config));
    TEST_ASSERT_EQUAL_INT32(0, filter_any_update(&f, 5));
    TEST_ASSERT_EQUAL_INT32(0, filter_any_coast(&f));
    TEST_ASSERT_EQUAL_UINT8(0, filter_any_flags(&f));
}

/* Each descriptor's limits, one step inside and outside, through F_init; the field named by offset and size. */
static void every_parameter_outside_its_range_is_refused(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_descriptor_t *d = filter_any_descriptor((filter_kind_t)kind);
        for (uint8_t i = 0; i < d->parameter_count; i++) {
            const filter_parameter_t *p = &d->parameters[i];
            const uint32_t values[] = { p->min, p->max, p->min - 1U, p->max + 1U, 0U };
            const bool legal[] = { true, true, p->zero_means_off && p->min == 1U, false, p->zero_means_off };
            for (int v = 0; v < 5; v++) {
                filter_any_config_t config;
                filter_any_t f;
                filter_any_defaults((filter_kind_t)kind, &config, 1000);
                memcpy((uint8_t *)&config + p->offset, &values[v], p->size); /* little-endian, as the AVR */
                bool taken = filter_any_init(&f, (filter_kind_t)kind, &config);
                TEST_ASSERT_EQUAL_INT_MESSAGE(legal[v], taken, p->name);
            }
        }
    }
}

static void rates_outside_5_to_4000_hz_are_refused(void)
{
    static const uint16_t rates[] = { 0, 49, 40001, 65535 };
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (int i = 0; i < 4; i++) {
            filter_any_config_t config;
            filter_any_t f;
            filter_any_defaults((filter_kind_t)kind, &config, 1000);
            config.kf.rate_dhz = rates[i]; /* first field of every configuration */
            TEST_ASSERT_FALSE(filter_any_init(&f, (filter_kind_t)kind, &config));
        }
    }
}

static void refused_init_leaves_the_filter_untouched(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        filter_any_t f;
        memset(&f, 0xA5, sizeof f);
        filter_any_t before = f;
        filter_any_config_t config;
        filter_any_defaults((filter_kind_t)kind, &config, 1000);
        config.kf.r_lsb2_q8 = 0;
        TEST_ASSERT_FALSE(filter_any_init(&f, (filter_kind_t)kind, &config));
        TEST_ASSERT_EQUAL_MEMORY(&before, &f, sizeof f);
    }
}

/* Kalman's update with innovation 0 moves nothing: exact. */
static void constant_in_constant_out_after_reset(void)
{
    static const int16_t levels[] = { -4096, -1, 0, 1, 255, 4095 };
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (int i = 0; i < 6; i++) {
            filter_any_t f;
            make(&f, (filter_kind_t)kind, 1000);
            filter_any_reset(&f, levels[i]);
            for (int k = 0; k < 300; k++) {
                TEST_ASSERT_EQUAL_INT32((int32_t)levels[i] * 65536, filter_any_update(&f, levels[i]));
                TEST_ASSERT_EQUAL_UINT8(0, filter_any_flags(&f));
            }
        }
    }
}

/* Medians by hand: {9}, {9,-3}, {9,-3,500}, {9,-3,500,8}, {9,-3,500,8,7}. */
static void warm_up_puts_out_the_running_median(void)
{
    static const int16_t in[] = { 9, -3, 500, 8, 7 };
    static const double median[] = { 9.0, 3.0, 9.0, 8.5, 8.0 };
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        filter_any_t f;
        make(&f, (filter_kind_t)kind, 1000);
        for (int k = 0; k < 5; k++) {
            TEST_ASSERT_EQUAL_INT32((int32_t)(median[k] * 65536.0), filter_any_update(&f, in[k]));
            TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP, filter_any_flags(&f));
        }
        (void)filter_any_update(&f, 8);
        TEST_ASSERT_EQUAL_UINT8(0, filter_any_flags(&f) & FILTER_WARMING_UP);
    }
}

static void coast_in_warm_up_keeps_the_median(void)
{
    filter_any_t f;
    make(&f, FILTER_KIND_sprf, 1000);
    (void)filter_any_update(&f, 40);
    TEST_ASSERT_EQUAL_INT32(40 * 65536, filter_any_coast(&f));
    TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP | FILTER_COASTED, filter_any_flags(&f));
}

/* Magnitude arithmetic: -z gives -x bit for bit while no clamp is hit. */
static void negation_is_exact(void)
{
    test_random_t random;
    random_seed(&random, SEED);
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        filter_any_t up;
        filter_any_t down;
        make(&up, (filter_kind_t)kind, 1000);
        make(&down, (filter_kind_t)kind, 1000);
        for (int k = 0; k < 5000; k++) {
            int16_t z = as_sample(300.0 * ((k / 400) % 3) + 3.0 * random_normal(&random));
            TEST_ASSERT_EQUAL_INT32(filter_any_update(&up, z), -filter_any_update(&down, (int16_t)-z));
        }
    }
}

static void copy_goes_on_like_the_original(void)
{
    test_random_t random;
    random_seed(&random, SEED + 1);
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        filter_any_t f;
        make(&f, (filter_kind_t)kind, 4000);
        for (int k = 0; k < 2000; k++) {
            filter_any_t copy = f;
            int16_t z = (int16_t)random_u32(&random);
            TEST_ASSERT_EQUAL_INT32(filter_any_update(&copy, z), filter_any_update(&f, z));
            filter_probe_t a;
            filter_probe_t b;
            memset(&a, 0, sizeof a);
            memset(&b, 0, sizeof b);
            filter_any_probe(&copy, &a);
            filter_any_probe(&f, &b);
            TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof a);
        }
    }
}

static int32_t random_call(filter_any_t *f, test_random_t *random)
{
    uint32_t what = random_below(random, 100);
    if (what < 80) {
        return filter_any_update(f, (int16_t)random_u32(random));
    }
    if (what < 95) {
        return filter_any_coast(f);
    }
    if (what < 97) {
        filter_any_set_noise(f, random_u32(random) >> random_below(random, 32));
    } else {
        filter_any_reset(f, (int16_t)random_u32(random));
    }
    return f->state.kf.core.x_lsb_q16;
}

/* 10^6 calls in 2,000 legal configurations, any int16, any order; the sanitizers watch the arithmetic. */
static void any_sequence_stays_within_bounds(void)
{
    test_random_t random;
    random_seed(&random, SEED + 2);
    printf("seed %d\n", SEED + 2);
    for (int run = 0; run < 2000; run++) {
        filter_any_t f;
        filter_any_config_t config;
        filter_kind_t kind = (filter_kind_t)(run % FILTER_KIND_COUNT);
        random_config(&random, kind, &config);
        TEST_ASSERT_TRUE(filter_any_init(&f, kind, &config));
        for (int k = 0; k < 500; k++) {
            int32_t x = random_call(&f, &random);
            assert_bounds(&f, x);
        }
    }
}

/* The largest stretch of one call after the other: a filter pushed to its rail and left to coast there. */
static void coasting_for_ever_stays_within_bounds(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        filter_any_t f;
        make(&f, (filter_kind_t)kind, 125);
        for (int k = 0; k < 40; k++) {
            (void)filter_any_update(&f, (int16_t)(k * 60));
        }
        for (int k = 0; k < 20000; k++) {
            assert_bounds(&f, filter_any_coast(&f));
        }
        TEST_ASSERT_EQUAL_INT32((int32_t)FILTER_X_MAX_LSB * 65536, filter_any_coast(&f));
        TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED | FILTER_SATURATED, filter_any_flags(&f));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(names_find_their_kind);
    RUN_TEST(defaults_are_legal_at_every_rate);
    RUN_TEST(unknown_kind_is_refused_and_harmless);
    RUN_TEST(every_parameter_outside_its_range_is_refused);
    RUN_TEST(rates_outside_5_to_4000_hz_are_refused);
    RUN_TEST(refused_init_leaves_the_filter_untouched);
    RUN_TEST(constant_in_constant_out_after_reset);
    RUN_TEST(warm_up_puts_out_the_running_median);
    RUN_TEST(coast_in_warm_up_keeps_the_median);
    RUN_TEST(negation_is_exact);
    RUN_TEST(copy_goes_on_like_the_original);
    RUN_TEST(any_sequence_stays_within_bounds);
    RUN_TEST(coasting_for_ever_stays_within_bounds);
    return UNITY_END();
}
