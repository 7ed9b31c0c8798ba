/* synth_opt: its schedule, classes and start on integers; runs on the PC and on the chip. */
#include "support/test_law.h"

static filter_t made_opt(int32_t variant_u, int32_t p0_lsb2_q8, int32_t r_lsb2_q8)
{
    filter_config_t config = { 1000,
                               { [SYNTH_OPT_VARIANT_U] = variant_u,
                                 [SYNTH_OPT_P0_LSB2_Q8] = p0_lsb2_q8,
                                 [SYNTH_OPT_R_LSB2_Q8] = r_lsb2_q8,
                                 [SYNTH_OPT_RATE_MAX_LSB_S] = RATE_UNLIMITED_LSB_S } };
    return made(&filter_law_synth_opt, &config);
}

static void warm_up(filter_t *f, int16_t z_lsb)
{
    feed(f, z_lsb, FILTER_WARM_UP_SAMPLES);
}

static uint16_t gain_of_next_sample(filter_t *f)
{
    (void)filter_update(f, 7);
    filter_probe_t probe = probe_of(f);
    return probe.gain_uq16;
}

/*
 * P0 = 100 LSB^2 and R = 6.25: class 16. From equal errors the first two gains of the exact schedule are
 * P0 / (P0 + R) = 16/17; after them S11 = S22 = 16/17 R and S12 = 16/289 R, so Pe = 4 S11 - 4 S12 + S22 = 1296/289 R
 * and the third is 1296/1585. Limit 2/3.
 */
TEST(schedule_of_16_by_hand)
{
    filter_t f = made_opt(0, 25600, 1600);
    warm_up(&f, 7);
    TEST_ASSERT_EQUAL_UINT16(61681, gain_of_next_sample(&f));
    TEST_ASSERT_EQUAL_UINT16(61681, gain_of_next_sample(&f));
    TEST_ASSERT_EQUAL_UINT16(53587, gain_of_next_sample(&f));
    for (uint8_t k = 3; k < 12; k++) {
        TEST_ASSERT_TRUE(gain_of_next_sample(&f) > 43691);
    }
    for (uint8_t k = 0; k < 3; k++) {
        TEST_ASSERT_EQUAL_UINT16(43691, gain_of_next_sample(&f));
    }
}

/* First gain of U: Pe = ((2 + 1/6)^2 + (4/3)^2 + 1/36) P0 = 6.5 P0, b0 = 104/105 for 16. Limit 11/13. */
TEST(schedule_of_u_by_hand)
{
    filter_t f = made_opt(1, 25600, 1600);
    warm_up(&f, 7);
    TEST_ASSERT_EQUAL_UINT16(64912, gain_of_next_sample(&f));
    feed(&f, 7, 11);
    TEST_ASSERT_EQUAL_UINT16(55454, gain_of_next_sample(&f));
}

/* a1 of U's limit is -1/6: from 600 after rest at 0, b0 = 11/13: 507.69; then 2 x1 + x1 / 6. Exact has 2 x1. */
TEST(coast_extrapolates_with_the_limit_of_a1)
{
    filter_t f = made_opt(1, 25600, 1600);
    filter_reset(&f, 0);
    int32_t x = filter_update(&f, 600);
    TEST_ASSERT_INT32_WITHIN(600, (int32_t)600 * 65536 / 13 * 11, x);
    TEST_ASSERT_INT32_WITHIN(600, 2 * x + x / 6, coast(&f));
    TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED, f.flags);
    f = made_opt(0, 25600, 1600);
    filter_reset(&f, 0);
    x = filter_update(&f, 600);
    TEST_ASSERT_EQUAL_INT32(2 * x, coast(&f));
}

/* R is 6.25 LSB^2, three sigmas 7.5 LSB: a rate of 7 may be noise, and neither it nor the one before it moves U's x. */
TEST(gap_stops_a_rate_that_may_be_noise_with_a1_too)
{
    filter_t f = made_opt(1, 25600, 1600);
    filter_reset(&f, 0);
    for (int16_t k = 1; k <= 400; k++) {
        (void)filter_update(&f, (int16_t)(7 * k));
    }
    filter_tracker_fade(&f, true);
    int32_t x = probe_of(&f).x_lsb_q16;
    for (uint8_t k = 0; k < 3; k++) {
        TEST_ASSERT_EQUAL_INT32(x, coast_only(&f));
    }
}

/* The border between 4^i and 4^(i + 1) is 2 x 4^i; below 1 and above 1024 the last class goes on. */
TEST(class_is_the_nearest_ratio)
{
    static const struct {
        int32_t p0_lsb2_q8, r_lsb2_q8;
        uint8_t ratio_class;
    } cases[] = {
        { 3, 256000, 0 },   { 512, 256, 0 },    { 513, 256, 1 },         { 2048, 256, 1 },  { 2049, 256, 2 },
        { 8192, 256, 2 },   { 8193, 256, 3 },   { 32768, 256, 3 },       { 32769, 256, 4 }, { 131072, 256, 4 },
        { 131073, 256, 5 }, { 25600000, 3, 5 }, { 25600000, 256000, 3 },
    };
    for (uint8_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        filter_t f = made_opt(0, cases[i].p0_lsb2_q8, cases[i].r_lsb2_q8);
        TEST_ASSERT_EQUAL_UINT8(cases[i].ratio_class, f.own.synth.of.scheduled.ratio_class);
    }
}

