/*
 * Noise estimator: its constants from their integral, its level, its robustness, what it makes of paper 000's rolls,
 * and healthy samples at rest.
 */
#include "noise.h"
#include "reference/noise.h"
#include "stream.h"
#include "support/filters.h"
#include "support/roles.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>

#define SEED 99
#define ROLL_RUNS 4000

/* E min(m, limit) for m the smaller of two squared standard normal numbers: integral of erfc(sqrt(t / 2))^2. */
static double limited_mean(double limit)
{
    const int steps = 20000;
    double width = sqrt(limit) / steps;
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        double u = width * (i + 0.5); /* u^2 = t: smooth at 0 too */
        double tail = erfc(u * sqrt(0.5));
        sum += 2.0 * u * tail * tail;
    }
    return sum * width;
}

/* w = E min(m, c w) by iteration; the constants in noise.c are 65536 / 6w for c = 3 and 4.5, rounded. */
static double unbias(double c)
{
    double w = 0.3;
    for (int i = 0; i < 200; i++) {
        w = limited_mean(c * w);
    }
    return 65536.0 / (6.0 * w);
}

/* The mean, Q16, from this one, after so many terms and one more of two second differences of 32 LSB. */
static double mean_after(uint8_t terms, uint32_t mean_lsb2_q16)
{
    static const int16_t bends_of_32[] = { 0, 0, 32, 0, 0, 32 };
    noise_t n;
    filter_noise_init(&n, 690, false);
    for (int i = 0; i < 6; i++) {
        n.terms = terms;
        n.mean_lsb2_q16 = mean_lsb2_q16;
        (void)filter_noise_update(&n, bends_of_32[i]);
    }
    return n.mean_lsb2_q16;
}

/*
 * Half a unit of a constant is 512 in a term of 32^2, of which the mean takes the share of its window, rounded. The
 * opening has 64 terms.
 */
TEST(constants_solve_their_equation)
{
    const double mean = 3e7;
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 1.0 - 2.0 / 3.14159265358979, limited_mean(40.0));
    TEST_ASSERT_DOUBLE_WITHIN(512 / 32 + 1, mean + (1024 * unbias(4.5) - mean) / 32, mean_after(63, (uint32_t)mean));
    TEST_ASSERT_DOUBLE_WITHIN(512 / 64 + 1, mean + (1024 * unbias(3.0) - mean) / 64, mean_after(64, (uint32_t)mean));
}

/* A window of 256 rounds: a term within 128 counts of the mean leaves it. A window of 64 gives the term within 32. */
TEST(a_full_window_rounds_to_the_nearest)
{
    const double from = 3e7;
    double term = from + 64.0 * (mean_after(64, (uint32_t)from) - from);
    TEST_ASSERT_EQUAL_DOUBLE(term - 64.0, mean_after(255, (uint32_t)term - 64U));
    TEST_ASSERT_EQUAL_DOUBLE(term + 64.0, mean_after(255, (uint32_t)term + 64U));
    TEST_ASSERT_EQUAL_DOUBLE(term - 191.0, mean_after(255, (uint32_t)term - 192U));
}

static double estimate(uint16_t rate_dhz, double sigma, double outliers, int samples, double amplitude, uint64_t seed)
{
    noise_t n;
    filter_noise_init(&n, rate_dhz, false);
    test_random_t random;
    random_seed(&random, seed);
    for (int k = 0; k < samples; k++) {
        double s = random_uniform(&random) < outliers ? 20.0 * sigma : sigma;
        double t = k / (rate_dhz / 10.0);
        double motion = amplitude * sin(3.14159265 * t);
        (void)filter_noise_update(&n, as_sample(motion + s * random_normal(&random)));
    }
    return filter_noise_r_lsb2_q8(&n) / 256.0;
}

/*
 * 1.5 (sigma^2 + 1/12) within an eighth of hysteresis and three standard deviations: the limited terms have a relative
 * standard deviation below 1.2 and a window of 256 averages 511; neighbouring terms are correlated (a sample serves in
 * six), which makes it at most sqrt(6) times 1.2 / sqrt(511) = 13 %.
 */
