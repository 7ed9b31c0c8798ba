/*
 * The whole firmware with the filter `auto` on a board that rolls while an axis is stuck or at its rail: the angle from
 * the axes that remain, flagged and told; with another filter, and with two bad axes, none is left out.
 */
#include "filter_list.h"
#include "path/pipeline.h"
#include "path/supervisor.h"
#include "support/path.h"
#include "support/random.h"
#include "support/roles.h"
#include "support/talk.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SEED 80044u
#define DEG_PER_RAD 57.295779513082320877

enum { SAMPLES = 2400, FAULT_FROM = 800, FAULT_TO = 2000, RATE_HZ = 100 };

/* At 100 Hz on 3.3 V x and y have 265 LSB/g, z 256. */
static const double scales[3] = { 265.0, 265.0, 256.0 };

typedef enum { HEALTHY, FROZEN, AT_ZERO, AT_RAIL } fault_t;

/* From 15 to 60 degrees and back in 12 s, pitch 10 degrees. */
static double roll_deg_at(double t_s)
{
    return 37.5 - 22.5 * cos(2.0 * 3.14159265358979 * t_s / 12.0);
}

static stream_t rolling_stream(uint8_t bad, fault_t fault)
{
    test_random_t random;
    random_seed(&random, SEED);
    stream_t stream = board_constant_stream(SAMPLES, RATE_HZ, 0, 0, 0);
    double pitch = 10.0 / DEG_PER_RAD;
    for (int i = 0; i < SAMPLES; i++) {
        double roll = roll_deg_at((double)i / RATE_HZ) / DEG_PER_RAD;
        const double g[3] = { -sin(pitch), sin(roll) * cos(pitch), cos(roll) * cos(pitch) };
        for (int axis = 0; axis < 3; axis++) {
            stream.rows[i].lsb[axis] = as_sample(scales[axis] * g[axis] + 1.5 * random_normal(&random));
        }
        if (fault != HEALTHY && i >= FAULT_FROM && i < FAULT_TO) {
            int16_t frozen = stream.rows[FAULT_FROM - 1].lsb[bad];
            stream.rows[i].lsb[bad] = (int16_t)(fault == FROZEN ? frozen : fault == AT_ZERO ? 0 : 4095);
        }
    }
    return stream;
}

static void run(stream_t *stream, const char *filter)
{
    board_start(stream, 0.0, 0);
    board_run_ms(100);
    char command[40];
    snprintf(command, sizeof command, "filter %s", filter);
    (void)talk_typed(command, SAMPLES * 1000.0 / RATE_HZ);
}

/* The sample of a row: the first one was latched a period after the first tick. */
static double truth_deg(const board_row_t *row)
{
    return roll_deg_at((row->t_us - board.latched_us[0]) / 1e6);
}

typedef struct {
    double worst_deg, worst_pitch_deg;
    unsigned rows, left_out;
} judged_t;

/* Rows of a time, in samples of the stream. */
static judged_t judge(double from, double to)
{
    judged_t j = { 0.0, 0.0, 0, 0 };
    for (size_t i = 0; i < board.row_count; i++) {
        const board_row_t *row = &board.rows[i];
        double sample = (row->t_us - board.latched_us[0]) / 1e6 * RATE_HZ;
        if (sample >= from && sample < to) {
            j.rows++;
            j.left_out += (row->flags & ROW_LEFT_OUT) != 0;
            j.worst_deg = fmax(j.worst_deg, fabs(row->roll_cdeg / 100.0 - truth_deg(row)));
            j.worst_pitch_deg = fmax(j.worst_pitch_deg, fabs(row->pitch_cdeg / 100.0 - 10.0));
        }
    }
    return j;
}

/*
 * The noise of 1.5 LSB over the missing component, halved by the slow member at least: five sigmas of 0.25 degree / cos
 * 60, / sin 15 or, of pitch, / sin 10, and 1 degree for what a motion of 12 degree/s and 6 degree/s^2 leaves of lag.
 */
static double bound_deg(uint8_t bad)
{
    const double least_deg[3] = { 10.0, 15.0, 30.0 };
    double component = sin(least_deg[bad] / DEG_PER_RAD);
    double sigma_deg = 1.5 / 256.0 * DEG_PER_RAD / 2.0;
    return 5.0 * sigma_deg / component / cos(10.0 / DEG_PER_RAD) + 1.0;
}

