/*
 * The shipped streams are what sim/streams/README.md says: noise, disturbances, rates and truth are checked against
 * numbers derived from the description, and the files against their generator byte for byte. Statistical bounds are 4
 * standard deviations of the estimate; single samples 6 sigma of the noise (1.2e-4 false alarms in 60,000 readings).
 */
#include "stream.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define FOLDER "sim/streams/"
#define GENERATOR "python3 tools/make_streams.py"
#define RAD_PER_CDEG (3.14159265358979323846 / 18000.0)
#define Z_NOISE_RATIO 1.3
#define ROUNDING_LSB 0.55 /* half a reading, and 0.005 degree of truth in 265 LSB */
#define ROUNDING_VARIANCE (1.0 / 12.0)

static const double lsb_per_g[3] = { 265.0, 265.0, 256.0 };

static stream_t stream;

void tearDown(void)
{
    stream_free(&stream);
    stream = (stream_t){ 0 };
}

static void load(const char *name)
{
    char path[128];
    snprintf(path, sizeof path, FOLDER "%s.csv", name);
    stream_free(&stream);
    TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, path), stream.error);
    TEST_ASSERT_TRUE_MESSAGE(stream.has_truth, path);
}

/* What the axis would read without noise at the row's true attitude. */
static double gravity_lsb(const stream_row_t *row, int axis)
{
    double roll = row->truth_cdeg[0] * RAD_PER_CDEG;
    double pitch = row->truth_cdeg[1] * RAD_PER_CDEG;
    const double g[3] = { -sin(pitch), cos(pitch) * sin(roll), cos(pitch) * cos(roll) };
    return lsb_per_g[axis] * g[axis];
}

static double deviation_lsb(const stream_row_t *row, int axis)
{
    return row->lsb[axis] - gravity_lsb(row, axis);
}

static double largest_deviation_lsb(const stream_row_t *row)
{
    return fmax(fabs(deviation_lsb(row, 0)), fmax(fabs(deviation_lsb(row, 1)), fabs(deviation_lsb(row, 2))));
}

static bool healthy(const stream_row_t *row, double sigma_lsb)
{
    return fabs(deviation_lsb(row, 0)) <= 6.0 * sigma_lsb + ROUNDING_LSB &&
           fabs(deviation_lsb(row, 1)) <= 6.0 * sigma_lsb + ROUNDING_LSB &&
           fabs(deviation_lsb(row, 2)) <= 6.0 * Z_NOISE_RATIO * sigma_lsb + ROUNDING_LSB;
}

static double rms_of_axis(int axis)
{
    double sum = 0.0;
    for (size_t i = 0; i < stream.count; i++) {
        double d = deviation_lsb(&stream.rows[i], axis);
        sum += d * d;
    }
    return sqrt(sum / (double)stream.count);
}

static double step_cdeg(size_t i, int angle)
{
    double step = stream.rows[i].truth_cdeg[angle] - stream.rows[i - 1].truth_cdeg[angle];
    return step > 18000.0 ? step - 36000.0 : (step <= -18000.0 ? step + 36000.0 : step);
}

/* Fastest true roll or pitch in degrees per second; a step of 0.01 degree is the resolution of the columns. */
static double peak_rate_deg_s(int angle)
{
    double peak = 0.0;
    for (size_t i = 1; i < stream.count; i++) {
        double seconds = 1e-6 * (double)(stream.rows[i].t_us - stream.rows[i - 1].t_us);
        peak = fmax(peak, fabs(step_cdeg(i, angle)) / 100.0 / seconds);
    }
    return peak;
}

static void assert_truth_still(double from_s, double to_s)
{
    for (size_t i = 1; i < stream.count; i++) {
        double t_s = 1e-6 * (double)stream.rows[i].t_us;
        if (t_s > from_s && t_s < to_s) {
            TEST_ASSERT_EQUAL_INT16(stream.rows[i - 1].truth_cdeg[0], stream.rows[i].truth_cdeg[0]);
            TEST_ASSERT_EQUAL_INT16(stream.rows[i - 1].truth_cdeg[1], stream.rows[i].truth_cdeg[1]);
        }
    }
}

