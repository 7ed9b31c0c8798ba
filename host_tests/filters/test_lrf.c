/* lrf in integers, on the PC and on the chip; against the double reference: test_lrf_reference.c. */
#include "support/test_law.h"

#define SEED 4713UL

static filter_config_t config_100hz(void)
{
    return filter_defaults(&filter_law_lrf, 1000);
}

/* (40) by hand: N^2 - q1 (N^2 - 1) = 400 - 0.85 x 399 = 60.85; 9 - 0.5 x 8 = 5; N = 1: 1. In 2^-16. */
TEST(mean_variance_is_that_of_the_formula)
{
    static const struct {
        uint16_t clean_uq16, ratio_uq8;
        uint32_t factor_uq16;
    } cases[] = { { 55706, 5120, 3987866 }, { 32768, 768, 5UL * 65536 }, { 6554, 256, 65536 } };
    for (uint8_t i = 0; i < 3; i++) {
        filter_config_t config = config_100hz();
        config.value[LRF_CLEAN_UQ16] = cases[i].clean_uq16;
        config.value[LRF_RATIO_UQ8] = cases[i].ratio_uq8;
        filter_t f = made(&filter_law_lrf, &config);
        /* q1 = 0.85 is 55706 / 65536: 0.4 counts of 2^-16 too much, times 399 */
        TEST_ASSERT_UINT32_WITHIN(i == 0 ? 160 : 0, cases[i].factor_uq16, f.own.kalman.of.factor_uq16);
        uint32_t r_mixed = cases[i].factor_uq16 / 256U * (uint32_t)config.value[LRF_R_LSB2_Q8] / 256U;
        TEST_ASSERT_UINT32_WITHIN(r_mixed / 8192U + 2U, r_mixed, f.own.kalman.r_lsb2_q8);
    }
}

TEST(with_ratio_1_it_is_the_kalman_filter)
{
    filter_config_t config = config_100hz();
    config.value[LRF_RATIO_UQ8] = 256;
    filter_t f = made(&filter_law_lrf, &config);
    filter_t k;
    TEST_ASSERT_TRUE(init_plain(&k, &config));
    uint32_t random = SEED;
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(5000, 1000); i++) {
        int16_t z = (int16_t)((int32_t)(random32(&random) >> 16) - 32768);
        TEST_ASSERT_EQUAL_INT32(filter_update(&k, z), filter_update(&f, z));
        if ((i & 255U) == 255U) {
            uint32_t r_lsb2_q8 = random32(&random) >> 12;
            filter_set_noise(&k, r_lsb2_q8);
            filter_set_noise(&f, r_lsb2_q8);
        }
    }
}

/* What lrf is: kf whose R is R_L, to the bit; here 5 R = 15 LSB^2. */
TEST(it_is_the_kalman_filter_of_the_mean_variance)
{
    filter_config_t config = config_100hz();
    config.value[LRF_R_LSB2_Q8] = 3U * 256U;
    config.value[LRF_CLEAN_UQ16] = 32768;
    config.value[LRF_RATIO_UQ8] = 768;
    filter_t f = made(&filter_law_lrf, &config);
    filter_t k;
    config.value[LRF_R_LSB2_Q8] = 15U * 256U;
    TEST_ASSERT_TRUE(init_plain(&k, &config));
    uint32_t random = SEED;
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(5000, 1000); i++) {
        int16_t z = (int16_t)(random32(&random) & 1023U);
        TEST_ASSERT_EQUAL_INT32(filter_update(&k, z), filter_update(&f, z));
    }
}

/* 1000 LSB^2 x 1024 is beyond the format: 65,536 LSB^2 less a count then, as kf.c says; R = 64 LSB^2 x 1014 is not. */
TEST(mean_variance_ends_at_its_limit)
{
    filter_config_t config = config_100hz();
    config.value[LRF_CLEAN_UQ16] = 656;
    config.value[LRF_RATIO_UQ8] = 8192;
    config.value[LRF_R_LSB2_Q8] = FILTER_R_MAX_LSB2_Q8;
    filter_t f = made(&filter_law_lrf, &config);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFF, f.own.kalman.r_lsb2_q8);
    filter_set_noise(&f, 64U * 256U);
    uint32_t r_mixed = 64UL * 256U * 1014U; /* 1024 - 0.01 x 1023 = 1013.76 */
    TEST_ASSERT_UINT32_WITHIN(r_mixed / 2048U, r_mixed, f.own.kalman.r_lsb2_q8);
}

/* Warming up the probe tells R_L for the variance of a sample: here 5 x 3 LSB^2. */
TEST(probe_reports_the_mean_variance)
{
    filter_config_t config = config_100hz();
    config.value[LRF_R_LSB2_Q8] = 3U * 256U;
    config.value[LRF_CLEAN_UQ16] = 32768;
    config.value[LRF_RATIO_UQ8] = 768;
    filter_t f = made(&filter_law_lrf, &config);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_UINT32(15U * 256U, probe.p_lsb2_q8);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, probe.gate_lsb2_q8);
}