static void assert_left_out(uint8_t bad, fault_t fault)
{
    stream_t stream = rolling_stream(bad, fault);
    run(&stream, "auto");
    unsigned detected = FAULT_FROM + (fault == AT_RAIL ? SUPERVISOR_RAIL_SAMPLES : SUPERVISOR_REPEATED_SAMPLES) + 3;
    judged_t before = judge(200.0, FAULT_FROM);
    judged_t during = judge(detected, FAULT_TO - 1.0);
    judged_t after = judge(FAULT_TO + 100.0, SAMPLES - 20.0);
    TEST_ASSERT_TRUE(before.rows > 500 && during.rows > 900 && after.rows > 200);
    TEST_ASSERT_EQUAL_UINT(0, before.left_out);
    TEST_ASSERT_EQUAL_UINT(during.rows, during.left_out);
    TEST_ASSERT_EQUAL_UINT(0, after.left_out);
    TEST_ASSERT_TRUE(before.worst_deg < 1.5 && after.worst_deg < 1.5);
    TEST_ASSERT_TRUE(before.worst_pitch_deg < 1.5 && after.worst_pitch_deg < 1.5);
    TEST_ASSERT_TRUE(during.worst_deg < (bad == 0 ? 1.5 : bound_deg(bad)));
    TEST_ASSERT_TRUE(during.worst_pitch_deg < (bad == 0 ? bound_deg(bad) : 1.5));
}

TEST(test_a_bad_x_is_left_out)
{
    assert_left_out(0, FROZEN);
    assert_left_out(0, AT_ZERO);
    assert_left_out(0, AT_RAIL);
}

TEST(test_a_bad_z_is_left_out)
{
    assert_left_out(2, FROZEN);
    assert_left_out(2, AT_ZERO);
    assert_left_out(2, AT_RAIL);
}

TEST(test_a_bad_y_is_left_out)
{
    assert_left_out(1, FROZEN);
    assert_left_out(1, AT_ZERO);
    assert_left_out(1, AT_RAIL);
}

TEST(test_a_healthy_board_leaves_none_out)
{
    stream_t stream = rolling_stream(0, HEALTHY);
    run(&stream, "auto");
    judged_t all = judge(200.0, SAMPLES - 20.0);
    TEST_ASSERT_EQUAL_UINT(0, all.left_out);
    TEST_ASSERT_TRUE(all.worst_deg < 1.5);
}

/* Another filter believes the axis: the angle is wrong by tens of degrees, and nothing is flagged. */
TEST(test_another_filter_leaves_none_out)
{
    stream_t stream = rolling_stream(2, AT_ZERO);
    run(&stream, by_role("{plain}"));
    judged_t during = judge(FAULT_FROM + 200.0, FAULT_TO - 1.0);
    TEST_ASSERT_EQUAL_UINT(0, during.left_out);
    TEST_ASSERT_TRUE(during.worst_deg > 20.0);
}

/* An axis that is left out is believed again by the filter that comes after. */
TEST(test_a_change_of_the_filter_leaves_none_out)
{
    stream_t stream = rolling_stream(2, AT_ZERO);
    board_start(&stream, 0.0, 0);
    board_run_ms(100);
    (void)talk_typed("filter auto", 12000.0);
    TEST_ASSERT_EQUAL_UINT(100, judge(1050.0, 1150.0).left_out);
    (void)talk_typed(by_role("filter {plain}"), 4000.0);
    judged_t after = judge(1300.0, 1500.0);
    TEST_ASSERT_EQUAL_UINT(200, after.rows);
    TEST_ASSERT_EQUAL_UINT(0, after.left_out);
}

static bool leaves_one_out(void)
{
    row_t row;
    pipeline_row(&row);
    return (row.flags & ROW_LEFT_OUT) != 0;
}

/* After one good sample, so many with z at its rail, while the other axes change, until z is left out. */
static unsigned samples_until_left_out(void)
{
    unsigned samples = 0;
    do {
        adxl345_sample_t s = { .t_us = samples * 10000u, .lsb = { 0, 0, samples == 0 ? 256 : 4095 } };
        s.lsb[0] = s.lsb[1] = (int16_t)(samples % 2);
        samples++;
        pipeline_sample(&s);
        pipeline_finish();
    } while (!leaves_one_out() && samples < 100);
    return samples - 1;
}

/* The second time z has been at its rail before, too: what was known of it is forgotten. */
TEST(test_a_restart_forgets_an_axis_that_was_left_out)
{
    for (int restarts = 0; restarts < 2; restarts++) {
        path_start((uint8_t)filter_find("auto"), 1000, 16, 0);
        TEST_ASSERT_FALSE(leaves_one_out());
        TEST_ASSERT_EQUAL_UINT(1 + SUPERVISOR_RAIL_SAMPLES, samples_until_left_out()); /* the first repeats nothing */
    }
}

/* Of two bad axes none can be made up. */
TEST(test_two_bad_axes_are_too_many)
{
    stream_t stream = rolling_stream(2, AT_ZERO);
    for (int i = FAULT_FROM; i < FAULT_TO; i++) {
        stream.rows[i].lsb[1] = 100;
    }
    run(&stream, "auto");
    TEST_ASSERT_EQUAL_UINT(0, judge(FAULT_FROM, FAULT_TO).left_out);
}

