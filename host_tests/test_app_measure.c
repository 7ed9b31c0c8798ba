/*
 * The measuring commands of the whole firmware, judged by the truth of the model's part: `selftest` of good, dead, weak
 * and strong axes at any rate and range, `noise`, `odr`, and what comes in the middle.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "adxl345_registers.h"
#include "app.h"
#include "counters.h"
#include "hal_watchdog.h"
#include "pipeline.h"
#include "settings.h"
#include "support_board.h"
#include "unity.h"

/* 256 samples at 400 Hz twice are 1.28 s; a change of configuration takes a period and 20 ms, three times. */
enum { SELFTEST_MS = 1600, REST_X = 31, REST_Y = -53, REST_Z = 248, NEAR_LSB = 12 };

static stream_t stream;

void setUp(void) {}

void tearDown(void)
{
    stream_free(&stream);
}

/* At rest, with noise of 1.5 LSB, at the rate of the stream. */
static void start_resting(double rate_hz, double ppm)
{
    stream = board_noisy_stream((size_t)(60.0 * rate_hz), rate_hz, 1.5, 11u);
    board_start(&stream, ppm, 0);
    board_run_ms(700);
}

/* Every second reading is one LSB more, so that the mean of a whole number of pairs is known: half of one more. */
static void start_exact(const int16_t self_test_lsb[3])
{
    stream = board_constant_stream(6000, 100.0, REST_X, REST_Y, REST_Z);
    for (size_t i = 1; i < stream.count; i += 2) {
        for (size_t axis = 0; axis < 3; axis++) {
            stream.rows[i].lsb[axis]++;
        }
    }
    board_start(&stream, 0.0, 0);
    memcpy(hal_host_sensor.part.self_test_lsb, self_test_lsb, sizeof hal_host_sensor.part.self_test_lsb);
    board_run_ms(500);
}

static size_t typed(const char *command, double ms)
{
    size_t before = board.note_count;
    board_type(command);
    board_run_ms(ms);
    return before;
}

static void assert_note(const char *expected, size_t at)
{
    TEST_ASSERT_TRUE_MESSAGE(at < board.note_count, expected);
    TEST_ASSERT_EQUAL_STRING(expected, board.notes[at]);
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
    for (uint16_t dhz = 125; dhz < settings.rate_dhz; dhz = (uint16_t)(dhz * 2u)) {
        code++;
    }
    TEST_ASSERT_EQUAL_HEX8(formats[settings.range_g], hal_host_sensor.reg[ADXL345_DATA_FORMAT]);
    TEST_ASSERT_EQUAL_HEX8(code, hal_host_sensor.reg[ADXL345_BW_RATE]);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/*
 * The typical part: 522, -522 and 698 LSB. Rows of a stream of 100 Hz are read four times at 400 Hz, so 64 readings of
 * 1.5 LSB rms make each mean: their difference is good to 0.27 LSB, 1.4 is five times that.
 */
static void test_a_good_part_passes_at_any_rate_and_range(void)
{
    static const char *const rates[] = { "rate 12.5", "rate 25",  "rate 50", "rate 100",
                                         "rate 200",  "rate 400", "rate 800" };
    static const char *const ranges[] = { "range 2", "range 4", "range 8", "range 16" };
    static const double truth_lsb[] = { 522.0, 522.0, 698.0 };
    for (size_t i = 0; i < 7; i++) {
        start_resting(100.0, 0.0);
        (void)typed("baud 1000000", 100.0);
        (void)typed(rates[i], 400.0);
        (void)typed(ranges[i % 4], 600.0);
        size_t row = board.row_count - 1;
        uint32_t lost = counters[COUNT_LOST];
        size_t note = typed("selftest", SELFTEST_MS + 400.0);
        assert_note("# selftest: hold still", note);
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
        TEST_ASSERT_EQUAL_UINT32(lost, counters[COUNT_LOST]);
        TEST_ASSERT_EQUAL_UINT32(0, counters[COUNT_DROPPED]);
        stream_free(&stream);
    }
}

/* Rows stop for so long, and no other time; then filters warm up as after `go`; none is called missing. */
static void test_rows_pause_and_begin_anew(void)
{
    start_resting(100.0, 0.0);
    (void)typed("selftest", 2500.0);
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
static void test_the_limits(void)
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
        size_t note = typed("selftest", SELFTEST_MS + 200.0);
        TEST_ASSERT_EQUAL_size_t(note + 4, board.note_count);
        for (size_t axis = 0; axis < 3; axis++) {
            double lsb = 0.0;
            const char *told = board.notes[note + 1 + axis];
            TEST_ASSERT_EQUAL_INT(1, sscanf(told, "# selftest %*c %lf LSB", &lsb));
            double along = parts[i].shift_lsb[axis] * (axis == 1 ? -1.0 : 1.0);
            TEST_ASSERT_DOUBLE_WITHIN(1.0 / 16.0 + 3.0 / 256.0, along, lsb);
            TEST_ASSERT_EQUAL_STRING_MESSAGE(parts[i].verdict[axis], strrchr(told, ' ') + 1, told);
        }
        stream_free(&stream);
    }
}

