/*
 * The dispatch over the list of filters: each call reaches the filter of its kind, and none for a kind that there is
 * not.
 */
#include <string.h>

#include "filter_any.h"
#include "filter_parameter.h"
#include "support_filters.h"
#include "support_random.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static void test_an_unknown_kind_changes_nothing(void)
{
    filter_any_t f;
    filter_any_config_t config;
    filter_probe_t probe;
    memset(&f, 0xA5, sizeof f);
    memset(&config, 0x5A, sizeof config);
    memset(&probe, 0xC3, sizeof probe);
    f.kind = FILTER_KIND_COUNT;
    filter_any_t f_before = f;
    filter_any_config_t config_before = config;
    filter_probe_t probe_before = probe;
    TEST_ASSERT_NULL(filter_any_descriptor(FILTER_KIND_COUNT));
    filter_any_defaults(FILTER_KIND_COUNT, &config, 1000);
    TEST_ASSERT_EQUAL_MEMORY(&config_before, &config, sizeof config);
    TEST_ASSERT_FALSE(filter_any_init(&f, FILTER_KIND_COUNT, &config));
    f.kind = FILTER_KIND_COUNT + 1;
    f_before.kind = f.kind;
    filter_any_configure(&f, FILTER_KIND_COUNT, &config);
    TEST_ASSERT_FALSE(filter_any_together(FILTER_KIND_COUNT, &config));
    filter_any_set_noise(&f, 256);
    filter_any_reset(&f, 100);
    TEST_ASSERT_FALSE(filter_any_reset_step(&f, 100, 0));
    TEST_ASSERT_EQUAL_INT32(0, filter_any_update(&f, 100));
    TEST_ASSERT_EQUAL_INT32(0, filter_any_coast(&f));
    filter_any_damp(&f);
    filter_any_gap(&f);
    filter_any_hold(&f);
    filter_any_restart(&f);
    TEST_ASSERT_EQUAL_UINT8(0, filter_any_flags(&f));
    TEST_ASSERT_EQUAL_MEMORY(&f_before, &f, sizeof f);
    filter_any_probe(&f, &probe);
    TEST_ASSERT_EQUAL_MEMORY(&probe_before, &probe, sizeof probe);
}

/* At each rate of its range, whose defaults are legal; not looked at: what lies between the fields. */
static void test_configure_is_init_without_the_question(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (uint32_t rate_dhz = FILTER_RATE_MIN_DHZ; rate_dhz <= FILTER_RATE_MAX_DHZ; rate_dhz++) {
            filter_any_t configured;
            filter_any_t initialised;
            filter_any_config_t config;
            memset(&configured, 0, sizeof configured);
            memset(&initialised, 0, sizeof initialised);
            filter_any_defaults((filter_kind_t)kind, &config, (uint16_t)rate_dhz);
            filter_any_configure(&configured, (filter_kind_t)kind, &config);
            TEST_ASSERT_TRUE(filter_any_init(&initialised, (filter_kind_t)kind, &config));
            TEST_ASSERT_EQUAL_MEMORY(&initialised, &configured, sizeof configured);
        }
    }
}

static test_random_t random_source;

/* A value of a parameter: at and around the ends of its range, in it, anywhere, 0. */
static uint32_t some_value(const filter_parameter_t *p, unsigned which)
{
    uint32_t span = (uint32_t)p->max - (uint32_t)p->min;
    uint32_t inside = (uint32_t)p->min +
                      (span == UINT32_MAX ? random_u32(&random_source) : random_u32(&random_source) % (span + 1u));
    const uint32_t values[] = { (uint32_t)p->min,
                                (uint32_t)p->max,
                                (uint32_t)p->min - 1u,
                                (uint32_t)p->max + 1u,
                                0,
                                random_u32(&random_source),
                                inside,
                                inside,
                                inside,
                                inside };
    return values[which % (sizeof values / sizeof values[0])];
}

