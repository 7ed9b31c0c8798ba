/* What `status` says, judged by what was done to the bus and the sensor and by what the sensor did. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "adxl345.h"
#include "adxl345_registers.h"
#include "hal_i2c.h"
#include "hal_sleep.h"
#include "support/documented_limits.h"
#include "support/talk.h"
#include "support/test.h"

enum {
    STATUS_LINES = 7,
    READ_BUS_EVENTS = 5
}; /* START, address, register, repeated START, address: then the data come */

/* First lines of the newest reply to `status` and of the one before it: some counters go on from test to test. */
static size_t newest;
static size_t before;

static void ask(void)
{
    before = newest;
    newest = talk_typed("status", 200);
    TEST_ASSERT_EQUAL_size_t(newest + STATUS_LINES, board.note_count);
    TEST_ASSERT_EQUAL_STRING_LEN("# state ", board.notes[newest], 8);
}

static unsigned told_at(size_t from, const char *name)
{
    for (size_t i = from; i < from + STATUS_LINES; i++) {
        const char *at = strstr(board.notes[i], name);
        if (at != NULL && at[-1] == ' ' && (at[-2] == '#' || at[-2] == ',')) {
            return (unsigned)strtoul(at + strlen(name), NULL, 10);
        }
    }
    TEST_FAIL_MESSAGE(name);
    return 0;
}

/* What a counter has grown by between the last two replies to `status`. */
static unsigned told(const char *name)
{
    return told_at(newest, name) - told_at(before, name);
}

static void start(const stream_t *stream, uint8_t (*on_rx)(uint8_t reg, uint8_t byte))
{
    if (stream == NULL) {
        board_start_resting();
    } else {
        board_start_with_rx(stream, on_rx);
    }
    board_run_ms(500);
    ask();
}

static void main_stands_still(double ms)
{
    for (double end_ms = hal_host_now_ms() + ms; hal_host_now_ms() < end_ms;) {
        hal_sleep_until_wake();
    }
    board_run_ms(300);
}

/* One bus event of the next burst, so many from its START on, has this status instead. */
static void disturb(uint8_t status, unsigned events)
{
    board_run_ms(50);
    hal_host_faults()->status_skip = events;
    hal_host_faults()->next_status = status;
    board_run_ms(30);
    TEST_ASSERT_TRUE_MESSAGE(hal_host_faults()->next_status < 0, "the disturbance has not happened");
}

TEST(test_failed_transfers_are_told_apart)
{
    static const struct {
        uint8_t status, events, times;
    } done[] = {
        { HAL_I2C_WRITE_ADDRESS_NACK, 1, 3 },
        { HAL_I2C_SENT_NACK, 2, 2 },
        { HAL_I2C_READ_ADDRESS_NACK, 4, 2 },
        { HAL_I2C_ARBITRATION_LOST, 1, 2 },
        { HAL_I2C_ARBITRATION_LOST, READ_BUS_EVENTS, 3 },
        { HAL_I2C_BUS_ERROR, 2, 3 },
        { HAL_I2C_SENT_NACK, READ_BUS_EVENTS + 2, 1 }, /* cannot be there */
    };
    start(NULL, NULL);
    for (size_t i = 0; i < sizeof done / sizeof done[0]; i++) {
        for (unsigned n = 0; n < done[i].times; n++) {
            disturb(done[i].status, done[i].events);
        }
    }
    for (unsigned n = 0; n < 6; n++) {
        board_run_ms(50);
        hal_host_faults()->hang_clocks = 9;
        board_run_ms(30);
        TEST_ASSERT_EQUAL_UINT8(0, hal_host_faults()->hang_clocks);
    }
    ask();
    TEST_ASSERT_EQUAL_UINT(7, told("not acknowledged "));
    TEST_ASSERT_EQUAL_UINT(5, told("arbitration lost "));
    TEST_ASSERT_EQUAL_UINT(4, told("bus errors "));
    TEST_ASSERT_EQUAL_UINT(6, told("timeouts "));
    TEST_ASSERT_EQUAL_UINT(0, told("restarts "));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# fault 3", 0));
}

