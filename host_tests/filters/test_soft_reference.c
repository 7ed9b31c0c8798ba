/* soft against Eigen: steps, weights, recovery. */
#include "reference/filters.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>

#define SEED 4721
#define R_LSB2 16U

/* 100 Hz, R 16 LSB^2: sigma 4, agreement within floor(3 sqrt(32) + 8) = 24 LSB, rate at most 8 LSB per sample. */
static filter_config_t config_100hz(void)
{
    filter_config_t config = filter_defaults(&filter_law_soft, 1000);
    config.value[SOFT_R_LSB2_Q8] = R_LSB2 * 256U;
    return config;
}

/* The reference in the state that the filter is in; P in units of R, rates per sample. */
static robust_reference_t reference_in_the_state_of(const filter_t *f)
{
    const double r = f->own.kalman.r_lsb2_q8 / 256.0;
    const double one = 67108864.0;
    const double k = f->own.kalman.coarse ? 4.0 * f->own.kalman.gate_lsb2_uq6 : f->own.kalman.gate_lsb2_uq6 / 64.0;
    robust_reference_t reference;
    TEST_ASSERT_TRUE(robust_reference_table1(&reference, "soft"));
    reference.period_s = 1.0;
    reference.r = r;
    reference.gate_sigma = HUGE_VAL;
    reference.softgate_sigma = sqrt(k / r);
    reference.q[3] = f->own.kalman.q22_uq26 / one * r;
    reference.x[0] = f->x_lsb_q16 / 65536.0;
    reference.x[1] = f->rate_lsb / 65536.0;
    reference.rate_max = f->rate_max_lsb / 65536.0;
    reference.p[0] = f->own.kalman.p.p11 / (one / 4.0) * r;
    reference.p[1] = reference.p[2] = f->own.kalman.p.p12 / one * r;
    reference.p[3] = f->own.kalman.p.p22 / one * r;
    return reference;
}

/*
 * One step of both from the same state. With P in units of R: m errs by e = 2^-20 + m (2^-8 / |r| x 2 + 2^-13), from
 * its own rounding, that of |r| to 2^-8 LSB and that of the reciprocal, squared; P11 m by P11 e + 2^-16 m + 2^-25,
 * P12 m by P12 e + 2^-18 m + 2^-24. P22 takes w2 rounded down to 2^-16. A step errs by |r| times that, by w 2^-8 LSB
 * (2^-8 of itself beyond 256 LSB) and by two counts.
 */
