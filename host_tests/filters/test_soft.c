/*
 * soft in integers, on the PC and on the chip: within the soft gate, beyond it, beyond the gate. Against the double
 * reference: test_soft_reference.c.
 */
#include "support/test_law.h"

#define SEED 4712UL
#define R_LSB2 16U

/* 100 Hz, R 16 LSB^2: sigma 4, agreement within floor(3 sqrt(32) + 8) = 24 LSB, rate at most 8 LSB per sample. */
static filter_config_t config_100hz(void)
{
    filter_config_t config = filter_defaults(&filter_law_soft, 1000);
    config.value[SOFT_R_LSB2_Q8] = R_LSB2 * 256U;
    return config;
}

static filter_t settled(const filter_config_t *config, int16_t level)
{
    filter_t f = made(&filter_law_soft, config);
    filter_reset(&f, level);
    return f;
}

/* x after one sample at z for a filter at rest at 0. */
static int32_t step_to(const filter_t *at_zero, int16_t z)
{
    filter_t f = *at_zero;
    return filter_update(&f, z);
}

static void assert_same_as_plain(const filter_config_t *config, int16_t mask)
{
    filter_t k;
    filter_t f = made(&filter_law_soft, config);
    TEST_ASSERT_TRUE(init_plain(&k, config));
    uint32_t random = SEED;
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(5000, 1000); i++) {
        int16_t z = (int16_t)((int16_t)(random32(&random) >> 16) & mask);
        TEST_ASSERT_EQUAL_INT32(filter_update(&k, z), filter_update(&f, z));
        TEST_ASSERT_EQUAL_UINT16(k.gain_uq16, f.gain_uq16);
    }
}

/* Off: any samples. On: samples of 0 to 7 LSB, which a soft gate of 2 sigma or more, 8 LSB, leaves alone. */
TEST(without_or_within_the_soft_gate_it_is_the_kalman_filter)
{
    filter_config_t config = config_100hz();
    config.value[SOFT_RATE_MAX_LSB_S] = 1000000;
    assert_same_as_plain(&config, 7);
    config.value[SOFT_SOFT_SIGMA_Q8] = 4096;
    assert_same_as_plain(&config, 31);
    config.value[SOFT_SOFT_SIGMA_Q8] = 0;
    assert_same_as_plain(&config, -1);
}

/* Any sample moves the estimate towards it, whatever R, gate and gain: the defect of a weight that rounds to zero. */
TEST(no_sample_is_without_effect)
{
    static const int32_t r_lsb2_q8[] = { 3, 20, 768, 20000, 256000 };
    static const uint16_t softs_q8[] = { 256, 512, 4096 };
    static const uint16_t rates_dhz[] = { 125, 1000, 8000 };
    for (uint8_t i = 0; i < 45; i++) {
        filter_config_t config = filter_defaults(&filter_law_soft, rates_dhz[i % 3U]);
        config.value[SOFT_R_LSB2_Q8] = r_lsb2_q8[i / 9U];
        config.value[SOFT_SOFT_SIGMA_Q8] = softs_q8[i / 3U % 3U];
        filter_t f = settled(&config, 0);
        for (int16_t z = 1; z <= 4095; z = (int16_t)(z + ON_PC_OR_CHIP(1, 300))) {
            TEST_ASSERT_TRUE(step_to(&f, z) > 0);
            TEST_ASSERT_TRUE(step_to(&f, (int16_t)-z) < 0);
        }
        filter_t high = settled(&config, 4095); /* the largest innovation that rest allows */
        TEST_ASSERT_TRUE(step_to(&high, -4096) < (int32_t)4095 * 65536);
        (void)filter_update(&high, -4096);
        filter_probe_t probe = probe_of(&high);
        TEST_ASSERT_TRUE(probe.gain_uq16 > 0);
    }
}

/*
 * Beyond the soft gate the step is P11 softgate^2 R / |r| and falls as |r| grows: by more than the 2^-18 of the weight
 * and a count of rounding, |r| 2^-18 P11 <= |r| / 2^18 here, it can rise nowhere.
 */