TEST(test_every_stream_is_there_with_its_length_rate_and_size)
{
    static const struct {
        const char *name;
        size_t rows;
        double rate_hz;
    } list[] = {
        { "rest-0.7lsb", 6000, 100.0 },    { "rest-2lsb", 6000, 100.0 },        { "rest-4lsb", 6000, 100.0 },
        { "rest-8lsb", 6000, 100.0 },      { "tilt-slow", 6000, 100.0 },        { "tilt-fast", 1500, 100.0 },
        { "tilt-400hz", 4000, 400.0 },     { "through-pitch-90", 3200, 100.0 }, { "through-roll-180", 3000, 100.0 },
        { "outliers-15pct", 6000, 100.0 }, { "vibration", 6000, 100.0 },        { "bad-reads", 6000, 100.0 },
        { "clipping", 6000, 100.0 },       { "free-fall", 2600, 100.0 },        { "sideways-0.5g", 2000, 100.0 },
        { "steps", 5100, 100.0 },          { "steps-outliers", 5100, 100.0 },
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        load(list[i].name);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(list[i].rows, stream.count, list[i].name);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.01 * list[i].rate_hz, list[i].rate_hz, stream.rate_hz, list[i].name);
        char path[128];
        snprintf(path, sizeof path, FOLDER "%s.csv", list[i].name);
        FILE *file = fopen(path, "rb");
        TEST_ASSERT_NOT_NULL(file);
        TEST_ASSERT_EQUAL_INT(0, fseek(file, 0, SEEK_END));
        TEST_ASSERT_LESS_OR_EQUAL_INT32(300000, (int32_t)ftell(file));
        fclose(file);
    }
}

/* The standard deviation of an rms over n samples is rms / sqrt(2 n); rounding adds its variance of 1/12. */
TEST(test_rest_noise_is_as_named_on_each_axis)
{
    static const struct {
        const char *name;
        double rms_lsb;
    } list[] = { { "rest-0.7lsb", 0.7 }, { "rest-2lsb", 2.0 }, { "rest-4lsb", 4.0 }, { "rest-8lsb", 8.0 } };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        load(list[i].name);
        double expected = sqrt(list[i].rms_lsb * list[i].rms_lsb + ROUNDING_VARIANCE);
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(4.0 * expected / sqrt(2.0 * (double)stream.count), expected,
                                              rms_of_axis(axis), list[i].name);
        }
        TEST_ASSERT_EQUAL_INT16(1200, stream.rows[0].truth_cdeg[0]);
        TEST_ASSERT_EQUAL_INT16(-700, stream.rows[0].truth_cdeg[1]);
        assert_truth_still(0.0, 60.0);
    }
}

TEST(test_clean_streams_agree_with_their_truth)
{
    static const struct {
        const char *name;
        double sigma_lsb;
    } list[] = {
        { "tilt-slow", 2.0 },        { "tilt-fast", 2.0 },   { "tilt-400hz", 4.0 }, { "through-pitch-90", 2.0 },
        { "through-roll-180", 2.0 }, { "gaps-jitter", 2.0 }, { "steps", 2.0 }
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        load(list[i].name);
        for (size_t row = 0; row < stream.count; row++) {
            TEST_ASSERT_TRUE_MESSAGE(healthy(&stream.rows[row], list[i].sigma_lsb), list[i].name);
        }
        for (int axis = 0; axis < 3; axis++) {
            double sigma = (axis == 2 ? Z_NOISE_RATIO : 1.0) * list[i].sigma_lsb;
            double expected = sqrt(sigma * sigma + ROUNDING_VARIANCE);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(4.0 * expected / sqrt(2.0 * (double)stream.count), expected,
                                              rms_of_axis(axis), list[i].name);
        }
    }
}

