/* The driver's time: how often it tries again, how long a burst may hang, stops and starts while it awaits the bus. */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_time.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/rig.h"
#include "support/test.h"

enum { PROBES_MAX = 64 };

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static double probed_ms[PROBES_MAX];
static size_t probes;

static uint32_t edge_us;
static bool sample_comes_while_clearing;

void hal_host_drdy_handler(void);
void hal_host_i2c_handler(void);

/* Interrupts are on while the bus is being cleared: a sample is latched, INT1 rises and its interrupt is served. */
static void on_bus_clear(void)
{
    static const int16_t lsb[3] = { 3999, 0, 0 };
    if (sample_comes_while_clearing) {
        sample_comes_while_clearing = false;
        edge_us = hal_time_us();
        (void)adxl345_model_tick(hal_host_sensor(), lsb);
    }
}

/* One poll and sleep; notes when the driver leaves its back-off for another try. */
static void pass(void)
{
    adxl345_phase_t before = adxl345_phase();
    adxl345_poll(hal_time_us());
    if (before == ADXL345_FAULTY && adxl345_phase() == ADXL345_STARTING && probes < PROBES_MAX) {
        probed_ms[probes++] = hal_host_now_ms();
    }
    rig_take_all();
    board_driver_sleep();
}

void setUp(void)
{
    probes = 0;
    sample_comes_while_clearing = false;
    rig_begin(100.0, (hal_host_config_t){ .on_bus_clear = on_bus_clear });
    rig.pass = pass;
}

/* Runs until the condition holds; fails after so many virtual milliseconds. */
#define RUN_UNTIL(condition, limit_ms)                                                       \
    do {                                                                                     \
        double end_ms = hal_host_now_ms() + (limit_ms);                                      \
        while (!(condition)) {                                                               \
            TEST_ASSERT_TRUE_MESSAGE(hal_host_now_ms() < end_ms, "never came: " #condition); \
            pass();                                                                          \
        }                                                                                    \
    } while (0)

/* Back-off 5, 10, 20, then 25 ms for ever: the alarm wakes main for it, whose passes take 20 us here. */
TEST(test_tries_again_at_a_pause_that_doubles_to_25_ms)
{
    static const double back_off_ms[] = {
        LIMIT_BACK_OFF_MIN_MS, 10, 20, LIMIT_BACK_OFF_MAX_MS, LIMIT_BACK_OFF_MAX_MS, LIMIT_BACK_OFF_MAX_MS,
        LIMIT_BACK_OFF_MAX_MS
    };
    hal_host_sensor()->powered = false;
    adxl345_start(&at_100_hz);
    double failed_ms = 0.0;
    for (size_t i = 0; i < 7; i++) {
        RUN_UNTIL(adxl345_phase() == ADXL345_FAULTY, 50);
        failed_ms = hal_host_now_ms();
        RUN_UNTIL(probes == i + 1, 50);
        double pause_ms = probed_ms[i] - failed_ms;
        TEST_ASSERT_TRUE(pause_ms >= back_off_ms[i] - 0.05);
        TEST_ASSERT_TRUE(pause_ms <= back_off_ms[i] + 0.1);
    }
}

/* A good sample brings the pace back to 5 ms. */
TEST(test_a_good_sample_resets_the_pace)
{
    adxl345_model_power(hal_host_sensor(), false);
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    adxl345_model_power(hal_host_sensor(), true);
    RUN_UNTIL(adxl345_phase() == ADXL345_STREAMING, 200);
    rig_run_ms(100);
    adxl345_model_power(hal_host_sensor(), false);
    RUN_UNTIL(adxl345_phase() == ADXL345_FAULTY, 100);
    double failed_ms = hal_host_now_ms();
    probes = 0;
    RUN_UNTIL(probes == 1, 50);
    TEST_ASSERT_TRUE(probed_ms[0] - failed_ms <= LIMIT_BACK_OFF_MIN_MS + 0.1);
}

/* A burst that hangs is given up 3 ms after it began, and read again at once; each is seen up to 20 us late. */
TEST(test_a_hung_burst_is_given_up)
{
    adxl345_counters_t before;
    adxl345_counters_t after;
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    adxl345_counters(&before);
    RUN_UNTIL(!hal_drdy_high() && !adxl345_burst_running(), 50);
    rig_run_ms(2); /* the last STOP is out */
    hal_host_faults()->hang_clocks = 9;
    rig_until_burst();
    double begun_ms = hal_host_now_ms();
    RUN_UNTIL(!adxl345_burst_running(), 12);
    double took_ms = hal_host_now_ms() - begun_ms;
    TEST_ASSERT_TRUE(took_ms >= 3.0 - 0.02 && took_ms <= 3.0 + 0.02);
    adxl345_counters(&after);
    TEST_ASSERT_EQUAL_UINT16(before.timeouts + 1, after.timeouts);
    TEST_ASSERT_EQUAL_UINT16(before.bus_errors, after.bus_errors);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(50));
}

