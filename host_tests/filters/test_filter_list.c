/* The list of laws: names, numbers, descriptors, and what init says of a configuration that it refuses. */
#include <string.h>

#include "support/filters.h"
#include "support/random.h"
#include "support/roles.h"
#include "support/test.h"

static test_random_t random_source;

/* A value of a parameter: at and around the ends of its range, in it, anywhere, 0. */
static int32_t some_value(const filter_parameter_t *p, unsigned which)
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
    return (int32_t)values[which % (sizeof values / sizeof values[0])];
}

/* What init takes is what the ranges of the descriptor and `together` take, and it says which of them does not. */
TEST(test_ranges_and_together_are_what_init_asks)
{
    unsigned taken = 0;
    unsigned refused = 0;
    random_seed(&random_source, 11);
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_law_t *law = filter_listed((filter_kind_t)kind);
        for (int i = 0; i < 20000; i++) {
            filter_t f;
            filter_config_t config = filter_defaults(law, 1000);
            filter_answer_t wanted = FILTER_ACCEPTED;
            for (uint8_t p = 0; p < filter_parameter_count(law); p++) {
                const filter_parameter_t *parameter = filter_parameter(law, p);
                config.value[p] = some_value(parameter, random_u32(&random_source));
                TEST_ASSERT_EQUAL(parameter_legal(parameter, config.value[p]),
                                  filter_in_range(parameter, config.value[p]));
                if (wanted == FILTER_ACCEPTED && !parameter_legal(parameter, config.value[p])) {
                    wanted = (filter_answer_t)(FILTER_REFUSED_FIRST + p);
                }
            }
            if (wanted == FILTER_ACCEPTED && law->together != NULL && !law->together(&config)) {
                wanted = FILTER_REFUSED_TOGETHER;
            }
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(wanted, filter_judge(law, &config), filter_name(law));
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(wanted, filter_init(&f, law, &config), filter_name(law));
            taken += wanted == FILTER_ACCEPTED;
            refused += wanted != FILTER_ACCEPTED;
        }
    }
    TEST_ASSERT_TRUE(taken > 10000 && refused > 10000);
}

TEST(test_defaults_are_legal_at_each_rate)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (uint32_t rate_dhz = FILTER_RATE_MIN_DHZ; rate_dhz <= FILTER_RATE_MAX_DHZ; rate_dhz++) {
            filter_t f;
            TEST_ASSERT_TRUE(init_default(&f, (filter_kind_t)kind, (uint16_t)rate_dhz));
        }
    }
}

TEST(test_name_and_descriptor_agree)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_law_t *law = filter_listed((filter_kind_t)kind);
        TEST_ASSERT_NOT_NULL(law);
        TEST_ASSERT_EQUAL_STRING(filter_name(law), filter_listed_name((filter_kind_t)kind));
        TEST_ASSERT_EQUAL_INT(kind, filter_find(filter_name(law)));
        TEST_ASSERT_LESS_OR_EQUAL_UINT8(FILTER_PARAMETERS_MAX, filter_parameter_count(law));
    }
}

/* Init refuses the configuration and names the parameter. */
static void assert_refused_for(filter_kind_t kind, const char *name, int32_t value)
{
    filter_t f;
    const filter_law_t *law = filter_listed(kind);
    filter_config_t config = filter_defaults(law, 1000);
    for (uint8_t i = 0; i < parameter_count(kind); i++) {
        if (strcmp(parameter_name(kind, i), name) == 0) {
            config.value[i] = value;
            TEST_ASSERT_EQUAL_UINT8_MESSAGE(FILTER_REFUSED_FIRST + i, filter_init(&f, law, &config), name);
            return;
        }
    }
    TEST_FAIL_MESSAGE(name);
}

/* A value that every filter with the parameter takes, one that none takes, and how many have it at least. */
typedef struct {
    const char *name;
    int32_t legal;
    int32_t illegal;
    unsigned by;
    uint8_t trait; /* only filters with it */
} edge_t;

static const edge_t edges[] = {
    { "q", 1, 0, 9, 0 },
    { "q", 1000000000, 1000000001, 9, 0 },
    { "gate", 256, 255, 4, 0 },              /* 1 sigma */
    { "gate", 256, 0, 1, LAW_FIRST_SAMPLE }, /* as published: it cannot be switched off */
    { "gate", 4096, 4097, 4, 0 },
    { "softgate", 0, 255, 1, 0 },
    { "softgate", 4096, 4097, 1, 0 },
    { "reacquire", 9, 10, 2, 0 },
    { "ratemax", 10, 9, 6, 0 },
    { "ratemax", 1000000, 1000001, 6, 0 },
    { "clean", 55706, 0, 4, 0 }, /* a probability of 0 */
    { "clean", 32768, 32767, 3, LAW_GATED },
    { "clean", 65470, 65471, 3, LAW_GATED },
    { "ratio", 5120, 255, 4, 0 },
    { "ratio", 512, 511, 3, LAW_GATED },
    { "a1", -65535, -65536, 1, 0 },
    { "a1", 65535, 65536, 1, 0 },
    { "b0", 656, 655, 2, 0 },
    { "b0", 65535, 65536, 2, 0 },
    { "b1", -65535, -65536, 1, 0 },
    { "b1", 65535, 65536, 1, 0 },
    { "b2", -65535, -65536, 1, 0 },
    { "b2", 65535, 65536, 1, 0 },
    { "k", 8, 9, 1, 0 },
    { "u", 1, 2, 1, 0 },
    { "p0", 3, 2, 1, 0 },
    { "p0", 25600000, 25600001, 1, 0 },
    { "guard", 0, 255, 1, 0 },
    { "guard", 256, 255, 1, 0 },
    { "guard", 4096, 4097, 1, 0 },
    { "identify", 1, 2, 1, 0 },
    { "slow", 10, 0, 2, 0 },
    { "slow", 10, 9, 1, LAW_FINE_RATE }, /* the slowest memory of a single filter */
    { "slow", 60000, 60001, 2, 0 },
    { "middle", 1, 0, 1, 0 },
    { "middle", 60000, 60001, 1, 0 },
    { "fast", 1, 0, 2, 0 },
    { "fast", 60000, 60001, 2, 0 },
    { "confirm", 0, -1, 1, 0 },
    { "confirm", 10000, 10001, 1, 0 },
};

