/* Roll over the shipped streams: fixed point against double, robust against not, filtered against raw. */
#include "filter_list.h"
#include "noise.h"
#include "reference/filters.h"
#include "stream.h"
#include "support/roles.h"
#include "support/test.h"
#include "tilt.h"
#include "tracker.h"

#include <math.h>
#include <stdio.h>

#define FIRST_ROW 10U /* warm-up rows of the filter and as many again are not scored */
#define DEGREES (180.0 / 3.14159265358979323846)

/* RMS errors of roll, degrees. */
typedef struct {
    double raw, plain, robust, plain_double, robust_double;
} score_t;

typedef struct {
    filter_t f[FILTER_KIND_COUNT];
    robust_reference_t plain, robust;
    noise_t noise;
} axis_t;

static double wrapped(double degrees)
{
    return degrees - 360.0 * floor(degrees / 360.0 + 0.5);
}

/* Median of five by counting: the start of the references, as of the filters. */
static double median5(const stream_t *s, int axis)
{
    for (int i = 0; i < 5; i++) {
        int below = 0;
        int equal = 0;
        for (int j = 0; j < 5; j++) {
            below += s->rows[j].lsb[axis] < s->rows[i].lsb[axis];
            equal += s->rows[j].lsb[axis] == s->rows[i].lsb[axis];
        }
        if (below <= 2 && below + equal > 2) {
            return s->rows[i].lsb[axis];
        }
    }
    return 0.0;
}

/* r_lsb2 0: floor and estimate, as the firmware uses them. */
static void start_axis(axis_t *a, const stream_t *s, int axis, double r_lsb2)
{
    uint16_t rate_dhz = (uint16_t)lrint(s->rate_hz * 10.0);
    filter_noise_init(&a->noise, rate_dhz, axis == 2);
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        filter_config_t config = filter_defaults(filter_listed((filter_kind_t)kind), rate_dhz);
        TEST_ASSERT_TRUE(filter_init(&a->f[kind], filter_listed((filter_kind_t)kind), &config) == FILTER_ACCEPTED);
        uint32_t r_q8 = r_lsb2 > 0.0 ? (uint32_t)lrint(r_lsb2 * 256.0) : filter_noise_r_lsb2_q8(&a->noise);
        filter_set_noise(&a->f[kind], r_q8);
    }
    double r = r_lsb2 > 0.0 ? r_lsb2 : 1.0;
    reference_library(&a->plain, filter_listed_name(plain_kind()), s->rate_hz, r, filter_parameter_q.standard, 0, 0.0,
                      median5(s, axis));
    reference_library(&a->robust, filter_listed_name(robust_kind()), s->rate_hz, r, filter_parameter_q.standard, 5,
                      800.0, median5(s, axis));
}

static void step_axis(axis_t *a, int16_t z, bool estimate, bool warm)
{
    bool changed = filter_noise_update(&a->noise, z);
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        if (estimate && changed) {
            filter_set_noise(&a->f[kind], filter_noise_r_lsb2_q8(&a->noise));
        }
        (void)filter_update(&a->f[kind], z);
    }
    if (warm) {
        (void)robust_reference_step(&a->plain, z);
        (void)robust_reference_step(&a->robust, z);
    }
}

/* The streams' parts read 265, 265, 256 LSB per g. */
static const double of_z[3] = { 256.0 / 265.0, 256.0 / 265.0, 1.0 };

static double roll_deg(double y_lsb, double z_lsb)
{
    return DEGREES * atan2(of_z[1] * y_lsb, of_z[2] * z_lsb);
}

static double roll_fixed(const axis_t axes[3], filter_kind_t kind)
{
    int32_t q8[3];
    for (int i = 0; i < 3; i++) {
        q8[i] = (int32_t)lrint(of_z[i] * axes[i].f[kind].x_lsb_q16 / 256.0);
    }
    tilt_t tilt = { 0, 0, false };
    tilt_angles(&tilt, q8);
    return tilt.roll_cdeg / 100.0;
}

static void add_square(double *sum, double roll, double truth)
{
    double error = wrapped(roll - truth);
    *sum += error * error;
}

