/* synth_opt against its double reference; the schedules in double against the notes: test_synthesis_reference.c. */
#include "reference/synth_opt.h"
#include "reference/synthesis.h"
#include "support/test_law.h"
#include "synth.h"

#include <math.h>
#include <string.h>

#define STRETCH 0.9413
enum { SEED = 7101, STEPS = 12 };

/* The exact schedule from equal errors of variance p0, per R. */
static reference_exact_t exact_from(double p0)
{
    const double s[9] = { p0, p0, p0, p0, p0, p0, p0, p0, p0 };
    reference_exact_t f;
    reference_exact_begin(&f, 1.0, -1.0 / 3.0, 0.0, s);
    return f;
}

/* P0 = ratio R, with R = 4 LSB^2. */
static filter_t made_opt(bool u, double ratio)
{
    filter_config_t config = { 1000, { u, (int32_t)lround(1024.0 * ratio), 1024, RATE_UNLIMITED_LSB_S } };
    return made(&filter_law_synth_opt, &config);
}

typedef struct {
    double a1, b0;
} gains_t;

/* Gains of the steps of class i: its own first four, then those of 16, then the limit; a1 found by a bend of 3000. */
static gains_t expected_gains(bool u, double own_ratio, int step)
{
    double ratio = step < 4 ? own_ratio : 16.0;
    const double p[5] = { ratio, ratio, ratio, ratio, ratio };
    reference_exact_t exact = exact_from(ratio);
    reference_schedule_t uncorrelated;
    reference_schedule_begin(&uncorrelated, SCHEDULE_UNCORRELATED, 1.0, p);
    for (int n = 0; n <= (step < STEPS ? step : 400); n++) {
        reference_exact_step(&exact);
        TEST_ASSERT_TRUE(reference_schedule_step(&uncorrelated));
    }
    return u ? (gains_t){ uncorrelated.a1, uncorrelated.b0 } : (gains_t){ exact.a1, exact.b0 };
}

/* What the filter does at a step: gain from the probe, a1 from the extrapolation of 3000, 0, 0 (a bend of 3000). */
static void assert_step(filter_t *f, const gains_t *expected)
{
    filter_t bent = *f;
    /* 0, 0 and then 1000 LSB */
    bent.x_lsb_q16 = 1000 * 65536;
    bent.rate_lsb = 1000 * 65536;
    bent.own.synth.rate_before_lsb_q16 = 0;
    double extrapolated = coast(&bent) / 65536.0;
    TEST_ASSERT_DOUBLE_WITHIN(1000.0 / 131072.0 + 1e-4, 2000.0 - 1000.0 * expected->a1, extrapolated);
    (void)filter_update(f, 10);
    filter_probe_t probe = probe_of(f);
    TEST_ASSERT_DOUBLE_WITHIN(0.6, fmin(expected->b0 * 65536.0, 65535.0), probe.gain_uq16);
}

TEST(table_is_the_schedule_of_the_reference)
{
    for (int u = 0; u <= 1; u++) {
        for (int i = 0; i < 6; i++) {
            double ratio = pow(4.0, i);
            filter_t f = made_opt(u != 0, ratio);
            feed(&f, 10, FILTER_WARM_UP_SAMPLES);
            for (int step = 0; step < STEPS + 5; step++) {
                gains_t expected = expected_gains(u != 0, ratio, step);
                assert_step(&f, &expected);
            }
        }
    }
}

TEST(u_schedule_has_its_limit)
{
    const gains_t limit = { -1.0 / 6.0, 11.0 / 13.0 };
    filter_t f = made_opt(true, 16.0);
    feed(&f, 10, 400);
    assert_step(&f, &limit);
}

/*
 * The variance that the filter's own gains leave, over what the schedule made for the very P0 / R leaves: at most
 * 1.15 in any sample and 1.023 in the mean of the 16 of the start, for P0 / R from 1/2 to 100,000.
 */
