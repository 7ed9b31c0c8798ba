/*
 * sprf in integers, on the PC and on the chip: gate, re-acquisition on raw samples. Against the double reference:
 * test_sprf_reference.c.
 */
#include "support/test_law.h"

#define SEED 4711UL
#define R_LSB2 16U

/* 100 Hz, R 16 LSB^2: sigma 4, agreement within floor(3 sqrt(32) + 8) = 24 LSB, rate at most 8 LSB per sample. */
static filter_config_t config_100hz(void)
{
    filter_config_t config = filter_defaults(&filter_law_sprf, 1000);
    config.value[SPRF_R_LSB2_Q8] = R_LSB2 * 256U;
    return config;
}

/* Settled at level: 300 equal samples. */
static filter_t settled(const filter_config_t *config, int16_t level)
{
    filter_t f = made(&filter_law_sprf, config);
    feed(&f, level, 300);
    return f;
}

TEST(refused_sample_leaves_the_prediction)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 100);
    TEST_ASSERT_EQUAL_INT32((int32_t)100 * 65536, filter_update(&f, 2000));
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    TEST_ASSERT_EQUAL_INT32((int32_t)100 * 65536, filter_update(&f, 100));
    TEST_ASSERT_EQUAL_UINT8(0, f.flags);
}

/* Without gate and with a rate limit out of reach sprf is kf. */
TEST(without_gate_it_is_the_kalman_filter)
{
    filter_config_t config = config_100hz();
    config.value[SPRF_GATE_SIGMA_Q8] = 0;
    config.value[SPRF_RATE_MAX_LSB_S] = 1000000;
    filter_t k;
    filter_t f = made(&filter_law_sprf, &config);
    TEST_ASSERT_TRUE(init_plain(&k, &config));
    uint32_t random = SEED;
    for (uint16_t i = 0; i < ON_PC_OR_CHIP(5000, 1000); i++) {
        int16_t z = (int16_t)((int32_t)(random32(&random) >> 16) - 32768);
        TEST_ASSERT_EQUAL_INT32(filter_update(&k, z), filter_update(&f, z));
    }
}

/*
 * Rule CR by hand: L refused samples on 4 LSB per sample restart at the last, rate 4, P = (1, 1/(L-1), 2/(L-1)^2 +
 * q22).
 */
TEST(consistent_run_restarts_on_its_slope)
{
    static const uint16_t lengths[] = { 3, 5, 9 };
    for (uint8_t i = 0; i < 3; i++) {
        filter_config_t config = config_100hz();
        config.value[SPRF_REACQUIRE_SAMPLES] = lengths[i];
        filter_t f = settled(&config, 0);
        int16_t z = 500;
        for (uint16_t k = 1; k < lengths[i]; k++, z = (int16_t)(z + 4)) {
            (void)filter_update(&f, z);
            TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
        }
        TEST_ASSERT_EQUAL_INT32((int32_t)z * 65536, filter_update(&f, z));
        TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
        uint32_t steps = lengths[i] - 1U; /* a power of two: exact */
        TEST_ASSERT_EQUAL_INT32((int32_t)4 * 65536, f.rate_lsb);
        TEST_ASSERT_EQUAL_UINT32(16777216U, f.own.kalman.p.p11);
        TEST_ASSERT_EQUAL_UINT32(67108864U / steps, f.own.kalman.p.p12);
        TEST_ASSERT_EQUAL_UINT32(2U * 67108864U / steps / steps + f.own.kalman.q22_uq26, f.own.kalman.p.p22);
    }
}

/* 20 LSB per sample agree (limit 24) but are faster than the rate may be: 8. */
TEST(restart_limits_the_rate)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int k = 0; k < 5; k++) {
        (void)filter_update(&f, (int16_t)(500 + 20 * k));
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
    TEST_ASSERT_INT32_WITHIN(64, (int32_t)8 * 65536, f.rate_lsb); /* 800 / 100 with 16-bit mantissas: 2^-13 relative */
}

TEST(disagreeing_run_never_restarts)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int k = 0; k < 1000; k++) {
        TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, (k & 1) != 0 ? 1000 : 1025)); /* 25 LSB apart, limit 24 */
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    }
}

