/*
 * A register access that fails, in every step of every change: a single one is made again and nothing is told; what
 * was asked for comes about. The sensor is looked for at both addresses, whoever else answers.
 */
#include <stdio.h>

#include "adxl345.h"
#include "adxl345_registers.h"
#include "base/counters.h"
#include "hal_i2c.h"
#include "path/pipeline.h"
#include "support/random.h"
#include "support/talk.h"
#include "support/test.h"

enum { NEIGHBOUR_ID = 0x42 };

static uint8_t neighbour; /* address of a device that is no ADXL345; 0: there is none */

static uint8_t on_rx(uint8_t reg, uint8_t byte)
{
    return neighbour != 0 && hal_host_sensor()->address == neighbour && reg == ADXL345_DEVID ? NEIGHBOUR_ID : byte;
}

void setUp(void)
{
    neighbour = 0;
}

static void start(void)
{
    stream_t stream = board_noisy_stream(3000, 100.0, 1.5, 3u);
    board_start_with_rx(&stream, on_rx);
    board_run_ms(1003);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
}

/* One bus event, so many from the command on, has this status instead; false: it has not come about. */
static bool failed_once(const char *command, uint8_t status, unsigned skip)
{
    start();
    board_type(command);
    while (adxl345_phase() == ADXL345_STREAMING) {
        hal_host_faults()->next_status = status;
        hal_host_faults()->status_skip = skip;
        board_run_ms(0.02);
    }
    board_run_ms(500);
    bool failed = hal_host_faults()->next_status < 0;
    hal_host_faults()->next_status = -1;
    return failed;
}

static const uint8_t statuses[] = { HAL_I2C_WRITE_ADDRESS_NACK, HAL_I2C_SENT_NACK, HAL_I2C_READ_ADDRESS_NACK,
                                    HAL_I2C_ARBITRATION_LOST, HAL_I2C_BUS_ERROR };

/* Standby, samples fetched, 21 accesses of configuration, the beginning: over a hundred bus events. */
TEST(test_one_failed_access_in_a_change_of_rate_is_not_noticed)
{
    static const char *const commands[] = { "rate 50", "rate 200" };
    static const double rates_hz[] = { 50.0, 200.0 };
    unsigned times = 0;
    for (size_t c = 0; c < 2; c++) {
        for (size_t s = 0; s < sizeof statuses; s++) {
            for (unsigned skip = 0; skip < 110; skip += 3) {
                times += failed_once(commands[c], statuses[s], skip);
                TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# fault", 0));
                TEST_ASSERT_EQUAL_DOUBLE(rates_hz[c], adxl345_model_odr_hz(hal_host_sensor()));
                TEST_ASSERT_UINT32_WITHIN(30, (uint32_t)(1e6 / rates_hz[c]), adxl345_period_us());
                TEST_ASSERT_TRUE(counted(COUNT_LOST) <= 2);
            }
        }
    }
    TEST_ASSERT_TRUE(times > 300);
}

TEST(test_one_failed_access_in_a_stop_leaves_no_sensor_awake)
{
    unsigned times = 0;
    for (size_t s = 0; s < sizeof statuses; s++) {
        for (unsigned skip = 0; skip < 8; skip++) {
            times += failed_once("stop", statuses[s], skip);
            TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
            TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(hal_host_sensor()));
        }
    }
    TEST_ASSERT_TRUE(times >= 15);
}

/* A line is low while the sensor is put to rest for another rate: it is configured behind the fault, at that rate. */
TEST(test_a_fault_in_a_change_of_rate_keeps_no_old_period)
{
    for (unsigned phase = 0; phase < 20; phase++) {
        start();
        hal_host_faults()->sda_low = true;
        (void)talk_typed("rate 50", 10.0 + phase * 0.5);
        hal_host_faults()->sda_low = false;
        board_run_ms(500);
        size_t row = board.row_count;
        uint32_t lost = counted(COUNT_LOST);
        board_run_ms(1000);
        TEST_ASSERT_UINT32_WITHIN(30, 20000, adxl345_period_us());
        TEST_ASSERT_EQUAL_UINT32(lost, counted(COUNT_LOST));
        TEST_ASSERT_UINT_WITHIN(1, 50, (unsigned)(board.row_count - row));
    }
}

/*
 * Contact lost, and back 1 ms after a stop at any moment of the search for the sensor (a blank takes 87 us), or with a
 * neighbour that answers all the while: the stop finds the sensor.
 */
