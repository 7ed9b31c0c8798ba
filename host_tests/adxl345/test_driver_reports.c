/*
 * What the driver reports of itself and does to the bus: phases, marks and counters one by one, what is written
 * and read when the sensor is configured, what a loss of the sensor leaves known.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
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

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static const adxl345_config_t at_400_hz = { 4000, 16, false, 0 };
static unsigned bytes_read;

void hal_host_drdy_handler(void);

static uint8_t on_rx(uint8_t reg, uint8_t byte)
{
    (void)reg;
    bytes_read++;
    return byte;
}

static void begin(double rate_hz, double ppm)
{
    rig_begin(rate_hz, (hal_host_config_t){ .ppm = ppm, .on_rx = on_rx });
    bytes_read = 0;
}

void setUp(void)
{
    begin(100.0, 0.0);
}

static void stream_for_ms(double ms)
{
    rig_stream_ms(&at_100_hz, ms);
    rig_until_pause();
}

static adxl345_counters_t counters(void)
{
    adxl345_counters_t now;
    adxl345_counters(&now);
    return now;
}

/*
 * DEVID is read, 11 registers are written, the last 8 read back: 9 bytes come, and none is written while it measures.
 */
TEST(test_what_the_bus_carries_to_configure)
{
    adxl345_start(&at_100_hz);
    for (unsigned passes = 0; hal_host_sensor()->reg[ADXL345_INT_ENABLE] == 0 && passes < 1000; passes++) {
        rig_pass();
    }
    TEST_ASSERT_EQUAL_HEX8(ADXL345_INT_DATA_READY, hal_host_sensor()->reg[ADXL345_INT_ENABLE]); /* the last one */
    TEST_ASSERT_EQUAL_HEX8(0, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
    rig_run_ms(5);
    TEST_ASSERT_EQUAL_HEX8(ADXL345_POWER_MEASURE, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
    TEST_ASSERT_EQUAL_UINT(1 + 8, bytes_read);
    rig_run_ms(200);
    hal_host_reset_mcu(1); /* the sensor measures on */
    rig_reset();
    adxl345_start(&at_400_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_sensor()->writes_while_measuring);
}

/* Other offsets and interrupts that another program left do not stay. */
TEST(test_what_another_program_left_is_cleared)
{
    static const uint8_t cleared[] = { 0x1E, 0x1F, 0x20, 0x2F }; /* OFSX, OFSY, OFSZ, INT_MAP (data sheet p. 23) */
    for (size_t i = 0; i < sizeof cleared; i++) {
        hal_host_sensor()->reg[cleared[i]] = 0xFF;
    }
    stream_for_ms(100);
    for (size_t i = 0; i < sizeof cleared; i++) {
        TEST_ASSERT_EQUAL_HEX8(0, hal_host_sensor()->reg[cleared[i]]);
    }
}

/* From the end of the old configuration to the first sample of the new one, 11.1 ms and more, it is starting. */
TEST(test_starting_ends_with_the_first_sample)
{
    stream_for_ms(300);
    TEST_ASSERT_FALSE(adxl345_interrupted());
    adxl345_start(&at_100_hz);
    TEST_ASSERT_EQUAL(ADXL345_QUIESCING, adxl345_phase());
    rig_run_ms(5);
    size_t before = rig.taken_count;
    unsigned passes = 0;
    for (; rig.taken_count == before && passes < 1000; passes++) {
        TEST_ASSERT_EQUAL(ADXL345_STARTING, adxl345_phase());
        rig_pass();
    }
    TEST_ASSERT_TRUE(passes > 0 && passes < 1000);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
}

/* Interrupted by a fault, until a sample comes; what was stopped is not, and begins again without a restart. */
TEST(test_interrupted_is_what_failed)
{
    stream_for_ms(300);
    adxl345_model_power(hal_host_sensor(), false);
    rig_run_ms(60);
    TEST_ASSERT_TRUE(adxl345_interrupted());
    adxl345_model_power(hal_host_sensor(), true);
    rig_run_ms(60);
    TEST_ASSERT_FALSE(adxl345_interrupted());
    uint16_t restarts = counters().restarts;
    adxl345_model_power(hal_host_sensor(), false);
    rig_run_ms(60);
    TEST_ASSERT_EQUAL_size_t(0, rig.latched_count - rig.taken_count);
    adxl345_stop();
    rig_run_ms(60);
    TEST_ASSERT_FALSE(adxl345_interrupted());
    adxl345_model_power(hal_host_sensor(), true);
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_UINT16(restarts, counters().restarts);
}

/* The measured period holds for the same sensor, found again; a start begins with the nominal one. */
TEST(test_the_measured_period_survives_a_fault)
{
    begin(100.0, 30000.0); /* 3 % fast: 9,709 us */
    stream_for_ms(300);
    TEST_ASSERT_UINT32_WITHIN(1, 9709, adxl345_period_us());
    adxl345_model_power(hal_host_sensor(), false);
    rig_run_ms(100);
    adxl345_model_power(hal_host_sensor(), true);
    rig_run_ms(60);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_UINT32_WITHIN(1, 9709, adxl345_period_us());
    TEST_ASSERT_UINT32_WITHIN(1, 10300, adxl345_rate_chz());
    adxl345_start(&at_100_hz);
    rig_run_ms(5);
    TEST_ASSERT_EQUAL_UINT32(10000, adxl345_period_us());
    TEST_ASSERT_EQUAL_UINT32(0, adxl345_rate_chz());
}

/*
 * By its edge a sample is not drained; each that is found in the FIFO without an edge of its own is, and no other, but
 * for one that comes while the clock looks for it: the times of those before it are half a period off at most.
 */
TEST(test_drained_samples_are_counted_one_by_one)
{
    for (unsigned held = 3; held <= 10; held++) {
        setUp();
        rig.limit_us = 6000;
        stream_for_ms(300);
        uint16_t before = counters().samples_drained;
        rig_run_ms(100);
        TEST_ASSERT_EQUAL_UINT16(before, counters().samples_drained);
        hal_host_faults()->int1_cut = true;
        for (unsigned left = 20000; hal_host_sensor()->fifo_count < held && left != 0; left--) {
            rig_away(1);
        }
        rig_away(100); /* 2 ms: all are read before the next one comes */
        hal_host_faults()->int1_cut = false;
        hal_host_drdy_handler(); /* the edge is not the sample's */
        rig_run_ms(30);
        uint16_t drained = (uint16_t)(counters().samples_drained - before);
        TEST_ASSERT_TRUE(drained == held || drained == held + 1);
    }
}

static uint8_t torn_left;

/* FIFO_CTL loses a bit in so many readings. */
static uint8_t on_rx_torn(uint8_t reg, uint8_t byte)
{
    bool tear = reg == ADXL345_FIFO_CTL && torn_left != 0;
    torn_left = (uint8_t)(torn_left - tear);
    return tear ? (uint8_t)(byte ^ 1u) : byte;
}

/* The next event of the bus has this status; so many times, with good samples in between. */
static void fail_bursts(uint8_t status, unsigned times)
{
    for (; times != 0; times--) {
        hal_host_faults()->next_status = status;
        hal_host_faults()->status_skip = 0;
        rig_run_ms(50);
        TEST_ASSERT_TRUE(hal_host_faults()->next_status < 0);
    }
}

/* INT1 flickers so many times, and is believed again each time. */
static void storms(unsigned times)
{
    for (; times != 0; times--) {
        rig_edges(LIMIT_EDGES);
        TEST_ASSERT_TRUE(hal_drdy_flickers());
        rig_run_ms(400);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    }
}

/* What each counter counts, each a different number of times. */
static void count_everything(void)
{
    rig_begin(100.0, (hal_host_config_t){ .on_rx = on_rx_torn });
    rig.limit_us = UINT32_MAX;
    for (size_t i = 20; i < 40; i++) {
        rig.stream.rows[i].lsb[0] = 20;
    }
    stream_for_ms(600); /* the tenth to the twentieth of twenty equal ones are stuck: 11 */
    fail_bursts(HAL_I2C_ARBITRATION_LOST, 4);
    fail_bursts(HAL_I2C_BUS_ERROR, 5);
    for (unsigned times = 0; times < 6; times++) {
        rig_until_pause();
        hal_host_faults()->hang_clocks = 9;
        rig_run_ms(50);
    }
    torn_left = 2;
    rig_run_ms(100);
    rig_away(40000); /* 800 ms: the FIFO fills up */
    rig_run_ms(100);
    for (unsigned times = 0; times < 3; times++) {
        adxl345_model_power(hal_host_sensor(), false);
        rig_run_ms(60);
        adxl345_model_power(hal_host_sensor(), true);
        rig_run_ms(100);
    }
    storms(8);
    hal_host_faults()->int1_high = true;
    rig_run_ms(500);
}

/* Each counter has its place, the driver's first, then those of the readings: the eleven differ and none is 0. */
TEST(test_counters_by_their_places)
{
    count_everything();
    adxl345_readings_t readings;
    adxl345_readings(&readings);
    const adxl345_counters_t own = counters();
    const uint16_t expected[] = { own.samples_drained,   own.samples_stuck, own.restarts,   own.nacks,
                                  own.arbitrations_lost, own.bus_errors,    own.timeouts,   readings.failed,
                                  readings.empty,        readings.overruns, readings.storms };
    TEST_ASSERT_TRUE(own.samples_stuck == 11 && own.arbitrations_lost == 4 && own.bus_errors == 5);
    TEST_ASSERT_TRUE(own.timeouts == 6 && own.restarts == 3 && readings.failed == 2 && readings.storms == 8);
    for (uint8_t at = 0; at < sizeof expected / sizeof expected[0]; at++) {
        TEST_ASSERT_NOT_EQUAL_UINT16(0, expected[at]);
        for (uint8_t other = 0; other < at; other++) {
            TEST_ASSERT_NOT_EQUAL_UINT16(expected[other], expected[at]);
        }
        TEST_ASSERT_EQUAL_UINT16(expected[at], adxl345_count(at));
    }
}

/* Samples 20 to 39 are equal: the tenth and those after it are stuck, 11, and each is marked once. */
TEST(test_stuck_samples_are_marked_and_counted)
{
    uint16_t before = counters().samples_stuck;
    for (size_t i = 20; i < 40; i++) {
        rig.stream.rows[i].lsb[0] = 20;
    }
    adxl345_start(&at_100_hz);
    (void)adxl345_marks();
    unsigned equal = 0;
    for (size_t taken = 1; taken < 60; taken++) {
        rig_until_taken(taken);
        equal = rig.last_x == 20 ? equal + 1 : 0;
        bool stuck = equal >= 10;
        TEST_ASSERT_EQUAL_HEX8(stuck ? ADXL345_MARK_STUCK : 0, adxl345_marks());
        TEST_ASSERT_EQUAL_HEX8(0, adxl345_marks());
        TEST_ASSERT_EQUAL(stuck ? ADXL345_FAULT_STUCK : ADXL345_FAULT_NONE, adxl345_fault());
    }
    TEST_ASSERT_EQUAL_UINT16(before + 11, counters().samples_stuck);
}

/* x jumps to its double and back from sample 20 on: the eighth jump from one sample to the next is the fault. */
TEST(test_doubled_samples_are_two_sensors)
{
    for (size_t i = 0; i < 40; i++) {
        rig.stream.rows[i].lsb[0] = i < 20 || i % 2 != 0 ? (int16_t)(200 + i % 3) : (int16_t)(400 + i % 5);
    }
    adxl345_start(&at_100_hz);
    unsigned jumps = 0;
    int was = 200;
    for (size_t taken = 1; taken < 40; taken++) {
        rig_until_taken(taken);
        jumps += (rig.last_x >= 400) != (was >= 400);
        was = rig.last_x;
        TEST_ASSERT_EQUAL(jumps >= 8 ? ADXL345_FAULT_TWO_SENSORS : ADXL345_FAULT_NONE, adxl345_fault());
    }
    TEST_ASSERT_TRUE(jumps > 8);
}

/* The sensor paused and is asked why; the edge of the sample that comes just then is no time, but INT1 has risen. */
TEST(test_an_edge_while_the_sensor_is_asked_says_that_int1_is_well)
{
    stream_for_ms(300);
    hal_host_sensor()->reg[ADXL345_POWER_CTL] = 0;
    rig_until_asked();
    hal_host_faults()->int1_cut = false;
    hal_host_sensor()->reg[ADXL345_POWER_CTL] = ADXL345_POWER_MEASURE;
    size_t before = rig.taken_count;
    rig.limit_us = 4000; /* a period after the one before: it comes a quarter late, and the clock asks just then */
    TEST_ASSERT_TRUE(adxl345_model_tick(hal_host_sensor(), rig.stream.rows[3000].lsb));
    rig_until_taken(before + 1);
    TEST_ASSERT_EQUAL_INT(3000, rig.last_x);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/*
 * INT1 falls silent: the sensor is read five quarters of a period after the last burst, which takes 119 bits. Main
 * passes for that, and not for nothing.
 */
TEST(test_a_silent_sensor_is_asked_after_five_quarters_of_a_period)
{
    for (unsigned phase = 0; phase < 10; phase++) {
        setUp();
        stream_for_ms(300 + phase);
        hal_host_faults()->int1_cut = true;
        uint32_t last_us = adxl345_burst_begun_us();
        unsigned passes = 0;
        while (adxl345_fault() == ADXL345_FAULT_NONE && passes < 1000) {
            rig_pass();
            passes++;
        }
        TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
        uint32_t took_us = hal_time_us() - last_us;
        TEST_ASSERT_TRUE(took_us >= 12500 && took_us <= 12500 + 119 * 44 / 16 + 100);
        TEST_ASSERT_TRUE(passes <= 10);
    }
}