/* Gain and offset of the part have no part in the shift. */
static void test_offsets_do_not_count(void)
{
    static const int16_t shift_lsb[] = { 300, -300, 400 };
    start_exact(shift_lsb);
    hal_host_sensor.part.offset_lsb[0] = -400;
    hal_host_sensor.part.offset_lsb[2] = 300;
    board_run_ms(300);
    size_t note = typed("selftest", SELFTEST_MS + 200.0);
    for (size_t axis = 0; axis < 3; axis++) {
        double lsb = 0.0;
        TEST_ASSERT_EQUAL_INT(1, sscanf(board.notes[note + 1 + axis], "# selftest %*c %lf LSB", &lsb));
        TEST_ASSERT_DOUBLE_WITHIN(0.1, axis == 2 ? 400.0 : 300.0, lsb);
    }
}

/* The board is turned by 20 LSB in x at this time of a test, in the plain half or in the other one. */
static void test_a_board_that_moves_is_refused(void)
{
    static const double at_ms[] = { 350.0, 1000.0 };
    for (size_t i = 0; i < 2; i++) {
        stream = board_noisy_stream(6000, 100.0, 1.5, 12u);
        for (size_t k = 0; k < stream.count; k++) {
            stream.rows[k].lsb[0] = (int16_t)(stream.rows[k].lsb[0] + ((double)k * 10.0 > 500.0 + at_ms[i] ? 20 : 0));
        }
        board_start(&stream, 0.0, 0);
        board_run_ms(500);
        size_t note = typed("selftest", 2500.0);
        assert_note("# selftest: hold still", note);
        assert_note("# refused 8: moving", note + 1);
        TEST_ASSERT_EQUAL_size_t(note + 2, board.note_count);
        TEST_ASSERT_TRUE(board.note_ms[note + 1] < 500.0 + (i == 0 ? 1100.0 : 1600.0));
        assert_sensor_is_as_set();
        stream_free(&stream);
    }
}

/* What is told of a measurement that something came into: its result, or that it was cut; one of them, once. */
static void assert_told_once(size_t note, const char *of)
{
    char done[40];
    snprintf(done, sizeof done, "# %s z ", of);
    size_t results = board_notes_with(done, note);
    size_t cut = board_notes_with("# refused 9: samples lost, or another configuration", note);
    TEST_ASSERT_EQUAL_size_t_MESSAGE(1, results + cut, of);
    snprintf(done, sizeof done, "# %s x ", of);
    TEST_ASSERT_EQUAL_size_t(results, board_notes_with(done, note));
    if (results != 0) {
        TEST_ASSERT_EQUAL_size_t(strcmp(of, "selftest") == 0 ? 3 : 0, board_notes_with(": pass", note));
    }
}

/* The supply fails for 30 ms at any stage: a result is one of good samples, and everything is as before afterwards. */
static void test_a_supply_that_fails_in_the_middle(void)
{
    size_t cut = 0;
    for (double at_ms = 3.0; at_ms < 1600.0; at_ms += 17.0) {
        start_resting(100.0, 0.0);
        size_t note = typed("selftest", at_ms);
        adxl345_model_power(&hal_host_sensor, false);
        board_run_ms(30.0);
        adxl345_model_power(&hal_host_sensor, true);
        board_run_ms(SELFTEST_MS + 300.0);
        assert_told_once(note, "selftest");
        cut += board_notes_with("# refused 9", note);
        assert_sensor_is_as_set();
        assert_no_row_is_shifted(0);
        TEST_ASSERT_TRUE(board.rows[board.row_count - 1].flags == 0);
        stream_free(&stream);
    }
    TEST_ASSERT_TRUE(cut > 70); /* of 94, all but those behind its end */
}

