/* Closed forms of the constant synthesised filter and its region of stability, against sums and eigenvalues. */
#include "reference/synth.h"
#include "reference/synthesis.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>

/* Table of the notes, section 1. */
static const double table[][2] = { { -0.3, 0.1 },           { 0, 0.1 },  { 0, 0.3 }, { -0.3, 0.5 }, { 0, 2.0 / 3 },
                                   { -1.0 / 6, 11.0 / 13 }, { 0.5, 0.5 } };
enum { ROWS = sizeof table / sizeof table[0] };

/* Sums over the impulse response of the recursion (7); the extrapolation's is the sum over x_e, in which h0 is not. */
TEST(closed_forms_are_sums_of_the_impulse_response)
{
    for (int i = 0; i < ROWS; i++) {
        double a1 = table[i][0];
        double b0 = table[i][1];
        double noise = 0.0;
        double extrapolated = 0.0;
        double second = 0.0;
        reference_synth_t f;
        reference_synth_at(&f, a1, b0, 0.0);
        for (int n = 0; n < 4000; n++) {
            double h = reference_synth_step(&f, n == 0 ? 1.0 : 0.0);
            noise += h * h;
            extrapolated += n > 0 ? f.extrapolated * f.extrapolated : 0.0;
            second += h * n * (n + 1.0) / 2.0;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, noise, reference_closed_noise_gain(a1, b0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, reference_synth_noise_gain(a1, b0), reference_closed_noise_gain(a1, b0));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, extrapolated, reference_closed_pe(a1, b0));
        /* x(n - k) of x = n (n + 1) / 2 is x - k n + k (k - 1) / 2, and the filter has no error on a line */
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, -second, reference_closed_lag(a1, b0));
    }
}

/* The covariance recursion ends where the closed forms are. */
TEST(covariance_recursion_has_the_closed_forms)
{
    for (int i = 0; i < ROWS; i++) {
        double s[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
        for (int n = 0; n < 4000; n++) {
            reference_covariance_step(s, table[i][0], table[i][1], 1.0);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, reference_closed_noise_gain(table[i][0], table[i][1]), s[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, reference_closed_pe(table[i][0], table[i][1]),
                                  reference_covariance_pe(s, table[i][0]));
    }
}

/* 400 x 400 points each, midway between the borders' rational points; only what eigenvalues cannot tell is left out. */
TEST(stability_is_exact_on_a_grid)
{
    enum { N = 400 };
    int stable[2] = { 0, 0 };
    int left_out = 0;
    for (int i = 0; i < N * N; i++) {
        double u = (i % N + 0.5) / N;
        double v = (i / N + 0.5) / N;
        double a1 = -u;
        double b0 = v;
        bool legal = reference_synth_radius(a1, b0) < 1.0;
        TEST_ASSERT_EQUAL_INT(legal, reference_closed_stable_region(a1, b0));
        stable[0] += legal ? 1 : 0;
        TEST_ASSERT_TRUE_MESSAGE(legal || !reference_printed_region(a1, b0),
                                 "the printed region holds an unstable point");
        a1 = -2.0 + 4.0 * u;
        b0 = -0.5 + 3.0 * v;
        double radius = reference_synth_radius(a1, b0);
        if (fabs(radius - 1.0) < 1e-9) {
            left_out++;
            continue;
        }
        TEST_ASSERT_EQUAL_INT(radius < 1.0, reference_closed_stable(a1, b0));
        stable[1] += radius < 1.0 ? 1 : 0;
    }
    printf("stable: %d of %d in the paper's box, %d of %d around it (%d on the border)\n", stable[0], N * N, stable[1],
           N * N, left_out);
    TEST_ASSERT_TRUE(stable[0] > N * N / 2 && stable[0] < N * N);
    TEST_ASSERT_TRUE(stable[1] > 1000 && left_out < 100);
}

/* Noise is not amplified exactly where (1 - b0)(3 a1^2 - 2 a1) <= 1; inside the printed region it may double. */
TEST(noise_is_amplified_inside_the_printed_region)
{
    double worst = 0.0;
    for (int i = 1; i < 400; i++) {
        for (int j = 1; j < 400; j++) {
            double a1 = -i / 400.0;
            double b0 = j / 400.0;
            double border = (1.0 - b0) * (3.0 * a1 * a1 - 2.0 * a1) - 1.0;
            if (reference_closed_stable_region(a1, b0) && fabs(border) > 1e-9) {
                TEST_ASSERT_EQUAL_INT(border < 0.0, reference_closed_noise_gain(a1, b0) < 1.0);
            }
            if (reference_printed_region(a1, b0)) {
                worst = fmax(worst, reference_closed_noise_gain(a1, b0));
            }
        }
    }
    printf("largest noise gain in the printed region: %.3f\n", worst);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 2.2, worst);
}
