/*
 * The driver where something is cut in its middle: a burst inside its data, the wires, the answer of a sensor that
 * loses its supply, a recovery by a stop. No sample comes out wrong or with the time of another, no fault by a wrong
 * name.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_driver.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_time.h"
#include "support/board.h"
#include "support/rig.h"
#include "support/test.h"

/* START, address, register, repeated START, address, INT_SOURCE, DATA_FORMAT, six of data, FIFO_CTL, FIFO_STATUS. */
enum { FIRST_DATA_EVENT = 7, EVENTS_PER_BURST = 15 };

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static const adxl345_config_t at_800_hz = { 8000, 16, false, 0 };

void hal_host_drdy_handler(void);

static void begin(double rate_hz)
{
    rig_begin(rate_hz, (hal_host_config_t){ .time_start_us = 0xFFFFFFFFu - 300000u });
}

void setUp(void)
{
    begin(100.0);
}

static void disturb(unsigned event, uint8_t status)
{
    hal_host_faults()->status_skip = event;
    hal_host_faults()->next_status = status;
}

/*
 * Every status that the bus can give, at every event of a burst where it is not the right one: a transfer that took it
 * would read another register, or more bytes than there is room for. Before the data nothing is lost, inside one
 * sample.
 */
TEST(test_no_status_at_any_event_makes_a_wrong_sample)
{
    static const uint8_t right[EVENTS_PER_BURST] = { 0x08, 0x18, 0x28, 0x10, 0x40, 0x50, 0x50, 0x50,
                                                     0x50, 0x50, 0x50, 0x50, 0x50, 0x50, 0x58 };
    static const uint8_t statuses[] = { 0x00, 0x08, 0x10, 0x18, 0x20, 0x28, 0x30, 0x38, 0x40, 0x48, 0x50, 0x58, 0xF8 };
    for (unsigned s = 0; s < sizeof statuses; s++) {
        for (unsigned event = 0; event < EVENTS_PER_BURST; event++) {
            if (statuses[s] == right[event]) {
                continue;
            }
            begin(100.0);
            adxl345_start(&at_100_hz);
            rig_run_ms(100);
            rig_until_pause();
            disturb(event, statuses[s]);
            rig_run_ms(25);
            TEST_ASSERT_EQUAL(-1, hal_host_faults()->next_status);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
            /* in its first data byte the sensor has not been read yet, here; a real one may have been */
            TEST_ASSERT_EQUAL_size_t(event > FIRST_DATA_EVENT ? 1 : 0, rig_lost(60));
        }
    }
}

/*
 * Main was late and the FIFO holds several samples when a burst is cut: inside its data the oldest is gone, and the
 * others keep their own times.
 */
static void cut_with_more_in_the_fifo(const adxl345_config_t *config, unsigned waiting, unsigned event)
{
    double period_ms = 10000.0 / config->rate_dhz;
    begin(config->rate_dhz / 10.0);
    adxl345_start(config);
    rig_run_ms(100);
    rig_until_pause();
    /* the edge's burst is refused at its address, which leaves the stamp; main does not look until `waiting` wait */
    disturb(1, HAL_I2C_WRITE_ADDRESS_NACK);
    for (size_t end = rig.latched_count + waiting; rig.latched_count < end;) {
        board_driver_sleep();
    }
    double end_ms = hal_host_now_ms() + period_ms / 4.0;
    disturb(event, HAL_I2C_BUS_ERROR);
    while (hal_host_now_ms() < end_ms) {
        rig_pass();
    }
    TEST_ASSERT_EQUAL(-1, hal_host_faults()->next_status);
    rig_run_ms(10.0 * period_ms);
    TEST_ASSERT_EQUAL_size_t(event > FIRST_DATA_EVENT ? 1 : 0, rig_lost(60));
}

TEST(test_what_follows_a_sample_that_was_cut_has_its_own_time)
{
    for (unsigned waiting = 1; waiting < 6; waiting++) {
        for (unsigned event = 0; event < EVENTS_PER_BURST; event++) {
            cut_with_more_in_the_fifo(&at_100_hz, waiting, event);
        }
    }
}