static void assert_step_equals_the_reference(const filter_t *start, int16_t z)
{
    filter_t f = *start;
    if (f.own.kalman.p.p11 >= 0x4000000U || ((f.own.kalman.p.p12 | f.own.kalman.p.p22) & 0xC0000000U) != 0U) {
        return; /* P at its limit is not predicted, and the reference knows no limit */
    }
    robust_reference_t r = reference_in_the_state_of(&f);
    const double soft2 = r.softgate_sigma * r.softgate_sigma;
    (void)filter_update(&f, z);
    (void)robust_reference_step(&r, z);
    if (r.innovation * r.innovation <= soft2 * r.r * 53.0 || (f.flags & FILTER_SATURATED) != 0U) {
        return; /* S <= 53 R: not surely beyond the soft gate */
    }
    const double size = fabs(r.innovation);
    const double m = soft2 * r.r / (size * size);
    const double e = 1.0 / 1048576.0 + m * (2.0 / 256.0 / size + 1.0 / 8192.0);
    const double p11 = r.gain[0] / m;
    const double p12 = r.gain[1] / m;
    const double w1_error = p11 * e + m / 65536.0;
    const double w2_error = p12 * e + m / 262144.0;
    const double step = 1.0 / 256.0 / size + (size >= 256.0 ? 1.0 / size : 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(size * (w1_error + r.gain[0] * step + 6e-8) + 2.0 / 65536.0, r.x[0],
                              f.x_lsb_q16 / 65536.0);
    TEST_ASSERT_DOUBLE_WITHIN(size * (w2_error + r.gain[1] * step + 12e-8) + 2.0 / 65536.0, r.x[1],
                              f.rate_lsb / 65536.0);
    const double p_error = 3.0 / 65536.0;
    TEST_ASSERT_DOUBLE_WITHIN(r.r * p11 * (w1_error + p_error) + r.r / 65536.0, r.p[0],
                              f.own.kalman.p.p11 / 16777216.0 * r.r);
    TEST_ASSERT_DOUBLE_WITHIN(r.r * p12 * (w1_error + p_error) + r.r / 262144.0, r.p[1],
                              f.own.kalman.p.p12 / 67108864.0 * r.r);
    const double p22_error = p12 * (w2_error + 3.0 * m / 262144.0 + 1.0 / 65536.0) + 4.0 / 67108864.0;
    TEST_ASSERT_DOUBLE_WITHIN(r.r * p22_error, r.p[3], f.own.kalman.p.p22 / 67108864.0 * r.r);
}

/* Any configuration, after any samples and gaps: P small and at its limit. */
TEST(steps_beyond_the_soft_gate_equal_the_reference)
{
    uint32_t random = SEED;
    int compared = 0;
    for (int run = 0; run < 2000; run++) {
        filter_config_t config = filter_defaults(&filter_law_soft, (uint16_t)(50U + random32_below(&random, 39951)));
        config.value[SOFT_R_LSB2_Q8] = 3 +
                                       (int32_t)((random32(&random) >> (14U + random32_below(&random, 16))) % 255998U);
        config.value[SOFT_Q_LSB2_S3] = 1 + (int32_t)(random32(&random) >> (3U + random32_below(&random, 28)));
        config.value[SOFT_SOFT_SIGMA_Q8] = (uint16_t)(256U + random32_below(&random, 1024));
        config.value[SOFT_GATE_SIGMA_Q8] = 0;
        config.value[SOFT_RATE_MAX_LSB_S] = 1000000;
        filter_t f = made(&filter_law_soft, &config);
        for (int k = 0; k < 40; k++) {
            int16_t z = (int16_t)random32_below(&random, 1U << random32_below(&random, 13));
            if (f.collected == FILTER_RUNNING) {
                assert_step_equals_the_reference(&f, z);
                compared++;
            }
            (void)filter_update(&f, z);
            for (uint32_t gap = random32_below(&random, 40); gap > 35U; gap--) {
                (void)coast(&f);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_INT(50000, compared);
}

/* 15 % outliers of 20 sigma on a slow motion, no re-acquisition: the errors of both against the truth, within 2 %. */
TEST(errors_equal_those_of_the_reference)
{
    filter_config_t config = config_100hz();
    config.value[SOFT_GATE_SIGMA_Q8] = 0;
    filter_t f = made(&filter_law_soft, &config);
    feed(&f, 0, FILTER_WARM_UP_SAMPLES);
    robust_reference_t r;
    reference_library(&r, "soft", 100.0, R_LSB2, config.value[SOFT_Q_LSB2_S3], 0, 800.0, 0.0);
    test_random_t random;
    random_seed(&random, SEED);
    printf("seed %d\n", SEED);
    double fixed = 0.0;
    double exact = 0.0;
    for (int k = 0; k < 20000; k++) {
        double truth = 100.0 * sin(0.01 * k);
        double sigma = random_uniform(&random) < 0.15 ? 80.0 : 4.0;
        int16_t z = as_sample(truth + sigma * random_normal(&random));
        double x = filter_update(&f, z) / 65536.0 - truth;
        (void)robust_reference_step(&r, z);
        fixed += x * x;
        exact += (r.x[0] - truth) * (r.x[0] - truth);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.02 * exact, exact, fixed);
}

/*
 * Alone, without re-acquisition, the soft gate follows a step of 2.5 to 10 sigma as its double does, in the same number
 * of samples within 2 %. (Of further ones it is slower: P stops at its limit, test_soft.c.)
 */
TEST(without_reacquisition_it_returns_as_the_reference)
{
    static const int steps_lsb[] = { 10, 20, 30, 40 };
    filter_config_t config = config_100hz();
    config.value[SOFT_REACQUIRE_SAMPLES] = 0;
    config.value[SOFT_RATE_MAX_LSB_S] = 1000000;
    for (int i = 0; i < 4; i++) {
        filter_t f = made(&filter_law_soft, &config);
        robust_reference_t r;
        reference_library(&r, "soft", 100.0, R_LSB2, config.value[SOFT_Q_LSB2_S3], 0, 0.0, 0.0);
        for (int k = 0; k < 500; k++) {
            (void)filter_update(&f, 0);
            (void)robust_reference_step(&r, 0.0);
        }
        int fixed = 0;
        int exact = 0;
        for (int k = 1; k < 5000; k++) {
            double x = filter_update(&f, (int16_t)steps_lsb[i]) / 65536.0;
            (void)robust_reference_step(&r, steps_lsb[i]);
            fixed = (fixed == 0 && fabs(x - steps_lsb[i]) < 4.0) ? k : fixed;
            exact = (exact == 0 && fabs(r.x[0] - steps_lsb[i]) < 4.0) ? k : exact;
        }
        printf("step of %d LSB: %d samples, in double %d\n", steps_lsb[i], fixed, exact);
        TEST_ASSERT_GREATER_THAN_INT(0, exact);
        TEST_ASSERT_INT_WITHIN(1U + (unsigned)exact / 50U, exact, fixed);
    }
}
