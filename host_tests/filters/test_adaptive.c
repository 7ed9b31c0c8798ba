/* The guarded adaptive filter: what it does with a ramp, outliers, a burst, a jump; limits of its parameters. */
#include "adaptive.h"
#include "support/test_law.h"

enum { NOISE_LSB = 8 }; /* uniform, +-8 LSB: sigma 4.9 */

static uint32_t random_state;

void setUp(void)
{
    random_state = 77u;
}

static int16_t noisy(int16_t level_lsb)
{
    return (int16_t)(level_lsb + (int16_t)random32_below(&random_state, 2u * NOISE_LSB + 1u) - NOISE_LSB);
}

/* Settled at a level, 100 Hz. */
static filter_t settled(int16_t level_lsb, bool guarded)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    if (!guarded) {
        config.value[ADAPTIVE_GUARD_SIGMA_Q8] = 0;
    }
    filter_t f = made(&filter_law_adaptive, &config);
    for (uint16_t k = 0; k < 600u; k++) {
        (void)filter_update(&f, noisy(level_lsb));
    }
    return f;
}

static int16_t whole(int32_t x_lsb_q16)
{
    return (int16_t)((x_lsb_q16 + 32768) >> 16);
}

/* Far beyond twice the gate nothing is taken: the estimate goes on as if the sample were missing. */
TEST(an_isolated_outlier_moves_nothing)
{
    filter_t f = settled(100, true);
    (void)filter_update(&f, 92); /* the one before lies on the other side */
    filter_t without = f;
    int32_t expected = coast(&without);
    TEST_ASSERT_EQUAL_INT32(expected, filter_update(&f, 2000));
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_UINT16(0, probe.gain_uq16);
    TEST_ASSERT_TRUE(probe.innovation_lsb_q16 > 1800L * 65536);
    TEST_ASSERT_TRUE(probe.gate_lsb2_q8 < 100UL * 100UL * 256UL);
}

/* The twin: without the guard it passes with its gain. */
TEST(without_the_guard_an_outlier_passes)
{
    filter_t f = settled(100, false);
    TEST_ASSERT_TRUE(whole(filter_update(&f, 2000)) > 150);
    TEST_ASSERT_EQUAL_UINT8(0, f.flags & FILTER_GATED);
}

/* Nine doubled readings, the longest burst that was measured on a shared bus, do not reach `confirm` (12 samples). */
TEST(a_burst_of_nine_is_not_believed)
{
    filter_t f = settled(250, true);
    for (uint8_t k = 0; k < 9u; k++) {
        int16_t x = whole(filter_update(&f, noisy(500)));
        TEST_ASSERT_INT16_WITHIN(120, 250, x);
        TEST_ASSERT_EQUAL_UINT8(0, f.flags & FILTER_REACQUIRED);
    }
    for (uint8_t k = 0; k < 60u; k++) {
        (void)filter_update(&f, noisy(250));
    }
    TEST_ASSERT_INT16_WITHIN(NOISE_LSB, 250, whole(f.x_lsb_q16));
}

/* A jump that stays is believed with the twelfth sample at the latest, and from then on the estimate is there. */
TEST(a_jump_that_stays_is_believed)
{
    filter_t f = settled(0, true);
    bool again = false;
    for (uint8_t k = 0; k < 12u; k++) {
        (void)filter_update(&f, noisy(900));
        again = again || (f.flags & FILTER_REACQUIRED) != 0U;
    }
    TEST_ASSERT_TRUE(again);
    TEST_ASSERT_INT16_WITHIN(3 * NOISE_LSB, 900, whole(f.x_lsb_q16));
}

/* A manoeuvre within what motion can do is followed without waiting: 300 LSB/s from rest at 100 Hz, 10 samples late. */
TEST(motion_is_followed_and_shortens_the_memory)
{
    filter_t f = settled(0, true);
    uint32_t slow = f.own.adaptive.k_uq32;
    uint32_t shortest = 0;
    int16_t level = 0;
    for (uint8_t k = 0; k < 100u; k++) {
        level = (int16_t)(level + 3);
        (void)filter_update(&f, noisy(level));
        shortest = (f.own.adaptive.k_uq32 > shortest) ? f.own.adaptive.k_uq32 : shortest;
    }
    TEST_ASSERT_INT16_WITHIN(2 * NOISE_LSB, level, whole(f.x_lsb_q16));
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_INT32_WITHIN(65536, 3L * 65536, probe.rate_lsb_q16);
    TEST_ASSERT_EQUAL_UINT16(f.own.adaptive.fast_uq16, (uint16_t)(shortest >> 16));
    TEST_ASSERT_TRUE(slow < shortest / 2U);
}

