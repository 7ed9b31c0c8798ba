/*
 * Corners of the driver's error branches: a line that comes free just when time is up, a STOP that holds up the reading
 * by the clock, commands while samples are still being fetched, a count of the FIFO with a wrong bit, two accesses at
 * once.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_integrity.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/rig.h"
#include "support/test.h"

enum { PERIOD_MS = 10 };

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static uint8_t count_flip; /* of FIFO_STATUS, on its way */
static double rises_ms;    /* INT1, when INT_SOURCE is read after this time */

void hal_host_drdy_handler(void);

static uint8_t on_rx(uint8_t reg, uint8_t byte)
{
    if (reg == ADXL345_INT_SOURCE && !hal_host_faults()->int1_high && hal_host_now_ms() > rises_ms) {
        hal_host_faults()->int1_high = true;
        hal_host_drdy_handler();
    }
    return reg == ADXL345_FIFO_STATUS ? byte ^ count_flip : byte;
}

void setUp(void)
{
    count_flip = 0;
    rises_ms = 1e9;
    rig_begin(1000.0 / PERIOD_MS, (hal_host_config_t){ .on_rx = on_rx });
    rig.limit_us = UINT32_MAX; /* each test says what it may be */
}

static void stream_for_ms(double ms)
{
    rig_stream_ms(&at_100_hz, ms);
    TEST_ASSERT_TRUE(rig.taken_count > 3);
}

/* Time is up for a transfer, and the line that was low is free again. */
static void transfer_without_end(void)
{
    adxl345_poll(hal_time_us()); /* DEVID is asked */
    hal_host_faults()->scl_low = true;
    uint32_t begun_us = hal_time_us();
    while (hal_time_us() - begun_us < 3500) {
        board_driver_sleep();
    }
    hal_host_faults()->scl_low = false;
    adxl345_poll(hal_time_us());
}

/* No line can be named. The first two are made again, the third is a fault. */
TEST(test_three_transfers_without_end_on_free_lines_are_a_fault_of_the_bus)
{
    for (unsigned times = 1; times <= 3; times++) {
        adxl345_counters_t before;
        adxl345_counters_t counters;
        setUp();
        adxl345_counters(&before);
        adxl345_start(&at_100_hz);
        for (unsigned i = 1; i <= times; i++) {
            transfer_without_end();
            TEST_ASSERT_EQUAL(i == 3 ? ADXL345_FAULT_BUS : ADXL345_FAULT_NONE, adxl345_fault());
        }
        adxl345_counters(&counters);
        TEST_ASSERT_EQUAL_UINT16(times, counters.timeouts - before.timeouts);
        TEST_ASSERT_EQUAL_UINT16(0, counters.bus_errors - before.bus_errors);
        rig_run_ms(60);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(6 * PERIOD_MS));
    }
}

/*
 * INT1 is silent, and the STOP of the burst by the clock does not get out: for a while, and until the next sample is
 * due, when the bus is taken over. No sample is lost.
 */
TEST(test_stop_holds_up_the_reading_by_the_clock)
{
    for (int comes_out = 0; comes_out <= 1; comes_out++) {
        adxl345_counters_t before;
        adxl345_counters_t counters;
        setUp();
        stream_for_ms(205);
        adxl345_counters(&before);
        hal_host_faults()->int1_cut = true;
        hal_host_faults()->stop_stuck = true;
        while (adxl345_fault() != ADXL345_FAULT_INT1_SILENT) {
            rig_pass();
        }
        TEST_ASSERT_TRUE(hal_i2c_stop_pending());
        size_t taken = rig.taken_count;
        rig_run_ms(2);
        TEST_ASSERT_TRUE(hal_i2c_stop_pending());
        if (comes_out) {
            hal_host_faults()->stop_stuck = false;
        }
        rig_run_ms(10 * PERIOD_MS);
        hal_host_faults()->stop_stuck = false;
        adxl345_counters(&counters);
        uint32_t came = (uint32_t)(rig.taken_count - taken);
        TEST_ASSERT_UINT32_WITHIN(1, 10, came);
        TEST_ASSERT_EQUAL_UINT16(comes_out ? 0 : came, counters.timeouts - before.timeouts);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(6 * PERIOD_MS));
    }
}