/* Slow: 30 degrees * 2 pi * 0.05 Hz. Fast: 15/8 * 90 degrees / 2.2 s. 0.01 degree steps: 1 degree/s, 4 at 400 Hz. */
TEST(test_motion_is_as_fast_as_described)
{
    load("tilt-slow");
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 9.42, peak_rate_deg_s(0));
    load("tilt-fast");
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 76.7, peak_rate_deg_s(0));
    assert_truth_still(0.0, 5.0);
    assert_truth_still(10.01, 15.0);
    load("tilt-400hz");
    TEST_ASSERT_DOUBLE_WITHIN(4.0, 76.7, peak_rate_deg_s(0));
    assert_truth_still(0.0, 2.5);
    assert_truth_still(7.51, 10.0);
}

TEST(test_pitch_passes_90_and_roll_flips_only_there)
{
    load("through-pitch-90");
    int16_t top = 0;
    unsigned flips = 0;
    for (size_t i = 1; i < stream.count; i++) {
        const stream_row_t *row = &stream.rows[i];
        top = row->truth_cdeg[1] > top ? row->truth_cdeg[1] : top;
        if (fabs(step_cdeg(i, 0)) > 100.0) {
            flips++;
            TEST_ASSERT_GREATER_THAN_INT16(8950, row->truth_cdeg[1]);
        }
        /* roll 10 on the way up, -170 beyond the top; 90 degrees itself may show either */
        TEST_ASSERT_TRUE(row->truth_cdeg[0] == 1000 || row->truth_cdeg[0] == -17000);
    }
    TEST_ASSERT_GREATER_THAN_INT16(8980, top);
    TEST_ASSERT_EQUAL_UINT(2, flips);
}

TEST(test_roll_crosses_the_seam_and_rests_on_it)
{
    load("through-roll-180");
    unsigned resting = 0;
    bool seen_below = false;
    for (size_t i = 0; i < stream.count; i++) {
        TEST_ASSERT_GREATER_OR_EQUAL_INT16(-17999, stream.rows[i].truth_cdeg[0]);
        resting += stream.rows[i].truth_cdeg[0] == 18000;
        seen_below = seen_below || stream.rows[i].truth_cdeg[0] < -17000;
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(400, resting); /* 4 s at 100 Hz */
    TEST_ASSERT_TRUE(seen_below);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 15.0 / 8.0 * 360.0 / 8.0, peak_rate_deg_s(0));
}

/* P(|n| > 16 LSB) = 0.15 P(|N| > 0.2) + 0.85 P(|N| > 4) = 0.15 * 0.84148 + 0.85 * 6.33e-5; N standard normal. */
TEST(test_outliers_are_15_percent_of_20_times)
{
    load("outliers-15pct");
    unsigned large = 0;
    double square = 0.0;
    for (size_t i = 0; i < stream.count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            double d = deviation_lsb(&stream.rows[i], axis);
            large += fabs(d) > 16.0; /* rounding to integers changes p by less than 0.0005 */
            square += d * d;
        }
    }
    double n = 3.0 * (double)stream.count;
    double p = 0.15 * 0.84148 + 0.85 * 6.33e-5;
    TEST_ASSERT_DOUBLE_WITHIN(4.0 * sqrt(p * (1.0 - p) / n), p, large / n);
    /* variance 0.85 * 4^2 + 0.15 * 80^2 = 973.6; kurtosis makes the standard deviation of its estimate 2.6 % */
    double fourth = 3.0 * (0.85 * 256.0 + 0.15 * 80.0 * 80.0 * 80.0 * 80.0);
    TEST_ASSERT_DOUBLE_WITHIN(4.0 * sqrt((fourth - 973.6 * 973.6) / n), 973.6, square / n);
}

/* P(|n| > 4 sigma), sigma that of the axis; rounding changes p by less than 0.003, the slope at 0.2 of 20 sigma. */
TEST(test_steps_with_outliers_have_15_percent_of_20_times)
{
    load("steps-outliers");
    unsigned large = 0;
    for (size_t i = 0; i < stream.count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            large += fabs(deviation_lsb(&stream.rows[i], axis)) > 8.0 * (axis == 2 ? Z_NOISE_RATIO : 1.0);
        }
    }
    double n = 3.0 * (double)stream.count;
    double p = 0.15 * 0.84148 + 0.85 * 6.33e-5;
    TEST_ASSERT_DOUBLE_WITHIN(4.0 * sqrt(p * (1.0 - p) / n) + 0.003, p, large / n);
}