/* At rest the memory grows by half a sample per sample, to the slowest: k = 2/N falls from 1/2 as 2 / (4 + n/2). */
TEST(memory_grows_by_half_a_sample)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    config.value[ADAPTIVE_SLOW_MS] = 60000;
    filter_t f = made(&filter_law_adaptive, &config);
    feed(&f, 0, 405);
    double memory = 2.0 * 4294967296.0 /
                    (double)f.own.adaptive.k_uq32; /* 4 + 200, and 1/k grows a little faster at first */
    TEST_ASSERT_TRUE(memory > 200.0 && memory < 212.0);
}

/* Mean of the scatter over the last four fifths of 2000 noisy samples, LSB / 256; R = 100 is set after each of them. */
static uint32_t mean_scatter_uq8(bool identify)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    config.value[ADAPTIVE_IDENTIFY] = identify ? 1 : 0;
    filter_t f = made(&filter_law_adaptive, &config);
    uint32_t sum = 0;
    for (uint16_t k = 0; k < 2000u; k++) {
        (void)filter_update(&f, noisy(0));
        if (!identify || k >= FILTER_WARM_UP_SAMPLES) {
            filter_set_noise(&f, 100u * 256u);
        }
        sum += (k >= 400u) ? f.own.adaptive.scatter_lsb_uq24 >> 16 : 0U;
    }
    return sum / 1600u;
}

/*
 * Off, sigma is the one set last. On, it is set too late to count: the scatter is at least the 0.972 sigma of
 * Gaussian noise at the shortest memory (reference_adaptive_scatter) and at most the 1.000 of the slowest times 1.11,
 * since a mean size of uniform noise is 0.866 sigma instead of the 0.798 of Gaussian. Sigma is 4.90 LSB (variance
 * (17^2 - 1) / 12); 9 % for chance: three deviations of a mean over 800 terms, of which 31 weigh in each value.
 */
TEST(what_identification_off_means)
{
    TEST_ASSERT_EQUAL_UINT32(10u * 256u, mean_scatter_uq8(false));
    uint32_t scatter_uq8 = mean_scatter_uq8(true);
    TEST_ASSERT_TRUE(scatter_uq8 >= 1107u); /* 0.882 x 4.90 */
    TEST_ASSERT_TRUE(scatter_uq8 <= 1518u); /* 1.210 x 4.90 */
}

/*
 * Across a gap no sample agrees with the one before it. Of the two one is a term of the scatter, limited to 2.5 times
 * what is expected: 1.5 (1 + k) / 16 more, k <= 0.2.
 */
TEST(a_gap_breaks_agreement)
{
    filter_t f = settled(0, true);
    uint32_t scatter = f.own.adaptive.scatter_lsb_uq24;
    (void)filter_update(&f, 700);
    (void)coast(&f);
    int32_t before = f.x_lsb_q16;
    (void)filter_update(&f, 700);
    TEST_ASSERT_INT32_WITHIN(65536, before, f.x_lsb_q16);
    TEST_ASSERT_TRUE(f.own.adaptive.scatter_lsb_uq24 > scatter);
    TEST_ASSERT_TRUE(f.own.adaptive.scatter_lsb_uq24 < scatter + scatter / 8U);
}

/* A prediction at the end of the range and a sample beyond the gate: both are flagged. */
TEST(a_gated_sample_keeps_the_saturation)
{
    filter_t f = settled(100, true);
    f.own.adaptive.gate_sigma_q8 = 8u * 256u;
    f.x_lsb_q16 = 4600L * 65536;
    f.rate_lsb = 20L * 16777216;
    f.negative = false;
    (void)filter_update(&f, 4095);
    TEST_ASSERT_TRUE(f.x_lsb_q16 < 4608L * 65536);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED | FILTER_SATURATED, f.flags);
}

