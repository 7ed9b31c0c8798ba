/* The instruments of the tests on recordings: the sums that the rules stand on, medians, distances, counts. */
#include "support/random.h"
#include "support/roles.h"
#include "support/survey.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SEED 20

/* Sum of the magnitudes of the answer to one sample of 1; *square of their squares. */
static double answer_sum(double w1, double w2, double *square)
{
    double x = 0.0;
    double rate = 0.0;
    double sum = 0.0;
    *square = 0.0;
    for (int k = 0; k < 6000; k++) {
        x += rate;
        double r = (k == 0 ? 1.0 : 0.0) - x;
        x += w1 * r;
        rate += w2 * r;
        sum += fabs(x);
        *square += x * x;
    }
    return sum;
}

TEST(gain_sums_are_as_stated)
{
    double worst = 0.0;
    for (int i = 1; i <= 200; i++) {
        double w1 = 0.005 * i;
        double square;
        worst = fmax(worst, answer_sum(w1, w1 * w1 / (2.0 - w1), &square));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9 + 1e-6 * square, square, noise_gain_of(w1));
    }
    TEST_ASSERT_TRUE(worst <= law_facts(plain_kind()).envelope.gain_sum && worst > 1.43);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, noise_gain_of(0.0));
}

/* The paper's system: T = 0.0247 s and Q = 0.0009 against R = 0.0064 make q22 = Q T^2 / R = 8.58e-5. */
TEST(a_time_constant_of_the_paper_has_14_7_samples)
{
    double r_lsb2 = filter_parameter_q.standard * 1e-6 / 8.58e-5; /* the same q22 at 100 Hz */
    TEST_ASSERT_DOUBLE_WITHIN(0.05, 14.7, time_constant_samples(1000, r_lsb2));
    TEST_ASSERT_EQUAL_size_t(200, band_window(robust_kind(), 1000, r_lsb2));
}

TEST(even_medians_are_refused)
{
    median_t m;
    for (unsigned window = 0; window <= 12; window++) {
        const char *reason = median_init(&m, window);
        bool legal = window % 2U == 1U && window >= 3U && window <= MEDIAN_WINDOW_MAX;
        TEST_ASSERT_EQUAL_INT(legal, reason == NULL);
        TEST_ASSERT_TRUE(legal || strstr(reason, window % 2U == 0U ? "even" : "outside 3..9") != NULL);
    }
}

static int compare(const void *a, const void *b)
{
    return *(const int16_t *)a - *(const int16_t *)b;
}

/* Sliding medians and extremes against sorting. */
TEST(medians_are_those_of_sorting)
{
    enum { COUNT = 3000 };
    static int16_t z[COUNT];
    static band_t band;
    test_random_t random;
    random_seed(&random, SEED);
    for (size_t window = 1; window < 60; window += 7) {
        band_clear(&band);
        median_t five;
        TEST_ASSERT_NULL(median_init(&five, 5));
        for (size_t i = 0; i < COUNT; i++) {
            z[i] = as_sample(random_uniform(&random) < 0.1 ? 3000.0 * random_normal(&random)
                                                           : 20.0 * random_normal(&random));
            band_add(&band, z, window);
            int16_t ascending[60];
            size_t length = i + 1 < window ? i + 1 : window;
            memcpy(ascending, &z[i + 1 - length], length * sizeof z[0]);
            qsort(ascending, length, sizeof z[0], compare);
            double median = ascending[length / 2];
            TEST_ASSERT_EQUAL_DOUBLE(median, band_median_lsb(&band));
            TEST_ASSERT_EQUAL_DOUBLE(fmax(median - ascending[0], ascending[length - 1] - median),
                                     band_spread_lsb(&band));
            TEST_ASSERT_EQUAL_DOUBLE(0.0, band_outside_lsb(&band, z[i]));
            TEST_ASSERT_EQUAL_DOUBLE(1.5, band_outside_lsb(&band, ascending[0] - 1.5));
            length = i < 5 ? i + 1 : 5;
            memcpy(ascending, &z[i + 1 - length], length * sizeof z[0]);
            qsort(ascending, length, sizeof z[0], compare);
            TEST_ASSERT_EQUAL_INT16(ascending[length / 2], median_update(&five, z[i]));
        }
    }
}

/* R = 4 LSB^2 at 100 Hz: within reach 9 x 2 + 4 x 8 = 50 LSB; steps agree up to 3 sqrt(8) + 8 - 1 = 15.5. */
TEST(the_hull_tells_near_from_far)
{
    hull_t hull = { .filled = 0 };
    double left;
    for (int i = 0; i < 4; i++) {
        hull_add(&hull, (int16_t)(100 + 15 * i), 4.0, 0);
        TEST_ASSERT_FALSE(hull_judge(&hull, 1000, 100.0, &left));
    }
    hull_add(&hull, 160, 4.0, 0);
    TEST_ASSERT_TRUE(hull_judge(&hull, 1000, 160.0 + 49.9, &left) && left > 0.0);
    TEST_ASSERT_TRUE(hull_judge(&hull, 1000, 160.0 + 50.1, &left) && left < 0.0);
    TEST_ASSERT_TRUE(hull_judge(&hull, 1000, 100.0 - 50.1, &left) && left < 0.0);
    hull_add(&hull, 175, 4.0, 2); /* two missing before it: 16 LSB more */
    TEST_ASSERT_TRUE(hull_judge(&hull, 1000, 175.0 + 65.9, &left) && left > 0.0);
    TEST_ASSERT_TRUE(hull_judge(&hull, 1000, 175.0 + 66.1, &left) && left < 0.0);
    hull_add(&hull, 191, 4.0, 0);
    TEST_ASSERT_FALSE(hull_judge(&hull, 1000, 180.0, &left));
}

TEST(rows_are_counted)
{
    static stream_row_t rows[] = {
        { .lsb = { 0, 0, 0 } },      { .lsb = { -1, -1, -1 } },   { .lsb = { -1, -1, -1 } },   { .lsb = { 1, 2, 511 } },
        { .lsb = { 1, -512, 250 } }, { .lsb = { 1, -512, 250 } }, { .lsb = { 1, 510, -511 } },
    };
    stream_t stream = { .rows = rows, .count = sizeof rows / sizeof rows[0] };
    row_counts_t counts = survey_rows(&stream, 2);
    TEST_ASSERT_EQUAL_size_t(7, counts.rows);
    TEST_ASSERT_EQUAL_size_t(3, counts.clipped);
    TEST_ASSERT_EQUAL_size_t(2, counts.duplicates);
    TEST_ASSERT_EQUAL_size_t(1, counts.zeros);
    TEST_ASSERT_EQUAL_size_t(2, counts.ones);
    TEST_ASSERT_EQUAL_size_t(0, survey_rows(&stream, 16).clipped);
}

int main(void)
{
    printf("seed %d\n", SEED);
    return test_all();
}