/* The truth of both step streams: 3 s pieces, every second one off by its size, roll first; nothing in between. */
TEST(test_steps_are_of_the_named_sizes_at_the_named_times)
{
    static const char *const names[] = { "steps", "steps-outliers" };
    static const int16_t sizes_cdeg[] = { 50, 200, 1000, 4500 };
    for (size_t k = 0; k < 2; k++) {
        load(names[k]);
        for (size_t i = 0; i < stream.count; i++) {
            size_t piece = (size_t)(stream.rows[i].t_us / 3000000U);
            int16_t size = piece % 2 == 1 ? sizes_cdeg[piece / 2 % 4] : 0;
            TEST_ASSERT_EQUAL_INT16(1200 + (piece < 8 ? size : 0), stream.rows[i].truth_cdeg[0]);
            TEST_ASSERT_EQUAL_INT16(-700 + (piece < 8 ? 0 : size), stream.rows[i].truth_cdeg[1]);
        }
    }
}

static bool all_equal(const stream_row_t *row, int16_t value)
{
    return row->lsb[0] == value && row->lsb[1] == value && row->lsb[2] == value;
}

/* Exactly one axis is about twice its gravity: 6 sigma of doubled noise. */
static bool has_doubled_axis(const stream_row_t *row)
{
    for (int axis = 0; axis < 3; axis++) {
        double doubled = row->lsb[axis] - 2.0 * gravity_lsb(row, axis);
        if (row->lsb[axis] % 2 == 0 && fabs(doubled) <= 2.0 * (6.0 * 2.6 + ROUNDING_LSB)) {
            return true;
        }
    }
    return false;
}

/* Bad with 0.01 unless the one before was: 0.01 / 1.01 of 6000 = 59.4, a third of each kind; 4 sqrt(19.8) = 17.8. */
TEST(test_bad_reads_are_single_and_of_the_three_kinds)
{
    load("bad-reads");
    unsigned zeros = 0;
    unsigned ones = 0;
    bool last_bad = false;
    for (size_t i = 0; i < stream.count; i++) {
        const stream_row_t *row = &stream.rows[i];
        bool bad = !healthy(row, 2.0);
        zeros += all_equal(row, 0);
        ones += all_equal(row, -1);
        TEST_ASSERT_TRUE(!bad || all_equal(row, 0) || all_equal(row, -1) || has_doubled_axis(row));
        TEST_ASSERT_FALSE(bad && last_bad);
        last_bad = bad;
    }
    TEST_ASSERT_UINT_WITHIN(17, 20, zeros);
    TEST_ASSERT_UINT_WITHIN(17, 20, ones);
}

/* A burst is over within 150 ms: at most 15 samples at 100 Hz; gaps of at least 0.3 s; 500 LSB and 6 sigma at most. */
TEST(test_vibration_comes_in_bursts)
{
    load("vibration");
    size_t first = 0;
    size_t last = 0;
    unsigned bursts = 0;
    for (size_t i = 0; i < stream.count; i++) {
        if (healthy(&stream.rows[i], 2.0)) {
            continue;
        }
        TEST_ASSERT_TRUE(largest_deviation_lsb(&stream.rows[i]) <= 500.0 + 6.0 * 2.6 + ROUNDING_LSB);
        if (bursts == 0 || i - last > 20) {
            TEST_ASSERT_TRUE(bursts == 0 || i - last >= 30);
            bursts++;
            first = i;
        }
        last = i;
        TEST_ASSERT_LESS_OR_EQUAL_size_t(14, last - first);
    }
    /* 58 s / (0.085 + 0.9) s = 59 bursts, standard deviation 2.7; small ones may hide in the noise */
    TEST_ASSERT_UINT_WITHIN(15, 55, bursts);
}

