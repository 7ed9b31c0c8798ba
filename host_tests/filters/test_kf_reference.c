/* kf against its reference in double, which test_robust_reference.c holds against numbers of paper 002. */
#include "reference/filters.h"
#include "support/own_model.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>

#define SEED 31

/* A filter that has taken five zeros, and its reference from the same start. */
static void start_both(filter_t *f, robust_reference_t *r, const filter_config_t *config)
{
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(f, &filter_law_kf, config));
    feed(f, 0, FILTER_WARM_UP_SAMPLES);
    reference_library(r, "kf", config->rate_dhz / 10.0, config->value[KF_R_LSB2_Q8] / 256.0,
                      config->value[KF_Q_LSB2_S3], 0, 0.0, 0.0);
}

/*
 * Bound of the gain's error: the reciprocal errs by 1.5 counts of 2^-16 and w1 inherits it; an error d of P11 returns
 * as d (1 - w1)^2, so errors sum to at most d / (2 w1 - w1^2) < d / w1. q22 errs by 4 roundings of 2^-14 in its
 * conversion and by half a count there and half a count at each update of P22; the gain goes with at most the square
 * root of q22.
 */
static double gain_bound(double w1, double q22_counts)
{
    return 1.5 / 65536.0 / w1 + w1 * 0.5 * (4.0 / 16384.0 + 1.0 / q22_counts);
}

TEST(gains_equal_the_reference)
{
    static const uint16_t rates[] = { 125, 250, 500, 1000, 2000, 4000, 8000 };
    for (int i = 0; i < 7; i++) {
        for (int32_t scale = 1; scale <= 16; scale *= 4) {
            filter_config_t config = filter_defaults(&filter_law_kf, rates[i]);
            config.value[KF_R_LSB2_Q8] *= scale;
            config.value[KF_Q_LSB2_S3] *= scale; /* keeps q22, changes all else */
            filter_t f;
            robust_reference_t r;
            start_both(&f, &r, &config);
            for (int k = 0; k < 1500; k++) {
                (void)filter_update(&f, 0);
                (void)robust_reference_step(&r, 0.0);
                double gain = f.gain_uq16 / 65536.0;
                double bound = gain_bound(r.gain[0], f.own.kalman.q22_uq26);
                char which[96];
                snprintf(which, sizeof which, "position gain of sample %d at %.1f Hz, in double %.5f +- %.5f", k + 1,
                         rates[i] / 10.0, r.gain[0], bound);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(bound, r.gain[0], gain, which);
            }
        }
    }
}

/*
 * Against the reference on noisy motion: the gain error above times the innovation, plus 1/256 LSB of the innovation's
 * rounding, through a filter whose error memory is 1 / w1 samples: |dx| <= (dw1 |r| + w1 / 256) / w1, |r| <= 5 sqrt(S
 * R).
 */
TEST(estimate_equals_the_reference)
{
    static const uint16_t rates[] = { 125, 1000, 4000, 8000 };
    test_random_t random;
    random_seed(&random, SEED);
    for (int i = 0; i < 4; i++) {
        filter_config_t config = filter_defaults(&filter_law_kf, rates[i]);
        filter_t f;
        robust_reference_t r;
        start_both(&f, &r, &config);
        double sigma = sqrt(config.value[KF_R_LSB2_Q8] / 256.0);
        for (int k = 0; k < 4000; k++) {
            int16_t z = as_sample(200.0 * sin(0.5 * k / (rates[i] / 10.0)) + sigma * random_normal(&random));
            double x = filter_update(&f, z) / 65536.0;
            (void)robust_reference_step(&r, z);
            double w1 = r.gain[0];
            double reach = 5.0 * sigma / sqrt(1.0 - w1);
            double bound = 2.0 * (gain_bound(w1, f.own.kalman.q22_uq26) * reach / w1 + 1.0 / 256.0);
            TEST_ASSERT_DOUBLE_WITHIN(bound, r.x[0], x);
        }
    }
}

/*
 * filter_reset is a start as if the level had been read for ever: P11 is then what it is after 20,000 samples. It
 * starts from P12 = sqrt(q), P11 = sqrt(2 P12), which in double comes within 1 %; the root is taken in whole counts of
 * 2^-13, and half of its error goes into P11.
 */
TEST(a_reset_has_the_covariance_of_a_long_past)
{
    static const uint16_t rates[] = { 125, 250, 500, 1000, 2000, 4000, 8000 };
    for (int i = 0; i < 7; i++) {
        filter_config_t config = filter_defaults(&filter_law_kf, rates[i]);
        filter_t f;
        TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_kf, &config));
        filter_reset(&f, 0);
        double reset = f.own.kalman.p.p11;
        feed(&f, 0, 20000);
        double past = f.own.kalman.p.p11;
        double bound = past * (0.01 + 0.5 / floor(sqrt(f.own.kalman.q22_uq26)));
        TEST_ASSERT_DOUBLE_WITHIN(bound, past, reset);
    }
}

TEST(probe_reports_the_variance)
{
    filter_config_t config = { 1000, { [KF_R_LSB2_Q8] = 16 * 256, [KF_Q_LSB2_S3] = 10000 } };
    filter_t f;
    robust_reference_t r;
    start_both(&f, &r, &config);
    for (int k = 0; k < 200; k++) {
        (void)filter_update(&f, 10);
        (void)robust_reference_step(&r, 10);
    }
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_DOUBLE_WITHIN(1.0 + 256.0 * 16.0 * gain_bound(r.gain[0], f.own.kalman.q22_uq26), r.p[0] * 256.0,
                              probe.p_lsb2_q8);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, probe.gate_lsb2_q8);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, r.innovation, probe.innovation_lsb_q16 / 65536.0);
}

/*
 * At every rate of the sensor, and with so much noise that q T^3 / R is the least: as good as in double, and S is the
 * innovations' variance.
 */
TEST(as_good_as_in_double_on_its_own_model)
{
    static const struct {
        uint16_t rate_dhz;
        int32_t noise;
    } cases[] = {
        { 125, 1 }, { 250, 1 }, { 500, 1 }, { 1000, 1 }, { 2000, 1 }, { 4000, 1 }, { 8000, 1 }, { 8000, 12 }
    };
    for (int i = 0; i < 8; i++) {
        filter_config_t config = filter_defaults(&filter_law_kf, cases[i].rate_dhz);
        config.value[KF_R_LSB2_Q8] *= cases[i].noise;
        const own_model_t found = own_model(&filter_law_kf, &config, SEED);
        TEST_ASSERT_DOUBLE_WITHIN(0.001, 1.0, found.rmse);
        TEST_ASSERT_DOUBLE_WITHIN(0.041, 1.0, found.nis); /* 5 sigma of 30,000 squares */
        TEST_ASSERT_TRUE(found.gated == 0.0);
    }
}
