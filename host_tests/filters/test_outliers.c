/* The outliers that make default puts into streams: as many, as large and in such runs as support/outliers.h says. */
#include "support/outliers.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS 40000U
#define RATE_DHZ 4000U /* twice the noise of 100 Hz */

static stream_t clean;
static char text[120];

void setUp(void)
{
    clean.rate_hz = RATE_DHZ / 10.0;
    clean.count = ROWS;
    clean.rows = calloc(ROWS, sizeof *clean.rows);
    TEST_ASSERT_NOT_NULL(clean.rows);
    for (size_t i = 0; i < ROWS; i++) { /* no reading twice in a row */
        clean.rows[i].t_us = 2500U * i;
        clean.rows[i].lsb[0] = (int16_t)(i % 2U);
        clean.rows[i].lsb[1] = (int16_t)(i % 2U);
        clean.rows[i].lsb[2] = (int16_t)(250U + i % 2U);
    }
}

void tearDown(void)
{
    stream_free(&clean);
}

typedef struct {
    double share, run, sigma_lsb; /* mean length of runs; of the first deviate of each */
    size_t repeats;               /* outliers that read as the row before */
} seen_t;

static seen_t seen(const faulty_t *faulty, int axis)
{
    size_t outliers = 0;
    size_t runs = 0;
    double square = 0.0;
    bool before = false;
    seen_t found = { .repeats = 0 };
    for (size_t i = 0; i < ROWS; i++) {
        double off_lsb = faulty->stream.rows[i].lsb[axis] - clean.rows[i].lsb[axis];
        bool outlier = fabs(off_lsb) > 0.0;
        outliers += outlier;
        found.repeats += outlier && before && faulty->stream.rows[i].lsb[axis] == faulty->stream.rows[i - 1].lsb[axis];
        if (outlier && !before) {
            runs++;
            square += off_lsb * off_lsb;
        }
        before = outlier;
    }
    found.share = (double)outliers / ROWS;
    found.run = (double)outliers / (double)runs;
    found.sigma_lsb = sqrt(square / (double)runs);
    return found;
}

static faulty_t made(outliers_t kind, uint8_t range_g)
{
    faulty_t faulty;
    TEST_ASSERT_TRUE(outliers_make(&faulty, &clean, kind, RATE_DHZ, range_g, 1));
    TEST_ASSERT_EQUAL_size_t(ROWS, faulty.stream.count);
    return faulty;
}

/*
 * A share p with runs of mean length n has a standard deviation of sqrt(p (1 - p) / rows x (1 + r) / (1 - r)), where r
 * = 1 - 1 / n - p / (1 - p) / n is what a reading says of the next: 0.0018 alone, 0.0051 in runs. Four of them, and
 * four of the mean length of 5,100 or 1,200 runs. One deviate in 200 is rounded to 0.
 */
TEST(they_are_as_many_as_large_and_in_such_runs)
{
    static const struct {
        double share_off, run, run_off, sigma_off;
    } wanted[OUTLIERS_COUNT] = { { 0.008, 1.0 / 0.85, 0.03, 0.05 },
                                 { 0.022, 5.0, 0.6, 0.09 },
                                 { 0.022, 5.0, 0.6, 0.09 } };
    for (outliers_t kind = (outliers_t)0; kind < OUTLIERS_COUNT; kind++) {
        faulty_t faulty = made(kind, 16);
        for (int axis = 0; axis < 3; axis++) {
            seen_t found = seen(&faulty, axis);
            double sigma_lsb = 80.0 * (axis == 2 ? 1.3 : 1.0);
            snprintf(text, sizeof text, "%s, %c: share %.4f, runs %.3f, %.1f LSB", outliers_name(kind), "xyz"[axis],
                     found.share, found.run, found.sigma_lsb);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(wanted[kind].share_off, OUTLIER_SHARE, found.share, text);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(wanted[kind].run_off, wanted[kind].run, found.run, text);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(wanted[kind].sigma_off * sigma_lsb, sigma_lsb, found.sigma_lsb, text);
        }
        faulty_free(&faulty);
    }
}

/* Of runs of mean length 5 four readings in five repeat where the first is held; of deviates of 80 LSB, one in 283. */
TEST(only_what_is_held_repeats)
{
    faulty_t apart = made(OUTLIERS_IN_RUNS, 16);
    faulty_t held = made(OUTLIERS_HELD, 16);
    size_t outliers = (size_t)(OUTLIER_SHARE * ROWS);
    TEST_ASSERT_LESS_THAN_size_t(outliers / 50U, seen(&apart, 0).repeats);
    TEST_ASSERT_GREATER_THAN_size_t(outliers * 7U / 10U, seen(&held, 0).repeats);
    faulty_free(&apart);
    faulty_free(&held);
}

/* 250 LSB lie 2.5 standard deviations of z below the rail of 2 g: one outlier in 160 ends there. */
TEST(the_rails_of_the_range_hold)
{
    faulty_t faulty = made(OUTLIERS_ALONE, 2);
    size_t at_rail = 0;
    for (size_t i = 0; i < ROWS; i++) {
        int16_t lsb = faulty.stream.rows[i].lsb[2];
        TEST_ASSERT_TRUE(lsb >= -512 && lsb <= 511);
        at_rail += lsb == 511;
    }
    TEST_ASSERT_TRUE(at_rail > 10 && at_rail < 80);
    faulty_free(&faulty);
}

TEST(axes_have_their_own_and_a_seed_gives_the_same)
{
    faulty_t one = made(OUTLIERS_ALONE, 16);
    faulty_t same = made(OUTLIERS_ALONE, 16);
    size_t any = 0;
    for (size_t i = 0; i < ROWS; i++) {
        TEST_ASSERT_EQUAL_INT16_ARRAY(one.stream.rows[i].lsb, same.stream.rows[i].lsb, 3);
        TEST_ASSERT_EQUAL_size_t(i, one.source[i]);
        any += memcmp(one.stream.rows[i].lsb, clean.rows[i].lsb, sizeof clean.rows[i].lsb) != 0;
    }
    TEST_ASSERT_EQUAL_size_t(any, one.faulty);
    /* 1 - 0.85^3 of the rows; four standard deviations */
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.386, (double)any / ROWS);
    faulty_free(&one);
    faulty_free(&same);
}
