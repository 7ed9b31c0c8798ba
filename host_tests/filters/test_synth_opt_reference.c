/* synth_opt against its double reference, and the reference against the values and limits of the notes. */
#include "reference/synth_opt.h"
#include "support/test_law.h"
#include "synth.h"

#include <math.h>

#define PI 3.14159265358979323846
#define STRETCH 0.9413
enum { SEED = 7101, STEPS = 12 };

static void equal_errors(double s[9], double p0)
{
    for (int i = 0; i < 9; i++) {
        s[i] = p0;
    }
}

/* notes/synthesised-filter.md 1.1 and 2.1, to the digits printed there: P0 = 5, R = 1 and 0.5; three raw samples. */
TEST(exact_schedule_begins_as_in_the_notes)
{
    static const double p0[3] = { 5.0, 10.0, 0.0 };
    static const double b0[3][6] = { { 0.83333, 0.83333, 0.78313, 0.72532, 0.69948, 0.68625 },
                                     { 0.90909, 0.90909, 0.80824, 0.73759, 0.0, 0.0 },
                                     { 0.833333, 0.75, 0.714286, 0.694545, 0.682971, 0.0 } };
    for (int i = 0; i < 3; i++) {
        double s[9] = { 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 };
        if (i < 2) {
            equal_errors(s, p0[i]);
        }
        for (int n = 0; n < 6 && b0[i][n] > 0.0; n++) {
            reference_gains_t g = reference_opt_exact_step(s);
            TEST_ASSERT_DOUBLE_WITHIN(1e-5, b0[i][n], g.b0);
            TEST_ASSERT_EQUAL_DOUBLE(0.0, g.a1);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, g.b0, g.p); /* P = R b0 */
        }
    }
}

TEST(u_schedule_begins_as_in_the_notes)
{
    static const double expected[4][3] = { { -1.0 / 6, 32.5, 0.970149 },
                                           { -0.032338, 9.680014, 0.906367 },
                                           { -1.0 / 3, 8.18508, 0.891128 },
                                           { 0.0, 4.470878, 0.817214 } };
    static const double of_paper[4] = { 0.981873, 0.928617, 0.897004, 0.81873 }; /* R = 0.6 */
    double p[5] = { 5.0, 5.0, 5.0, 5.0, 5.0 };
    double q[5] = { 5.0 / 0.6, 5.0 / 0.6, 5.0 / 0.6, 5.0 / 0.6, 5.0 / 0.6 };
    for (int n = 0; n < 4; n++) {
        reference_gains_t g = reference_opt_u_step(p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * 0.33, expected[n][0], g.a1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * expected[n][1], expected[n][1], g.pe);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5 * expected[n][2], expected[n][2], g.b0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, of_paper[n], reference_opt_u_step(q).b0);
    }
}

/* From 1000 positive-definite starts over six decades: a1 = 0, b0 = 2/3, P = 2/3 R. */
TEST(exact_schedule_has_one_limit)
{
    test_random_t random;
    random_seed(&random, SEED);
    for (int run = 0; run < 1000; run++) {
        double root[9];
        double s[9];
        double scale = pow(10.0, 6.0 * run / 1000.0 - 3.0);
        for (int i = 0; i < 9; i++) {
            root[i] = random_normal(&random);
        }
        for (int i = 0; i < 9; i++) {
            s[i] = 0.0;
            for (int k = 0; k < 3; k++) {
                s[i] += scale * root[i / 3 * 3 + k] * root[i % 3 * 3 + k];
            }
        }
        reference_gains_t g = { 0 };
        for (int n = 0; n < 200; n++) {
            g = reference_opt_exact_step(s);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, g.a1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0 / 3.0, g.b0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 2.0 / 3.0, g.p);
    }
}

/* U: a1 = -1/6, b0 = P / R = 11/13 from flat starts over ten decades, and from 0, which the clamp of b0 leaves. */
TEST(u_schedule_has_its_limit)
{
    for (int decade = -6; decade <= 4; decade++) {
        double p0 = decade == -6 ? 0.0 : pow(10.0, decade);
        double p[5] = { p0, p0, p0, p0, p0 };
        reference_gains_t g = { 0 };
        for (int n = 0; n < 400; n++) {
            g = reference_opt_u_step(p);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, -1.0 / 6.0, g.a1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 11.0 / 13.0, g.b0);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 11.0 / 13.0, g.p);
    }
}