TEST(nearest_class_costs_little)
{
    double worst = 1.0;
    double worst_mean = 1.0;
    for (double ratio = 0.5; ratio < 1e5; ratio *= 1.05) {
        double best[9];
        double own[9];
        double sums[2] = { 0.0, 0.0 };
        filter_t f;
        filter_config_t config = { 1000, { 0, (int32_t)lround(256.0 * ratio), 256, RATE_UNLIMITED_LSB_S } };
        TEST_ASSERT_TRUE(ratio > 99999.0 || (filter_init(&f, &filter_law_synth_opt, &config) == FILTER_ACCEPTED));
        memcpy(best, exact_from(ratio).s, sizeof best);
        memcpy(own, best, sizeof own);
        feed(&f, 10, FILTER_WARM_UP_SAMPLES);
        for (int step = 0; step < 16; step++) {
            (void)filter_update(&f, 10);
            filter_probe_t probe = probe_of(&f);
            reference_exact_t next;
            reference_exact_begin(&next, 1.0, -1.0 / 3.0, 0.0, best);
            reference_exact_step(&next);
            double optimum = reference_given_step(best, next.a1,
                                                  fmax(next.b0, 0.5)); /* switching is safe from 1/2 on */
            double variance = reference_given_step(own, 0.0, probe.gain_uq16 / 65536.0);
            worst = fmax(worst, variance / optimum);
            sums[0] += optimum;
            sums[1] += variance;
        }
        worst_mean = fmax(worst_mean, sums[1] / sums[0]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 1.15, worst);
    TEST_ASSERT_DOUBLE_WITHIN(0.003, 1.023, worst_mean);
}

/* --- switching --- */

/*
 * F is affine in (1 - b0, (1 - b0) a1), so the clamps are the hull of three corners, and a norm that each corner
 * contracts contracts them all: e' P e by 0.9413. A disturbance of at most d a step then leaves |e| below
 * sqrt(P11 inv(P)11) / (1 - 0.9413) d < 25 d, whatever the gains.
 */
static double switching_bound(void)
{
    return reference_norm_loss() / (1.0 - STRETCH);
}

TEST(clamps_are_safe_for_any_switching)
{
    TEST_ASSERT_TRUE(reference_stretch(0.0, 0.5) > 0.5);
    for (int i = 0; i <= 20; i++) {
        for (int j = 0; j <= 20; j++) {
            TEST_ASSERT_TRUE(reference_stretch(-i / 60.0, 0.5 + j / 40.0) <= STRETCH);
        }
    }
    TEST_ASSERT_TRUE(switching_bound() < 25.0);
    /* and they are needed: with a1 = 0 and b0 from 0.2 on some sequence diverges although each gain is stable */
    double largest = 0.0;
    for (unsigned code = 0; code < 4096U; code++) {
        double a1[12] = { 0 };
        double b0[12];
        for (unsigned i = 0; i < 12U; i++) {
            b0[i] = ((code >> i) & 1U) != 0U ? 1.0 : 0.2;
        }
        largest = fmax(largest, reference_product_radius(a1, b0, 12));
    }
    TEST_ASSERT_TRUE(largest > 1.0);
}

static double uniform(test_random_t *random)
{
    return 0.5 * (1.0 + erf(random_normal(random) / sqrt(2.0)));
}

/*
 * 10^5 steps of random gains within the clamps, every other one at a corner, held for 1 to 8 steps; a disturbance of
 * +-1, its sign random or that of the error.
 */
TEST(random_switching_stays_below_the_bound)
{
    static const double corners[3][2] = { { 0.0, 1.0 }, { 0.0, 0.5 }, { -1.0 / 3.0, 0.5 } };
    test_random_t random;
    random_seed(&random, SEED + 1);
    double x[3] = { 0.0, 0.0, 0.0 };
    double largest = 0.0;
    double a1 = 0.0;
    double b0 = 0.5;
    int hold = 0;
    for (long k = 0; k < 100000; k++) {
        if (hold-- <= 0) {
            int corner = (int)(6.0 * uniform(&random));
            a1 = corner < 3 ? corners[corner][0] : -uniform(&random) / 3.0;
            b0 = corner < 3 ? corners[corner][1] : 0.5 + 0.5 * uniform(&random);
            hold = (int)(8.0 * uniform(&random));
        }
        double ahead = reference_opt_filter(x, a1, b0, 0.0);
        x[0] += (k / 1000 % 2 == 0 ? ahead >= 0.0 : random_normal(&random) > 0.0) ? 1.0 : -1.0;
        largest = fmax(largest, fabs(x[0]));
    }
    TEST_ASSERT_TRUE(largest < switching_bound());
    TEST_ASSERT_TRUE(largest > 4.0);
}

/*
 * The library's step with gains at random: samples of +-150 LSB and nothing but rounding between it and the double
 * filter: |difference| < 25 x 1.5 x 2^-17 LSB at every one of 10^5 steps, and the estimate below 25 x 150 LSB.
 */
TEST(fixed_point_switches_as_the_reference)
{
    test_random_t random;
    random_seed(&random, SEED + 2);
    double x[3] = { 0.0, 0.0, 0.0 };
    filter_t f = made_opt(true, 1.0);
    filter_reset(&f, 0);
    for (long k = 0; k < 100000; k++) {
        uint16_t a1_uq16 = (uint16_t)(21845.0 * uniform(&random));
        f.gain_uq16 = (uint16_t)(32768.0 + 32767.0 * uniform(&random));
        int16_t z = random_normal(&random) > 0.0 ? 150 : -150;
        filter_synth_bent_step(&f, z, STEP_SAMPLE, a1_uq16);
        double got = f.x_lsb_q16 / 65536.0;
        double wanted = reference_opt_filter(x, -a1_uq16 / 65536.0, f.gain_uq16 / 65536.0, z);
        TEST_ASSERT_TRUE(fabs(got - wanted) < switching_bound() * 1.5 / 131072.0);
        TEST_ASSERT_TRUE(fabs(got) < switching_bound() * 150.0 && f.flags == 0U);
    }
}

/* --- the whole filter --- */

/* |x - reference| below 25 x 1.5 roundings of 2^-17 LSB, from the start on: the start's median is exact. */
TEST(estimate_equals_the_reference)
{
    test_random_t random;
    random_seed(&random, SEED + 3);
    for (int i = 0; i < 12; i++) {
        bool u = i % 2 != 0;
        filter_t f = made_opt(u, pow(4.0, i / 2));
        double x[3] = { 0.0, 0.0, 0.0 };
        for (int k = 0; k < 5000; k++) {
            int16_t z = as_sample(900.0 * sin(0.01 * k) + 2.0 * random_normal(&random));
            double got = filter_update(&f, z) / 65536.0;
            if (k < FILTER_WARM_UP_SAMPLES) {
                x[0] = x[1] = x[2] = got;
                continue;
            }
            gains_t g = expected_gains(u, pow(4.0, i / 2), k < 40 ? k - FILTER_WARM_UP_SAMPLES : STEPS);
            double a1 = -floor(-g.a1 * 65536.0 + 0.5) / 65536.0;
            double b0 = fmin(floor(g.b0 * 65536.0 + 0.5), 65535.0) / 65536.0;
            double wanted = reference_opt_filter(x, a1, b0, z);
            TEST_ASSERT_TRUE(fabs(got - wanted) < switching_bound() * 1.5 / 131072.0);
        }
    }
}

/* Variance that the probe tells in the limit against that of 200,000 samples: 2/3 R and, of U, 0.8059 R. */
TEST(probe_reports_the_true_variance)
{
    test_random_t random;
    random_seed(&random, SEED + 5);
    for (int u = 0; u <= 1; u++) {
        filter_t f = made_opt(u != 0, 4.0);
        filter_set_noise(&f, 25600);
        filter_reset(&f, 0);
        double squares = 0.0;
        for (long k = 0; k < 200000; k++) {
            double x = filter_update(&f, as_sample(10.0 * random_normal(&random))) / 65536.0;
            squares += x * x / 200000.0;
        }
        filter_probe_t probe = probe_of(&f);
        TEST_ASSERT_DOUBLE_WITHIN(0.02 * squares, squares, probe.p_lsb2_q8 / 256.0);
    }
}
