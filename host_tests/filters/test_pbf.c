/* pbf in integers, on PC and chip: what an outlier moves, recovery. Against double: test_wide_reference.c. */
#include "support/test_law.h"

/* 100 Hz, R 16 LSB^2: sigma 4 LSB; settled at level. */
static filter_t settled(int16_t level)
{
    filter_config_t config = filter_defaults(&filter_law_pbf, 1000);
    config.value[MIXTURE_R_LSB2_Q8] = 16U * 256U;
    filter_t f = made(&filter_law_pbf, &config);
    feed(&f, level, 300);
    return f;
}

/* Table 1: 0.85 and 20. */
TEST(defaults_are_the_papers)
{
    filter_config_t config = filter_defaults(&filter_law_pbf, 1000);
    TEST_ASSERT_EQUAL_INT32(55706, config.value[MIXTURE_CLEAN_UQ16]);
    TEST_ASSERT_EQUAL_INT32(20 * 256, config.value[MIXTURE_RATIO_UQ8]);
}

/*
 * Beyond doubt an outlier counts with Kalman's gain P11 / S times S / S_N, that is P11 / (P11 + 400): r = 4000 LSB
 * against sigma 4.
 */
TEST(outlier_moves_the_estimate_by_its_small_gain)
{
    filter_t f = settled(0);
    filter_t predicted = f;
    (void)coast(&predicted);
    uint32_t p11 = predicted.own.mixture.core.p.p11;
    int32_t step_q16 = (int32_t)((uint64_t)p11 * 4000U * 65536U / (p11 + 400UL * 65536UL));
    int32_t x = filter_update(&f, 4000);
    TEST_ASSERT_INT32_WITHIN(step_q16 / 50, step_q16, x);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    TEST_ASSERT_TRUE(f.gain_uq16 != 0U);
}

/* The posterior decides: at 1 sigma p = 0.98, at 10 p = 0; 1/2 where b t / 2 = ln(0.85 / 0.15) + ln(S_N / S) / 2. */
TEST(flag_means_more_likely_an_outlier_than_not)
{
    filter_t f = settled(0);
    filter_t near = f;
    filter_t far = f;
    (void)filter_update(&near, 4);
    (void)filter_update(&far, 40);
    TEST_ASSERT_EQUAL_UINT8(0, near.flags);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, far.flags);
    TEST_ASSERT_TRUE(far.gain_uq16 < near.gain_uq16 / 50U);
}

/* P grows where the sample is neither clearly normal nor clearly an outlier: that opens the filter to a step. */
TEST(doubt_makes_p_grow)
{
    filter_t f = settled(0);
    filter_t predicted = f;
    (void)coast(&predicted);
    (void)filter_update(&f, 15); /* 3.5 sigma of the innovation */
    TEST_ASSERT_TRUE(f.own.mixture.core.p.p11 > predicted.own.mixture.core.p.p11);
}

TEST(step_of_100_sigma_is_followed_within_800_samples)
{
    filter_t f = settled(0);
    uint16_t k = 0;
    while (f.x_lsb_q16 < (int32_t)384 * 65536 && k < 800U) {
        (void)filter_update(&f, 400);
        k++;
    }
    TEST_ASSERT_TRUE(k < 800U);
    for (k = 0; k < 200; k++) {
        (void)filter_update(&f, 400);
    }
    TEST_ASSERT_INT32_WITHIN(65536, (int32_t)400 * 65536, f.x_lsb_q16);
}

TEST(every_second_sample_an_outlier_does_not_lead_it_away)
{
    filter_t f = settled(0);
    for (uint16_t k = 0; k < 400; k++) {
        int32_t x = filter_update(&f, (k & 1U) != 0U ? (int16_t)(((k & 2U) != 0U) ? 2000 : -2000) : 0);
        TEST_ASSERT_INT32_WITHIN((int32_t)16 * 65536, 0, x);
    }
}

/* stay against clean 0.85: from 0.15 on; against N = 2: below 2/3; up to 500 Hz: else they do not go together. */
TEST(stay_goes_with_the_share_and_the_ratio)
{
    static const struct {
        int32_t stay, ratio_q8;
        filter_answer_t answer;
    } cases[] = { { 9829, 5120, FILTER_REFUSED_TOGETHER },
                  { 9830, 5120, FILTER_ACCEPTED },
                  { 43690, 512, FILTER_ACCEPTED },
                  { 43691, 512, FILTER_REFUSED_TOGETHER },
                  { 62415, 5120, FILTER_ACCEPTED },
                  { 62416, 5120, FILTER_REFUSED_TOGETHER },
                  { 0, 512, FILTER_ACCEPTED } };
    for (uint8_t i = 0; i < 7U; i++) {
        filter_config_t config = filter_defaults(&filter_law_pbf, 5000);
        config.value[MIXTURE_STAY_UQ16] = cases[i].stay;
        config.value[MIXTURE_RATIO_UQ8] = cases[i].ratio_q8;
        filter_t f;
        TEST_ASSERT_EQUAL_UINT8(cases[i].answer, filter_init(&f, &filter_law_pbf, &config));
        config.rate_dhz = 5001;
        TEST_ASSERT_EQUAL_UINT8((cases[i].stay == 0) ? FILTER_ACCEPTED : FILTER_REFUSED_TOGETHER,
                                filter_init(&f, &filter_law_pbf, &config));
    }
}

/*
 * After an outlier q is 1 - stay = 0.2; a missing sample leaves turn = (0.85 + 0.8 - 1) / 0.85 = 0.765 of its distance
 * to the share of normal samples, 0.85.
 */
TEST(a_chain_fades_over_missing_samples)
{
    filter_config_t config = filter_defaults(&filter_law_pbf, 1000);
    config.value[MIXTURE_STAY_UQ16] = 52429;
    filter_t f = made(&filter_law_pbf, &config);
    filter_reset(&f, 0);
    (void)filter_update(&f, 4000);
    TEST_ASSERT_UINT32_WITHIN(3000, 3355443UL, f.own.mixture.normal_uq24); /* 0.2 */
    (void)filter_missing(&f);
    TEST_ASSERT_UINT32_WITHIN(3000, 5921370UL, f.own.mixture.normal_uq24); /* 0.2 + 0.2 x 0.765 = 0.85 - 0.65 x 0.765 */
    for (uint8_t k = 0; k < 7U; k++) {
        (void)filter_missing(&f);
    }
    filter_reset(&f, 0);
    TEST_ASSERT_EQUAL_UINT32(55706UL << 8, f.own.mixture.normal_uq24);
}
