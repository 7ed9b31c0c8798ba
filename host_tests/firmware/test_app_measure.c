/*
 * `selftest` of the whole firmware, judged by the truth of the model's part: good, dead, weak and strong axes at any
 * rate and range, and what comes in the middle.
 */
#include <stdio.h>
#include <string.h>

#include "adxl345_registers.h"
#include "app/app.h"
#include "base/counters.h"
#include "hal_watchdog.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/talk.h"
#include "support/test.h"

/* 256 samples at 400 Hz twice are 1.28 s; a change of configuration takes a period and 20 ms, three times. */
enum { SELFTEST_MS = 1600, REST_X = 31, REST_Y = -53, REST_Z = 248, NEAR_LSB = 12 };

/* Every second reading is one LSB more, so that the mean of a whole number of pairs is known: half of one more. */
static void start_exact(const int16_t self_test_lsb[3])
{
    stream_t stream = board_constant_stream(6000, 100.0, REST_X, REST_Y, REST_Z);
    for (size_t i = 1; i < stream.count; i += 2) {
        for (size_t axis = 0; axis < 3; axis++) {
            stream.rows[i].lsb[axis]++;
        }
    }
    board_start(&stream, 0.0, 0);
    memcpy(hal_host_sensor()->part.self_test_lsb, self_test_lsb, sizeof hal_host_sensor()->part.self_test_lsb);
    board_run_ms(500);
}

/* No reading that went out was taken with the force on. */
static void assert_no_row_is_shifted(size_t from)
{
    for (size_t i = from; i < board.row_count; i++) {
        TEST_ASSERT_INT_WITHIN(NEAR_LSB, REST_X, board.rows[i].lsb[0]);
        TEST_ASSERT_INT_WITHIN(NEAR_LSB, REST_Y, board.rows[i].lsb[1]);
        TEST_ASSERT_INT_WITHIN(NEAR_LSB, REST_Z, board.rows[i].lsb[2]);
    }
}

static void assert_sensor_is_as_set(void)
{
    static const uint8_t formats[] = { [2] = 0x08, [4] = 0x09, [8] = 0x0A, [16] = 0x0B };
    uint8_t code = 7; /* 12.5 Hz, doubled by each step */
    for (uint16_t dhz = 125; dhz < settings()->rate_dhz; dhz = (uint16_t)(dhz * 2u)) {
        code++;
    }
    TEST_ASSERT_EQUAL_HEX8(formats[settings()->range_g], hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
    TEST_ASSERT_EQUAL_HEX8(code, hal_host_sensor()->reg[ADXL345_BW_RATE]);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/*
 * The typical part: 522, -522 and 698 LSB. Rows of a stream of 100 Hz are read four times at 400 Hz, so 64 readings of
 * 1.5 LSB rms make each mean: their difference is good to 0.27 LSB, 1.4 is five times that.
 */
TEST(test_a_good_part_passes_at_any_rate_and_range)
{
    static const char *const rates[] = { "rate 12.5", "rate 25",  "rate 50", "rate 100",
                                         "rate 200",  "rate 400", "rate 800" };
    static const char *const ranges[] = { "range 2", "range 4", "range 8", "range 16" };
    static const double truth_lsb[] = { 522.0, 522.0, 698.0 };
    for (size_t i = 0; i < 7; i++) {
        talk_start_noisy(100.0, 0.0);
        (void)talk_typed("baud 1000000", 100.0);
        (void)talk_typed(rates[i], 400.0);
        (void)talk_typed(ranges[i % 4], 600.0);
        size_t row = board.row_count - 1;
        uint32_t lost = counted(COUNT_LOST);
        size_t note = talk_typed("selftest", SELFTEST_MS + 400.0);
        talk_assert_note("# selftest: hold still", note);
        for (size_t axis = 0; axis < 3; axis++) {
            char name = '?';
            double lsb = 0.0;
            char limits[40] = "";
            TEST_ASSERT_EQUAL_INT(
                3, sscanf(board.notes[note + 1 + axis], "# selftest %c %lf LSB, %39[^\n]", &name, &lsb, limits));
            TEST_ASSERT_EQUAL_CHAR("xyz"[axis], name);
            TEST_ASSERT_DOUBLE_WITHIN(1.4, truth_lsb[axis], lsb);
            TEST_ASSERT_EQUAL_STRING(axis == 2 ? "110.25 to 1286.25: pass" : "88.5 to 955.8: pass", limits);
        }
        TEST_ASSERT_EQUAL_size_t(note + 4, board.note_count);
        assert_sensor_is_as_set();
        assert_no_row_is_shifted(row);
        TEST_ASSERT_EQUAL_UINT32(lost, counted(COUNT_LOST));
        TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_DROPPED));
    }
}