/* Off the bus for good: told within half a second, and no hang; the sensor that comes back is configured as set. */
static void test_a_sensor_that_stays_away(void)
{
    start_resting(100.0, 0.0);
    size_t note = typed("selftest", 900.0);
    adxl345_model_power(&hal_host_sensor, false);
    board_run_ms(500.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 9", note));
    board_run_ms(3000.0);
    TEST_ASSERT_EQUAL_UINT64(0, hal_host_watchdog_bite());
    adxl345_model_power(&hal_host_sensor, true);
    board_run_ms(300.0);
    assert_sensor_is_as_set();
    assert_no_row_is_shifted(board.row_count - 5);
    note = typed("selftest", SELFTEST_MS + 200.0);
    assert_told_once(note, "selftest");
    TEST_ASSERT_EQUAL_size_t(3, board_notes_with(": pass", note));
}

/* What of it changes the sensor ends the test, what does not leaves it its result; `stop` and `go` as always. */
static void test_commands_in_the_middle(void)
{
    static const struct {
        const char *command;
        bool ends_it;
    } talk[] = { { "rate 200", true },   { "rate 12.5", true }, { "range 2", true },      { "go", true },
                 { "filter kf", false }, { "every 2", false },  { "status", false },      { "mode csv", false },
                 { "rate", false },      { "rate 60", false },  { "baud 250000", false }, { "odr", false },
                 { "defaults", true },   { "help", false },     { "mode plot", false } };
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        for (double at_ms = 20.0; at_ms < 1300.0; at_ms += 311.0) {
            start_resting(100.0, 0.0);
            size_t note = typed("selftest", at_ms);
            (void)typed(talk[i].command, SELFTEST_MS + 1000.0);
            if (strcmp(talk[i].command, "mode plot") != 0) {
                assert_no_row_is_shifted(0);
            }
            TEST_ASSERT_EQUAL_size_t_MESSAGE(talk[i].ends_it, board_notes_with("# refused 9", note), talk[i].command);
            assert_told_once(note, "selftest");
            assert_sensor_is_as_set();
            stream_free(&stream);
        }
    }
}

static void test_stop_in_the_middle(void)
{
    for (double at_ms = 5.0; at_ms < 1500.0; at_ms += 61.0) {
        start_resting(100.0, 0.0);
        size_t note = typed("selftest", at_ms);
        size_t stopped = typed("stop", 500.0);
        TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# stopped", stopped));
        assert_told_once(note, "selftest");
        size_t row = board.row_count;
        (void)typed("go", 500.0);
        TEST_ASSERT_TRUE(board.row_count > row + 40);
        assert_no_row_is_shifted(0);
        assert_sensor_is_as_set();
        stream_free(&stream);
    }
}

static void test_one_at_a_time(void)
{
    start_resting(100.0, 0.0);
    size_t note = typed("selftest", 300.0);
    board_type("noise");
    board_type("selftest");
    board_run_ms(200.0);
    TEST_ASSERT_EQUAL_size_t(2, board_notes_with("# refused 10: one measurement at a time", note));
    board_run_ms(SELFTEST_MS);
    assert_told_once(note, "selftest");
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("noise", note));
    assert_note("# noise: hold still", typed("noise", 100.0));
}

/* Not while nothing is measured: told at once. */
static void test_without_samples_there_is_no_measurement(void)
{
    start_resting(100.0, 0.0);
    (void)typed("stop", 200.0);
    size_t note = typed("noise", 100.0);
    assert_note("# refused 9: samples lost, or another configuration", note + 1);
    note = typed("selftest", 100.0);
    assert_note("# refused 9: samples lost, or another configuration", note + 1);
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0, hal_host_sensor.reg[ADXL345_POWER_CTL]);
    (void)typed("go", 300.0);
    adxl345_model_power(&hal_host_sensor, false);
    board_run_ms(300.0);
    note = typed("selftest", 100.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 9", note));
}

