/*
 * Generic properties, over the list of filters: what every filter of lib/filters promises, whatever its rule. Runs on
 * the PC and on the chip. Facts about single laws live in support_law_NAME.c.
 */
#include "support/test_law.h"

#include <string.h>

#define SEED 20021UL

static uint32_t random_state;

void setUp(void)
{
    random_state = SEED;
}

static filter_t made_random(uint8_t kind)
{
    filter_t f;
    uint32_t refused = 0;
    TEST_ASSERT_TRUE(init_random(&f, (filter_kind_t)kind, &random_state, &refused));
    return f;
}

static int16_t any_sample(void)
{
    return (int16_t)((int32_t)(random32(&random_state) >> 16) - 32768);
}

static void assert_bounds(const filter_t *f, int32_t x_lsb_q16)
{
    filter_probe_t probe = probe_of(f);
    const char *broken = broken_bound(f, &probe, x_lsb_q16);
    if (broken != NULL) {
        TEST_FAIL_MESSAGE(broken);
    }
}

static void assert_same_probe(const filter_t *a, const filter_t *b)
{
    filter_probe_t of_a;
    filter_probe_t of_b;
    memset(&of_a, 0, sizeof of_a);
    memset(&of_b, 0, sizeof of_b);
    filter_probe(a, &of_a);
    filter_probe(b, &of_b);
    TEST_ASSERT_EQUAL_MEMORY(&of_a, &of_b, sizeof of_a);
}

TEST(every_name_finds_its_kind_and_no_other_does)
{
    FOR_EACH_KIND(kind)
    {
        char name[16];
        uint8_t length = 0;
        do {
            name[length] = (char)flash_u8((const uint8_t *)filter_listed_name((filter_kind_t)kind) + length);
        } while (name[length++] != '\0');
        TEST_ASSERT_EQUAL_INT(kind, filter_find(name));
        name[length - 1U] = 'x';
        name[length] = '\0';
        TEST_ASSERT_EQUAL_INT(FILTER_KIND_COUNT, filter_find(name));
        name[length - 2U] = '\0'; /* kf3 without its end is another's name */
        TEST_ASSERT_NOT_EQUAL_INT(kind, filter_find(name));
    }
    TEST_ASSERT_EQUAL_INT(FILTER_KIND_COUNT, filter_find(""));
}

/* Sensor rates, and both ends of the legal range of rates. */
TEST(defaults_are_legal_at_every_rate)
{
    static const uint16_t rates[] = { 50, 125, 250, 500, 1000, 2000, 4000, 8000, 40000 };
    FOR_EACH_KIND(kind)
    {
        for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
            (void)made_kind(kind, rates[i]);
        }
    }
}

TEST(there_is_no_law_of_an_unknown_kind)
{
    TEST_ASSERT_NULL(filter_listed(FILTER_KIND_COUNT));
    TEST_ASSERT_NULL(filter_listed((filter_kind_t)(FILTER_KIND_COUNT + 1)));
}

/* Init must refuse the configuration, say why, and leave every byte of the filter as it was. */
static void assert_refused(uint8_t kind, const filter_config_t *config, filter_answer_t reason)
{
    filter_t f;
    filter_t before;
    memset(&f, 0xA5, sizeof f);
    memcpy(&before, &f, sizeof f);
    TEST_ASSERT_EQUAL_UINT8(reason, filter_init(&f, filter_listed((filter_kind_t)kind), config));
    TEST_ASSERT_EQUAL_MEMORY(&before, &f, sizeof f);
}

/* A value of a parameter in an otherwise default configuration. */
static void try_value(uint8_t kind, uint8_t index, int32_t value)
{
    const filter_law_t *law = filter_listed((filter_kind_t)kind);
    filter_parameter_t parameter = parameter_at((filter_kind_t)kind, index);
    filter_config_t config = filter_defaults(law, 1000);
    config.value[index] = value;
    if (!parameter_legal(&parameter, value)) {
        assert_refused(kind, &config, (filter_answer_t)(FILTER_REFUSED_FIRST + index));
    } else if (!law_facts((filter_kind_t)kind).joint_condition) {
        filter_t f;
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(FILTER_ACCEPTED, filter_init(&f, law, &config),
                                        parameter_name((filter_kind_t)kind, index));
    }
}