TEST(the_step_falls_as_the_sample_gets_further)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    int32_t before = step_to(&f, 10);
    for (int16_t z = 11; z < 4095; z = (int16_t)(z + ON_PC_OR_CHIP(1, 50))) {
        int32_t step = step_to(&f, z);
        TEST_ASSERT_TRUE(step <= before + z / 4 + 2);
        before = step;
    }
    TEST_ASSERT_TRUE(before < step_to(&f, 10) / 50);
}

/* As sprf refuses it, so soft flags it: the two agree on every sample but those within 1/256 of the gate in r^2. */
TEST(flag_is_at_the_gate_of_sprf)
{
    static const uint16_t gates_q8[] = { 512, 768, 1536 };
    for (uint8_t i = 0; i < 3; i++) {
        filter_config_t config = config_100hz();
        config.value[SOFT_R_LSB2_Q8] = 400U * 256U;
        config.value[SOFT_GATE_SIGMA_Q8] = gates_q8[i];
        filter_config_t sprf_config = filter_defaults(&filter_law_sprf, 1000);
        sprf_config.value[SPRF_R_LSB2_Q8] = config.value[SOFT_R_LSB2_Q8];
        sprf_config.value[SPRF_GATE_SIGMA_Q8] = config.value[SOFT_GATE_SIGMA_Q8];
        filter_t f = settled(&config, 0);
        filter_t g = made(&filter_law_sprf, &sprf_config);
        filter_reset(&g, 0);
        for (int16_t z = 1; z < 200; z++) {
            filter_t soft = f;
            filter_t sprf = g;
            (void)filter_update(&soft, z);
            (void)filter_update(&sprf, z);
            uint32_t limit = sprf.own.kalman.coarse ? sprf.own.kalman.limit_lsb2 / 256U
                                                    : sprf.own.kalman.limit_lsb2 / 65536U;
            uint32_t r2 = (uint32_t)((int32_t)z * z);
            if (r2 + limit / 256U < limit || r2 > limit + limit / 256U + 1U) {
                TEST_ASSERT_EQUAL_UINT8(sprf.flags, soft.flags);
            }
        }
    }
}

/* Between 2 and 3 sigma part of the sample is taken, no flag; beyond 3 the flag; without a gate never a flag. */
TEST(taken_in_part_is_flagged_beyond_the_gate_only)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    filter_t g = f;
    (void)filter_update(&f, 10); /* S is 1.1 to 1.4 R: 2 sigma within 8.4..9.5, 3 sigma within 12.5..14.3 */
    TEST_ASSERT_EQUAL_UINT8(0, f.flags);
    (void)filter_update(&g, 15);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, g.flags);
    config.value[SOFT_GATE_SIGMA_Q8] = 0;
    filter_t h = settled(&config, 0);
    for (int k = 0; k < 20; k++) {
        (void)filter_update(&h, (int16_t)(1000 + k));
        TEST_ASSERT_EQUAL_UINT8(0, h.flags & (FILTER_GATED | FILTER_REACQUIRED));
    }
}

/* A gate inside the soft gate flags what lies beyond the latter. */
TEST(gate_inside_the_soft_gate_counts_from_the_latter)
{
    filter_config_t config = config_100hz();
    config.value[SOFT_SOFT_SIGMA_Q8] = 1024;
    config.value[SOFT_GATE_SIGMA_Q8] = 256;
    filter_t f = settled(&config, 0);
    filter_t g = f;
    (void)filter_update(&f, 12);
    TEST_ASSERT_EQUAL_UINT8(0, f.flags);
    (void)filter_update(&g, 25);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, g.flags);
}

/* Rule CR by hand, as sprf: five flagged samples on 4 LSB per sample restart at the last with that rate. */
TEST(consistent_run_restarts_on_its_slope)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    int16_t z = 500;
    for (uint8_t k = 1; k < 5; k++, z = (int16_t)(z + 4)) {
        (void)filter_update(&f, z);
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    }
    TEST_ASSERT_EQUAL_INT32((int32_t)z * 65536, filter_update(&f, z));
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
    TEST_ASSERT_EQUAL_INT32((int32_t)4 * 65536, f.rate_lsb);
    TEST_ASSERT_EQUAL_UINT32(16777216U, f.own.kalman.p.p11);
    TEST_ASSERT_EQUAL_UINT32(67108864U / 4U, f.own.kalman.p.p12);
    TEST_ASSERT_EQUAL_UINT32(67108864U / 8U + f.own.kalman.q22_uq26, f.own.kalman.p.p22);
}