/* What is asked while samples are fetched after a change of settings waits for them; the last of it counts. */
TEST(test_commands_while_samples_are_fetched)
{
    for (int stops = 0; stops <= 1; stops++) {
        setUp();
        stream_for_ms(205);
        rig.leaves = true;
        rig_run_ms(12 * PERIOD_MS);
        adxl345_config_t other = { 1000, 4, false, 0 };
        adxl345_start(&other);
        rig_run_ms(1); /* standby is set, samples wait for main and, behind a full queue, in the sensor */
        TEST_ASSERT_TRUE(hal_host_sensor()->fifo_count >= 2);
        if (stops) {
            adxl345_stop();
        } else {
            adxl345_start(&at_100_hz);
        }
        rig.leaves = false;
        rig_run_ms(5 * PERIOD_MS);
        TEST_ASSERT_EQUAL(stops ? ADXL345_STOPPED : ADXL345_STREAMING, adxl345_phase());
        TEST_ASSERT_EQUAL_HEX8(stops ? 0x00 : 0x08, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
        TEST_ASSERT_EQUAL_HEX8(0x0B, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(6 * PERIOD_MS));
    }
}

/* A read that fails where its sample had no edge of its own: it is read again, with the time that follows the last. */
TEST(test_failed_read_of_a_sample_that_had_waited)
{
    for (unsigned skip = 0; skip < 5; skip++) { /* START, address, register, START, address: no data asked yet */
        setUp();
        stream_for_ms(205);
        rig.leaves = true;
        rig_run_ms(12 * PERIOD_MS); /* more than the queue holds: they wait in the sensor, with one edge for all */
        TEST_ASSERT_TRUE(hal_host_sensor()->fifo_count >= 3);
        rig.leaves = false;
        rig_take_all();
        adxl345_poll(hal_time_us());
        board_driver_sleep();
        while (hal_host_sensor()->fifo_count >= 3) {
            rig_pass();
        }
        hal_host_faults()->next_status = HAL_I2C_ARBITRATION_LOST;
        hal_host_faults()->status_skip = skip;
        rig_run_ms(20 * PERIOD_MS);
        TEST_ASSERT_EQUAL(-1, hal_host_faults()->next_status);
        TEST_ASSERT_TRUE_MESSAGE(rig.off_us < 1000u * PERIOD_MS, "a sample has the time of another one");
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(6 * PERIOD_MS));
    }
}

/* A bit of the count arrives wrong: samples that wait behind would put this one before the last, which cannot be. */
TEST(test_count_with_a_wrong_bit_moves_no_stamp)
{
    for (unsigned bit = 1; bit < 6; bit++) {
        setUp();
        stream_for_ms(205);
        count_flip = (uint8_t)(1u << bit);
        rig_run_ms(10 * PERIOD_MS);
        count_flip = 0;
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(6 * PERIOD_MS));
        TEST_ASSERT_TRUE_MESSAGE(rig.off_us < 100, "a stamp was moved");
    }
}

/* The sensor has none and is not waited for any more, but INT1 rises just then: one more look before it is a fault. */
TEST(test_int1_that_rises_while_the_sensor_says_it_has_none)
{
    double told_ms[2] = { 0.0 };
    for (int rises = 0; rises <= 1; rises++) {
        setUp();
        stream_for_ms(205);
        hal_host_sensor()->reg[ADXL345_POWER_CTL] = 0; /* it measures no more */
        rises_ms = rises ? told_ms[0] - 0.15 : 1e9;    /* during the last look */
        while (adxl345_fault() != ADXL345_FAULT_NO_DATA) {
            rig_pass();
        }
        told_ms[rises] = hal_host_now_ms();
        TEST_ASSERT_EQUAL(rises, hal_host_faults()->int1_high);
        rises_ms = 1e9;
        hal_host_faults()->int1_high = false;
        rig_run_ms(8 * PERIOD_MS);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    }
    TEST_ASSERT_TRUE(told_ms[0] > 230 && told_ms[0] < 240);
    TEST_ASSERT_TRUE_MESSAGE(told_ms[1] > told_ms[0] + 0.1 && told_ms[1] < told_ms[0] + 1, "not looked at");
}

