/* Each flag of a row: a stream that must raise it and one beside it that must not. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "path/pipeline.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/test.h"

/*
 * Flags of the last of 60 rows of a board that reads (x, y, z), after the command if there is one; without that of a
 * sensor that repeats itself.
 */
static unsigned flags_of(const char *command, int16_t x, int16_t y, int16_t z)
{
    stream_t stream = board_constant_stream(400, 100.0, x, y, z);
    board_start(&stream, 0.0, 0);
    board_run_ms(300);
    if (command != NULL) {
        board_type(command);
    }
    board_run_ms(600);
    return board.rows[board.row_count - 1].flags & ~(unsigned)ROW_STUCK;
}

/* 0.85 g are 217.6 LSB, 1.15 g are 294.4. */
TEST(test_not_gravity)
{
    TEST_ASSERT_EQUAL_UINT(ROW_NOT_GRAVITY, flags_of(NULL, 0, 0, 217));
    TEST_ASSERT_EQUAL_UINT(0, flags_of(NULL, 0, 0, 219));
    TEST_ASSERT_EQUAL_UINT(0, flags_of(NULL, 0, 0, 294));
    TEST_ASSERT_EQUAL_UINT(ROW_NOT_GRAVITY, flags_of(NULL, 0, 0, 296));
}

TEST(test_roll_undefined_is_flagged_and_held)
{
    TEST_ASSERT_EQUAL_UINT(ROW_ROLL_UNDEFINED, flags_of(NULL, 256, 2, 2));
    TEST_ASSERT_EQUAL_INT(0, board.rows[board.row_count - 1].roll_cdeg);
    TEST_ASSERT_INT_WITHIN(6, -8937, board.rows[board.row_count - 1].pitch_cdeg); /* atan2(-256, sqrt(8)) */
    TEST_ASSERT_EQUAL_UINT(0, flags_of(NULL, 256, 6, 0));
}

/* Both rails of each range, and one LSB inside them. */
TEST(test_clipped_at_the_rails_of_the_range_in_force)
{
    for (int range_g = 2; range_g <= 16; range_g *= 2) {
        char command[24];
        int16_t high = (int16_t)(LIMIT_G_LSB * range_g - 1);
        snprintf(command, sizeof command, "range %d", range_g);
        TEST_ASSERT_EQUAL_UINT(ROW_CLIPPED, flags_of(command, high, 0, 256) & ROW_CLIPPED);
        TEST_ASSERT_EQUAL_UINT(ROW_CLIPPED, flags_of(command, (int16_t)(-high - 1), 0, 256) & ROW_CLIPPED);
        TEST_ASSERT_EQUAL_UINT(0, flags_of(command, (int16_t)(high - 1), 0, 256) & ROW_CLIPPED);
        TEST_ASSERT_EQUAL_UINT(0, flags_of(command, (int16_t)-high, 0, 256) & ROW_CLIPPED);
    }
}

/*
 * y climbs by 1 LSB a sample; two samples are missing at 3 s: each has a row, whose estimate climbs on. The clock looks
 * for the next one when it comes: its time is as near as the looks are.
 */
TEST(test_missing_samples_are_coasted_over)
{
    stream_t ramp = board_constant_stream(600, 100.0, 0, 0, 256);
    for (size_t i = 0; i < ramp.count; i++) {
        size_t sample = i < 300 ? i : i + 2;
        ramp.rows[i].t_us = (uint64_t)sample * 10000u;
        ramp.rows[i].lsb[1] = (int16_t)((int)sample - 300);
    }
    board_start(&ramp, 0.0, 0);
    board_run_ms(3500);
    size_t compared = 0;
    int coasted = 0;
    int coasts = 0;
    for (size_t i = 200; i < board.row_count; i++) {
        coasted = board.rows[i].flags & ROW_COASTED ? coasted + 1 : 0;
        coasts += coasted != 0;
        TEST_ASSERT_INT_WITHIN(3, (board.rows[i].lsb[1] + coasted) * 1000 / 265, board.rows[i].mg[1]);
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_GATED | ROW_REACQUIRED | ROW_FAULT));
        TEST_ASSERT_UINT32_WITHIN(coasted ? 60 : 300, 10000, board.rows[i].t_us - board.rows[i - 1].t_us);
        compared++;
    }
    TEST_ASSERT_EQUAL_INT(2, coasts);
    TEST_ASSERT_TRUE(compared > 120);
}

/* A sensor hangs on one reading for 60 samples: the tenth and those behind it are marked, the fault is told once. */
TEST(test_stuck_from_the_tenth_equal_reading_on)
{
    stream_t stream = board_hung_stream(1000, 11u, 300, 60);
    board_start(&stream, 0.0, 0);
    board_run_ms(8000);
    size_t equal = 0;
    size_t marked = 0;
    for (size_t i = 1; i < board.row_count; i++) {
        bool same = memcmp(board.rows[i].lsb, board.rows[i - 1].lsb, sizeof board.rows[i].lsb) == 0;
        equal = same ? equal + 1 : 0;
        TEST_ASSERT_EQUAL_UINT(equal >= 9 ? ROW_STUCK : 0, board.rows[i].flags & (ROW_STUCK | ROW_FAULT));
        marked += equal >= 9;
    }
    TEST_ASSERT_EQUAL_size_t(51, marked);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 10: values do not change: check ", 0));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 10 over: ", 0));
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("# fault", 0));
}