/* R set during the warm-up counts, R set later changes no gain. */
TEST(noise_counts_until_the_schedule_runs)
{
    filter_t f = made_opt(0, 25600, 1600);
    (void)filter_update(&f, 7);
    filter_set_noise(&f, 25600);
    TEST_ASSERT_EQUAL_UINT8(0, f.own.synth.of.scheduled.ratio_class);
    filter_set_noise(&f, 1600);
    for (uint8_t k = 1; k < FILTER_WARM_UP_SAMPLES; k++) {
        (void)filter_update(&f, 7);
    }
    filter_set_noise(&f, 25600);
    TEST_ASSERT_EQUAL_UINT16(61681, gain_of_next_sample(&f));
}

/* Every gain of every class within the clamps of safe switching: b0 from 1/2 up, a1 from -1/3 to 0. */
TEST(gains_are_within_the_clamps)
{
    for (uint8_t turn = 0; turn < 12; turn++) {
        filter_t f = made_opt(turn & 1, 1L << (8 + 2 * (turn >> 1)), 256);
        TEST_ASSERT_EQUAL_UINT8(turn >> 1, f.own.synth.of.scheduled.ratio_class);
        warm_up(&f, 7);
        for (uint8_t k = 0; k < 16; k++) {
            filter_t bent = f;
            /* 0, 0 and then 3 LSB */
            bent.x_lsb_q16 = 3 * 65536;
            bent.rate_lsb = 3 * 65536;
            bent.own.synth.rate_before_lsb_q16 = 0;
            int32_t x = coast(&bent); /* 6 + 3 |a1| */
            TEST_ASSERT_TRUE(x >= 6 * 65536 && x <= 7 * 65536);
            TEST_ASSERT_TRUE(gain_of_next_sample(&f) >= 32768);
        }
    }
}

/* Five samples with one outlier: the estimates start on their median, at rest, the outlier does not count. */
TEST(start_is_the_median)
{
    static const int16_t z_lsb[FILTER_WARM_UP_SAMPLES] = { 40, 44, -4000, 42, 43 };
    filter_t f = made_opt(0, 25600, 1600);
    int32_t x = 0;
    for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        x = filter_update(&f, z_lsb[k]);
    }
    TEST_ASSERT_EQUAL_INT32(42L * 65536, x);
    TEST_ASSERT_EQUAL_INT32(42L * 65536, coast(&f));
    TEST_ASSERT_EQUAL_INT32(42L * 65536, filter_update(&f, 42));
}

/* A gap does not use up the schedule; a reset ends it, as if z0 had been read for ever. */
TEST(schedule_goes_by_samples_seen)
{
    filter_t f = made_opt(0, 25600, 1600);
    warm_up(&f, 7);
    (void)gain_of_next_sample(&f);
    for (uint8_t k = 0; k < 30; k++) {
        (void)coast(&f);
    }
    TEST_ASSERT_EQUAL_UINT16(61681, gain_of_next_sample(&f));
    filter_reset(&f, 7);
    TEST_ASSERT_EQUAL_UINT16(43691, gain_of_next_sample(&f));
    TEST_ASSERT_EQUAL_UINT16(43691, gain_of_next_sample(&f));
}

/* A sample's variance while warming up, R b0 in the schedule (16/17 R), 2/3 R behind it, and of U 0.8059 R. */
TEST(probe_reports_the_variance)
{
    filter_t f = made_opt(0, 409600, 25600);
    warm_up(&f, 7);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_UINT32(25600, probe.p_lsb2_q8);
    (void)filter_update(&f, 7);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(4, 24094, probe.p_lsb2_q8);
    filter_reset(&f, 7);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(4, 17067, probe.p_lsb2_q8);
    f = made_opt(1, 409600, 25600);
    filter_reset(&f, 7);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(4, 20632, probe.p_lsb2_q8);
}

/*
 * 400 LSB/s x T squared and 19/64 of R = 0.003 LSB^2 per 0.1 Hz: 16 + 0.89 LSB^2 at 100 Hz, 256 + 0.22 at 25 Hz and,
 * the motion rounded down to 1/16 LSB, 0.25 + 7.1 at 800 Hz.
 */
TEST(default_p0_is_that_of_the_median)
{
    static const struct {
        uint16_t rate_dhz;
        int32_t p0_lsb2_q8;
    } cases[] = { { 1000, 4324 }, { 250, 65594 }, { 8000, 1889 } };
    for (uint8_t i = 0; i < 3; i++) {
        filter_config_t config = filter_defaults(&filter_law_synth_opt, cases[i].rate_dhz);
        TEST_ASSERT_INT32_WITHIN(2, cases[i].p0_lsb2_q8, config.value[SYNTH_OPT_P0_LSB2_Q8]);
        TEST_ASSERT_EQUAL_INT32(0, config.value[SYNTH_OPT_VARIANT_U]);
    }
}

/* ratemax 800 LSB/s at 100 Hz is 8 LSB a sample: b0 x 9 is below it, b0 x 15 is 10. */
TEST(one_sample_turns_the_rate_up_to_its_limit)
{
    for (uint8_t k = 0; k < 2; k++) {
        filter_t f = made_default(&filter_law_synth_opt, 1000);
        filter_reset(&f, 0);
        int32_t x = filter_update(&f, (k == 0U) ? 9 : 15);
        TEST_ASSERT_EQUAL_UINT8((k == 0U) ? 0 : FILTER_SATURATED, f.flags);
        TEST_ASSERT_EQUAL_INT32((k == 0U) ? x : 8L * 65536, coast(&f) - x);
    }
}
