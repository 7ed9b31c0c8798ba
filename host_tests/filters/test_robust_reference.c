/* The double references of paper 002 against the golden rows, exact covariances and each other. */
#include "reference/robust.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GOLDEN "../shared/reference/golden_mls.csv"
#define GOLDEN_FILTERS 9
#define FIRST_COLUMN 4
#define FIRST_REACQUIRING 7 /* of the filters */
#define REACQUIRE 5
#define AGREE_DEG 0.37

/* Order of the columns: four per filter. */
static robust_reference_t golden_filter(int column)
{
    static const char *const kinds[GOLDEN_FILTERS] = { "kf", "lrf",  "pbf",  "shrf", "af_grid",
                                                       "af", "sprf", "sprf", "soft" };
    robust_reference_t f;
    robust_reference_table1(&f, kinds[column]);
    if (column >= FIRST_REACQUIRING) {
        f.reacquire = REACQUIRE;
        f.agree = AGREE_DEG;
    }
    return f;
}

static double auxiliary(const robust_reference_t *f, int column)
{
    if (column >= 6) {
        return f->reacquired ? 2.0 : (f->gated ? 1.0 : 0.0);
    }
    return (column < 2) ? 0.0 : f->p_normal;
}

/* Twelve digits are printed; the KF and LRF have no p: their column is not looked at. */
static void compare(robust_reference_t *filters, const double *cells)
{
    for (int i = 0; i < GOLDEN_FILTERS; i++) {
        const double *wanted = cells + FIRST_COLUMN + 4 * i;
        robust_reference_t *f = &filters[i];
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted[0], robust_reference_step(f, cells[1]));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted[1], f->x[1]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted[2], f->p[0]);
        if (i >= 2) {
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, wanted[3], auxiliary(f, i));
        }
    }
}

TEST(golden_rows_are_reproduced)
{
    FILE *file = fopen(GOLDEN, "r");
    if (file == NULL) {
        TEST_IGNORE_MESSAGE(GOLDEN " is not there");
    }
    robust_reference_t filters[GOLDEN_FILTERS];
    for (int i = 0; i < GOLDEN_FILTERS; i++) {
        filters[i] = golden_filter(i);
    }
    char line[2000];
    int rows = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        double cells[40];
        int n = 0;
        for (char *word = strtok(line, ","); word != NULL && n < 40; word = strtok(NULL, ",")) {
            cells[n++] = atof(word);
        }
        if (n == 40 && line[0] != '#') {
            compare(filters, cells);
            rows++;
        }
    }
    fclose(file);
    TEST_ASSERT_EQUAL_INT(200, rows);
}