/* One reading of z in ten is doubled for 3 s: told once, and once that it is over, within 2.6 s. */
TEST(test_two_sensors_are_told)
{
    stream_t stream = board_noisy_stream(1500, 100.0, 1.5, 12u);
    for (size_t i = 300; i < 600; i += 10) {
        stream.rows[i].lsb[2] = (int16_t)(2 * stream.rows[i].lsb[2]);
    }
    board_start(&stream, 0.0, 0);
    board_run_ms(2900);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# fault", 0));
    board_run_ms(3100);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 12: values double: two sensors", 0));
    board_run_ms(2700);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 12 over: ", 0));
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("# fault", 0));
    for (size_t i = 0; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_STUCK | ROW_FAULT | ROW_INTEGRITY));
    }
}

/* A sensor hangs for so many samples, y reads this behind it for one sample, and then it is well. */
static void hangs(size_t hung, int16_t then_lsb)
{
    stream_t stream = board_hung_stream(3000, (uint32_t)hung, 300, hung);
    stream.rows[300 + hung].lsb[1] = then_lsb;
    board_start(&stream, 0.0, 0);
    board_run_ms(10.0 * (double)(300 + hung + 400));
}

/* What it has learned of the noise meanwhile is forgotten: the angles are right at once, and nothing is refused. */
TEST(test_the_default_filter_behind_a_sensor_that_hung)
{
    for (size_t hung = 20; hung <= 1280; hung *= 2) {
        hangs(hung, -53);
        unsigned refused = 0;
        size_t behind = 0;
        for (size_t i = 1; i < board.row_count; i++) {
            bool stuck = (board.rows[i].flags & ROW_STUCK) != 0;
            behind = stuck ? 1 : behind + (behind != 0);
            if (!stuck && behind != 0) {
                refused += (board.rows[i].flags & ROW_GATED) != 0;
                TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags & (ROW_REACQUIRED | ROW_WARMING_UP | ROW_COASTED));
                TEST_ASSERT_INT_WITHIN(100, -1166, board.rows[i].roll_cdeg); /* atan2(-53 / 265, 248 / 256) */
            }
        }
        TEST_ASSERT_TRUE(behind > 300);
        TEST_ASSERT_TRUE(refused <= 4); /* of 400: that is chance */
    }
}

/* Mean square of the change of roll, cdeg^2, in the first rows after a sensor that hung for so many samples. */
static double unrest_after(size_t hung)
{
    double squares = 0.0;
    for (uint32_t seed = 0; seed < 20; seed++) {
        stream_t stream = board_noisy_stream(400, 100.0, 6.0, 77u + seed);
        for (size_t i = 301; i < 300 + hung; i++) {
            memcpy(stream.rows[i].lsb, stream.rows[300].lsb, sizeof stream.rows[i].lsb);
        }
        board_start(&stream, 0.0, 0);
        board_run_ms(10.0 * (double)(300 + hung + 20));
        size_t last = board.row_count - 1;
        while ((board.rows[last].flags & ROW_STUCK) == 0) {
            last--;
        }
        for (size_t i = last + 1; i < last + 7; i++) {
            double change = board.rows[i].roll_cdeg - board.rows[i - 1].roll_cdeg;
            squares += change * change;
        }
    }
    return squares / 120.0;
}

/* With the 16th marked reading, the 25th equal one, and none before, what the filters had learned is forgotten. */
TEST(test_sixteen_marked_readings_are_forgotten)
{
    double kept = unrest_after(24);
    double forgotten = unrest_after(25);
    printf("    mean square of a change of roll after it: %.0f, %.0f\n", kept, forgotten);
    TEST_ASSERT_TRUE(kept < 1.3 * unrest_after(23));
    TEST_ASSERT_TRUE(forgotten > 1.6 * kept);
}

/* The first reading that differs is a bad one: the filter does not begin anew on it. */
TEST(test_a_bad_reading_behind_a_sensor_that_hung)
{
    hangs(200, 900);
    size_t behind = 0;
    for (size_t i = 1; i < board.row_count; i++) {
        bool stuck = (board.rows[i].flags & ROW_STUCK) != 0;
        behind = stuck ? 1 : behind + (behind != 0);
        TEST_ASSERT_EQUAL(behind == 2, (board.rows[i].flags & ROW_GATED) != 0 && behind < 10 && behind != 0);
        TEST_ASSERT_TRUE(behind == 0 || abs(board.rows[i].roll_cdeg + 1166) < 200);
    }
    TEST_ASSERT_TRUE(behind > 300);
}