TEST(test_clipping_meets_both_rails)
{
    load("clipping");
    unsigned low = 0;
    unsigned high = 0;
    for (size_t i = 0; i < stream.count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            low += stream.rows[i].lsb[axis] == -4096;
            high += stream.rows[i].lsb[axis] == 4095;
        }
    }
    /* a shock every 2 s of 58: 29, half of each sign, most with a sample over 16 g */
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(10, low);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT(10, high);
}

TEST(test_free_fall_has_no_force_and_keeps_the_truth)
{
    load("free-fall");
    assert_truth_still(0.0, 26.0);
    for (size_t i = 0; i < stream.count; i++) {
        const stream_row_t *row = &stream.rows[i];
        uint64_t since_us = (row->t_us + 4000000U) % 10000000U; /* drops begin at 6 s and 16 s */
        if (row->t_us < 26000000U && row->t_us >= 6000000U && since_us < 1000000U) {
            for (int axis = 0; axis < 3; axis++) {
                TEST_ASSERT_INT_WITHIN(16, 0, row->lsb[axis]); /* 6 sigma of z: 15.6 */
            }
        } else if (row->t_us < 6000000U || since_us >= 1060000U) {
            TEST_ASSERT_TRUE(healthy(row, 2.0));
        }
    }
}

/* 0.5 g is 128 LSB; the mean of 280 samples of 2 LSB has a standard deviation of 0.12. */
TEST(test_sideways_force_is_half_a_g_on_y_for_3_s)
{
    load("sideways-0.5g");
    assert_truth_still(0.0, 20.0);
    double sum = 0.0;
    unsigned n = 0;
    for (size_t i = 0; i < stream.count; i++) {
        if (stream.rows[i].t_us >= 8200000U && stream.rows[i].t_us < 11000000U) {
            sum += deviation_lsb(&stream.rows[i], 1);
            n++;
        }
    }
    TEST_ASSERT_EQUAL_UINT(280, n);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 0.5 * lsb_per_g[1], sum / n);
}

TEST(test_gaps_and_jitter_are_within_their_limits)
{
    load("gaps-jitter");
    unsigned gaps = 0;
    bool jitters = false;
    for (size_t i = 1; i < stream.count; i++) {
        uint64_t offset_us = (stream.rows[i].t_us + 1000U) % 10000U; /* 0..2000: 1 ms either side of the grid */
        uint64_t step_us = stream.rows[i].t_us - stream.rows[i - 1].t_us;
        TEST_ASSERT_LESS_OR_EQUAL_UINT64(2000U, offset_us);
        jitters = jitters || offset_us != 1000U;
        if (step_us > 15000U) {
            gaps++;
            TEST_ASSERT_GREATER_OR_EQUAL_UINT64(30000U, step_us);
            TEST_ASSERT_LESS_OR_EQUAL_UINT64(1012000U, step_us); /* 1 s, one period, twice the jitter */
        }
    }
    TEST_ASSERT_TRUE(jitters);
    TEST_ASSERT_UINT_WITHIN(10, 21, gaps); /* 57 s / (2.5 + 0.28) s */
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 100.0, stream.rate_hz);
}

/* Every file equals what the generator makes; the twin: one byte more in one file is noticed. */
TEST(test_files_are_as_generated_and_a_changed_one_is_noticed)
{
    TEST_ASSERT_EQUAL_INT(0, system(GENERATOR " --check > build/streams_check.log 2>&1"));
    TEST_ASSERT_EQUAL_INT(0, system(GENERATOR " --dir build/streams_twin > build/streams_check.log 2>&1"));
    TEST_ASSERT_EQUAL_INT(0, system(GENERATOR " --check --dir build/streams_twin > build/streams_check.log 2>&1"));
    FILE *file = fopen("build/streams_twin/tilt-fast.csv", "ab");
    TEST_ASSERT_NOT_NULL(file);
    fputc('\n', file);
    fclose(file);
    TEST_ASSERT_NOT_EQUAL_INT(0, system(GENERATOR " --check --dir build/streams_twin > build/streams_check.log 2>&1"));
}