/* Rows stop for so long, and no other time; then filters warm up as after `go`; none is called missing. */
TEST(test_rows_pause_and_begin_anew)
{
    talk_start_noisy(100.0, 0.0);
    (void)talk_typed("selftest", 2500.0);
    size_t gaps = 0;
    for (size_t i = 1; i < board.row_count; i++) {
        uint32_t step_us = board.rows[i].t_us - board.rows[i - 1].t_us;
        if (step_us > 20000u) {
            gaps++;
            TEST_ASSERT_UINT32_WITHIN(150000, 1400000, step_us);
            for (size_t k = 0; k < 6; k++) {
                TEST_ASSERT_EQUAL_UINT(k < 5 ? ROW_WARMING_UP : 0, board.rows[i + k].flags);
            }
        }
    }
    TEST_ASSERT_EQUAL_size_t(1, gaps);
    TEST_ASSERT_TRUE(board.row_count > 150);
}

/*
 * The limits by definition, x and y 88.5 to 955.8 LSB, z 110.25 to 1286.25: the last whole LSB on each side of each.
 * Pairs that a mean has cut in two shift it by 3/256 LSB at most. y acts the other way.
 */
TEST(test_the_limits)
{
    static const struct {
        int16_t shift_lsb[3];
        const char *verdict[3];
    } parts[] = {
        { { 89, -89, 111 }, { "pass", "pass", "pass" } },    { { 88, -88, 110 }, { "FAIL", "FAIL", "FAIL" } },
        { { 955, -955, 1286 }, { "pass", "pass", "pass" } }, { { 956, -956, 1287 }, { "high", "high", "high" } },
        { { 0, -522, 698 }, { "FAIL", "pass", "pass" } },  /* dead */
        { { 522, 522, 698 }, { "pass", "FAIL", "pass" } }, /* the wrong way */
        { { 522, -522, -698 }, { "pass", "pass", "FAIL" } }, { { -1, 0, 1286 }, { "FAIL", "FAIL", "pass" } },
    };
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        start_exact(parts[i].shift_lsb);
        size_t note = talk_typed("selftest", SELFTEST_MS + 200.0);
        TEST_ASSERT_EQUAL_size_t(note + 4, board.note_count);
        for (size_t axis = 0; axis < 3; axis++) {
            double lsb = 0.0;
            const char *told = board.notes[note + 1 + axis];
            TEST_ASSERT_EQUAL_INT(1, sscanf(told, "# selftest %*c %lf LSB", &lsb));
            double along = parts[i].shift_lsb[axis] * (axis == 1 ? -1.0 : 1.0);
            TEST_ASSERT_DOUBLE_WITHIN(1.0 / 16.0 + 3.0 / 256.0, along, lsb);
            TEST_ASSERT_EQUAL_STRING_MESSAGE(parts[i].verdict[axis], strrchr(told, ' ') + 1, told);
        }
    }
}

/* Gain and offset of the part have no part in the shift. */
TEST(test_offsets_do_not_count)
{
    static const int16_t shift_lsb[] = { 300, -300, 400 };
    start_exact(shift_lsb);
    hal_host_sensor()->part.offset_lsb[0] = -400;
    hal_host_sensor()->part.offset_lsb[2] = 300;
    board_run_ms(300);
    size_t note = talk_typed("selftest", SELFTEST_MS + 200.0);
    for (size_t axis = 0; axis < 3; axis++) {
        double lsb = 0.0;
        TEST_ASSERT_EQUAL_INT(1, sscanf(board.notes[note + 1 + axis], "# selftest %*c %lf LSB", &lsb));
        TEST_ASSERT_DOUBLE_WITHIN(0.1, axis == 2 ? 400.0 : 300.0, lsb);
    }
}

/* The board is turned by 20 LSB in x at this time of a test, in the plain half or in the other one. */
TEST(test_a_board_that_moves_is_refused)
{
    static const double at_ms[] = { 350.0, 1000.0 };
    for (size_t i = 0; i < 2; i++) {
        stream_t stream = board_noisy_stream(6000, 100.0, 1.5, 12u);
        for (size_t k = 0; k < stream.count; k++) {
            stream.rows[k].lsb[0] = (int16_t)(stream.rows[k].lsb[0] + ((double)k * 10.0 > 500.0 + at_ms[i] ? 20 : 0));
        }
        board_start(&stream, 0.0, 0);
        board_run_ms(500);
        size_t note = talk_typed("selftest", 2500.0);
        talk_assert_note("# selftest: hold still", note);
        talk_assert_note("# refused 8: moving", note + 1);
        TEST_ASSERT_EQUAL_size_t(note + 2, board.note_count);
        TEST_ASSERT_TRUE(board.note_ms[note + 1] < 500.0 + (i == 0 ? 1100.0 : 1600.0));
        assert_sensor_is_as_set();
    }
}

/* The supply fails for 30 ms at any stage: a result is one of good samples, and everything is as before afterwards. */
TEST(test_a_supply_that_fails_in_the_middle)
{
    size_t cut = 0;
    for (double at_ms = 3.0; at_ms < 1600.0; at_ms += 17.0) {
        talk_start_noisy(100.0, 0.0);
        size_t note = talk_typed("selftest", at_ms);
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(30.0);
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(SELFTEST_MS + 300.0);
        talk_assert_told_once(note, "selftest");
        cut += board_notes_with("# refused 9", note);
        assert_sensor_is_as_set();
        assert_no_row_is_shifted(0);
        TEST_ASSERT_TRUE(board.rows[board.row_count - 1].flags == 0);
    }
    TEST_ASSERT_TRUE(cut > 70); /* of 94, all but those behind its end */
}

