/* synth_plus against its double reference, and the reference against what the filter is said to contain. */
#include "reference/synth_plus.h"
#include "support/test_law.h"
#include "synth.h"

#include <math.h>

#define SEED 7201

static double wave(int k, test_random_t *random)
{
    return 800.0 * sin(0.02 * k) + 2.0 * random_normal(random);
}

/* a1 = 0, b0 = alpha, b1 = beta - alpha: 1e-13 of a signal of 800. */
TEST(contains_alpha_beta)
{
    static const double gains[4][2] = { { 0.5, 0.1 }, { 0.2887, 0.0487 }, { 0.9, 0.9 }, { 0.05, 0.0013 } };
    test_random_t random;
    random_seed(&random, SEED);
    for (int i = 0; i < 4; i++) {
        reference_taps_t taps = { 0.0, gains[i][0], gains[i][1] - gains[i][0], 0.0 };
        reference_plus_t f = { { 0.0 }, { 0.0 } };
        double state[2] = { 0.0, 0.0 };
        for (int k = 0; k < 5000; k++) {
            double z = wave(k, &random) / 800.0;
            double expected = reference_alpha_beta_step(state, gains[i][0], gains[i][1], z);
            TEST_ASSERT_DOUBLE_WITHIN(1e-13, expected, reference_plus_step(&f, &taps, z));
        }
    }
}

/*
 * Taps of notes 5.3, to the digits printed there, from the Riccati recursion; the filters' answers equal to 1e-12; and
 * the relation b2 = rho (1 - b0) (b1 + (2 + rho) b0) of every such filter.
 */
TEST(contains_the_steady_singer_filter)
{
    static const struct {
        double rho, lambda, b[3];
    } cases[] = { { 0.7, 0.01, { 0.509563, -0.678818, 0.239285 } },
                  { 0.9, 0.001, { 0.423581, -0.682675, 0.283102 } },
                  { 1.0, 0.0005, { 0.431300, -0.733268, 0.318831 } } };
    test_random_t random;
    random_seed(&random, SEED + 1);
    for (int i = 0; i < 3; i++) {
        double k3[3];
        double state[3] = { 0.0, 0.0, 0.0 };
        reference_plus_t f = { { 0.0 }, { 0.0 } };
        reference_singer_gains(cases[i].rho, cases[i].lambda, k3);
        reference_taps_t taps = reference_singer_taps(cases[i].rho, k3);
        TEST_ASSERT_DOUBLE_WITHIN(6e-7, cases[i].b[0], taps.b0);
        TEST_ASSERT_DOUBLE_WITHIN(6e-7, cases[i].b[1], taps.b1);
        TEST_ASSERT_DOUBLE_WITHIN(6e-7, cases[i].b[2], taps.b2);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, cases[i].rho * (1.0 - taps.b0) * (taps.b1 + (2.0 + cases[i].rho) * taps.b0),
                                  taps.b2);
        for (int k = 0; k < 5000; k++) {
            double z = wave(k, &random) / 800.0;
            double expected = reference_singer_step(state, cases[i].rho, k3, z);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected, reference_plus_step(&f, &taps, z));
        }
    }
}

static reference_taps_t taps_of(const filter_config_t *config)
{
    double rho = config->value[SYNTH_PLUS_K] < 8 ? 1.0 - pow(2.0, -(double)config->value[SYNTH_PLUS_K]) : 1.0;
    return (reference_taps_t){ -rho, config->value[SYNTH_PLUS_B0_UQ16] / 65536.0,
                               config->value[SYNTH_PLUS_B1_Q16] / 65536.0, config->value[SYNTH_PLUS_B2_Q16] / 65536.0 };
}

static filter_config_t random_taps(uint32_t *state)
{
    filter_config_t config = filter_defaults(&filter_law_synth_plus, 1000);
    config.value[SYNTH_PLUS_K] = (uint16_t)random32_below(state, 9);
    config.value[SYNTH_PLUS_B0_UQ16] = (uint16_t)(656U + random32_below(state, 65536U - 656U));
    config.value[SYNTH_PLUS_B1_Q16] = (int32_t)random32_below(state, 131071) - 65535;
    config.value[SYNTH_PLUS_B2_Q16] = (int32_t)random32_below(state, 131071) - 65535;
    return config;
}

/* 20,000 coefficients at random: taken exactly when all poles are inside the unit circle, to the eigenvalues' 1e-6. */
TEST(region_is_exactly_the_stable_one)
{
    uint32_t state = SEED;
    int taken = 0;
    int refused = 0;
    for (int i = 0; i < 20000; i++) {
        filter_t f;
        filter_config_t config = random_taps(&state);
        reference_taps_t taps = taps_of(&config);
        double radius = reference_plus_radius(&taps);
        bool legal = (filter_init(&f, &filter_law_synth_plus, &config) == FILTER_ACCEPTED);
        if (fabs(radius - 1.0) > 1e-6) {
            TEST_ASSERT_EQUAL_INT(radius < 1.0, legal);
            taken += legal ? 1 : 0;
            refused += legal ? 0 : 1;
        }
    }
    TEST_ASSERT_TRUE(taken > 5000 && refused > 5000);
}

