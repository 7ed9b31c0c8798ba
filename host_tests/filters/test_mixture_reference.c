/* The pieces of mixture.h against libm: posterior, log odds, and the distance of wide.h. */
#include "mixture.h"
#include "support/roles.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Every L of the format. p + (1 - p) = 1 exactly by construction; the tail ends at 12. */
TEST(posterior_is_the_sigmoid)
{
    double worst = 0.0;
    double worst_relative = 0.0;
    for (int l = -32767; l <= 32767; l++) {
        mixture_posterior_t posterior = filter_mixture_posterior((int16_t)l);
        double rest = posterior.rest_uq24 / 16777216.0;
        double exact = 1.0 / (1.0 + exp(abs(l) / 512.0));
        TEST_ASSERT_EQUAL(l < 0, posterior.outlier);
        if (abs(l) >= MIXTURE_TAIL_Q9) {
            TEST_ASSERT_EQUAL_UINT32(0, posterior.rest_uq24);
            continue;
        }
        worst = fmax(worst, fabs(rest - exact));
        worst_relative = fmax(worst_relative, (fabs(rest - exact) - 1.0 / 16777216.0) / exact); /* beyond a count */
    }
    printf("p: worst error %.5f, of min(p, 1 - p) %.3f %%\n", worst, 100.0 * worst_relative);
    TEST_ASSERT_TRUE(worst <= 0.0016);
    TEST_ASSERT_TRUE(worst_relative <= 0.02);
    TEST_ASSERT_EQUAL_UINT32(1UL << 23, filter_mixture_posterior(0).rest_uq24);
}

/* It falls without a step: the next L never has the larger rest. */
TEST(posterior_is_monotone)
{
    uint32_t before = filter_mixture_posterior(0).rest_uq24;
    for (int16_t l = 1; l < 7000; l++) {
        uint32_t rest = filter_mixture_posterior(l).rest_uq24;
        TEST_ASSERT_TRUE(rest <= before);
        TEST_ASSERT_EQUAL_UINT32(rest, filter_mixture_posterior((int16_t)-l).rest_uq24);
        before = rest;
    }
}

TEST(log_odds_are_the_logarithm)
{
    double worst = 0.0;
    for (uint32_t q = 1024; q <= 0x1000000U - 1024U; q += 509U) {
        double exact = log(q / (16777216.0 - q));
        worst = fmax(worst, fabs(filter_mixture_log_odds_q9(q) / 512.0 - exact));
    }
    printf("log odds: worst error %.5f\n", worst);
    TEST_ASSERT_TRUE(worst <= 0.006);
    TEST_ASSERT_EQUAL_INT16(0, filter_mixture_log_odds_q9(1UL << 23));
}

/* r^2 / (R S) for innovations, R and P11 of all sizes. */
TEST(distance_is_the_squared_innovation_in_variances)
{
    static const int32_t r_q8[] = { 3, 100, 256, 768, 4096, 40000, 256000 };
    double worst = 0.0;
    for (size_t i = 0; i < sizeof r_q8 / sizeof r_q8[0]; i++) {
        filter_config_t config = filter_defaults(&filter_law_pbf, 1000);
        config.value[MIXTURE_R_LSB2_Q8] = r_q8[i];
        filter_t f = made(&filter_law_pbf, &config);
        for (uint32_t p11 = 0; p11 < 0x7F000000U; p11 += p11 / 4U + 977U) {
            for (int16_t z = 1; z < 4095; z = (int16_t)(z + z / 7 + 1)) {
                wide_from(&f, 0, 0, (filter_covariance_t){ p11, 0, 0 });
                (void)filter_wide_predict(&f, z);
                double exact = z * (double)z / (r_q8[i] / 256.0) / (p11 / 65536.0 + 1.0);
                double got = filter_wide_distance_uq8(&f) / 256.0;
                if (exact >= 255.9) {
                    TEST_ASSERT_TRUE(got >= 255.8);
                } else {
                    worst = fmax(worst, (fabs(got - exact) - 1.0 / 256.0) / exact);
                }
            }
        }
    }
    printf("distance: worst relative error beyond 1/256: %.2e\n", worst);
    TEST_ASSERT_TRUE(worst <= 3e-4);
}

/* Steady gain for a drive q22 = w1^4 / ((2 - w1)^2 (1 - w1)), by bisection. */
static double steady_gain(double q22)
{
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 60; i++) {
        double w1 = 0.5 * (low + high);
        *(w1 * w1 * w1 * w1 < q22 * (2.0 - w1) * (2.0 - w1) * (1.0 - w1) ? &low : &high) = w1;
    }
    return low;
}

/* Largest position after a start at rate 1, and sum of the magnitudes of the rate's answer to one sample of 1. */
static void rate_answers(double w1, double *carried, double *driven)
{
    double w2 = w1 * w1 / (2.0 - w1);
    double x = 0.0;
    double rate = 1.0;
    double own_x = 0.0;
    double own_rate = 0.0;
    *carried = *driven = 0.0;
    for (int k = 0; k < 6000; k++) {
        x += rate;
        rate -= w2 * x;
        x -= w1 * x;
        *carried = fmax(*carried, fabs(x));
        own_x += own_rate;
        double r = (k == 0 ? 1.0 : 0.0) - own_x;
        own_x += w1 * r;
        own_rate += w2 * r;
        *driven += fabs(own_rate);
    }
}

/* At 400 times the R the drive per R is 1 / 400; both gains at their smallest are the worst. */
TEST(the_rate_of_a_mixture_carries_it_as_far_as_stated)
{
    double worst = 0.0;
    for (double q22 = 1e-6; q22 < 1.0; q22 *= 2.0) {
        double carried_slow;
        double carried;
        double driven;
        rate_answers(steady_gain(q22), &carried, &driven);
        double driven_fast = driven;
        rate_answers(steady_gain(q22 / 400.0), &carried_slow, &driven);
        worst = fmax(worst, driven_fast * carried_slow);
    }
    double stated = law_facts(FILTER_KIND_pbf).envelope.gain_sum - law_facts(plain_kind()).envelope.gain_sum;
    printf("rate of a mixture: %.3f, stated %.3f\n", worst, stated);
    TEST_ASSERT_TRUE(worst <= stated && worst > 0.95 * stated);
}