TEST(level_is_one_and_a_half_variances)
{
    static const double sigmas[] = { 2, 4, 8, 16 };
    for (int i = 0; i < 40; i++) {
        double sigma = sigmas[i % 4];
        double expected = 1.5 * (sigma * sigma + 1.0 / 12.0);
        double r = estimate(1000, sigma, 0.0, 4000, 0.0, SEED + (uint64_t)i);
        TEST_ASSERT_DOUBLE_WITHIN((0.125 + 3 * 0.13) * expected, expected, r);
    }
}

/*
 * 0.5 Hz, +-30 degrees: the second difference over four samples is 128 (2 pi / 2)^2 (0.02)^2 = 0.5 LSB at most,
 * variance 0.25 / 2 / 6 = 0.02 LSB^2: nothing beside 4. */
TEST(motion_does_not_count_as_noise)
{
    double expected = 1.5 * (4.0 + 1.0 / 12.0);
    for (int i = 0; i < 10; i++) {
        double r = estimate(1000, 2.0, 0.0, 4000, 128.0, SEED + (uint64_t)i);
        TEST_ASSERT_DOUBLE_WITHIN((0.125 + 3 * 0.13) * expected, expected, r);
    }
}

/*
 * How many times too high the estimate settles when each sample is a huge outlier with probability 0.15: of the pairs
 * of differences 0.85^6 = 0.377 are clean, 0.474 have one clean difference, which is then the smaller, 0.149 none: the
 * limit c w. Solves 0.377 E min(m / x, c w) + 0.474 E min(a^2 / x, c w) + 0.149 c w = w for x by bisection.
 */
static double inflation(double c)
{
    double w = 65536.0 / (6.0 * unbias(c));
    double low = 1.0;
    double high = 50.0;
    for (int i = 0; i < 40; i++) {
        double x = 0.5 * (low + high);
        double mean = 0.377 * limited_mean(c * w * x) / x + 0.149 * c * w;
        double single = 0.0;
        for (int j = 0; j < 20000; j++) {
            single += erfc(sqrt(c * w * x * (j + 0.5) / 40000.0)) * c * w * x / 20000.0;
        }
        mean += 0.474 * single / x;
        *(mean > w ? &low : &high) = x;
    }
    return low;
}

/* Hysteresis and spread as above; finite outliers (20 sigma) stay a little below the bound for huge ones. */
TEST(outliers_do_not_run_away_with_it)
{
    double x = inflation(3.0);
    TEST_ASSERT_TRUE(x > 3.0 && x < 4.0);
    for (int i = 0; i < 10; i++) {
        double r = estimate(1000, 4.0, 0.15, 12000, 0.0, SEED + (uint64_t)i);
        TEST_ASSERT_TRUE(r < 1.5 * 16.0 * x * (1.125 + 3 * 0.13));
        TEST_ASSERT_TRUE(r > 1.5 * 16.0);
    }
}

/* From the floor (3 at 100 Hz) to 8 LSB rms (96) within 2 s; the same 32 times at 12.5 Hz in 2 s is 25 samples. */
TEST(climbs_from_the_floor_in_two_seconds)
{
    for (int i = 0; i < 10; i++) {
        TEST_ASSERT_TRUE(estimate(1000, 8.0, 0.0, 200, 0.0, SEED + (uint64_t)i) > 0.5 * 1.5 * 64.0);
        TEST_ASSERT_TRUE(estimate(125, 2.83, 0.0, 25, 0.0, SEED + (uint64_t)i) > 0.25 * 1.5 * 8.0);
    }
}

/* Paper 000's roll at a rate; a bad read is 20 degrees off, beyond all limits. */
typedef struct {
    const char *name;
    roll_profile_t profile;
    uint16_t rate_dhz;
    double bad;
} roll_case_t;

