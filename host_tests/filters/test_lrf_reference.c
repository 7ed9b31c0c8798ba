/* lrf against its reference in double, which test_robust_reference.c holds against numbers of paper 002. */
#include "reference/filters.h"
#include "support/roles.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>

#define SEED 32
#define FACTOR 60.85 /* q1 (1 - N^2) + N^2 at q1 = 0.85, N = 20 */

/* Table 1 at rest, by Riccati and Lyapunov: 2.06 with outliers, to 1e-3 of what its four-digit parts give. */
TEST(variance_ratios_are_those_of_the_notes)
{
    robust_reference_t plain;
    robust_reference_t lrf;
    double p[4];
    double of_plain[2];
    double of_lrf[2];
    TEST_ASSERT_TRUE(robust_reference_table1(&plain, filter_listed_name(plain_kind())) &&
                     robust_reference_table1(&lrf, "lrf"));
    robust_reference_steady(&plain, p, of_plain);
    robust_reference_steady(&lrf, p, of_lrf);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3 * 0.0476, 0.0476, of_lrf[0]);
    const double unmerged = robust_reference_lyapunov(&plain, of_plain, FACTOR * 0.0064);
    const double merged = robust_reference_lyapunov(&lrf, of_lrf, FACTOR * 0.0064);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 1.852e-2, 1.852e-2, merged);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 4.750e-3, 4.750e-3, robust_reference_lyapunov(&lrf, of_lrf, 0.0064));
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 2.06, 3.819 / 1.852, unmerged / merged);
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
    robust_reference_t reference;
    double p[4];
    double gain[2];
    TEST_ASSERT_TRUE(robust_reference_table1(&reference, "lrf"));
    robust_reference_steady(&reference, p, gain);
    filter_config_t config = filter_defaults(&filter_law_lrf, 1000);
    config.value[LRF_R_LSB2_Q8] = 100 * 256;
    config.value[LRF_Q_LSB2_S3] = 8579;
    filter_t f = made(&filter_law_lrf, &config);
    TEST_ASSERT_DOUBLE_WITHIN(0.005 * gain[0], gain[0], steady_gain(&f));
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
    robust_reference_t r;
    filter_t f = made(&filter_law_lrf, &config);
    feed(&f, 0, FILTER_WARM_UP_SAMPLES);
    double sigma = sqrt(config.value[LRF_R_LSB2_Q8] / 256.0);
    reference_library(&r, filter_listed_name(plain_kind()), 100.0, FACTOR * sigma * sigma, config.value[LRF_Q_LSB2_S3],
                      0, 0.0, 0.0);
    for (int k = 0; k < 5000; k++) {
        double spread = random_uniform(&random) < 0.15 ? 20.0 * sigma : sigma;
        int16_t z = as_sample(50.0 * sin(0.005 * k) + spread * random_normal(&random));
        double x = filter_update(&f, z) / 65536.0;
        (void)robust_reference_step(&r, z);
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