TEST(test_a_stop_behind_refused_transfers_finds_the_sensor)
{
    for (int phase = 0; phase < 600; phase++) {
        char typed[320];
        snprintf(typed, sizeof typed, "%*s", phase / 2 + 4, "stop");
        start();
        neighbour = phase % 2 == 0 ? 0 : ADXL345_ADDRESS_HIGH;
        hal_host_sensor()->address = phase % 2 == 0 ? 0x2A : ADXL345_ADDRESS_HIGH;
        board_run_ms(100.0);
        board_type(typed);
        while (adxl345_phase() != ADXL345_STOPPED && adxl345_phase() != ADXL345_QUIESCING) {
            board_run_ms(0.01);
        }
        hal_host_sensor()->address = ADXL345_ADDRESS_LOW;
        board_run_ms(100);
        TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
        TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(hal_host_sensor()));
    }
}

/* The line of this number is low, or both are free again. */
static void hold(unsigned line, bool low)
{
    hal_host_faults()->sda_low = low && line == 0;
    hal_host_faults()->scl_low = low && line == 1;
}

/*
 * A line is low when the stop comes: silence at once, but for the row on the line and that of the sample under way, and
 * the sensor rests when it is free. A sample comes every 10 ms, tries for the bus 5 to 25 ms apart: each time the line
 * goes low, and the stop comes, at another moment of both.
 */
TEST(test_a_stop_while_a_line_is_low_reaches_the_sensor_later)
{
    test_random_t chance;
    random_seed(&chance, 20261122u);
    for (unsigned phase = 0; phase < 400; phase++) {
        start();
        board_run_ms(10.0 * random_uniform(&chance));
        hold(phase % 2, true);
        board_run_ms((phase < 200 ? 10.0 : 120.0) * random_uniform(&chance));
        size_t rows = board.row_count;
        (void)talk_typed("stop", 200);
        TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
        TEST_ASSERT_TRUE(board.row_count <= rows + 2);
        rows = board.row_count;
        hold(phase % 2, false);
        board_run_ms(50);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(hal_host_sensor()));
        TEST_ASSERT_EQUAL_size_t(rows, board.row_count);
    }
}

/* A sensor without supply is asked to rest for a time, and then let be. */
TEST(test_a_stop_that_nobody_answers_is_given_up)
{
    start();
    adxl345_model_power(hal_host_sensor(), false);
    (void)talk_typed("stop", 2500);
    adxl345_counters_t before;
    adxl345_counters_t after;
    adxl345_counters(&before);
    board_run_ms(1000);
    adxl345_counters(&after);
    TEST_ASSERT_EQUAL_UINT16(before.nacks, after.nacks);
}

/* Another device answers at one address; the sensor is at the other one, has lost contact, and is found again. */
TEST(test_a_neighbour_at_the_other_address_does_not_keep_the_sensor_out)
{
    static const uint8_t addresses[] = { ADXL345_ADDRESS_LOW, ADXL345_ADDRESS_HIGH };
    for (size_t i = 0; i < 2; i++) {
        neighbour = addresses[1 - i];
        stream_t stream = board_noisy_stream(3000, 100.0, 1.5, 3u);
        board_start_with_rx(&stream, on_rx);
        hal_host_sensor()->address = addresses[i];
        board_run_ms(500);
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        hal_host_sensor()->address = neighbour; /* it alone answers */
        board_run_ms(500);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_WRONG_ID, adxl345_fault());
        TEST_ASSERT_EQUAL_HEX8(neighbour, adxl345_foreign_address());
        TEST_ASSERT_EQUAL_HEX8(NEIGHBOUR_ID, adxl345_foreign_id());
        hal_host_sensor()->address = addresses[i];
        board_run_ms(150);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_HEX8(addresses[i], adxl345_address());
    }
}

/* Three bursts are refused and the sensor answers when it is looked for: configured anew, and nothing to tell. */
TEST(test_three_refused_bursts_of_a_sensor_that_is_there)
{
    adxl345_counters_t before;
    adxl345_counters_t now;
    start();
    adxl345_counters(&before);
    hal_host_sensor()->address = 0x2A;
    do {
        board_run_ms(0.01);
        adxl345_counters(&now);
    } while (now.nacks - before.nacks < 3);
    hal_host_sensor()->address = ADXL345_ADDRESS_LOW;
    board_run_ms(100);
    adxl345_counters(&now);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("# fault", 0));
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_UINT32_WITHIN(1, (uint32_t)board.latched_count, counted(COUNT_SAMPLES));
    for (size_t row = 50; row < board.row_count; row++) { /* what is missing has its rows, and is counted */
        TEST_ASSERT_UINT32_WITHIN(5000, 10000, board.rows[row].t_us - board.rows[row - 1].t_us);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 2, counted(COUNT_LOST));
    TEST_ASSERT_EQUAL_UINT16(before.restarts + 1, now.restarts);
}

/* Wires off: one line, with the words for a sensor that is gone. */
TEST(test_no_sensor_is_told_when_neither_address_has_answered)
{
    start();
    size_t before = board.note_count;
    hal_host_sensor()->address = 0x2A;
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1: ", before));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault", before));
}