/* P0 = ratio R, with R = 4 LSB^2. */
static filter_t made_opt(bool u, double ratio)
{
    filter_config_t config = { 1000, { u, (int32_t)lround(1024.0 * ratio), 1024, RATE_UNLIMITED_LSB_S } };
    return made(&filter_law_synth_opt, &config);
}

/* Gains of the steps of class i: its own first four, then those of 16, then the limit; a1 found by a bend of 3000. */
static reference_gains_t expected_gains(bool u, double own_ratio, int step)
{
    double ratio = step < 4 ? own_ratio : 16.0;
    double s[9];
    double p[5] = { ratio, ratio, ratio, ratio, ratio };
    equal_errors(s, ratio);
    reference_gains_t g = { 0 };
    for (int n = 0; n <= (step < STEPS ? step : 400); n++) {
        g = u ? reference_opt_u_step(p) : reference_opt_exact_step(s);
    }
    return g;
}

/* What the filter does at a step: gain from the probe, a1 from the extrapolation of 3000, 0, 0 (a bend of 3000). */
static void assert_step(filter_t *f, const reference_gains_t *expected)
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
                reference_gains_t expected = expected_gains(u != 0, ratio, step);
                assert_step(&f, &expected);
            }
        }
    }
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
        equal_errors(best, ratio);
        equal_errors(own, ratio);
        feed(&f, 10, FILTER_WARM_UP_SAMPLES);
        for (int step = 0; step < 16; step++) {
            (void)filter_update(&f, 10);
            filter_probe_t probe = probe_of(&f);
            double optimum = reference_opt_exact_step(best).p;
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
            reference_gains_t g = expected_gains(u, pow(4.0, i / 2), k < 40 ? k - FILTER_WARM_UP_SAMPLES : STEPS);
            double a1 = -floor(-g.a1 * 65536.0 + 0.5) / 65536.0;
            double b0 = fmin(floor(g.b0 * 65536.0 + 0.5), 65535.0) / 65536.0;
            double wanted = reference_opt_filter(x, a1, b0, z);
            TEST_ASSERT_TRUE(fabs(got - wanted) < switching_bound() * 1.5 / 131072.0);
        }
    }
}

/* Profiles of section 2.3 of the notes, T = 0.1 s, in degrees. */
static double profile(int which, double t)
{
    double s = fmin(fmax((t - 6.0) / 4.0, 0.0), 1.0);
    if (which == 0) {
        return 30.0 * s;
    }
    return which == 1 ? 30.0 - 30.0 * cos(PI * s) : 15.0 - 15.0 * cos(2.0 * PI * s);
}

/* Row (0, 2/3) of that section, exact there, from a constant start: 0..5, 6..10, 11..15 s; 4000 runs, R = 0.6. */
TEST(roll_experiment_has_the_errors_of_the_notes)
{
    static const double expected[3][3] = { { 0.4026, 0.4023, 0.4000 },
                                           { 0.4026, 0.4041, 0.4000 },
                                           { 0.4026, 0.4166, 0.4000 } };
    static const int first[3] = { 0, 60, 110 };
    static const int last[3] = { 50, 100, 150 };
    test_random_t random;
    random_seed(&random, SEED + 4);
    for (int which = 0; which < 3; which++) {
        double sums[3] = { 0.0, 0.0, 0.0 };
        for (int run = 0; run < 4000; run++) {
            filter_t f = made_opt(false, 4.0);
            for (int k = 0; k <= 150; k++) {
                double truth = 100.0 * (profile(which, 0.1 * k) - 30.0);
                int16_t z = as_sample(truth + 100.0 * sqrt(0.6) * random_normal(&random));
                if (k == 0) {
                    filter_reset(&f, z);
                }
                double error = (filter_update(&f, z) / 65536.0 - truth) / 100.0;
                for (int i = 0; i < 3; i++) {
                    sums[i] += k >= first[i] && k <= last[i] ? error * error : 0.0;
                }
            }
        }
        for (int i = 0; i < 3; i++) {
            double mse = sums[i] / 4000.0 / (last[i] - first[i] + 1);
            TEST_ASSERT_DOUBLE_WITHIN(0.03 * expected[which][i], expected[which][i], mse);
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