/* Three failed bursts in a row are a fault of the bus; the first two are read again without a word. */
TEST(test_three_failed_bursts_are_a_fault)
{
    adxl345_counters_t counters;
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    RUN_UNTIL(!hal_drdy_high() && !adxl345_burst_running(), 20);
    adxl345_counters(&counters);
    uint16_t errors_before = counters.bus_errors;
    for (unsigned failed = 1; failed <= LIMIT_TRIES; failed++) {
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        hal_host_faults()->next_status = HAL_I2C_BUS_ERROR;
        hal_host_faults()->status_skip = 0;
        double end_ms = hal_host_now_ms() + 20;
        while (hal_host_faults()->next_status >= 0 && hal_host_now_ms() < end_ms) {
            pass();
        }
        adxl345_poll(hal_time_us());
        TEST_ASSERT_EQUAL_UINT8(failed, adxl345_burst_failures());
    }
    rig_run_ms(0.1);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_BUS, adxl345_fault());
    adxl345_counters(&counters);
    TEST_ASSERT_EQUAL_UINT16(errors_before + LIMIT_TRIES, counters.bus_errors);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/*
 * A sensor that never has a sample: the first may come 20 ms late, by which the turn-on time is over at 1.1 ms and a
 * period (data sheet p. 5), and is a fault three periods and 3 ms after that. It is asked every half millisecond to the
 * end.
 */
TEST(test_a_first_sample_that_does_not_come_is_a_fault)
{
    static const uint16_t rates_dhz[] = { 8000, 4000, 2000, 1000, 500, 250, 125 };
    for (size_t i = 0; i < 7; i++) {
        adxl345_config_t config = { rates_dhz[i], 16, false, 0 };
        double period_ms = 10000.0 / rates_dhz[i];
        const hal_host_config_t without_samples = { 0 };
        hal_host_begin(&without_samples, NULL, false);
        rig_reset();
        adxl345_start(&config);
        RUN_UNTIL(hal_host_sensor()->reg[ADXL345_POWER_CTL] == ADXL345_POWER_MEASURE, 20);
        double begun_ms = hal_host_now_ms();
        RUN_UNTIL(adxl345_fault() != ADXL345_FAULT_NONE, 300);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_DATA, adxl345_fault());
        double took_ms = hal_host_now_ms() - begun_ms;
        double due_ms = 20.0 + 3.0 * period_ms + 3.0;
        TEST_ASSERT_TRUE(took_ms >= due_ms && took_ms <= due_ms + 1.5);
    }
}

/*
 * A stop that does not reach the sensor is tried again for a second, 40 times 25 ms apart and the time of the
 * transfers, under a millisecond each; then no more.
 */
TEST(test_a_stop_is_tried_again_for_a_second)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    adxl345_model_power(hal_host_sensor(), false);
    adxl345_stop();
    unsigned tries = 0;
    double begun_ms = hal_host_now_ms();
    double last_ms = begun_ms;
    adxl345_counters_t counters;
    adxl345_counters(&counters);
    for (uint16_t before = counters.nacks; hal_host_now_ms() < begun_ms + 1500.0; before = counters.nacks) {
        pass();
        adxl345_counters(&counters);
        bool is_try = counters.nacks != before && hal_host_now_ms() - last_ms > 20.0;
        tries += is_try;
        last_ms = counters.nacks != before ? hal_host_now_ms() : last_ms;
    }
    TEST_ASSERT_EQUAL_UINT(LIMIT_RESTS, tries);
    TEST_ASSERT_TRUE(last_ms - begun_ms >= 1000.0 && last_ms - begun_ms <= 1000.0 + 41 * 1.0);
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
}

/* INT1 comes back while the sensor is being asked why it is silent: no fault, and what its FIFO holds is delivered. */
TEST(test_int1_that_rises_while_the_sensor_is_asked_is_no_fault)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    rig_until_asked();
    hal_host_faults()->int1_cut = false;
    TEST_ASSERT_TRUE(hal_drdy_high());
    rig.limit_us = 4000; /* the edge comes as late as the sensor is asked */
    hal_host_drdy_handler();
    for (int i = 0; i < 500; i++) {
        pass();
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(50));
}

TEST(test_stop_with_a_stuck_bus_stops)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    hal_host_faults()->sda_low = true;
    adxl345_stop();
    TEST_ASSERT_EQUAL(ADXL345_QUIESCING, adxl345_phase());
    RUN_UNTIL(adxl345_phase() == ADXL345_STOPPED, 20);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    hal_host_faults()->sda_low = false;
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
}