static score_t run(const char *path, double r_lsb2)
{
    stream_t s;
    score_t sum = { 0, 0, 0, 0, 0 };
    TEST_ASSERT_TRUE_MESSAGE(stream_load(&s, path), s.error);
    TEST_ASSERT_TRUE_MESSAGE(s.has_truth, path);
    axis_t axes[3];
    for (int i = 0; i < 3; i++) {
        start_axis(&axes[i], &s, i, r_lsb2);
    }
    for (size_t k = 0; k < s.count; k++) {
        for (int i = 0; i < 3; i++) {
            step_axis(&axes[i], s.rows[k].lsb[i], r_lsb2 <= 0.0, k >= FILTER_WARM_UP_SAMPLES);
        }
        if (k < FIRST_ROW) {
            continue;
        }
        double truth = s.rows[k].truth_cdeg[0] / 100.0;
        add_square(&sum.raw, roll_deg(s.rows[k].lsb[1], s.rows[k].lsb[2]), truth);
        add_square(&sum.plain, roll_fixed(axes, plain_kind()), truth);
        add_square(&sum.robust, roll_fixed(axes, robust_kind()), truth);
        add_square(&sum.plain_double, roll_deg(axes[1].plain.x[0], axes[2].plain.x[0]), truth);
        add_square(&sum.robust_double, roll_deg(axes[1].robust.x[0], axes[2].robust.x[0]), truth);
    }
    double n = (double)(s.count - FIRST_ROW);
    stream_free(&s);
    score_t rms = { sqrt(sum.raw / n), sqrt(sum.plain / n), sqrt(sum.robust / n), sqrt(sum.plain_double / n),
                    sqrt(sum.robust_double / n) };
    printf("%-34s R %5.2f roll rms deg: raw %.3f plain %.3f robust %.3f", path, r_lsb2, rms.raw, rms.plain, rms.robust);
    if (r_lsb2 > 0.0) {
        printf(" double plain %.3f robust %.3f", rms.plain_double, rms.robust_double);
    }
    printf("\n");
    return rms;
}

/*
 * A Kalman filter with a gate beside one without. Same R, q and rate for both and for their references: R is the
 * generator's 4 LSB rms, 16, plus 1/12 of rounding.
 */
TEST(outliers_cost_the_robust_one_a_quarter_of_the_plain_one)
{
    score_t s = run("sim/streams/outliers-15pct.csv", 16.0 + 1.0 / 12.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * s.plain_double, s.plain_double, s.plain);
    TEST_ASSERT_DOUBLE_WITHIN(0.01 * s.robust_double, s.robust_double, s.robust);
    TEST_ASSERT_TRUE(s.robust <= 0.25 * s.plain);
}

/* With R estimated the estimate is about four times too high, and the gate still does its work. */
TEST(outliers_with_estimated_noise)
{
    score_t s = run("sim/streams/outliers-15pct.csv", 0.0);
    TEST_ASSERT_TRUE(s.robust <= 0.25 * s.plain);
}

TEST(clean_streams_lose_at_most_five_percent)
{
    static const char *const paths[] = {
        "sim/streams/rest-0.7lsb.csv", "sim/streams/rest-2lsb.csv",        "sim/streams/rest-4lsb.csv",
        "sim/streams/rest-8lsb.csv",   "sim/streams/tilt-slow.csv",        "sim/streams/tilt-fast.csv",
        "sim/streams/tilt-400hz.csv",  "sim/streams/through-roll-180.csv", "sim/streams/through-pitch-90.csv",
    };
    for (int i = 0; i < 9; i++) {
        score_t s = run(paths[i], 0.0);
        TEST_ASSERT_TRUE_MESSAGE(s.robust <= 1.05 * s.plain, paths[i]);
        if (i < 5) {
            TEST_ASSERT_TRUE_MESSAGE(s.plain <= 0.5 * s.raw, paths[i]);
        }
    }
}

/* The noise of each stream, known: fixed point within 1 % of double on clean data too. */
TEST(fixed_point_equals_double_on_clean_streams)
{
    static const char *const paths[] = { "sim/streams/rest-2lsb.csv", "sim/streams/tilt-slow.csv",
                                         "sim/streams/tilt-fast.csv", "sim/streams/through-roll-180.csv" };
    for (int i = 0; i < 4; i++) {
        score_t s = run(paths[i], 4.0 + 1.0 / 12.0);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 * s.plain_double, s.plain_double, s.plain);
        TEST_ASSERT_DOUBLE_WITHIN(0.01 * s.robust_double, s.robust_double, s.robust);
    }
}