/* A burst that hangs is given up after 3 ms: at 800 Hz other samples wait by then. */
TEST(test_what_follows_a_burst_that_hung_has_its_own_time)
{
    unsigned inside = 0;
    for (unsigned phase = 0; phase < 24; phase++) {
        begin(800.0);
        adxl345_start(&at_800_hz);
        rig_run_ms(100.0 + phase * 0.5);
        rig_until_pause();
        rig_until_burst();
        rig_away(phase); /* a burst takes 300 us */
        bool cut = adxl345_burst_bus_state() == I2C_BUS_BUSY;
        inside += cut;
        hal_host_faults()->hang_clocks = 9;
        while (adxl345_burst_running()) {
            rig_pass();
        }
        rig_run_ms(30);
        TEST_ASSERT_TRUE(rig_lost(60) <= (cut ? 1u : 0u));
    }
    TEST_ASSERT_TRUE(inside > 12 && inside < 24);
}

/* Stops at every 0.2 ms of the way back from a fault: what is stopped has no fault. */
TEST(test_stop_at_any_moment_of_a_recovery_leaves_no_fault)
{
    unsigned quiesced = 0;
    for (unsigned phase = 0; phase < 400; phase++) {
        begin(100.0);
        adxl345_start(&at_100_hz);
        rig_run_ms(100);
        adxl345_model_power(hal_host_sensor(), false);
        rig_run_ms(100);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
        adxl345_model_power(hal_host_sensor(), true);
        rig_run_ms(phase * 0.2);
        bool recovering = adxl345_fault() != ADXL345_FAULT_NONE;
        adxl345_stop();
        quiesced += recovering && adxl345_phase() == ADXL345_QUIESCING;
        hal_host_faults()->sda_low = (phase & 1u) != 0; /* ends by the deadline of a transfer, else by the drain */
        rig_run_ms(60);
        TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
    TEST_ASSERT_TRUE_MESSAGE(quiesced > 20, "no stop came while the first sample was awaited");
}

/* SDA or SCL comes off while the supply stays and INT1 is high: nobody answers, which is not a disturbed bus. */
TEST(test_wires_off_with_int1_high_are_a_missing_sensor)
{
    for (unsigned phase = 0; phase < 4; phase++) {
        begin(100.0);
        adxl345_start(&at_100_hz);
        rig_run_ms(300);
        rig_until_pause();
        hal_host_sensor()->address = 0x2A;
        for (double end_ms = hal_host_now_ms() + 100.0; hal_host_now_ms() < end_ms;) {
            rig_pass();
            adxl345_fault_t fault = adxl345_fault();
            TEST_ASSERT_TRUE(fault == ADXL345_FAULT_NONE || fault == ADXL345_FAULT_NO_SENSOR);
            rig_away(phase); /* a late main: the bus is free again when it looks */
        }
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
        hal_host_sensor()->address = 0x53;
        rig_run_ms(100);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
}

/*
 * Two bursts were refused at their address and a third is, and is judged as a poll does it; then INT1, which flaps,
 * begins another one before the poll looks at what the third was.
 */
static void until_a_burst_behind_the_last_refused_one(void)
{
    begin(100.0);
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    rig_until_pause();
    hal_host_sensor()->address = 0x2A;
    while (adxl345_burst_failures() < 2) {
        adxl345_poll(hal_time_us());
        rig_away(1);
    }
    rig_until_burst();
    while (adxl345_burst_bus_state() == I2C_BUS_BUSY) {
        rig_away(1);
    }
    rig_away(1); /* its STOP is out */
    TEST_ASSERT_EQUAL(READING_FAILED, adxl345_burst_judge());
    TEST_ASSERT_EQUAL_UINT8(3, adxl345_burst_failures());
    hal_host_drdy_handler();
    TEST_ASSERT_EQUAL(I2C_BUS_BUSY, adxl345_burst_bus_state());
}

TEST(test_a_burst_behind_the_last_refused_one_does_not_hide_it)
{
    adxl345_counters_t before;
    adxl345_counters_t after;
    adxl345_counters(&before);
    until_a_burst_behind_the_last_refused_one();
    while (adxl345_fault() == ADXL345_FAULT_NONE) {
        adxl345_poll(hal_time_us());
        rig_away(1);
    }
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
    adxl345_counters(&after);
    /* the first two, the verdict on the third was this test's; three at each address */
    TEST_ASSERT_EQUAL_UINT16(before.nacks + 2 + 6, after.nacks);
    TEST_ASSERT_EQUAL_UINT16(before.bus_errors, after.bus_errors);
    hal_host_sensor()->address = 0x53;
    rig.limit_us = 1000; /* the edge was not that of the sample */
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/* INT1 is cut, and a burst that asks the sensor all the same has just been put on the bus. */
static void until_the_sensor_is_asked(void)
{
    begin(100.0);
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    rig_until_pause();
    rig_until_asked();
}

/* The supply fails before or inside the answer: what is read are ones, and no sign that data are ready. */
TEST(test_a_sensor_lost_while_it_is_asked_has_no_data)
{
    unsigned cut = 0;
    for (unsigned phase = 0; phase < 20; phase++) {
        until_the_sensor_is_asked();
        rig_away(phase);
        bool inside = adxl345_burst_bus_state() == I2C_BUS_BUSY;
        cut += inside;
        adxl345_model_power(hal_host_sensor(), false);
        while (adxl345_fault() == ADXL345_FAULT_NONE) {
            rig_pass();
        }
        TEST_ASSERT_EQUAL(!inside, adxl345_fault() == ADXL345_FAULT_INT1_SILENT);
    }
    TEST_ASSERT_TRUE(cut >= 4 && cut < 20);
}

/* INT1 comes back while the sensor is asked, and a stop or another rate with it: first what the FIFO holds. */
TEST(test_stop_and_start_while_the_sensor_is_asked_deliver_first)
{
    for (unsigned phase = 0; phase < 8; phase++) {
        until_the_sensor_is_asked();
        rig_away(phase);
        hal_host_faults()->int1_cut = false;
        TEST_ASSERT_TRUE(hal_drdy_high());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
        TEST_ASSERT_EQUAL_HEX8(0x00, hal_host_sensor()->reg[ADXL345_POWER_CTL]);

        static const adxl345_config_t at_50_hz = { 500, 16, false, 0 };
        until_the_sensor_is_asked();
        rig_away(phase);
        hal_host_faults()->int1_cut = false;
        adxl345_start(&at_50_hz);
        TEST_ASSERT_EQUAL(ADXL345_QUIESCING, adxl345_phase());
        rig_run_ms(200);
        TEST_ASSERT_EQUAL_HEX8(0x09, hal_host_sensor()->reg[ADXL345_BW_RATE]);
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    }
}

enum { NEIGHBOUR_ID = 0x42 };
static uint8_t neighbour; /* address of a device that is no ADXL345 */
static bool sensor_away;

/* The bus is taken before each look for the sensor: whoever is at that address answers it. */
static void whoever_is_there(void)
{
    bool away = sensor_away && adxl345_driver_state()->address != neighbour;
    hal_host_sensor()->address = away ? 0x2A : adxl345_driver_state()->address;
}

static uint8_t neighbour_id(uint8_t reg, uint8_t byte)
{
    return adxl345_driver_state()->address == neighbour && reg == ADXL345_DEVID ? NEIGHBOUR_ID : byte;
}

/* Another device answers at the other address, always: the sensor is found, lost, and found again. */
TEST(test_a_neighbour_does_not_keep_the_sensor_out)
{
    static const uint8_t addresses[] = { ADXL345_ADDRESS_LOW, ADXL345_ADDRESS_HIGH };
    for (size_t i = 0; i < 2; i++) {
        neighbour = addresses[1 - i];
        rig_begin(100.0, (hal_host_config_t){ .on_rx = neighbour_id, .on_bus_clear = whoever_is_there });
        adxl345_start(&at_100_hz);
        for (unsigned times = 0; times < 3; times++) {
            sensor_away = false;
            rig_run_ms(100);
            TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
            TEST_ASSERT_EQUAL_HEX8(addresses[i], adxl345_address());
            sensor_away = true;
            hal_host_sensor()->address = 0x2A;
            rig_run_ms(100);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_WRONG_ID, adxl345_fault());
            TEST_ASSERT_EQUAL_HEX8(neighbour, adxl345_foreign_address());
            TEST_ASSERT_EQUAL_HEX8(NEIGHBOUR_ID, adxl345_foreign_id());
        }
    }
}