/* The last word counts, whatever comes while the sensor is being put to rest. */
TEST(test_start_and_stop_while_quiescing)
{
    static const adxl345_config_t at_400_hz = { 4000, 16, false, 0 };
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    adxl345_stop();
    adxl345_start(&at_400_hz);
    TEST_ASSERT_EQUAL(ADXL345_QUIESCING, adxl345_phase());
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0x0C, hal_host_sensor()->reg[ADXL345_BW_RATE]);
    adxl345_start(&at_100_hz);
    adxl345_stop();
    adxl345_stop();
    rig_run_ms(50);
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0x00, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
    TEST_ASSERT_EQUAL_size_t(rig.latched_count, rig.taken_count);
}

/* Main takes nothing while the driver drains: it gives up after 100 ms instead of waiting for ever. */
TEST(test_drain_that_nobody_empties_ends)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    adxl345_stop();
    double begun_ms = hal_host_now_ms();
    double end_ms = begun_ms + 150;
    adxl345_poll(hal_time_us());
    adxl345_model_tick(hal_host_sensor(), rig.stream.rows[0].lsb);
    while (adxl345_phase() != ADXL345_STOPPED && hal_host_now_ms() < end_ms) {
        board_driver_sleep();
        adxl345_poll(hal_time_us());
    }
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    double took_ms = hal_host_now_ms() - begun_ms;
    TEST_ASSERT_TRUE(took_ms >= 100.0 && took_ms <= 101.0);
}

/* The interrupt of a transfer that was given up: it must neither deliver nor disturb what follows. */
TEST(test_a_stale_bus_event_is_ignored)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    RUN_UNTIL(!adxl345_burst_running() && !hal_drdy_high(), 20);
    adxl345_burst_take_bus(0x53, false);
    TEST_ASSERT_EQUAL(I2C_BUS_OK, adxl345_burst_bus_state());
    hal_host_i2c_handler();
    TEST_ASSERT_EQUAL(I2C_BUS_OK, adxl345_burst_bus_state());
    TEST_ASSERT_EQUAL_UINT8(0, adxl345_queued());
    rig_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(50));
}

/*
 * An edge that comes while the pins are toggled by hand must not put a START on them; its sample is read afterwards,
 * with the time of the edge.
 */
TEST(test_an_edge_while_the_bus_is_cleared_starts_no_transfer)
{
    const adxl345_sample_t *sample;
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    RUN_UNTIL(!adxl345_burst_running() && !hal_drdy_high(), 20);
    rig_run_ms(2); /* the last STOP is out */
    sample_comes_while_clearing = true;
    adxl345_burst_take_bus(0x53, false);
    TEST_ASSERT_TRUE(hal_drdy_high());
    TEST_ASSERT_FALSE(adxl345_burst_running());
    TEST_ASSERT_EQUAL(I2C_BUS_OK, adxl345_burst_bus_state());
    TEST_ASSERT_EQUAL_UINT8(0, adxl345_burst_failures());
    board_driver_sleep();
    TEST_ASSERT_TRUE(hal_time_us() > edge_us);
    double end_ms = hal_host_now_ms() + 1.0;
    while ((sample = adxl345_take()) == NULL && hal_host_now_ms() < end_ms) {
        adxl345_poll(hal_time_us());
        board_driver_sleep();
    }
    TEST_ASSERT_NOT_NULL(sample);
    TEST_ASSERT_EQUAL_INT16(3999, sample->lsb[0]);
    TEST_ASSERT_EQUAL_UINT32(edge_us, sample->t_us);
}

/* A sensor that still runs from before gives edges while it is being configured: they are not for this driver. */
TEST(test_edges_before_streaming_are_ignored)
{
    adxl345_model_start(hal_host_sensor(), 0x53 << 1);
    adxl345_model_write(hal_host_sensor(), ADXL345_BW_RATE);
    adxl345_model_write(hal_host_sensor(), 0x0D);
    adxl345_model_write(hal_host_sensor(), ADXL345_POWER_MEASURE);
    adxl345_model_write(hal_host_sensor(), ADXL345_INT_DATA_READY);
    adxl345_model_stop(hal_host_sensor());
    TEST_ASSERT_TRUE(adxl345_model_tick(hal_host_sensor(), rig.stream.rows[7].lsb));
    TEST_ASSERT_TRUE(hal_drdy_high());
    rig_run_ms(5);
    TEST_ASSERT_EQUAL_UINT8(0, adxl345_queued());
    TEST_ASSERT_FALSE(adxl345_burst_running());
    rig.latched_count = 0;
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(50));
}

/* 25 ms a try and two addresses: 65,535 failed accesses in a quarter of an hour. Counters stop there. */
TEST(test_counters_saturate)
{
    adxl345_counters_t counters;
    adxl345_model_power(hal_host_sensor(), false);
    adxl345_start(&at_100_hz);
    rig_run_ms(1200e3);
    adxl345_counters(&counters);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, counters.nacks);
    rig_run_ms(100);
    adxl345_counters(&counters);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, counters.nacks);
}