/* What `status` says of an axis that is frozen, with a row for so many samples. */
static double sigma_of_cdeg(uint8_t axis, const char *every)
{
    stream_t stream = rolling_stream(axis, FROZEN);
    board_start(&stream, 0.0, 0);
    board_run_ms(100);
    (void)talk_typed("filter auto", 5000);
    size_t first = talk_typed("status", 100);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(", chosen x ", first));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("without", first));
    (void)talk_typed(every, 6500);
    first = talk_typed("status", 100);
    char words[] = ", without z sigma cdeg ";
    words[strlen(", without ")] = "xyz"[axis];
    const char *told = strstr(board.notes[first], words);
    TEST_ASSERT_NOT_NULL(told);
    double sigma_cdeg = strtod(told + strlen(words), NULL);
    return sigma_cdeg;
}

/* `status` names the members, and the axis with the sigma of the direction: noise and 10 LSB of the part, 1 / cos. */
TEST(test_status_tells_choices_and_the_axis_left_out)
{
    double sigma_cdeg = sigma_of_cdeg(2, "every 1");
    /* R is 1.5 x 2.25 LSB^2; variance gains of the members 0.05 to 0.4; the component 0.6 to 1 of 1 g; rounded down */
    TEST_ASSERT_TRUE(sigma_cdeg > sqrt(0.05 * 2.0 + 100.0) / 256.0 * DEG_PER_RAD * 100.0 - 1.0);
    TEST_ASSERT_TRUE(sigma_cdeg < sqrt(0.40 * 5.0 + 100.0) / 256.0 / 0.45 * DEG_PER_RAD * 100.0);
    /* it waits for no row, and keeps nothing of another axis */
    TEST_ASSERT_TRUE(sigma_of_cdeg(0, "every 1") > 2.0 * sigma_cdeg);
    TEST_ASSERT_EQUAL_DOUBLE(sigma_cdeg, sigma_of_cdeg(2, "every 1000"));
}

static double sigma_told_cdeg(void)
{
    size_t first = talk_typed("status", 100);
    const char *told = strstr(board.notes[first], " sigma cdeg ");
    TEST_ASSERT_NOT_NULL(told);
    return strtod(told + strlen(" sigma cdeg "), NULL);
}

/*
 * The noisier of the axes that remain, whichever comes first: x still and y rolling, and the other way round. With an R
 * of 1000 LSB^2 the members' gains make the difference, and not the 10 LSB of the part.
 */
TEST(test_the_sigma_told_is_that_of_the_noisier_axis)
{
    double told_cdeg[2];
    for (int swapped = 0; swapped < 2; swapped++) {
        stream_t stream = rolling_stream(2, FROZEN);
        for (int i = 0; i < SAMPLES && swapped != 0; i++) {
            int16_t x = stream.rows[i].lsb[0];
            stream.rows[i].lsb[0] = stream.rows[i].lsb[1];
            stream.rows[i].lsb[1] = x;
        }
        board_start(&stream, 0.0, 0);
        board_run_ms(100);
        (void)talk_typed("filter auto", 100);
        (void)talk_typed("r 1000", 11400);
        told_cdeg[swapped] = sigma_told_cdeg();
    }
    TEST_ASSERT_TRUE(told_cdeg[0] > 0.0);
    TEST_ASSERT_DOUBLE_WITHIN(1.0, told_cdeg[0], told_cdeg[1]);
}

/* A change of the choice is flagged: rarely at rest, and never with another filter. */
TEST(test_changes_of_the_choice_are_flagged)
{
    stream_t stream = rolling_stream(0, HEALTHY);
    run(&stream, "auto");
    size_t changes = 0;
    for (size_t i = 0; i < board.row_count; i++) {
        changes += (board.rows[i].flags & ROW_SWITCHED) != 0;
    }
    TEST_ASSERT_TRUE(changes > 10 && changes < board.row_count / 2);
    run(&stream, by_role("{plain}"));
    for (size_t i = 0; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & ROW_SWITCHED);
    }
}

/* While the axes change to another filter, the last one first, there is no choice of each to tell. */
TEST(test_no_choices_are_told_of_a_filter_that_is_leaving)
{
    stream_t stream = rolling_stream(0, HEALTHY);
    board_start(&stream, 0.0, 0);
    board_run_ms(100);
    (void)talk_typed("filter auto", 1000);
    board_type(by_role("filter {plain}"));
    for (int ms = 0; ms < 40 && pipeline_axes()[2].filter.law != filter_listed(plain_kind()); ms++) {
        board_run_ms(1);
    }
    TEST_ASSERT_EQUAL_PTR(&filter_law_auto, pipeline_axes()[0].filter.law);
    size_t first = talk_typed("status", 3);
    TEST_ASSERT_EQUAL_PTR(&filter_law_auto, pipeline_axes()[0].filter.law);
    board_run_ms(100);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# state streaming", first));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("chosen", first));
}