/* After a reset of the MCU amid the force the sensor has it still, until it is configured. */
static void test_a_reset_amid_the_force(void)
{
    start_resting(100.0, 0.0);
    (void)typed("selftest", 1000.0);
    TEST_ASSERT_EQUAL_HEX8(0x8B, hal_host_sensor.reg[ADXL345_DATA_FORMAT]);
    hal_host_reset_mcu(HAL_RESET_EXTERNAL);
    size_t row = board.row_count;
    app_start();
    board_run_ms(500.0);
    assert_sensor_is_as_set();
    TEST_ASSERT_TRUE(board.row_count > row + 20);
    assert_no_row_is_shifted(row);
}

/* A second net below the driver's own deadlines. */
static void test_no_measurement_lasts_longer_than_two_minutes(void)
{
    start_resting(100.0, 0.0);
    size_t note = typed("noise", 100.0);
    counters[COUNT_SECONDS] = 120; /* it began in second 0 */
    board_run_ms(50.0);
    TEST_ASSERT_EQUAL_size_t(note + 1, board.note_count);
    counters[COUNT_SECONDS]++;
    board_run_ms(100.0);
    assert_note("# refused 9: samples lost, or another configuration", note + 1);
}

/*
 * 256 readings of known noise: the estimate's own deviation is 1 / sqrt(512) = 4.4 % of rms; 18 % are four times that.
 * R is 1.5 times the variance. Told after 256 samples, of every second, fourth, eighth from 200 Hz on.
 */
static void test_noise_at_any_rate(void)
{
    static const struct {
        const char *command;
        double rate_hz, seconds;
    } rates[] = { { "rate 12.5", 12.5, 20.48 }, { "rate 50", 50.0, 5.12 },   { "rate 100", 100.0, 2.56 },
                  { "rate 200", 200.0, 2.56 },  { "rate 400", 400.0, 2.56 }, { "rate 800", 800.0, 2.56 } };
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        start_resting(rates[i].rate_hz, 0.0);
        (void)typed(rates[i].command, 1000.0);
        double begun_ms = hal_host_now_ms();
        size_t note = typed("noise", rates[i].seconds * 1000.0 + 200.0);
        assert_note("# noise: hold still", note);
        TEST_ASSERT_EQUAL_size_t(note + 4, board.note_count);
        TEST_ASSERT_DOUBLE_WITHIN(100.0 + 2000.0 / rates[i].rate_hz, rates[i].seconds * 1000.0,
                                  board.note_ms[note + 1] - begun_ms);
        for (size_t axis = 0; axis < 3; axis++) {
            char name = '?';
            double rms = 0.0;
            double r = 0.0;
            TEST_ASSERT_EQUAL_INT(
                3, sscanf(board.notes[note + 1 + axis], "# noise %c %lf LSB rms, R %lf LSB^2", &name, &rms, &r));
            TEST_ASSERT_EQUAL_CHAR("xyz"[axis], name);
            double truth = sqrt(1.5 * 1.5 + 1.0 / 12.0); /* and what rounding adds */
            TEST_ASSERT_DOUBLE_WITHIN(0.18 * truth, truth, rms);
            TEST_ASSERT_DOUBLE_WITHIN(0.02 + 2.0 * rms / 256.0, 1.5 * rms * rms, r);
        }
        stream_free(&stream);
    }
}

/* The samples that it looks at are the rows' own: none is missing meanwhile. */
static void test_noise_takes_nothing_from_the_rows(void)
{
    start_resting(100.0, 0.0);
    size_t first = board.row_count;
    (void)typed("noise", 3000.0);
    TEST_ASSERT_TRUE(board.row_count >= first + 299);
    for (size_t i = first; i < board.row_count; i++) {
        TEST_ASSERT_EQUAL_UINT(0, board.rows[i].flags);
        TEST_ASSERT_UINT32_WITHIN(2, 10000, board.rows[i].t_us - board.rows[i - 1].t_us);
    }
}