/* 80 and 4 LSB agree (8000 LSB/s: within 17 + 80), so that only its being taken whole lets 4 end the run. */
TEST(run_ends_at_a_sample_within_the_gate)
{
    static const int16_t samples[] = { 80, 80, 80, 4, 80, 80, 80, 80 };
    filter_config_t config = config_100hz();
    config.value[SOFT_RATE_MAX_LSB_S] = 8000;
    filter_t f = settled(&config, 0);
    for (uint8_t k = 0; k < 8; k++) {
        (void)filter_update(&f, samples[k]);
        TEST_ASSERT_EQUAL_UINT8((samples[k] == 80) ? FILTER_GATED : 0, f.flags);
    }
    (void)filter_update(&f, 80);
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
}

/* The same with a sample between the gates, which is taken in part and not flagged: 13 LSB. */
TEST(run_ends_at_a_sample_between_the_gates)
{
    filter_config_t config = config_100hz();
    config.value[SOFT_RATE_MAX_LSB_S] = 8000;
    filter_t f = settled(&config, 0);
    for (uint8_t k = 0; k < 9; k++) {
        (void)filter_update(&f, (k == 3U) ? 13 : 80);
        TEST_ASSERT_EQUAL_UINT8((k == 3U) ? 0 : (k == 8U) ? FILTER_REACQUIRED : FILTER_GATED, f.flags);
    }
}

/*
 * Without re-acquisition, from one end of the range to the other: it comes back, if slowly. P stops at its limit: P12
 * is then above 0.12 here, so the rate gains P12 softgate^2 R / |r| > 0.12 x 64 / 8191 less 2^-16 LSB in each sample,
 * and 8191 LSB are passed in sqrt(2 x 8191 / 0.00092) = 4220 samples. So it is for R = 16; a smaller R has the least m,
 * 2^-20, and P12 2^-20 8191 is as much, a larger one has more.
 */
TEST(it_is_never_locked_out)
{
    static const int32_t r_lsb2_q8[] = { 3, 256, 768, 4096, 256000 };
    for (uint8_t i = ON_PC_OR_CHIP(0, 3); i < 5U; i++) {
        filter_config_t config = config_100hz();
        config.value[SOFT_REACQUIRE_SAMPLES] = 0;
        config.value[SOFT_R_LSB2_Q8] = r_lsb2_q8[i];
        filter_t f = settled(&config, -4096);
        uint16_t samples = 0;
        while (f.x_lsb_q16 < (int32_t)4090 * 65536 && samples < 4220U) {
            (void)filter_update(&f, 4095);
            samples++;
        }
        TEST_ASSERT_TRUE(samples < 4220U);
    }
}

/* With the least m, 2^-20, and P11 = 0.03 the gain is below its last place: x moves by a count all the same. */
TEST(least_gain_moves_by_a_count)
{
    filter_config_t config = filter_defaults(&filter_law_soft, 8000);
    config.value[SOFT_R_LSB2_Q8] = FILTER_R_MIN_LSB2_Q8;
    config.value[SOFT_Q_LSB2_S3] = 1;
    config.value[SOFT_SOFT_SIGMA_Q8] = 256;
    filter_t f = settled(&config, 0);
    feed(&f, 0, 3000);
    TEST_ASSERT_EQUAL_INT32(1, filter_update(&f, 4095));
    TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, -4095));
}

/* The way of a run over a missing sample is unknown: it restarts without its slope. */
TEST(run_with_a_gap_restarts_at_rest)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int16_t k = 0; k < 5; k++) {
        if (k == 2) {
            (void)filter_missing(&f);
        }
        (void)filter_update(&f, (int16_t)(1000 + 4 * k));
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_INT32(0, probe.rate_lsb_q16);
}