/* Samples d LSB apart, far from the level that the filter has settled at: what becomes of 20 of them. */
static uint8_t flags_of_20_samples_apart(const filter_config_t *config, int16_t d_lsb)
{
    filter_t f = settled(config, 0);
    uint8_t flags = 0;
    for (int k = 0; k < 20; k++) {
        (void)filter_update(&f, (int16_t)((k & 1) != 0 ? 2000 + d_lsb : 2000));
        flags |= f.flags;
    }
    return flags;
}

/*
 * Consecutive samples of a run differ by at most 3 sqrt(2 R) and the motion of one sample, rounded down: 16.97 + 8,
 * 0.46 + 8, 134.16 + 8 and, at 12.5 Hz, 16.97 + 64 LSB. At that distance they agree, one LSB further they do not.
 */
TEST(agreement_ends_at_three_sigma_of_a_difference)
{
    static const struct {
        uint16_t rate_dhz;
        int32_t r_lsb2_q8;
        int16_t agree_lsb;
    } cases[] = { { 1000, R_LSB2 * 256U, 24 }, { 1000, 3, 8 }, { 1000, 256000, 142 }, { 125, R_LSB2 * 256U, 80 } };
    for (uint8_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        filter_config_t config = filter_defaults(&filter_law_sprf, cases[i].rate_dhz);
        config.value[SPRF_R_LSB2_Q8] = cases[i].r_lsb2_q8;
        TEST_ASSERT_TRUE((flags_of_20_samples_apart(&config, cases[i].agree_lsb) & FILTER_REACQUIRED) != 0U);
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, flags_of_20_samples_apart(&config, (int16_t)(cases[i].agree_lsb + 1)));
    }
}

/*
 * Four of the five samples that restart, then a reset: a sample 20 LSB from the new level would agree with it (24), but
 * it begins a run, which takes five. It is refused: 3 sigma of the innovation, 12 sqrt(1 + P11 / R) LSB, stay below 20.
 */
TEST(reset_forgets_the_run)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    feed(&f, 1000, 4);
    filter_reset(&f, 300);
    for (int k = 0; k < 4; k++) {
        TEST_ASSERT_EQUAL_INT32((int32_t)300 * 65536, filter_update(&f, 320));
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
    }
    (void)filter_update(&f, 320);
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
}

TEST(run_ends_at_an_accepted_sample)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int k = 0; k < 100; k++) {
        (void)filter_update(&f, (k % 5) == 4 ? 0 : 1000);
        TEST_ASSERT_EQUAL_UINT8(0, f.flags & FILTER_REACQUIRED);
    }
}

TEST(reacquisition_off_never_restarts)
{
    filter_config_t config = config_100hz();
    config.value[SPRF_REACQUIRE_SAMPLES] = 0;
    filter_t f = settled(&config, 0);
    for (int k = 0; k < 1000; k++) {
        TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, 1000));
    }
}

/* A missing sample makes the slope unknown: the restart is at rest. Missing samples do not prevent it either. */
TEST(run_with_a_gap_restarts_at_rest)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int k = 0; k < 5; k++) {
        (void)filter_update(&f, (int16_t)(500 + 4 * k));
        if (k < 4) {
            (void)filter_missing(&f);
        }
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
    TEST_ASSERT_EQUAL_INT32(0, f.rate_lsb);
}

/*
 * On 4 LSB per sample, then samples that nothing agrees with: five are refused while the rate is believed, as many as
 * a restart from those that agree may take, and the sixth prediction is the last at that rate.
 */
static void expect_a_stand(int16_t direction)
{
    enum { PREDICTIONS = 6 };
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int16_t k = 1; k <= 400; k++) {
        (void)filter_update(&f, (int16_t)(k * 4 * direction));
    }
    filter_probe_t probe = probe_of(&f);
    int32_t x = probe.x_lsb_q16;
    int32_t rate = probe.rate_lsb_q16;
    TEST_ASSERT_INT32_WITHIN(1024, (int32_t)4 * direction * 65536, rate);
    for (uint8_t k = 1; k <= 40; k++) {
        x += rate;
        TEST_ASSERT_EQUAL_INT32(x, filter_update(&f, (k & 1U) != 0U ? 4000 : -4000));
        TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, f.flags);
        if (k >= PREDICTIONS) {
            rate = 0;
        }
    }
    TEST_ASSERT_EQUAL_INT32(0, rate);
    (void)filter_update(&f, (int16_t)(x / 65536));
    TEST_ASSERT_EQUAL_UINT8(0, f.flags);
}