static double roll_variance(void)
{
    return ROLL_R_DEG2 * ROLL_LSB_PER_DEGREE * ROLL_LSB_PER_DEGREE + 1.0 / 12.0;
}

/* After 10 s. */
static reference_noise_estimate_t expected_of(const roll_case_t *c)
{
    static double truth_lsb[1001];
    for (int k = 0; k <= c->rate_dhz; k++) {
        truth_lsb[k] = ROLL_LSB_PER_DEGREE * roll_truth_deg(c->profile, 10.0 * k / c->rate_dhz);
    }
    reference_noise_t of = { truth_lsb, c->rate_dhz + 1, c->rate_dhz, roll_variance(), c->bad };
    return reference_noise_estimate(&of);
}

/* Estimate after 10 s in variances; the R in force lies within an eighth of 1.5 times it. */
static double roll_estimate(const roll_case_t *c, uint32_t *random)
{
    noise_t n;
    filter_noise_init(&n, c->rate_dhz, false);
    for (int k = 0; k <= c->rate_dhz; k++) {
        double bad_deg = roll_uniform(random) < c->bad ? 20.0 : 0.0;
        double truth_deg = roll_truth_deg(c->profile, 10.0 * k / c->rate_dhz);
        (void)filter_noise_update(&n, roll_measured_lsb(random, truth_deg + bad_deg, 0.0));
    }
    double r = filter_noise_r_lsb2_q8(&n) / 256.0;
    TEST_ASSERT_DOUBLE_WITHIN(r / 8.0 + 1.0 / 128.0, r, 1.5 * n.mean_lsb2_q16 / 65536.0);
    return n.mean_lsb2_q16 / 65536.0 / roll_variance();
}

/*
 * 1 % for what is left out, the third order of the fluctuation (a third of the second, 3.5 % at most), and three
 * standard errors. The variance of an exponential mean of terms, each with a relative deviation of 1.2 and correlated
 * with its neighbours as in level_is_one_and_a_half_variances.
 */
TEST(rolls_have_the_noise_that_the_terms_say)
{
    static const roll_case_t cases[] = {
        { "rest, 10 Hz", STILL, 100, 0.0 },      { "cos60, 10 Hz", COS60, 100, 0.0 },
        { "sine30, 10 Hz", SINE30, 100, 0.0 },   { "rest, 10 Hz, 1 % bad", STILL, 100, 0.01 },
        { "rest, 100 Hz", STILL, 1000, 0.0 },    { "rest, 100 Hz, 1 % bad", STILL, 1000, 0.01 },
        { "sine30, 100 Hz", SINE30, 1000, 0.0 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        uint32_t random = SEED + (uint32_t)i;
        double sum = 0.0;
        double squares = 0.0;
        for (int run = 0; run < ROLL_RUNS; run++) {
            double m = roll_estimate(&cases[i], &random);
            sum += m / ROLL_RUNS;
            squares += m * m / ROLL_RUNS;
        }
        double variance = squares - sum * sum;
        reference_noise_estimate_t e = expected_of(&cases[i]);
        double expected = e.estimate - e.bent * variance;
        printf("%s: %.4f variances, sd %.4f; %.4f expected, %.4f of it without fluctuation\n", cases[i].name, sum,
               sqrt(variance), expected, e.estimate);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 + 3.0 * sqrt(variance / ROLL_RUNS), expected, sum);
        TEST_ASSERT_TRUE(variance <= 6.0 * 1.2 * 1.2 * e.weight / (2.0 * (1.0 - e.again)) * expected * expected);
    }
}

/* A resting stretch of a recording and the output data rate of the sensor that made it. */
typedef struct {
    const char *path;
    double from_s, to_s;
    uint16_t rate_dhz;
    uint8_t every;
} rest_t;

