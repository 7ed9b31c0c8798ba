/* shrf in integers, on the PC and on the chip: outliers unused, no lock-out. Against double: test_wide_reference.c. */
#include "shrf.h"
#include "support_filters.h"
#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

/* 100 Hz, settled at 0. */
static shrf_t settled(uint32_t r_lsb2_q8)
{
    shrf_config_t config;
    shrf_t f;
    shrf_defaults(&config, 1000);
    config.r_lsb2_q8 = r_lsb2_q8;
    TEST_ASSERT_TRUE(shrf_init(&f, &config));
    shrf_reset(&f, 0);
    return f;
}

/* Unlike pbf: not by a 400th, not at all; P is the prediction's. */
static void clear_outlier_is_not_used_at_all(void)
{
    shrf_t f = settled(16U * 256U);
    shrf_t predicted = f;
    (void)shrf_coast(&predicted);
    TEST_ASSERT_EQUAL_INT32(0, shrf_update(&f, 4000));
    TEST_ASSERT_EQUAL_INT32(0, f.core.rate_lsb_q16);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, shrf_flags(&f));
    TEST_ASSERT_EQUAL_UINT16(0, f.core.gain_uq16);
    TEST_ASSERT_EQUAL_UINT32(predicted.core.u.p.p11_uq16, f.core.u.p.p11_uq16);
    TEST_ASSERT_EQUAL_UINT32(predicted.core.u.p.p22_uq28, f.core.u.p.p22_uq28);
}

/* m = p / S: at 4.2 sigma it counts a little, and P grows by p (1 - p) r^2, which pbf has times b^2. */
static void doubtful_sample_counts_a_little_and_lets_p_grow(void)
{
    shrf_t f = settled(16U * 256U);
    shrf_t predicted = f;
    (void)shrf_coast(&predicted);
    (void)shrf_update(&f, 18);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, shrf_flags(&f));
    TEST_ASSERT_TRUE(f.core.gain_uq16 > 0U && f.core.gain_uq16 < 4000U);
    TEST_ASSERT_TRUE(f.core.u.p.p11_uq16 > predicted.core.u.p.p11_uq16);
}

/* 1..100 sigma, within 1,200 samples, the limit. */
static void every_step_is_followed(void)
{
    static const int16_t steps_lsb[] = { 4, 8, 20, 40, 80, 200, 400 };
    for (uint8_t i = 0; i < 7; i++) {
        shrf_t f = settled(16U * 256U);
        for (uint16_t k = 0; k < 1200; k++) {
            (void)shrf_update(&f, steps_lsb[i]);
        }
        TEST_ASSERT_INT32_WITHIN(65536, (int32_t)steps_lsb[i] * 65536, f.core.x_lsb_q16);
    }
}

/* 4000 LSB at R = 0.0117: 37,000 sigma. P comes to the end of its range, and the filter restarts. */
static void step_beyond_the_range_of_p_restarts_it(void)
{
    shrf_t f = settled(FILTER_R_MIN_LSB2_Q8);
    uint16_t k = 0;
    while (shrf_update(&f, 4000) < (int32_t)3990 * 65536 && k < 400U) {
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, shrf_flags(&f));
        k++;
    }
    TEST_ASSERT_TRUE(k > 3U && k < 400U);
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, shrf_flags(&f));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(clear_outlier_is_not_used_at_all);
    RUN_TEST(doubtful_sample_counts_a_little_and_lets_p_grow);
    RUN_TEST(every_step_is_followed);
    RUN_TEST(step_beyond_the_range_of_p_restarts_it);
    return UNITY_END();
}