/* As published it has no other way back than P, and runs on by its rate. */
TEST(without_reacquisition_it_runs_on)
{
    filter_config_t config = config_100hz();
    config.value[SPRF_REACQUIRE_SAMPLES] = 0;
    filter_t f = settled(&config, 0);
    for (int16_t k = 1; k <= 400; k++) {
        (void)filter_update(&f, (int16_t)(k * 4));
    }
    filter_probe_t probe = probe_of(&f);
    for (uint8_t k = 0; k < 20U; k++) {
        (void)filter_update(&f, (k & 1U) != 0U ? 4000 : -4000);
    }
    int32_t rate = probe.rate_lsb_q16;
    filter_probe(&f, &probe);
    TEST_ASSERT_EQUAL_INT32(rate, probe.rate_lsb_q16);
}

TEST(where_nothing_agrees_it_comes_to_stand)
{
    expect_a_stand(1);
    expect_a_stand(-1);
}

/* An accepted sample begins the count anew: the rate is held over 3 refused ones, however often they come. */
TEST(rate_is_held_over_short_runs)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (int16_t k = 1; k <= 400; k++) {
        (void)filter_update(&f, (int16_t)(k * 4));
    }
    filter_probe_t probe;
    for (int16_t k = 401; k <= 700; k++) {
        bool refused = k % 4 != 0;
        int16_t away = ((k & 1) != 0) ? 4000 : -4000;
        (void)filter_update(&f, refused ? away : (int16_t)(k * 4));
        TEST_ASSERT_EQUAL_UINT8(refused ? FILTER_GATED : 0, f.flags);
        filter_probe(&f, &probe);
        TEST_ASSERT_INT32_WITHIN(1024, (int32_t)4 * 65536, probe.rate_lsb_q16);
    }
}

/* From 30 Hz down three samples that agree restart it as shipped, above that five. */
TEST(at_low_rates_three_samples_restart_it)
{
    static const uint16_t rates_dhz[] = { 50, 250, 300, 301, 1000, 8000 };
    for (uint8_t i = 0; i < 6U; i++) {
        filter_config_t config = filter_defaults(&filter_law_sprf, rates_dhz[i]);
        filter_t f = settled(&config, 0);
        uint8_t samples = 1;
        for (; (filter_update(&f, 1000), f.flags == FILTER_GATED) && samples < 20U; samples++) {
        }
        TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, f.flags);
        TEST_ASSERT_EQUAL_UINT8((i < 3U) ? 3 : 5, samples);
    }
}

/* P11 is above R: each refused sample leaves half of the rate, towards 0 on both sides. */
static void expect_doubt(int16_t direction)
{
    filter_config_t config = config_100hz();
    config.value[SPRF_Q_LSB2_S3] = 20000000; /* q T^3 / R = 1.25: P11 settles at 3.9 before the update */
    filter_t f = settled(&config, 0);
    for (int16_t k = 1; k <= 100; k++) {
        (void)filter_update(&f, (int16_t)(k * 7 * direction));
    }
    int32_t rate = f.rate_lsb;
    TEST_ASSERT_INT32_WITHIN(1024, (int32_t)7 * direction * 65536, rate);
    for (uint8_t n = 1; n <= 4U; n++) {
        (void)filter_update(&f, (n & 1U) != 0U ? 4000 : -4000);
        rate /= 2;
        TEST_ASSERT_EQUAL_INT32(rate, f.rate_lsb);
    }
}

TEST(an_uncertain_rate_is_halved_by_refused_samples)
{
    expect_doubt(1);
    expect_doubt(-1);
}

/* A run beyond the range of samples: each is clamped and says so, the one that re-acquires too. */
TEST(restart_on_a_clamped_sample_is_flagged_so)
{
    filter_config_t config = config_100hz();
    filter_t f = settled(&config, 0);
    for (uint8_t k = 1; k <= 5U; k++) {
        (void)filter_update(&f, 5000);
        TEST_ASSERT_EQUAL_UINT8(FILTER_SATURATED | ((k < 5U) ? FILTER_GATED : FILTER_REACQUIRED), f.flags);
    }
}