/* Memories out of reach are limited, not refused: to 3.3 (k = 0.6) and 4096 samples, the shortest to the slowest. */
TEST(memories_are_limited)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    config.value[ADAPTIVE_SLOW_MS] = 10; /* one sample */
    config.value[ADAPTIVE_FAST_MS] = 1;
    filter_t f = made(&filter_law_adaptive, &config);
    TEST_ASSERT_EQUAL_UINT16(39322, f.own.adaptive.slow_uq16);
    TEST_ASSERT_EQUAL_UINT16(39322, f.own.adaptive.fast_uq16);
    config.value[ADAPTIVE_SLOW_MS] = 60000; /* 6000 samples */
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_adaptive, &config));
    TEST_ASSERT_EQUAL_UINT16(32, f.own.adaptive.slow_uq16);
    config.value[ADAPTIVE_SLOW_MS] = 200;
    config.value[ADAPTIVE_FAST_MS] = 500;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_adaptive, &config));
    TEST_ASSERT_EQUAL_UINT16(6553, f.own.adaptive.slow_uq16);
    TEST_ASSERT_EQUAL_UINT16(6553, f.own.adaptive.fast_uq16);
}

TEST(reset_keeps_the_noise)
{
    filter_t f = settled(100, true);
    filter_t before = f;
    filter_reset(&f, -50);
    TEST_ASSERT_EQUAL_UINT32(before.own.adaptive.scatter_lsb_uq24, f.own.adaptive.scatter_lsb_uq24);
    TEST_ASSERT_EQUAL_UINT8(ADAPTIVE_OPENING_TERMS, f.own.adaptive.learnt);
    TEST_ASSERT_EQUAL_INT32(-50L * 65536, f.x_lsb_q16);
    TEST_ASSERT_EQUAL_INT32(0, f.rate_lsb);
    TEST_ASSERT_EQUAL_INT32(0, f.own.adaptive.mean_lsb_q24);
    TEST_ASSERT_EQUAL_UINT8(ADAPTIVE_UNUSED, f.own.adaptive.verdict);
    TEST_ASSERT_EQUAL_UINT32((uint32_t)f.own.adaptive.slow_uq16 << 16, f.own.adaptive.k_uq32);
}

/* The one rule for all rates: fast 80 ms and two samples, slow 20 samples and half a second, 3 sigma below 20 Hz. */
TEST(defaults_follow_one_rule)
{
    static const uint16_t rates_dhz[] = { 100, 199, 200, 250, 500, 1000, 2000, 4000, 8000, 40000 };
    for (uint8_t i = 0; i < 10u; i++) {
        filter_config_t config = filter_defaults(&filter_law_adaptive, rates_dhz[i]);
        TEST_ASSERT_EQUAL_INT32(80u + 20000u / rates_dhz[i], config.value[ADAPTIVE_FAST_MS]);
        TEST_ASSERT_EQUAL_INT32(rates_dhz[i] < 400u ? 200000UL / rates_dhz[i] : 500u, config.value[ADAPTIVE_SLOW_MS]);
        TEST_ASSERT_EQUAL_INT32(rates_dhz[i] < 200u ? 768u : 1152u, config.value[ADAPTIVE_GUARD_SIGMA_Q8]);
        TEST_ASSERT_EQUAL_INT32(1, config.value[ADAPTIVE_IDENTIFY]);
    }
}

/* A sigma of 3 LSB learnt from noise; a restart that lost it would have the configured 1.7, the root of R = 3. */
TEST(restart_keeps_what_was_learnt_of_the_noise)
{
    filter_t f = made_default(&filter_law_adaptive, 1000);
    for (uint16_t k = 0; k < 2000U; k++) {
        uint32_t v = random32(&random_state);
        int16_t sum = (int16_t)((v & 15U) + ((v >> 8) & 15U) + ((v >> 16) & 15U) + ((v >> 24) & 15U));
        (void)filter_update(&f, (int16_t)(sum / 3)); /* sigma 4.6 x 2 / 3 */
    }
    uint32_t scatter_lsb_uq24 = f.own.adaptive.scatter_lsb_uq24;
    TEST_ASSERT_TRUE(scatter_lsb_uq24 > 37520000UL); /* sqrt(5) LSB */
    filter_restart(&f);
    TEST_ASSERT_EQUAL_UINT32(scatter_lsb_uq24, f.own.adaptive.scatter_lsb_uq24);
}
