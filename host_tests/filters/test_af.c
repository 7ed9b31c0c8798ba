/* af in integers, on the PC and on the chip: what it learns. Against double: test_wide_reference.c. */
#include "mixture.h"
#include "support/test_law.h"

#define SEED 90210UL
#define ONE_UQ24 0x1000000UL

/* 100 Hz, R 16 LSB^2. */
static filter_t made_af(void)
{
    filter_config_t config = filter_defaults(&filter_law_af, 1000);
    config.value[MIXTURE_R_LSB2_Q8] = 16U * 256U;
    return made(&filter_law_af, &config);
}

/* With q = 0.85 from the start and nothing learnt yet the first sample is pbf's, bit for bit. */
TEST(first_step_is_that_of_pbf)
{
    filter_config_t config;
    config = filter_defaults(&filter_law_pbf, 1000);
    filter_t f = made(&filter_law_af, &config);
    filter_t p = made(&filter_law_pbf, &config);
    for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        (void)filter_update(&f, 0);
        (void)filter_update(&p, 0);
    }
    TEST_ASSERT_EQUAL_INT32(filter_update(&p, 7), filter_update(&f, 7));
    TEST_ASSERT_EQUAL_UINT32(p.own.mixture.core.p.p11, f.own.mixture.core.p.p11);
}

/* An outlier beyond doubt has p = 0: q = 1/2 (1 - 1/3) after the first, 1/3 (1 - 1/4) after the second, then 1/5. */
TEST(outliers_are_learnt_by_hand)
{
    static const uint32_t expected_uq24[] = { ONE_UQ24 / 3, ONE_UQ24 / 4, ONE_UQ24 / 5, ONE_UQ24 / 6 };
    filter_t f = made_af();
    filter_reset(&f, 0);
    TEST_ASSERT_EQUAL_UINT32(ONE_UQ24 / 2, f.own.mixture.normal_uq24);
    for (uint8_t k = 0; k < 4; k++) {
        (void)filter_update(&f, (k & 1U) != 0U ? 4000 : -4000);
        TEST_ASSERT_UINT32_WITHIN(ONE_UQ24 >> 14, expected_uq24[k], f.own.mixture.normal_uq24);
    }
}

/* Neither start, coasting nor a change of R teaches anything; a reset forgets. */
TEST(only_samples_teach)
{
    filter_t f = made_af();
    feed(&f, 100, FILTER_WARM_UP_SAMPLES);
    for (uint8_t k = 0; k < 50; k++) {
        (void)coast(&f);
    }
    filter_set_noise(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(ONE_UQ24 / 2, f.own.mixture.normal_uq24);
    TEST_ASSERT_EQUAL_UINT16(2, f.own.mixture.learnt_from);
    feed(&f, 100, 50);
    TEST_ASSERT_TRUE(f.own.mixture.normal_uq24 > ONE_UQ24 / 10 * 9);
    TEST_ASSERT_EQUAL_UINT16(52, f.own.mixture.learnt_from);
    filter_reset(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(ONE_UQ24 / 2, f.own.mixture.normal_uq24);
    TEST_ASSERT_EQUAL_UINT16(2, f.own.mixture.learnt_from);
}

/* For ever clean, for ever spoilt: q stays 1/1024 away from 1 and 0, and the memory ends at 1024 samples. */
TEST(what_is_learnt_stays_within_its_margin)
{
    filter_t f = made_af();
    filter_reset(&f, 0);
    feed(&f, 0, ON_PC_OR_CHIP(20000, 1500));
    TEST_ASSERT_TRUE(f.own.mixture.normal_uq24 <= ONE_UQ24 - MIXTURE_MARGIN_UQ24);
    TEST_ASSERT_TRUE(f.own.mixture.normal_uq24 > ONE_UQ24 / 100 * 99);
    TEST_ASSERT_EQUAL_UINT16(1024, f.own.mixture.learnt_from);
    for (uint16_t k = 0; k < ON_PC_OR_CHIP(20000, 1500); k++) {
        (void)filter_update(&f, (k & 1U) != 0U ? 4000 : -4000);
        TEST_ASSERT_TRUE(f.own.mixture.normal_uq24 >= MIXTURE_MARGIN_UQ24);
    }
}

/* Three of ten samples are outliers of up to 128 LSB, 32 sigma: about 0.7 are normal. */
TEST(share_of_outliers_is_found)
{
    filter_t f = made_af();
    filter_reset(&f, 0);
    uint32_t random = SEED;
    for (uint16_t k = 0; k < ON_PC_OR_CHIP(3000, 1500); k++) {
        uint32_t v = random32(&random);
        int16_t noise = (int16_t)((int16_t)(v & 7U) - (int16_t)((v >> 3) & 7U)); /* 3.2 LSB rms */
        bool outlier = ((v >> 8) & 1023U) < 307U;
        (void)filter_update(&f, outlier ? (int16_t)((int16_t)((v >> 20) & 255U) - 128) : noise);
    }
    /* outliers within 4 sigma, an eighth of them, pass for normal: 0.74 */
    TEST_ASSERT_UINT32_WITHIN(ONE_UQ24 / 20, ONE_UQ24 / 100 * 73, f.own.mixture.normal_uq24);
}