/* What init takes is what the ranges of the descriptor and `together` take; a field of 16 bits holds no more. */
static void test_ranges_and_together_are_what_init_asks(void)
{
    unsigned taken = 0;
    unsigned refused = 0;
    random_seed(&random_source, 11);
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_descriptor_t *d = filter_any_descriptor((filter_kind_t)kind);
        for (int i = 0; i < 20000; i++) {
            filter_any_t f;
            filter_any_config_t config;
            bool in_range = true;
            filter_any_defaults((filter_kind_t)kind, &config, 1000);
            for (uint8_t p = 0; p < d->parameter_count; p++) {
                uint32_t value = some_value(&d->parameters[p], random_u32(&random_source));
                filter_parameter_set(&config, &d->parameters[p], value);
                value = filter_parameter_get(&config, &d->parameters[p]);
                in_range = in_range && filter_parameter_in_range(&d->parameters[p], value);
            }
            bool legal = in_range && filter_any_together((filter_kind_t)kind, &config);
            TEST_ASSERT_EQUAL_MESSAGE(filter_any_init(&f, (filter_kind_t)kind, &config), legal, d->name);
            taken += legal;
            refused += !legal;
        }
    }
    TEST_ASSERT_TRUE(taken > 10000 && refused > 10000);
}

static void test_name_and_descriptor_agree(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_descriptor_t *d = filter_any_descriptor((filter_kind_t)kind);
        TEST_ASSERT_NOT_NULL(d);
        TEST_ASSERT_EQUAL_STRING(d->name, filter_any_name((filter_kind_t)kind));
        TEST_ASSERT_EQUAL_INT(kind, filter_any_find(d->name));
    }
}

/* Configurations that init refuses, and the parameter that is told. */
static void assert_refused_for(filter_kind_t kind, const char *name, uint32_t value)
{
    filter_any_t f;
    filter_any_config_t config;
    filter_any_defaults(kind, &config, 1000);
    for (uint8_t i = 0; i < parameter_count(kind); i++) {
        filter_parameter_t parameter = parameter_at(kind, i);
        if (strcmp(parameter.name, name) == 0) {
            parameter_set(&config, &parameter, value);
            TEST_ASSERT_FALSE_MESSAGE(filter_any_init(&f, kind, &config), name);
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(i, filter_any_refused(kind, &config), name);
            return;
        }
    }
    TEST_FAIL_MESSAGE(name);
}

static void test_a_refusal_names_the_parameter(void)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        assert_refused_for((filter_kind_t)kind, "r", 0);
        assert_refused_for((filter_kind_t)kind, "r", FILTER_R_MAX_LSB2_Q8 + 1);
    }
    static const filter_kind_t two_state[] = { FILTER_KIND_kf, FILTER_KIND_lrf, FILTER_KIND_soft, FILTER_KIND_sprf,
                                               FILTER_KIND_kf3 };
    for (int i = 0; i < 5; i++) {
        assert_refused_for(two_state[i], "q", 0);
        assert_refused_for(two_state[i], "q", 1000000001);
    }
    assert_refused_for(FILTER_KIND_sprf, "gate", 255); /* below 1 sigma */
    assert_refused_for(FILTER_KIND_soft, "gate", 255);
    assert_refused_for(FILTER_KIND_soft, "softgate", 255);
    assert_refused_for(FILTER_KIND_soft, "softgate", 4097);
    assert_refused_for(FILTER_KIND_soft, "reacquire", 10);
    assert_refused_for(FILTER_KIND_soft, "ratemax", 0);
    assert_refused_for(FILTER_KIND_lrf, "clean", 0); /* a probability of 0; 1 is not among 16 bits */
    assert_refused_for(FILTER_KIND_lrf, "ratio", 255);
    assert_refused_for(FILTER_KIND_synth, "a1", (uint32_t)-65536);
    assert_refused_for(FILTER_KIND_synth, "a1", 65536);
    static const filter_kind_t mixtures[] = { FILTER_KIND_shrf, FILTER_KIND_pbf, FILTER_KIND_af };
    for (int i = 0; i < 3; i++) {
        assert_refused_for(mixtures[i], "q", 0);
        assert_refused_for(mixtures[i], "clean", 0);
        assert_refused_for(mixtures[i], "clean", 32767);
        assert_refused_for(mixtures[i], "clean", 65535);
        assert_refused_for(mixtures[i], "ratio", 511);
    }
    assert_refused_for(FILTER_KIND_sprf_paper, "gate", 255);
    assert_refused_for(FILTER_KIND_sprf_paper, "gate", 0); /* a gate that cannot be switched off */
}