static unsigned judged_by_all(const edge_t *row)
{
    unsigned count = 0;
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_law_t *law = filter_listed((filter_kind_t)kind);
        uint8_t place = parameter_named((filter_kind_t)kind, row->name);
        if ((law->traits & row->trait) == row->trait && place != FILTER_PARAMETERS_MAX) {
            TEST_ASSERT_TRUE_MESSAGE(filter_in_range(filter_parameter(law, place), row->legal), row->name);
            assert_refused_for((filter_kind_t)kind, row->name, row->illegal);
            count++;
        }
    }
    return count;
}

TEST(test_a_refusal_names_the_parameter)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        assert_refused_for((filter_kind_t)kind, "r", 0);
        assert_refused_for((filter_kind_t)kind, "r", FILTER_R_MAX_LSB2_Q8 + 1);
    }
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        TEST_ASSERT_TRUE_MESSAGE(judged_by_all(&edges[i]) >= edges[i].by, edges[i].name);
    }
}

/* The first of several, the rate before all; off is no reason; an even run of samples lies within 3..9. */
TEST(test_a_refusal_tells_rate_and_combinations_apart)
{
    const filter_law_t *robust = filter_listed(robust_kind());
    const filter_law_t *light = filter_listed(light_kind());
    uint8_t q = parameter_named(robust_kind(), "q");
    uint8_t gate = parameter_named(robust_kind(), "gate");
    filter_config_t config = filter_defaults(robust, 1000);
    config.value[gate] = 0;
    config.value[parameter_named(robust_kind(), "reacquire")] = 4;
    filter_t f;
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_TOGETHER, filter_init(&f, robust, &config));
    config.value[gate] = 1;
    config.value[q] = 0;
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_FIRST + q, filter_init(&f, robust, &config));
    config.rate_dhz = FILTER_RATE_MIN_DHZ - 1U;
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_RATE, filter_init(&f, robust, &config));
    config = filter_defaults(light, 1000);
    config.value[parameter_named(light_kind(), "b0")] = 6554;
    config.value[parameter_named(light_kind(), "a1")] = -65000; /* outside the stability region */
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_TOGETHER, filter_init(&f, light, &config));
}

/* The gain at which a filter settles with this q, and whether it says that q is limited. */
static uint16_t settled_gain(const filter_law_t *law, filter_config_t config, uint8_t q, int32_t value, bool *limited)
{
    filter_t f;
    filter_probe_t probe;
    config.value[q] = value;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, law, &config));
    filter_reset(&f, 0);
    (void)filter_update(&f, 0);
    filter_probe(&f, &probe);
    *limited = filter_limited(&f);
    return probe.gain_uq16;
}

/* Ten times the q gives the same gain if both are said to be limited, and another one if neither is. */
TEST(test_a_limited_q_is_said)
{
    static const uint16_t rates_dhz[] = { 125, 1000, 8000, 32000 };
    static const int32_t noises_lsb2_q8[] = { FILTER_R_MIN_LSB2_Q8, 768, 256 * 1000 };
    unsigned within = 0;
    unsigned beyond = 0;
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const filter_law_t *law = filter_listed((filter_kind_t)kind);
        uint8_t q = parameter_named((filter_kind_t)kind, "q");
        for (size_t i = 0; q != FILTER_PARAMETERS_MAX && i < 12; i++) {
            filter_config_t config = filter_defaults(law, rates_dhz[i / 3]);
            config.value[parameter_named((filter_kind_t)kind, "r")] = noises_lsb2_q8[i % 3];
            bool limited_before;
            uint16_t before = settled_gain(law, config, q, 1, &limited_before);
            for (uint32_t value = 10; value <= 1000000000u; value *= 10u) {
                bool limited;
                uint16_t gain = settled_gain(law, config, q, (int32_t)value, &limited);
                if (limited == limited_before) {
                    TEST_ASSERT_EQUAL_MESSAGE(limited, gain == before, filter_name(law));
                }
                within += !limited;
                beyond += limited;
                limited_before = limited;
                before = gain;
            }
        }
    }
    TEST_ASSERT_TRUE(within > 100 && beyond > 100);
}
