/* The pieces of mixture.h against libm: posterior, log odds, and the distance of wide.h. */
#include "mixture.h"
#include "support_laws.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void setUp(void) {}

void tearDown(void) {}

/* Every L of the format. p + (1 - p) = 1 exactly by construction; the tail ends at 12. */
static void posterior_is_the_sigmoid(void)
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
static void posterior_is_monotone(void)
{
    uint32_t before = filter_mixture_posterior(0).rest_uq24;
    for (int16_t l = 1; l < 7000; l++) {
        uint32_t rest = filter_mixture_posterior(l).rest_uq24;
        TEST_ASSERT_TRUE(rest <= before);
        TEST_ASSERT_EQUAL_UINT32(rest, filter_mixture_posterior((int16_t)-l).rest_uq24);
        before = rest;
    }
}

static void log_odds_are_the_logarithm(void)
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
static void distance_is_the_squared_innovation_in_variances(void)
{
    static const int32_t r_q8[] = { 3, 100, 256, 768, 4096, 40000, 256000 };
    double worst = 0.0;
    for (size_t i = 0; i < sizeof r_q8 / sizeof r_q8[0]; i++) {
        filter_config_t config = filter_defaults(&filter_law_pbf, 1000);
        filter_t f;
        config.value[MIXTURE_R_LSB2_Q8] = r_q8[i];
        TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_pbf, &config));
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(posterior_is_the_sigmoid);
    RUN_TEST(posterior_is_monotone);
    RUN_TEST(log_odds_are_the_logarithm);
    RUN_TEST(distance_is_the_squared_innovation_in_variances);
    return UNITY_END();
}
