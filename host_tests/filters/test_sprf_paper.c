/* sprf_paper in integers, on the PC and on the chip: gate, no robust start, lock-out. Against double:
 * test_wide_reference.c. */
#include "support/test_law.h"

/* 100 Hz, R 16 LSB^2: sigma 4 LSB. */
static filter_t settled(int16_t level)
{
    filter_config_t config = filter_defaults(&filter_law_sprf_paper, 1000);
    config.value[SPRF_PAPER_R_LSB2_Q8] = 16U * 256U;
    filter_t f = made(&filter_law_sprf_paper, &config);
    feed(&f, level, 300);
    return f;
}

TEST(gate_is_two_sigma_by_default_and_never_off)
{
    filter_t f;
    filter_config_t config = filter_defaults(&filter_law_sprf_paper, 1000);
    TEST_ASSERT_EQUAL_INT32(512, config.value[SPRF_PAPER_GATE_SIGMA_Q8]);
    config.value[SPRF_PAPER_GATE_SIGMA_Q8] = 0;
    TEST_ASSERT_EQUAL_UINT8(FILTER_REFUSED_FIRST + SPRF_PAPER_GATE_SIGMA_Q8,
                            filter_init(&f, &filter_law_sprf_paper, &config));
}

/* The limit that the probe tells, gate^2 R S; the integers on either side of it decide differently. */
TEST(samples_within_the_limit_are_taken)
{
    filter_t f = settled(0);
    (void)filter_update(&f, 0);
    filter_probe_t probe = probe_of(&f);
    /* S = P11 + 1 = 1 / (1 - w1): gate^2 R S = 4 x 16 x 256 / (1 - w1) in Q8 */
    uint32_t expected_q8 = (uint32_t)(4UL * 16UL * 256UL * 65536ULL / (65536UL - probe.gain_uq16));
    TEST_ASSERT_UINT32_WITHIN(expected_q8 / 1000U, expected_q8, probe.gate_lsb2_q8);
    int16_t limit = (int16_t)(filter_fx_isqrt32(probe.gate_lsb2_q8) >> 4);
    filter_t inside = f;
    filter_t outside = f;
    (void)filter_update(&inside, limit);
    (void)filter_update(&outside, (int16_t)(-limit - 1));
    TEST_ASSERT_EQUAL_UINT8(0, inside.flags);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, outside.flags);
}

TEST(refused_sample_leaves_the_prediction)
{
    filter_t f = settled(100);
    TEST_ASSERT_EQUAL_INT32((int32_t)100 * 65536, filter_update(&f, 2000));
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    TEST_ASSERT_EQUAL_INT32((int32_t)100 * 65536, filter_update(&f, 100));
    TEST_ASSERT_EQUAL_UINT8(0, f.flags);
}

/* The first sample is the estimate, P11 = R: an outlier of 20 sigma there makes outliers of all that follow. */
TEST(an_outlier_at_the_start_locks_out)
{
    filter_config_t config = filter_defaults(&filter_law_sprf_paper, 1000);
    config.value[SPRF_PAPER_R_LSB2_Q8] = 16U * 256U;
    config.value[SPRF_PAPER_Q_LSB2_S3] = 1;
    filter_t f = made(&filter_law_sprf_paper, &config);
    TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP, f.flags);
    TEST_ASSERT_EQUAL_INT32((int32_t)80 * 65536, filter_update(&f, 80));
    TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP, f.flags);
    TEST_ASSERT_EQUAL_UINT32(0x10000U, f.own.wide.p.p11);
    f.own.wide.p.p22 = 0; /* as a rate known to be 0: nothing but q lets P grow */
    for (uint16_t k = 0; k < 500; k++) {
        TEST_ASSERT_EQUAL_INT32((int32_t)80 * 65536, filter_update(&f, 0));
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    }
}

/*
 * After a step of 80 LSB, 20 sigma, the gate opens with the first S = P11 + 1 of 20^2 / 2^2 = 100 and more: not before,
 * and not later; no run of equal samples opens it.
 */
TEST(gate_opens_only_when_p_has_grown_to_the_step)
{
    filter_t f = settled(0);
    uint16_t k = 0;
    do {
        (void)filter_update(&f, 80);
        k++;
        bool grown = f.own.wide.variance != 0U &&
                     (f.own.wide.variance >> 8 >> fx_places(f.own.wide.variance)) >= 100UL << 8;
        TEST_ASSERT_EQUAL_UINT8(grown ? 0U : FILTER_GATED, f.flags);
    } while (f.flags != 0U && k < 200U);
    TEST_ASSERT_TRUE(k > 20U && k < 200U);
    TEST_ASSERT_INT32_WITHIN((int32_t)2 * 65536, (int32_t)80 * 65536, f.x_lsb_q16);
}

/* A step that P cannot grow to, 4000 LSB at sigma 0.1: refused to the end of P's range, then taken. */
TEST(end_of_the_range_ends_the_lock_out)
{
    filter_config_t config = filter_defaults(&filter_law_sprf_paper, 1000);
    config.value[SPRF_PAPER_R_LSB2_Q8] = FILTER_R_MIN_LSB2_Q8;
    filter_t f = made(&filter_law_sprf_paper, &config);
    filter_reset(&f, 0);
    uint16_t k = 0;
    while (filter_update(&f, 4000) == 0 && k < 400U) {
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
        k++;
    }
    TEST_ASSERT_TRUE(k > 3U && k < 400U);
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
}