/* Riccati's equation of Table 1 solved by the prototypes to 9 digits. */
TEST(covariance_of_the_kf_comes_to_rest)
{
    robust_reference_t f;
    robust_reference_table1(&f, "kf");
    double p[4];
    double gain[2];
    robust_reference_steady(&f, p, gain);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * 8.14695564e-4, 8.14695564e-4, p[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * 2.24204683e-3, 2.24204683e-3, p[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * 1.32402513e-2, 1.32402513e-2, p[3]);
    /* K = P H' / R after the update */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, p[0] / f.r, gain[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, p[2] / f.r, gain[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 0.1273, 0.12730, gain[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 0.3503, 0.35032, gain[1]);
}

/* Error variances by Lyapunov's equation: outliers make the noise 0.85 + 0.15 x 400 = 60.85 times as large. */
TEST(lrf_gains_twofold_with_outliers_and_loses_sixfold_without)
{
    robust_reference_t kf;
    robust_reference_t lrf;
    robust_reference_table1(&kf, "kf");
    robust_reference_table1(&lrf, "lrf");
    double p[4];
    double kf_gain[2];
    double lrf_gain[2];
    robust_reference_steady(&kf, p, kf_gain);
    /* without outliers the KF's error is what its P says */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, p[0], robust_reference_lyapunov(&kf, kf_gain, kf.r));
    robust_reference_steady(&lrf, p, lrf_gain);
    double with = 60.85 * kf.r;
    double ratio_with = robust_reference_lyapunov(&kf, kf_gain, with) / robust_reference_lyapunov(&lrf, lrf_gain, with);
    double ratio_clean = robust_reference_lyapunov(&kf, kf_gain, kf.r) /
                         robust_reference_lyapunov(&lrf, lrf_gain, kf.r);
    /* 2.06 is given to three digits: half a unit of the last is 2.4e-3 of it */
    TEST_ASSERT_DOUBLE_WITHIN(0.005, 2.06, ratio_with);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 0.1715, 0.1715, ratio_clean);
}

static double difference_after(robust_reference_t *a, robust_reference_t *b, int samples)
{
    double largest = 0.0;
    for (int k = 0; k < samples; k++) {
        double z = 3.2 + 0.08 * sin(1.7 * k) + ((k % 7 == 3) ? 1.6 : 0.0);
        double difference = fabs(robust_reference_step(a, z) - robust_reference_step(b, z));
        largest = fmax(largest, difference);
    }
    return largest;
}

/* A reading that made no difference would be no reading. */
TEST(every_printed_reading_differs_from_the_corrected_one)
{
    static const char *const kinds[ROBUST_READING_COUNT] = {
        [ROBUST_PRINTED_15] = "af_grid", [ROBUST_PRINTED_GRID] = "af_grid", [ROBUST_PRINTED_21] = "pbf",
        [ROBUST_PRINTED_24] = "shrf",    [ROBUST_PRINTED_25] = "shrf",      [ROBUST_PRINTED_26] = "pbf",
        [ROBUST_PRINTED_27] = "shrf",    [ROBUST_PRINTED_30] = "shrf",      [ROBUST_PRINTED_33] = "sprf",
        [ROBUST_PRINTED_34] = "sprf",    [ROBUST_PRINTED_39] = "lrf",
    };
    for (int reading = ROBUST_CORRECTED + 1; reading < ROBUST_READING_COUNT; reading++) {
        robust_reference_t corrected;
        robust_reference_t printed;
        robust_reference_table1(&corrected, kinds[reading]);
        robust_reference_table1(&printed, kinds[reading]);
        printed.reading = (robust_reading_t)reading;
        double difference = difference_after(&corrected, &printed, 60);
        TEST_ASSERT_TRUE_MESSAGE(difference > 1e-6 || isnan(difference), "a reading changes nothing");
    }
}

/* The clairvoyant without outliers, the soft gate at infinity and outliers like all other samples: the KF. */
TEST(limits_of_the_filters_are_the_kf)
{
    robust_reference_t kf;
    robust_reference_t other;
    robust_reference_table1(&kf, "kf");
    robust_reference_table1(&other, "clairvoyant");
    TEST_ASSERT_TRUE(difference_after(&kf, &other, 60) < 1e-12);
    robust_reference_table1(&kf, "kf");
    robust_reference_table1(&other, "soft");
    other.softgate_sigma = 1e6;
    TEST_ASSERT_TRUE(difference_after(&kf, &other, 60) < 1e-12);
    robust_reference_table1(&kf, "kf");
    robust_reference_table1(&other, "pbf");
    other.ratio = 1.0 + 1e-9;
    TEST_ASSERT_TRUE(difference_after(&kf, &other, 60) < 1e-6);
}

TEST(median_start_is_the_median_of_five)
{
    static const double z[] = { 3.0, 9.0, -5.0, 3.2, 3.1 };
    static const double medians[] = { 3.0, 6.0, 3.0, 3.1, 3.1 };
    robust_reference_t f;
    robust_reference_table1(&f, "sprf");
    f.median_window = 5;
    for (int k = 0; k < 5; k++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, medians[k], robust_reference_step(&f, z[k]));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, f.r, f.p[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.04, f.p[3]);
}

static void assert_refused(const char *name, const robust_reference_t *f)
{
    const char *refused = robust_reference_refused(f);
    TEST_ASSERT_NOT_NULL(refused);
    TEST_ASSERT_EQUAL_STRING(name, refused);
}

TEST(parameters_outside_their_range_are_named)
{
    robust_reference_t good;
    robust_reference_table1(&good, "pbf");
    TEST_ASSERT_NULL(robust_reference_refused(&good));
    robust_reference_t f = good;
    f.r = 0.0;
    assert_refused("r", &f);
    f = good;
    f.q[3] = 0.0;
    assert_refused("q", &f);
    f = good;
    f.clean = 1.0;
    assert_refused("clean", &f);
    f.clean = 0.0;
    assert_refused("clean", &f);
    f = good;
    f.gate_sigma = 0.99;
    assert_refused("gate", &f);
    f = good;
    f.softgate_sigma = 0.5;
    assert_refused("softgate", &f);
    f = good;
    f.median_window = 4;
    assert_refused("median", &f);
}