/* Each descriptor's limits, one step inside and outside, zero, and the extremes of the field. */
TEST(parameters_are_taken_within_their_range_only)
{
    FOR_EACH_KIND(kind)
    {
        TEST_ASSERT_TRUE(parameter_count((filter_kind_t)kind) > 0U);
        for (uint8_t i = 0; i < parameter_count((filter_kind_t)kind); i++) {
            filter_parameter_t p = parameter_at((filter_kind_t)kind, i);
            TEST_ASSERT_FALSE_MESSAGE(parameter_legal(&p, p.max + 1), parameter_name((filter_kind_t)kind, i));
            const int32_t values[] = { p.min,     p.max,     p.min - 1, p.max + 1, p.min - 2,
                                       p.max + 2, p.min / 2, p.max * 2, INT32_MIN, INT32_MAX,
                                       0x8000,    0x7FFF,    0,         1,         -1 };
            for (size_t v = 0; v < sizeof values / sizeof values[0]; v++) {
                try_value(kind, i, values[v]);
            }
        }
    }
}

TEST(rates_outside_5_to_4000_hz_are_refused)
{
    static const uint16_t rates[] = { 0, 49, 40001, 65535 };
    FOR_EACH_KIND(kind)
    {
        for (uint8_t i = 0; i < 4; i++) {
            filter_config_t config = filter_defaults(filter_listed((filter_kind_t)kind), 1000);
            config.rate_dhz = rates[i];
            assert_refused(kind, &config, FILTER_REFUSED_RATE);
        }
    }
}

static void assert_constant_stays(filter_t *f, int16_t level, uint16_t samples)
{
    filter_reset(f, level);
    for (uint16_t k = 0; k < samples; k++) {
        TEST_ASSERT_EQUAL_INT32((int32_t)level * 65536, filter_update(f, level));
        TEST_ASSERT_EQUAL_UINT8(0, f->flags);
    }
}

/* An innovation of 0 moves nothing: exact, with any gain. */
TEST(constant_in_constant_out_after_reset)
{
    static const int16_t levels[] = { -4096, -1, 0, 1, 255, 4095 };
    FOR_EACH_KIND(kind)
    {
        for (uint8_t i = 0; i < 6; i++) {
            filter_t f = made_kind(kind, 1000);
            assert_constant_stays(&f, levels[i], 300);
        }
        for (uint16_t run = 0; run < ON_PC_OR_CHIP(2000, 20); run++) {
            filter_t f = made_random(kind);
            assert_constant_stays(&f, (int16_t)(any_sample() / 8), 50);
        }
    }
}

/* Medians by hand: {9}, {9,-3}, {9,-3,500}, {9,-3,500,8}, {9,-3,500,8,7}; twice each to stay whole. */
TEST(warm_up_puts_out_the_running_median)
{
    static const int16_t in[] = { 9, -3, 500, 8, 7 };
    static const int16_t twice_median[] = { 18, 6, 18, 17, 16 };
    FOR_EACH_KIND_WITH_MEDIAN(kind)
    {
        filter_t f = made_kind(kind, 1000);
        for (uint8_t k = 0; k < 5; k++) {
            TEST_ASSERT_EQUAL_INT32((int32_t)twice_median[k] * 32768, filter_update(&f, in[k]));
            TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP, f.flags);
            assert_bounds(&f, (int32_t)twice_median[k] * 32768); /* among them: no rate yet */
        }
        (void)filter_update(&f, 8);
        TEST_ASSERT_EQUAL_UINT8(0, f.flags & FILTER_WARMING_UP);
    }
}

TEST(a_missing_sample_in_warm_up_keeps_the_median)
{
    FOR_EACH_KIND_WITH_MEDIAN(kind)
    {
        filter_t f = made_kind(kind, 1000);
        (void)filter_update(&f, 40);
        TEST_ASSERT_EQUAL_INT32((int32_t)40 * 65536, filter_missing(&f));
        TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP | FILTER_COASTED, f.flags);
    }
}

/* A missing sample whose rate is not halved: halving rounds down, not towards zero. */
static int32_t predicted(filter_t *f)
{
    return (f->collected == FILTER_RUNNING) ? coast_only(f) : filter_missing(f);
}

/* Steps, noise and missing samples; never -4096, whose mirror image the sensor does not have. */
TEST(mirrored_input_gives_mirrored_output)
{
    FOR_EACH_KIND(kind)
    {
        int32_t tolerance = law_facts((filter_kind_t)kind).mirror_lsb_q16;
        TEST_ASSERT_TRUE(tolerance >= 0);
        for (uint16_t run = 0; run < ON_PC_OR_CHIP(200, 4); run++) {
            filter_t up = made_random(kind);
            filter_t down = up;
            int16_t level = 0;
            for (uint16_t k = 0; k < 250; k++) {
                uint32_t v = random32(&random_state);
                if ((v & 63U) == 0U) {
                    level = (int16_t)(any_sample() / 16);
                }
                int16_t z = (int16_t)(level + (int16_t)((v >> 8) & 0xFFU) - 128);
                bool missing = (v >> 28) == 0U;
                int32_t x = missing ? predicted(&up) : filter_update(&up, z);
                int32_t y = missing ? predicted(&down) : filter_update(&down, (int16_t)-z);
                TEST_ASSERT_INT32_WITHIN(tolerance, x, -y);
            }
        }
    }
}