/* Turning by 4.5 LSB in the time of a measurement, or a knock of 128: refused; the knock at once. */
static void test_noise_of_a_board_that_moves_is_refused(void)
{
    for (int knock = 0; knock < 2; knock++) {
        stream = board_noisy_stream(6000, 100.0, 1.5, 13u);
        for (size_t k = 0; k < stream.count; k++) {
            double off = knock != 0 ? (k == 100 ? 140.0 : 0.0) : 6.0 * (double)k / 256.0;
            stream.rows[k].lsb[1] = (int16_t)(stream.rows[k].lsb[1] + (int)lround(off));
        }
        board_start(&stream, 0.0, 0);
        board_run_ms(500.0);
        size_t note = typed("noise", 3000.0);
        assert_note("# refused 8: moving", note + 1);
        TEST_ASSERT_EQUAL_size_t(note + 2, board.note_count);
        if (knock != 0) {
            TEST_ASSERT_TRUE(board.note_ms[note + 1] < 1200.0);
        }
        stream_free(&stream);
    }
}

static void test_noise_ends_with_another_rate_and_goes_on_with_another_filter(void)
{
    static const struct {
        const char *command;
        bool ends_it;
    } talk[] = { { "rate 50", true },      { "range 4", true },  { "stop", true },        { "go", true },
                 { "filter sprf", false }, { "every 3", false }, { "baud 250000", false } };
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        start_resting(100.0, 0.0);
        size_t note = typed("noise", 500.0);
        (void)typed(talk[i].command, 3000.0);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(talk[i].ends_it, board_notes_with("# refused 9", note), talk[i].command);
        assert_told_once(note, "noise");
        stream_free(&stream);
    }
}

/* A sensor whose clock is 2 % fast, 3 % slow or right; the measurement itself is good to some ppm. */
static void test_odr_tells_the_measured_rate(void)
{
    static const struct {
        double ppm;
        const char *told;
    } clocks[] = { { 20000.0, "# odr 102.00 Hz, 2 % from 100 Hz" },
                   { -30000.0, "# odr 97.00 Hz, -3 % from 100 Hz" },
                   { 0.0, "# odr 100.00 Hz, 0 % from 100 Hz" } };
    for (size_t i = 0; i < 3; i++) {
        start_resting(100.0, clocks[i].ppm);
        size_t note = typed("odr", 200.0);
        TEST_ASSERT_EQUAL_size_t(note + 1, board.note_count);
        TEST_ASSERT_EQUAL_STRING_LEN(clocks[i].told, board.notes[note], strlen(clocks[i].told));
        stream_free(&stream);
    }
}

static void test_odr_is_not_known_before_sixteen_samples(void)
{
    start_resting(100.0, 0.0);
    (void)typed("rate 12.5", 100.0);
    assert_note("# odr: not measured yet", typed("odr", 1000.0));
    board_run_ms(1000.0);
    assert_note("# odr 12.50 Hz, 0 % from 12.5 Hz", typed("odr", 200.0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_good_part_passes_at_any_rate_and_range);
    RUN_TEST(test_rows_pause_and_begin_anew);
    RUN_TEST(test_the_limits);
    RUN_TEST(test_offsets_do_not_count);
    RUN_TEST(test_a_board_that_moves_is_refused);
    RUN_TEST(test_a_supply_that_fails_in_the_middle);
    RUN_TEST(test_a_sensor_that_stays_away);
    RUN_TEST(test_commands_in_the_middle);
    RUN_TEST(test_stop_in_the_middle);
    RUN_TEST(test_one_at_a_time);
    RUN_TEST(test_without_samples_there_is_no_measurement);
    RUN_TEST(test_a_reset_amid_the_force);
    RUN_TEST(test_no_measurement_lasts_longer_than_two_minutes);
    RUN_TEST(test_noise_at_any_rate);
    RUN_TEST(test_noise_takes_nothing_from_the_rows);
    RUN_TEST(test_noise_of_a_board_that_moves_is_refused);
    RUN_TEST(test_noise_ends_with_another_rate_and_goes_on_with_another_filter);
    RUN_TEST(test_odr_tells_the_measured_rate);
    RUN_TEST(test_odr_is_not_known_before_sixteen_samples);
    return UNITY_END();
}