TEST(test_a_calm_sensor_counts_nothing)
{
    static const char *const names[] = { "clipped ",       "dropped ",  "lines refused ",    "lost ",
                                         "drained ",       "stuck ",    "restarts ",         "empty ",
                                         "readings torn ", "overruns ", "not acknowledged ", "arbitration lost ",
                                         "bus errors ",    "timeouts ", "reacquired ",       "storms " };
    start(NULL, NULL);
    size_t latched = board.latched_count;
    board_run_ms(8000);
    ask();
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        TEST_ASSERT_EQUAL_UINT_MESSAGE(0, told(names[i]), names[i]);
    }
    TEST_ASSERT_UINT_WITHIN(1, 8, told("uptime s "));
    TEST_ASSERT_UINT_WITHIN(20, (unsigned)(board.latched_count - latched), told("samples "));
}

static unsigned corrupted_reads;
static unsigned reads_to_corrupt;

/* A bit of FIFO_CTL flips on its way, which the frame of a reading does not allow. */
static uint8_t corrupt(uint8_t reg, uint8_t byte)
{
    if (reg != ADXL345_FIFO_CTL || reads_to_corrupt == 0) {
        return byte;
    }
    reads_to_corrupt--;
    corrupted_reads++;
    return byte ^ 0x04;
}

TEST(test_readings_that_were_none_are_told)
{
    stream_t stream = board_noisy_stream(1000, 100.0, 1.5, 21u);
    start(&stream, corrupt);
    corrupted_reads = 0;
    for (unsigned n = 0; n < 5; n++) {
        reads_to_corrupt = 2;
        board_run_ms(100);
    }
    ask();
    TEST_ASSERT_EQUAL_UINT(10, corrupted_reads);
    TEST_ASSERT_EQUAL_UINT(corrupted_reads, told("readings torn "));
}

/* docs/faults.md */
TEST(test_a_register_that_lost_its_value_is_fault_4)
{
    board_start_resting();
    board_run_ms(500);
    hal_host_faults()->write_lost_register = ADXL345_BW_RATE;
    (void)talk_typed("rate 50", 500);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 4: a register lost its value", 0));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault", 0));
}

/* docs/faults.md. One less than that is only counted. */
TEST(test_torn_readings_in_a_row_are_fault_11)
{
    stream_t stream = board_noisy_stream(1000, 100.0, 1.5, 21u);
    start(&stream, corrupt);
    for (unsigned n = LIMIT_TORN - 1; n <= LIMIT_TORN; n++) {
        reads_to_corrupt = n;
        board_run_ms(200);
        TEST_ASSERT_EQUAL_UINT(0, reads_to_corrupt);
        TEST_ASSERT_EQUAL_size_t(n == LIMIT_TORN, board_notes_with("# fault 11: torn readings", 0));
    }
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault", 0) - board_notes_with("# fault 11 over", 0));
}

static unsigned sources_with_overrun;
static unsigned sources_without_data;

static uint8_t look_at_source(uint8_t reg, uint8_t byte)
{
    if (reg == ADXL345_INT_SOURCE) {
        sources_with_overrun += (byte & ADXL345_INT_OVERRUN) != 0;
        sources_without_data += (byte & ADXL345_INT_DATA_READY) == 0;
    }
    return byte;
}

/* Main stands still for longer than the FIFO is deep, or for less; what it reads late is drained. */
TEST(test_overruns_are_told)
{
    stream_t stream = board_noisy_stream(1000, 100.0, 1.5, 22u);
    start(&stream, look_at_source);
    (void)talk_typed("rate 200", 100);
    ask();
    sources_with_overrun = 0;
    main_stands_still(100);
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_sensor()->overruns);
    main_stands_still(200);
    main_stands_still(220);
    ask();
    TEST_ASSERT_TRUE(hal_host_sensor()->overruns > 0);
    TEST_ASSERT_TRUE(sources_with_overrun >= 2);
    TEST_ASSERT_EQUAL_UINT(sources_with_overrun, told("overruns "));
    TEST_ASSERT_TRUE(told("drained ") >= 19 + 33 + 33);
    TEST_ASSERT_UINT_WITHIN(1, hal_host_sensor()->overruns, told("lost ")); /* by the stamps, which are interpolated */
}

/* INT1 is held high: the sensor is looked at, and has nothing, again and again. */
TEST(test_readings_without_a_sample_are_told)
{
    stream_t stream = board_noisy_stream(1000, 100.0, 1.5, 23u);
    start(&stream, look_at_source);
    sources_without_data = 0;
    hal_host_faults()->int1_high = true;
    board_run_ms(300);
    hal_host_faults()->int1_high = false;
    board_run_ms(1000);
    ask();
    /* those that only ask are none, and a sample may come behind INT_SOURCE */
    TEST_ASSERT_TRUE(told("empty ") >= 3 && told("empty ") <= sources_without_data);
    TEST_ASSERT_EQUAL_UINT(0, told("readings torn "));
}