/* The first of several, the rate before all; off is no reason; an even run of samples lies within 3..9. */
static void test_a_refusal_tells_rate_and_combinations_apart(void)
{
    filter_any_config_t config;
    filter_any_defaults(FILTER_KIND_soft, &config, 1000);
    config.of_soft.gate_sigma_q8 = 0;
    config.of_soft.reacquire_samples = 4;
    filter_any_t f;
    TEST_ASSERT_FALSE(filter_any_init(&f, FILTER_KIND_soft, &config));
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_TOGETHER, filter_any_refused(FILTER_KIND_soft, &config));
    config.of_soft.soft_sigma_q8 = 1;
    config.of_soft.q_lsb2_s3 = 0;
    TEST_ASSERT_EQUAL_UINT8(1, filter_any_refused(FILTER_KIND_soft, &config));
    config.of_soft.rate_dhz = FILTER_RATE_MIN_DHZ - 1U;
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_RATE, filter_any_refused(FILTER_KIND_soft, &config));
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_KIND, filter_any_refused(FILTER_KIND_COUNT, &config));
    filter_any_defaults(FILTER_KIND_synth, &config, 1000);
    config.of_synth.b0_uq16 = 6554;
    config.of_synth.a1_q16 = -65000; /* outside the stability region */
    TEST_ASSERT_FALSE(filter_any_init(&f, FILTER_KIND_synth, &config));
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_TOGETHER, filter_any_refused(FILTER_KIND_synth, &config));
}

/* A filter that has seen motion, noise and outliers. */
static void run_in(filter_any_t *f, filter_kind_t kind, uint32_t *random)
{
    uint32_t refused = 0;
    memset(f, 0, sizeof *f);
    TEST_ASSERT_TRUE(init_random(f, kind, random, &refused));
    for (int16_t k = 0; k < 60; k++) {
        int16_t outlier = (int16_t)(random32_below(random, 8) == 0U ? random32_below(random, 4000) : 0U);
        (void)filter_any_update(f, (int16_t)(k * 3 + (int16_t)random32_below(random, 9) + outlier));
    }
}

/* Every byte of the state: run_in has cleared those between its fields. */
static void test_reset_in_steps_is_reset(void)
{
    uint32_t random = 20261122;
    for (uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (int turn = 0; turn < 200; turn++) {
            filter_any_t whole;
            run_in(&whole, (filter_kind_t)kind, &random);
            filter_any_t parts = whole;
            int16_t z0 = (int16_t)((int)random32_below(&random, 9000) - 4500);
            filter_any_reset(&whole, z0);
            uint8_t step = 0;
            while (filter_any_reset_step(&parts, z0, step)) {
                step++;
                TEST_ASSERT_LESS_OR_EQUAL_UINT8(64, step);
            }
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&whole, &parts, sizeof whole, filter_any_name((filter_kind_t)kind));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_unknown_kind_changes_nothing);
    RUN_TEST(test_configure_is_init_without_the_question);
    RUN_TEST(test_ranges_and_together_are_what_init_asks);
    RUN_TEST(test_name_and_descriptor_agree);
    RUN_TEST(test_reset_in_steps_is_reset);
    RUN_TEST(test_a_refusal_names_the_parameter);
    RUN_TEST(test_a_refusal_tells_rate_and_combinations_apart);
    return UNITY_END();
}