/* One call of any sort; the estimate after it. */
static int32_t random_call(filter_t *f)
{
    uint8_t what = (uint8_t)(random32(&random_state) >> 24);
    if (what < 200U) {
        return filter_update(f, any_sample());
    }
    if (what < 234U) {
        return filter_missing(f);
    }
    if (what < 240U) {
        filter_restart(f);
    } else if (what < 250U) {
        filter_set_noise(f, random32(&random_state) >> (what & 31U));
    } else {
        filter_reset(f, any_sample());
    }
    return estimate_of(f);
}

/* Whatever came before, a start half collected included: nothing is left but the level. */
TEST(reset_forgets_all_but_the_level)
{
    FOR_EACH_KIND(kind)
    {
        for (uint16_t run = 0; run < ON_PC_OR_CHIP(300, 10); run++) {
            filter_t f = made_random(kind);
            for (uint16_t k = run % 12U; k != 0U; k--) {
                (void)filter_update(&f, any_sample());
            }
            int16_t level = (int16_t)(any_sample() / 8);
            filter_reset(&f, level);
            filter_probe_t probe = probe_of(&f);
            TEST_ASSERT_EQUAL_INT32((int32_t)level * 65536, probe.x_lsb_q16);
            TEST_ASSERT_EQUAL_INT32(0, probe.rate_lsb_q16);
            TEST_ASSERT_EQUAL_INT32(0, probe.innovation_lsb_q16);
            TEST_ASSERT_EQUAL_UINT8(0, probe.flags);
        }
    }
}

/* The same calls for the original and its copy, by turns, so that nothing outside the state could tell them apart. */
TEST(copy_goes_on_like_the_original)
{
    FOR_EACH_KIND(kind)
    {
        for (uint16_t run = 0; run < ON_PC_OR_CHIP(100, 4); run++) {
            filter_t copy;
            filter_t f = made_random(kind);
            for (uint8_t k = 0; k < 100; k++) {
                if (k == 10U) {
                    memcpy(&copy, &f, sizeof f);
                }
                uint32_t before = random_state;
                int32_t x = random_call(&f);
                if (k >= 10U) {
                    random_state = before;
                    TEST_ASSERT_EQUAL_INT32(x, random_call(&copy));
                    assert_same_probe(&f, &copy);
                    TEST_ASSERT_EQUAL_MEMORY(&f, &copy, sizeof f);
                }
            }
        }
    }
}

/* A stream in one go, and in two blocks of which the second meets a copy of the state while the original is spoilt. */
TEST(two_halves_are_the_whole)
{
    FOR_EACH_KIND(kind)
    {
        for (uint16_t run = 0; run < ON_PC_OR_CHIP(300, 4); run++) {
            filter_t whole = made_random(kind);
            filter_t first;
            filter_t second;
            memcpy(&first, &whole, sizeof whole);
            uint16_t cut = (uint16_t)random32_below(&random_state, 100);
            uint32_t calls = random_state;
            for (uint16_t k = 0; k < 100; k++) {
                (void)random_call(&whole);
            }
            random_state = calls;
            for (uint16_t k = 0; k < cut; k++) {
                (void)random_call(&first);
            }
            memcpy(&second, &first, sizeof first);
            memset(&first, 0xA5, sizeof first);
            for (uint16_t k = cut; k < 100; k++) {
                (void)random_call(&second);
            }
            assert_same_probe(&whole, &second);
            TEST_ASSERT_EQUAL_MEMORY(&whole, &second, sizeof whole);
        }
    }
}

/* More of this, on the PC and on the chip alike: bitexact/filter_sequence.c. */
TEST(any_calls_stay_within_bounds)
{
    for (uint16_t run = 0; run < ON_PC_OR_CHIP(2000, 20); run++) {
        filter_t f = made_random(any_kind(run));
        for (uint16_t k = 0; k < ON_PC_OR_CHIP(500, 100); k++) {
            assert_bounds(&f, random_call(&f));
        }
    }
}

/* The largest stretch of one call after the other: a filter on its way to the rail and left to predict. */
TEST(predicting_for_ever_stays_within_bounds)
{
    FOR_EACH_KIND(kind)
    {
        filter_t f = made_kind(kind, 125);
        for (int16_t k = 0; k < 40; k++) {
            (void)filter_update(&f, (int16_t)(k * 60));
        }
        for (uint16_t k = 0; k < ON_PC_OR_CHIP(20000, 500); k++) {
            assert_bounds(&f, coast_only(&f));
            TEST_ASSERT_TRUE((f.flags & FILTER_COASTED) != 0U);
        }
    }
}
