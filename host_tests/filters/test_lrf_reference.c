/* lrf against Eigen: the reference against paper 002's numbers, the fixed-point filter against the reference. */
#include "reference/filters.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>

#define SEED 32
#define FACTOR 60.85 /* q1 (1 - N^2) + N^2 at q1 = 0.85, N = 20 */

/* 2.06 with outliers, 0.1715 without (by Lyapunov, notes section 3), to 1e-3 of what their four-digit parts give. */
TEST(variance_ratios_are_those_of_the_notes)
{
    reference_filter_t plain = reference_table_1(1.0);
    reference_filter_t lrf = reference_table_1(FACTOR);
    reference_settle(&plain);
    reference_settle(&lrf);
    const double outliers = reference_lyapunov(&plain, FACTOR * 0.0064) / reference_lyapunov(&lrf, FACTOR * 0.0064);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3 * 0.0476, 0.0476, lrf.gain[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 1.852e-2, 1.852e-2, reference_lyapunov(&lrf, FACTOR * 0.0064));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 4.750e-3, 4.750e-3, reference_lyapunov(&lrf, 0.0064));
    const double clean = reference_lyapunov(&plain, 0.0064) / reference_lyapunov(&lrf, 0.0064);
    printf("LRF: error variance of KF over its own %.4f with outliers, %.5f without\n", outliers, clean);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 2.06, 3.819 / 1.852, outliers);
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 2.06, outliers);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 0.1715, 0.1715, clean);
}

/* Steady gain w1 of a filter that reads zeros. */
static double steady_gain(filter_t *f)
{
    feed(f, 0, 5000);
    return f->gain_uq16 / 65536.0;
}

/*
 * Table 1 in the units of the library: q T^3 / R = Q T^2 / R = 8.5794e-5 at 100 Hz, R = 100 LSB^2 and q = 8579. The
 * steady gains within 0.5 % of the paper's, 0.12730 (N = 1) and 0.0476.
 */
TEST(steady_gains_are_those_of_the_paper)
{
    reference_filter_t reference = reference_table_1(FACTOR);
    reference_settle(&reference);
    filter_config_t config = filter_defaults(&filter_law_lrf, 1000);
    config.value[LRF_R_LSB2_Q8] = 100 * 256;
    config.value[LRF_Q_LSB2_S3] = 8579;
    filter_t f = made(&filter_law_lrf, &config);
    TEST_ASSERT_DOUBLE_WITHIN(0.005 * reference.gain[0], reference.gain[0], steady_gain(&f));
    config.value[LRF_RATIO_UQ8] = 256;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_lrf, &config));
    TEST_ASSERT_DOUBLE_WITHIN(0.005 * 0.12730, 0.12730, steady_gain(&f));
}

/* The bound of test_kf_reference.c, with R_L for R: 2 (dw1 |r| + w1 / 256) / w1, |r| up to the outliers' 60 sigma. */
TEST(estimate_equals_the_reference)
{
    test_random_t random;
    random_seed(&random, SEED);
    printf("seed %d\n", SEED);
    filter_config_t config = filter_defaults(&filter_law_lrf, 1000);
    reference_filter_t r;
    filter_t f = made(&filter_law_lrf, &config);
    feed(&f, 0, FILTER_WARM_UP_SAMPLES);
    double sigma = sqrt(config.value[LRF_R_LSB2_Q8] / 256.0);
    reference_library(&r, 100.0, FACTOR * sigma * sigma, config.value[LRF_Q_LSB2_S3], 0.0, 0, 0.0, 0.0);
    for (int k = 0; k < 5000; k++) {
        double spread = random_uniform(&random) < 0.15 ? 20.0 * sigma : sigma;
        int16_t z = as_sample(50.0 * sin(0.005 * k) + spread * random_normal(&random));
        double x = filter_update(&f, z) / 65536.0;
        reference_step(&r, z);
        double w1 = r.gain[0];
        double error = 1.5 / 65536.0 / w1 + w1 * 0.5 * (8.0 / 16384.0 + 1.0 / f.own.kalman.q22_uq26);
        TEST_ASSERT_DOUBLE_WITHIN(2.0 * (error * 60.0 * sigma / w1 + 1.0 / 256.0), r.x[0], x);
    }
}

/*
 * Where the header says that the core's smallest q T^3 / R_L binds: R is 0.03 LSB^2 per Hz, so 1e4 / f^3 / (60.85 x
 * 0.03 f) = 6e-8 at f = 550 Hz.
 */
TEST(smallest_gain_binds_where_the_header_says)
{
    filter_config_t config = filter_defaults(&filter_law_lrf, 5100); /* 5.4 counts of 2^-26 */
    filter_t f = made(&filter_law_lrf, &config);
    TEST_ASSERT_TRUE(f.own.kalman.q22_uq26 > 4U);
    config = filter_defaults(&filter_law_lrf, 5600);
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_lrf, &config));
    TEST_ASSERT_EQUAL_UINT32(4, f.own.kalman.q22_uq26);
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, 0.022, steady_gain(&f));
}