/*
 * The reference's own radius where poles lie on each other: critically damped alpha-beta (two at theta) and the steady
 * Singer filter with rho = 1 (three: trace 3 - k0 - k1 = 3 theta, minors 3 - 2 k0 - k1 + k2 = 3 theta^2, 1 - k0 =
 * theta^3). Rounding moves such poles by the root of its size.
 */
TEST(poles_on_each_other_have_their_radius)
{
    for (double theta = 0.3; theta < 0.9995; theta += 0.0333) {
        reference_taps_t two = { 0.0, 1.0 - theta * theta, 0.0, 0.0 };
        two.b1 = (1.0 - theta) * (1.0 - theta) - two.b0;
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, theta, reference_plus_radius(&two));
        double k[3] = { 1.0 - theta * theta * theta, 0.0, 0.0 };
        k[1] = 3.0 - 3.0 * theta - k[0];
        k[2] = 3.0 * theta * theta - 3.0 + 2.0 * k[0] + k[1];
        reference_taps_t three = reference_singer_taps(1.0, k);
        TEST_ASSERT_DOUBLE_WITHIN(5e-5, theta, reference_plus_radius(&three));
    }
}

/* Closed form against the Lyapunov equation, relative error as synth_plus.c says. */
TEST(noise_gain_is_that_of_the_reference)
{
    uint32_t state = SEED + 1;
    int compared = 0;
    for (int i = 0; i < 20000; i++) {
        filter_config_t config = random_taps(&state);
        reference_taps_t taps = taps_of(&config);
        if (reference_plus_radius(&taps) < 0.99) {
            double expected = reference_plus_noise_gain(&taps);
            double got = filter_synth_taps_noise_gain_uq16(&config) / 65536.0;
            TEST_ASSERT_DOUBLE_WITHIN(expected / 512.0, expected, got);
            compared++;
        }
    }
    TEST_ASSERT_TRUE(compared > 4000);
    /* slow alpha-beta: (2 alpha^2 + beta (2 - 3 alpha)) / (alpha (4 - 2 alpha - beta)) */
    for (int i = 656; i < 65536; i += 997) {
        double alpha = i / 65536.0;
        filter_config_t config = filter_defaults(&filter_law_synth_plus, 1000);
        config.value[SYNTH_PLUS_B0_UQ16] = (uint16_t)i;
        config.value[SYNTH_PLUS_B1_Q16] = (int32_t)lround(65536.0 * alpha * alpha / (2.0 - alpha)) - i;
        double beta = alpha + config.value[SYNTH_PLUS_B1_Q16] / 65536.0;
        double expected = (2.0 * alpha * alpha + beta * (2.0 - 3.0 * alpha)) / (alpha * (4.0 - 2.0 * alpha - beta));
        TEST_ASSERT_DOUBLE_WITHIN(expected / 512.0, expected, filter_synth_taps_noise_gain_uq16(&config) / 65536.0);
    }
}

/* The defaults are the steady gains of kf at its defaults, within 0.1 % of alpha and 0.4 % of beta, 25 to 800 Hz. */
TEST(defaults_are_steady_gains)
{
    static const uint16_t rates_dhz[] = { 250, 500, 1000, 2000, 4000, 8000 };
    for (int i = 0; i < 6; i++) {
        filter_config_t config;
        double k[2];
        double period_s = 10.0 / rates_dhz[i];
        config = filter_defaults(&filter_law_synth_plus, rates_dhz[i]);
        double r_lsb2 = 0.003 * rates_dhz[i];
        reference_white_gains(10000.0 * period_s * period_s * period_s / r_lsb2, k);
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * k[0], k[0], config.value[SYNTH_PLUS_B0_UQ16] / 65536.0);
        double beta = (config.value[SYNTH_PLUS_B0_UQ16] + config.value[SYNTH_PLUS_B1_Q16]) / 65536.0;
        TEST_ASSERT_DOUBLE_WITHIN(4e-3 * k[1] + 1.0 / 65536.0, k[1], beta);
    }
}

/* Filters that the test runs: default, alpha-beta slow and fast, Singer with rho 1/2, 7/8, 1, and b1 alone. */
static const struct {
    uint16_t k, b0_uq16;
    int32_t b1_q16, b2_q16;
    int roundings; /* half counts in x_e */
} filters[] = {
    { 0, 18921, -15729, 0, 1 },     { 0, 3277, -3194, 0, 1 },       { 0, 58982, 3277, 0, 1 },
    { 1, 34406, -39000, 10500, 3 }, { 3, 27000, -43400, 17900, 3 }, { 8, 28266, -48056, 20895, 2 },
    { 2, 40000, -30000, 0, 2 },
};
enum { FILTERS = sizeof filters / sizeof filters[0] };

