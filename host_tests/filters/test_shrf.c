/* shrf in integers, on the PC and on the chip: outliers unused, no lock-out. Against double: test_wide_reference.c. */
#include "support/test_law.h"

/* 100 Hz, settled at 0. */
static filter_t settled(int32_t r_lsb2_q8)
{
    filter_config_t config = filter_defaults(&filter_law_shrf, 1000);
    config.value[MIXTURE_R_LSB2_Q8] = r_lsb2_q8;
    filter_t f = made(&filter_law_shrf, &config);
    filter_reset(&f, 0);
    return f;
}

/* Unlike pbf: not by a 400th, not at all; P is the prediction's. */
TEST(clear_outlier_is_not_used_at_all)
{
    filter_t f = settled(16U * 256U);
    filter_t predicted = f;
    (void)coast(&predicted);
    TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, 4000));
    TEST_ASSERT_EQUAL_INT32(0, f.rate_lsb);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    TEST_ASSERT_EQUAL_UINT16(0, f.gain_uq16);
    TEST_ASSERT_EQUAL_UINT32(predicted.own.mixture.core.p.p11, f.own.mixture.core.p.p11);
    TEST_ASSERT_EQUAL_UINT32(predicted.own.mixture.core.p.p22, f.own.mixture.core.p.p22);
}

/* m = p / S: at 4.2 sigma it counts a little, and P grows by p (1 - p) r^2, which pbf has times b^2. */
TEST(doubtful_sample_counts_a_little_and_lets_p_grow)
{
    filter_t f = settled(16U * 256U);
    filter_t predicted = f;
    (void)coast(&predicted);
    (void)filter_update(&f, 18);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    TEST_ASSERT_TRUE(f.gain_uq16 > 0U && f.gain_uq16 < 4000U);
    TEST_ASSERT_TRUE(f.own.mixture.core.p.p11 > predicted.own.mixture.core.p.p11);
}

/* 1..100 sigma, within 1,200 samples, the limit. */
TEST(every_step_is_followed)
{
    static const int16_t steps_lsb[] = { 4, 8, 20, 40, 80, 200, 400 };
    for (uint8_t i = 0; i < 7; i++) {
        filter_t f = settled(16U * 256U);
        feed(&f, steps_lsb[i], 1200);
        TEST_ASSERT_INT32_WITHIN(65536, (int32_t)steps_lsb[i] * 65536, f.x_lsb_q16);
    }
}

/* 4000 LSB at R = 0.0117: 37,000 sigma. P comes to the end of its range, and the filter restarts. */
TEST(step_beyond_the_range_of_p_restarts_it)
{
    filter_t f = settled(FILTER_R_MIN_LSB2_Q8);
    uint16_t k = 0;
    while (filter_update(&f, 4000) < (int32_t)3990 * 65536 && k < 400U) {
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
        k++;
    }
    TEST_ASSERT_TRUE(k > 3U && k < 400U);
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
}