/* The sensor goes while what it holds is fetched: each try fails, hundreds of them, and the stop comes all the same. */
TEST(test_stop_while_every_read_fails)
{
    stream_for_ms(205);
    rig.leaves = true;
    adxl345_stop();
    while ((hal_host_sensor()->reg[ADXL345_POWER_CTL] & ADXL345_POWER_MEASURE) != 0) {
        rig_pass();
    }
    adxl345_model_power(hal_host_sensor(), false);
    hal_host_faults()->int1_high = true;
    double begun_ms = hal_host_now_ms();
    unsigned tries = 0;
    while (adxl345_phase() != ADXL345_STOPPED) {
        uint32_t begun_us = adxl345_burst_begun_us();
        rig_pass();
        tries += adxl345_burst_begun_us() != begun_us;
        TEST_ASSERT_TRUE(hal_host_now_ms() - begun_ms < 110);
    }
    TEST_ASSERT_TRUE(tries > 300);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/* Main leaves them: seven of the eight slots fill one by one, in order, and what comes then waits in the sensor. */
TEST(test_the_queue_holds_seven_samples)
{
    enum { SLOTS = 8 };
    stream_for_ms(205);
    rig_until_pause();
    rig.leaves = true;
    size_t before = rig.latched_count;
    for (unsigned waiting = 1; waiting < SLOTS + 5; waiting++) {
        while (rig.latched_count < before + waiting && hal_host_now_ms() < 400) {
            rig_pass();
        }
        rig_run_ms(1);
        TEST_ASSERT_EQUAL_size_t(before + waiting, rig.latched_count);
        unsigned queued = waiting < SLOTS ? waiting : SLOTS - 1;
        TEST_ASSERT_EQUAL_UINT8(queued, adxl345_queued());
        TEST_ASSERT_EQUAL_UINT8(waiting - queued, hal_host_sensor()->fifo_count);
    }
    rig.leaves = false;
    rig_run_ms(PERIOD_MS);
    TEST_ASSERT_EQUAL_UINT8(0, adxl345_queued());
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(6 * PERIOD_MS));
}

/* Main's second access, and a read by the clock, before the first access has ended: refused; the first one counts. */
TEST(test_one_access_at_a_time)
{
    adxl345_burst_init();
    (void)adxl345_burst_take_bus(ADXL345_ADDRESS_LOW, false);
    TEST_ASSERT_TRUE(adxl345_burst_access(ADXL345_DEVID, 0, true));
    TEST_ASSERT_FALSE(adxl345_burst_access(ADXL345_BW_RATE, 0, true));
    adxl345_burst_read();
    TEST_ASSERT_FALSE(adxl345_burst_running());
    for (double end_ms = hal_host_now_ms() + 1.0; hal_host_now_ms() < end_ms;) {
        hal_sleep_until_wake();
    }
    TEST_ASSERT_EQUAL(I2C_BUS_OK, adxl345_burst_bus_state());
    TEST_ASSERT_EQUAL_HEX8(0xE5, adxl345_burst_register_value()); /* DEVID, p. 24 */
    adxl345_init();                                               /* as the end of each test finds it */
}

/* A line that was stuck and then flickers is open, not shorted: one good reading takes "stuck" back. */
TEST(test_a_stuck_int1_that_flickers_is_stuck_no_more)
{
    stream_for_ms(300);
    rig_until_pause();
    for (unsigned i = 0; i < LIMIT_EMPTY; i++) {
        adxl345_integrity_int1_lied();
    }
    TEST_ASSERT_TRUE(adxl345_integrity_int1_stuck());
    rig_edges(LIMIT_EDGES);
    TEST_ASSERT_TRUE(hal_drdy_flickers());
    rig_run_ms(25);
    TEST_ASSERT_FALSE(adxl345_integrity_int1_stuck());
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_FLICKERS, adxl345_fault());
    rig.limit_us = 20000; /* by the clock */
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(300));
}

/* After a stop an edge begins nothing; one that came then is not the time of the first sample of the next start. */
TEST(test_an_edge_while_stopped_is_nobodys)
{
    stream_for_ms(300);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(50));
    hal_host_faults()->int1_high = true;
    hal_host_drdy_handler();
    TEST_ASSERT_FALSE(adxl345_burst_running());
    hal_host_faults()->int1_high = false;
    rig_run_ms(200);
    hal_host_faults()->int1_cut = true; /* the first sample is read by the clock, with others that give its age */
    rig.limit_us = 10000 / 2 + 1000;
    size_t before = rig.taken_count;
    adxl345_start(&at_100_hz);
    rig_until_taken(before + 1);
}