static filter_config_t config_of(int i)
{
    filter_config_t config = filter_defaults(&filter_law_synth_plus, 1000);
    config.value[SYNTH_PLUS_K] = filters[i].k;
    config.value[SYNTH_PLUS_B0_UQ16] = filters[i].b0_uq16;
    config.value[SYNTH_PLUS_B1_Q16] = filters[i].b1_q16;
    config.value[SYNTH_PLUS_B2_Q16] = filters[i].b2_q16;
    return config;
}

/* From rest: |x - reference| within the rounding's worst case, at every one of 20,000 samples. */
TEST(estimate_equals_the_reference)
{
    test_random_t random;
    random_seed(&random, SEED + 2);
    for (int i = 0; i < FILTERS; i++) {
        filter_config_t config = config_of(i);
        reference_taps_t taps = taps_of(&config);
        double bound = reference_plus_rounding_lsb(&taps, filters[i].roundings);
        reference_plus_t r = { { 0.0 }, { 0.0 } };
        filter_t f = made(&filter_law_synth_plus, &config);
        filter_reset(&f, 0);
        for (int k = 0; k < 20000; k++) {
            int16_t z = as_sample(wave(k, &random));
            double got = filter_update(&f, z) / 65536.0;
            (void)reference_plus_step(&r, &taps, z);
            TEST_ASSERT_TRUE(fabs(got - r.x[0]) <= bound + 1e-9);
        }
    }
}

/*
 * The start is the line of least squares through all samples so far, up to sample 31, the first five of which count as
 * their median: gains within 2^-17, so 0.02 LSB.
 */
TEST(start_is_the_least_squares_line)
{
    test_random_t random;
    random_seed(&random, SEED + 3);
    for (int run = 0; run < 50; run++) {
        filter_config_t config;
        double z[31];
        config = filter_defaults(&filter_law_synth_plus, 1000);
        config.value[SYNTH_PLUS_B0_UQ16] = 3277;
        config.value[SYNTH_PLUS_B1_Q16] = -3194;
        config.value[SYNTH_PLUS_K] = 2;
        filter_t f = made(&filter_law_synth_plus, &config);
        for (int k = 0; k < 31; k++) {
            int16_t sample = as_sample(100.0 + 5.0 * k + 2.0 * random_normal(&random));
            z[k] = sample;
            double x = filter_update(&f, sample) / 65536.0;
            if (k >= FILTER_WARM_UP_SAMPLES) {
                TEST_ASSERT_DOUBLE_WITHIN(0.02, reference_line_end(z, k + 1), x);
            }
            for (int i = 0; k == FILTER_WARM_UP_SAMPLES - 1 && i <= k; i++) {
                z[i] = x; /* the median */
            }
        }
        double own = filter_update(&f, 255) / 65536.0;
        TEST_ASSERT_EQUAL_UINT16(3277, f.gain_uq16);
        TEST_ASSERT_TRUE(isfinite(own));
    }
}

/*
 * rho is one of 1 - 2^-k. A process whose rho lies between is followed with the nearer one (on a logarithmic scale of
 * 1 - rho), noise adjusted: the variance is at most 0.5 % above that of the filter made for it, for lambda from 1e-4 to
 * 1 and rho from 0 to 0.995.
 */
static double with_nearest(double rho, double lambda)
{
    double k = floor(0.5 - log2(1.0 - rho));
    double near = k < 8.0 ? 1.0 - pow(2.0, -k) : 1.0;
    double least = HUGE_VAL;
    for (double factor = 0.125; factor < 8.1; factor *= sqrt(2.0)) {
        double gains[3];
        reference_singer_gains(near, lambda * factor, gains);
        least = fmin(least, reference_singer_error(near, gains, rho, lambda));
    }
    return least;
}

TEST(nearest_rho_costs_little)
{
    double worst = 1.0;
    for (int i = 0; i < 8; i++) {
        double rho = 1.0 - pow(2.0, -(i + 0.499)); /* as far from two of them as can be */
        for (double lambda = 1e-4; lambda < 2.0; lambda *= 10.0) {
            double gains[3];
            reference_singer_gains(rho, lambda, gains);
            double best = reference_singer_error(rho, gains, rho, lambda);
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, gains[0], best); /* P = R k1 */
            worst = fmax(worst, with_nearest(rho, lambda) / best);
        }
    }
    printf("synth_plus: variance with the nearest rho at most %.4f of the optimum\n", worst);
    TEST_ASSERT_TRUE(worst < 1.005);
}