/* Refused at most 2 % on each axis, no re-acquisition after the first 2 s. False: no such file. */
static bool check_rest(const rest_t *rest)
{
    stream_t stream;
    if (!stream_load(&stream, rest->path)) {
        return false;
    }
    for (int axis = 0; axis < 3; axis++) {
        noise_t n;
        filter_config_t config;
        filter_t f;
        filter_noise_init(&n, rest->rate_dhz, axis == 2);
        config = filter_defaults(filter_listed(robust_kind()), rest->rate_dhz);
        TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, filter_listed(robust_kind()), &config));
        filter_set_noise(&f, filter_noise_r_lsb2_q8(&n));
        int count = 0;
        int refused = 0;
        for (size_t i = 0; i < stream.count; i++) {
            double t = (double)stream.rows[i].t_us / 1e6;
            if (t < rest->from_s || t >= rest->to_s || i % rest->every != 0) {
                continue;
            }
            if (filter_noise_update(&n, stream.rows[i].lsb[axis])) {
                filter_set_noise(&f, filter_noise_r_lsb2_q8(&n));
            }
            (void)filter_update(&f, stream.rows[i].lsb[axis]);
            count++;
            refused += (f.flags & FILTER_GATED) != 0;
            if (count > 2 * rest->rate_dhz / 10) {
                TEST_ASSERT_EQUAL_UINT8_MESSAGE(0, f.flags & FILTER_REACQUIRED, rest->path);
            }
        }
        TEST_ASSERT_TRUE_MESSAGE(count > 100, rest->path);
        TEST_ASSERT_TRUE_MESSAGE(refused * 50 <= count, rest->path);
    }
    stream_free(&stream);
    return true;
}

TEST(shipped_rests_are_hardly_refused)
{
    static const rest_t rests[] = {
        { "sim/streams/rest-0.7lsb.csv", 0, 1e9, 1000, 1 },
        { "sim/streams/rest-2lsb.csv", 0, 1e9, 1000, 1 },
        { "sim/streams/rest-4lsb.csv", 0, 1e9, 1000, 1 },
        { "sim/streams/rest-8lsb.csv", 0, 1e9, 1000, 1 },
    };
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE_MESSAGE(check_rest(&rests[i]), rests[i].path);
    }
}

#define SHARED "../shared/streams/"

TEST(recorded_rests_are_hardly_refused)
{
    static const rest_t rests[] = {
        { SHARED "test-only/gy85-tilt-92hz.csv", 0, 23, 1000, 1 },
        { SHARED "test-only/uav-arm-100-a.csv", 0, 6, 1000, 1 },
        { SHARED "test-only/uav-hover-poll166.csv", 0, 10, 1000, 1 },
        { SHARED "test-only/printer-400-rest-zdown.csv", 0, 60, 4000, 1 },
        { SHARED "test-only/sis-fall-rail.csv", 11, 15, 2000, 1 },
        { SHARED "test-only/sis-garbled.csv", 9.5, 15, 2000, 1 },
        { SHARED "test-only/sis-zero-read-a.csv", 8.5, 12, 2000, 1 },
        { SHARED "test-only/sis-lie-slow.csv", 0, 2, 2000, 1 },
        { SHARED "test-only/sis-lie-slow.csv", 6, 8, 2000, 1 },
        { SHARED "test-only/sis-roll90.csv", 0, 1.5, 2000, 1 },
        { SHARED "open/kl3200-rest-zup.csv", 0, 1e9, 8000, 1 },
        { SHARED "open/kl3200-rest-zup.csv", 0, 1e9, 8000, 4 },
        { SHARED "open/freeimu-orient-a.csv", 54.9, 80, 250, 1 },
        { SHARED "open/freeimu-orient-a.csv", 0, 17, 250, 1 },
    };
    int found = 0;
    for (size_t i = 0; i < sizeof rests / sizeof rests[0]; i++) {
        found += check_rest(&rests[i]);
    }
    if (found == 0) {
        TEST_IGNORE_MESSAGE(SHARED " is not there");
    }
    TEST_ASSERT_EQUAL_INT(sizeof rests / sizeof rests[0], found);
}

int main(void)
{
    printf("seed %d\n", SEED);
    return test_all();
}