/* Off the bus for good: told within half a second, and no hang; the sensor that comes back is configured as set. */
TEST(test_a_sensor_that_stays_away)
{
    talk_start_noisy(100.0, 0.0);
    size_t note = talk_typed("selftest", 900.0);
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(500.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 9", note));
    board_run_ms(3000.0);
    TEST_ASSERT_EQUAL_UINT64(0, hal_host_watchdog_bite());
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(300.0);
    assert_sensor_is_as_set();
    assert_no_row_is_shifted(board.row_count - 5);
    note = talk_typed("selftest", SELFTEST_MS + 200.0);
    talk_assert_told_once(note, "selftest");
    TEST_ASSERT_EQUAL_size_t(3, board_notes_with(": pass", note));
}

/* What of it changes the sensor ends the test, what does not leaves it its result; `stop` and `go` as always. */
TEST(test_commands_in_the_middle)
{
    static const struct {
        const char *command;
        bool ends_it;
    } talk[] = { { "rate 200", true },        { "rate 12.5", true }, { "range 2", true },      { "go", true },
                 { "filter {plain}", false }, { "every 2", false },  { "status", false },      { "mode csv", false },
                 { "rate", false },           { "rate 60", false },  { "baud 250000", false }, { "odr", false },
                 { "defaults", true },        { "help", false },     { "mode plot", false } };
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        for (double at_ms = 20.0; at_ms < 1300.0; at_ms += 311.0) {
            talk_start_noisy(100.0, 0.0);
            size_t note = talk_typed("selftest", at_ms);
            (void)talk_typed(talk[i].command, SELFTEST_MS + 1000.0);
            if (strcmp(talk[i].command, "mode plot") != 0) {
                assert_no_row_is_shifted(0);
            }
            TEST_ASSERT_EQUAL_size_t_MESSAGE(talk[i].ends_it, board_notes_with("# refused 9", note), talk[i].command);
            talk_assert_told_once(note, "selftest");
            assert_sensor_is_as_set();
        }
    }
}

TEST(test_stop_in_the_middle)
{
    for (double at_ms = 5.0; at_ms < 1500.0; at_ms += 61.0) {
        talk_start_noisy(100.0, 0.0);
        size_t note = talk_typed("selftest", at_ms);
        size_t stopped = talk_typed("stop", 500.0);
        TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# stopped", stopped));
        talk_assert_told_once(note, "selftest");
        size_t row = board.row_count;
        (void)talk_typed("go", 500.0);
        TEST_ASSERT_TRUE(board.row_count > row + 40);
        assert_no_row_is_shifted(0);
        assert_sensor_is_as_set();
    }
}

TEST(test_one_at_a_time)
{
    talk_start_noisy(100.0, 0.0);
    size_t note = talk_typed("selftest", 300.0);
    board_type("noise");
    (void)talk_typed("selftest", 200.0);
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("# refused 10: busy measuring", note));
    board_run_ms(SELFTEST_MS);
    talk_assert_told_once(note, "selftest");
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("noise", note));
    talk_assert_note("# noise: hold still", talk_typed("noise", 100.0));
}

/* Not while nothing is measured: told at once. */
TEST(test_without_samples_there_is_no_measurement)
{
    talk_start_noisy(100.0, 0.0);
    (void)talk_typed("stop", 200.0);
    size_t note = talk_typed("noise", 100.0);
    talk_assert_note("# refused 9: samples lost or settings changed", note + 1);
    note = talk_typed("selftest", 100.0);
    talk_assert_note("# refused 9: samples lost or settings changed", note + 1);
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
    (void)talk_typed("go", 300.0);
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(300.0);
    note = talk_typed("selftest", 100.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 9", note));
}

/* After a reset of the MCU amid the force the sensor has it still, until it is configured. */
TEST(test_a_reset_amid_the_force)
{
    talk_start_noisy(100.0, 0.0);
    (void)talk_typed("selftest", 1000.0);
    TEST_ASSERT_EQUAL_HEX8(0x8B, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
    hal_host_reset_mcu(HAL_RESET_EXTERNAL);
    size_t row = board.row_count;
    app_start();
    board_run_ms(500.0);
    assert_sensor_is_as_set();
    TEST_ASSERT_TRUE(board.row_count > row + 20);
    assert_no_row_is_shifted(row);
}

/* A second net below the driver's own deadlines. */
TEST(test_no_measurement_lasts_longer_than_two_minutes)
{
    talk_start_noisy(100.0, 0.0);
    size_t note = talk_typed("noise", 100.0);
    for (int s = 0; s < 60 * LIMIT_MEASURE_MINUTES; s++) { /* it began in second 0 */
        count(COUNT_SECONDS);
    }
    board_run_ms(50.0);
    TEST_ASSERT_EQUAL_size_t(note + 1, board.note_count);
    count(COUNT_SECONDS);
    board_run_ms(100.0);
    talk_assert_note("# refused 9: samples lost or settings changed", note + 1);
}