TEST(test_stuck_samples_are_counted)
{
    stream_t stream = board_hung_stream(1000, 11u, 300, 60);
    start(&stream, NULL);
    board_run_ms(5000);
    ask();
    TEST_ASSERT_EQUAL_UINT(60 - 9, told("stuck "));
}

/* Nobody has answered yet: there is no rate. */
TEST(test_no_sensor_has_no_rate)
{
    board_start_resting();
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(500);
    ask();
    TEST_ASSERT_NOT_NULL(strstr(board.notes[newest], "fault 1, rate 100 Hz, measured 0.00 Hz, uptime s 0"));
}

TEST(test_restarts_are_counted)
{
    start(NULL, NULL);
    for (unsigned n = 0; n < 4; n++) {
        adxl345_model_power(hal_host_sensor(), false);
        board_run_ms(100);
        adxl345_model_power(hal_host_sensor(), true);
        board_run_ms(300);
    }
    ask();
    TEST_ASSERT_EQUAL_UINT(4, told("restarts "));
    TEST_ASSERT_TRUE(told("not acknowledged ") >= 8); /* both addresses, at least once each time */
}

/* INT1 was away for some samples, or a slave hung: what has gathered is fetched, and no sample is lost from then on. */
TEST(test_a_fifo_that_is_behind_is_fetched)
{
    static const char *const commands[] = { "rate 400", "rate 800" };
    for (unsigned i = 0; i < 4; i++) {
        start(NULL, NULL);
        (void)talk_typed(commands[i / 2], 500);
        if (i % 2 == 0) {
            hal_host_faults()->int1_cut = true;
            board_run_ms(10);
            hal_host_faults()->int1_cut = false;
        } else {
            hal_host_faults()->hang_clocks = 9;
        }
        board_run_ms(300);
        ask();
        board_run_ms(2000);
        ask();
        TEST_ASSERT_EQUAL_UINT(0, told("overruns "));
        TEST_ASSERT_EQUAL_UINT(0, told("lost "));
        TEST_ASSERT_TRUE(hal_host_sensor()->fifo_count <= 2);
    }
}

/* INT1 that came back is none: the sensor keeps its configuration. Nor is what a command asks for. */
TEST(test_what_is_no_restart)
{
    start(NULL, NULL);
    board_run_ms(300);
    hal_host_faults()->int1_cut = true;
    board_run_ms(300);
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
    hal_host_faults()->int1_cut = false;
    board_run_ms(300);
    TEST_ASSERT_EQUAL_UINT(ADXL345_FAULT_NONE, adxl345_fault());
    (void)talk_typed("rate 200", 300);
    ask();
    TEST_ASSERT_EQUAL_UINT(0, told("restarts "));
}

/* The sensor's clock is off by up to 5 %: what is told is its rate, within 0.05 %, at every rate. */
TEST(test_measured_rate)
{
    static const char *const rates[] = { "12.5", "25", "50", "100", "200", "400", "800" };
    static const double ppm[] = { 0, 50000, -50000, 21634, -123 };
    for (size_t p = 0; p < sizeof ppm / sizeof ppm[0]; p++) {
        stream_t stream = board_noisy_stream(1000, 100.0, 1.5, 5u);
        board_start(&stream, ppm[p], 0);
        board_run_ms(300);
        for (size_t r = 0; r < sizeof rates / sizeof rates[0]; r++) {
            char typed[16];
            char begin[48];
            double true_hz = atof(rates[r]) * (1.0 + ppm[p] * 1e-6);
            snprintf(typed, sizeof typed, "rate %s", rates[r]);
            (void)talk_typed(typed, 100.0 + 40e3 / true_hz);
            ask();
            const char *state = board.notes[newest];
            snprintf(begin, sizeof begin, "fault 0, rate %s Hz, measured ", rates[r]);
            const char *at = strstr(state, begin);
            TEST_ASSERT_NOT_NULL_MESSAGE(at, state);
            at += strlen(begin);
            char *end;
            double told_hz = strtod(at, &end);
            TEST_ASSERT_EQUAL_STRING_LEN(" Hz, uptime s ", end, 14);
            TEST_ASSERT_EQUAL_CHAR('.', end[-3]);
            TEST_ASSERT_DOUBLE_WITHIN(5e-4 * true_hz, true_hz, told_hz);
        }
    }
}
