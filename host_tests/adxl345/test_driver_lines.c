/*
 * The driver where lines are held low, a STOP does not get out, INT1 is silent: what it calls that, after how long, and
 * what it does to the lines.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_time.h"
#include "support/rig.h"
#include "support/test.h"

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static const adxl345_config_t at_800_hz = { 8000, 16, false, 0 };
static const uint16_t rates_dhz[] = { 125, 250, 500, 1000, 2000, 4000, 8000 };
static double ppm;
static uint32_t clocks_seen;
static uint32_t most_clocks;
static uint32_t clears;

static void on_bus_clear(void)
{
    uint32_t clocks = hal_host_hand_clocks() - clocks_seen;
    clocks_seen += clocks;
    most_clocks = clocks > most_clocks ? clocks : most_clocks;
    clears++;
}

static void begin(double rate_hz)
{
    const uint32_t start_us = 0xFFFFFFFFu - 300000u;
    rig_begin(rate_hz, (hal_host_config_t){ .time_start_us = start_us, .ppm = ppm, .on_bus_clear = on_bus_clear });
    rig.limit_us = UINT32_MAX; /* a test says what it may be */
    clocks_seen = 0;
    most_clocks = 0;
    clears = 0;
}

void setUp(void)
{
    ppm = 0.0;
    begin(100.0);
}

/* Passes until the fault is told, or is over; how long that took. */
static double ms_until_fault(bool wanted)
{
    double begun_ms = hal_host_now_ms();
    while ((adxl345_fault() != ADXL345_FAULT_NONE) != wanted) {
        TEST_ASSERT_TRUE_MESSAGE(hal_host_now_ms() - begun_ms < 600.0, "no change of the fault");
        rig_pass();
    }
    return hal_host_now_ms() - begun_ms;
}

static void hold(adxl345_fault_t line, bool low)
{
    *(line == ADXL345_FAULT_SCL_LOW ? &hal_host_faults()->scl_low : &hal_host_faults()->sda_low) = low;
}

/* A line that is low from the start is seen before any transfer: no deadline is needed. */
TEST(test_a_line_low_from_the_start_is_named_at_once)
{
    for (adxl345_fault_t line = ADXL345_FAULT_SCL_LOW; line <= ADXL345_FAULT_SDA_LOW; line++) {
        begin(100.0);
        hold(line, true);
        adxl345_start(&at_100_hz);
        TEST_ASSERT_EQUAL(line, adxl345_fault());
        rig_run_ms(300);
        TEST_ASSERT_EQUAL(line, adxl345_fault());
        TEST_ASSERT_TRUE(clears >= 12 && clears <= 20); /* at 0, 5, 15, 35 ms, then every 25 */
        hold(line, false);
        (void)ms_until_fault(false);
        rig_run_ms(100);
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    }
}

/* An SCL that is low is given no clock; for an SDA that stays low 16 are enough, and there is no STOP then. */
TEST(test_clocks_by_hand)
{
    hold(ADXL345_FAULT_SCL_LOW, true);
    adxl345_start(&at_100_hz);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_hand_clocks());
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_hand_stops());
    begin(100.0);
    hold(ADXL345_FAULT_SDA_LOW, true);
    adxl345_start(&at_100_hz);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_UINT32(16, most_clocks);
    TEST_ASSERT_EQUAL_UINT32(16u * clears, hal_host_hand_clocks());
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_hand_stops());
    begin(100.0);
    adxl345_start(&at_100_hz);
    TEST_ASSERT_EQUAL_UINT32(1, hal_host_hand_clocks());
    TEST_ASSERT_EQUAL_UINT32(1, hal_host_hand_stops());
}

/* The line goes low at every 0.1 ms of 20 ms of streaming: its name within a period and 3.3 ms, and back in time. */
TEST(test_a_line_low_while_streaming_is_named)
{
    for (unsigned phase = 0; phase < 400; phase++) {
        adxl345_fault_t line = (phase & 1u) != 0 ? ADXL345_FAULT_SCL_LOW : ADXL345_FAULT_SDA_LOW;
        begin(100.0);
        adxl345_start(&at_100_hz);
        rig_run_ms(100.0 + 0.05 * phase);
        hold(line, true);
        TEST_ASSERT_TRUE(ms_until_fault(true) <= 10.0 + 3.3);
        TEST_ASSERT_EQUAL(line, adxl345_fault());
        rig_run_ms(50);
        hold(line, false);
        (void)ms_until_fault(false);
        (void)rig_lost(60);
    }
}

/* At any moment of the way from start to the first sample: 3 ms and main's pass later the driver has given up. */
TEST(test_a_line_low_while_configuring_is_named_by_the_deadline)
{
    unsigned met = 0;
    for (unsigned phase = 0; phase < 150; phase++) {
        begin(100.0);
        adxl345_start(&at_100_hz);
        rig_run_ms(0.02 * phase);
        bool measures = hal_host_sensor()->reg[ADXL345_POWER_CTL] == ADXL345_POWER_MEASURE;
        hold(ADXL345_FAULT_SDA_LOW, true);
        double took_ms = ms_until_fault(true);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_SDA_LOW, adxl345_fault());
        if (!measures) {
            TEST_ASSERT_TRUE(took_ms >= 2.8 && took_ms <= 3.3);
            met++;
        }
    }
    TEST_ASSERT_TRUE(met > 80 && met < 150);
}

/* A slave that holds SDA until it has seen so many clocks: up to 16 nobody notices, more take a second clearing. */
TEST(test_a_hung_slave_is_freed)
{
    for (uint8_t clocks = 1; clocks <= 32; clocks++) {
        begin(100.0);
        adxl345_start(&at_100_hz);
        rig_run_ms(100);
        rig_until_pause();
        hal_host_faults()->hang_clocks = clocks;
        bool told = false;
        for (double end_ms = hal_host_now_ms() + 30.0; hal_host_now_ms() < end_ms;) {
            rig_pass();
            told = told || adxl345_fault() == ADXL345_FAULT_SDA_LOW;
            TEST_ASSERT_NOT_EQUAL(ADXL345_FAULT_BUS, adxl345_fault());
        }
        TEST_ASSERT_EQUAL(clocks > 16, told);
        TEST_ASSERT_EQUAL_UINT8(0, hal_host_faults()->hang_clocks);
        rig_run_ms(60);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_TRUE(rig_lost(60) == 0 || told);
    }
}

/* TWSTO never clears: no interrupt tells it, and no burst can begin. The bus is taken anew, no sample is lost. */
TEST(test_a_stop_that_does_not_get_out)
{
    for (unsigned phase = 0; phase < 40; phase++) {
        const adxl345_config_t *config = (phase & 1u) != 0 ? &at_800_hz : &at_100_hz;
        double period_ms = 10000.0 / config->rate_dhz;
        adxl345_counters_t before;
        adxl345_counters_t after;
        begin(config->rate_dhz / 10.0);
        adxl345_start(config);
        rig_run_ms(100.0 + 0.3 * phase);
        adxl345_counters(&before);
        hal_host_faults()->stop_stuck = true;
        uint32_t clears_before = clears;
        double begun_ms = hal_host_now_ms();
        while (clears == clears_before && hal_host_now_ms() < begun_ms + 50.0) {
            rig_pass();
        }
        TEST_ASSERT_TRUE(hal_host_now_ms() - begun_ms <= 2.0 * period_ms + 3.5);
        hal_host_faults()->stop_stuck = false;
        adxl345_counters(&after);
        TEST_ASSERT_EQUAL_UINT16(before.timeouts + 1, after.timeouts);
        rig_run_ms(30);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    }
}

/*
 * At every phase of a burst and of its STOP: the sensor is told to rest as soon as the bus is free, also by a main that
 * leaves the burst's sample in the queue and so has no reason of its own to pass again.
 */
TEST(test_a_busy_bus_is_waited_for_no_longer_than_it_is_busy)
{
    unsigned running = 0;
    for (unsigned i = 0; i < 50; i++) {
        begin(100.0);
        adxl345_start(&at_100_hz);
        rig_run_ms(100);
        rig_until_pause();
        rig_until_burst();
        rig_away(i / 2);
        running += adxl345_burst_bus_state() == I2C_BUS_BUSY;
        rig.leaves = (i & 1u) != 0;
        double begun_ms = hal_host_now_ms();
        adxl345_stop();
        while (hal_host_sensor()->reg[ADXL345_POWER_CTL] != 0) {
            rig_pass();
            TEST_ASSERT_TRUE(hal_host_now_ms() - begun_ms < 0.6);
        }
    }
    TEST_ASSERT_TRUE(running > 30 && running < 50);
}

/*
 * Main comes 5 ms late to what a step begins, to its end, or to both: that is no fault of the bus. The limit of the
 * transfer begins when it does.
 */
TEST(test_a_late_main_is_no_timeout)
{
    static const unsigned away[3][3] = { { 1, 250, 1 }, { 250, 1, 250 }, { 250, 250, 250 } };
    for (unsigned way = 0; way < 3; way++) {
        adxl345_counters_t before;
        adxl345_counters_t after;
        begin(100.0);
        adxl345_counters(&before);
        adxl345_start(&at_100_hz);
        for (unsigned i = 0; i < 120; i++) {
            adxl345_poll(hal_time_us());
            rig_away(away[way][i % 3]);
        }
        adxl345_counters(&after);
        TEST_ASSERT_EQUAL_UINT16(before.timeouts, after.timeouts);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_HEX8(ADXL345_POWER_MEASURE, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
    }
}

/* INT1 falls silent at any phase: named before the row of the sample that is missed is due, or at 800 Hz after 3 ms. */
TEST(test_silent_int1_is_noticed_in_time_for_the_row)
{
    for (size_t r = 0; r < sizeof rates_dhz / sizeof rates_dhz[0]; r++) {
        adxl345_config_t config = { rates_dhz[r], 16, false, 0 };
        double period_ms = 10000.0 / config.rate_dhz;
        double limit_ms = fmax(1.5 * period_ms, 3.0 + 0.25);
        for (unsigned phase = 0; phase < 20; phase++) {
            begin(config.rate_dhz / 10.0);
            adxl345_start(&config);
            rig_run_ms(50.0 + (5.0 + phase / 20.0) * period_ms);
            while (hal_drdy_high() || adxl345_burst_running()) {
                rig_pass();
            }
            hal_host_faults()->int1_cut = true;
            double took_ms = ms_until_fault(true);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
            TEST_ASSERT_TRUE(took_ms >= 0.2 * period_ms && took_ms <= limit_ms);
        }
    }
}

/*
 * INT1 stays silent: read by the clock for two seconds, at every rate and with a sensor 5 % off. The fault stays told,
 * no sample is lost, doubled or has the time of another; when INT1 is back the fault is over.
 */
TEST(test_without_int1_samples_are_read_by_the_clock)
{
    static const double clocks_ppm[] = { -50000.0, 0.0, 50000.0 };
    for (unsigned i = 0; i < 3 * sizeof rates_dhz / sizeof rates_dhz[0]; i++) {
        adxl345_config_t config = { rates_dhz[i / 3], 16, false, 0 };
        double period_ms = 10000.0 / config.rate_dhz;
        ppm = clocks_ppm[i % 3];
        begin(config.rate_dhz / 10.0);
        adxl345_start(&config);
        rig_run_ms(50.0 + 6.0 * period_ms);
        hal_host_faults()->int1_cut = true;
        (void)ms_until_fault(true);
        rig_run_ms(20.0 * period_ms);
        size_t latched = rig.latched_count;
        size_t taken = rig.taken_count;
        rig.off_us = 0;
        for (unsigned ms = 0; ms < 2000; ms++) {
            rig_run_ms(1.0);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
            TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        }
        TEST_ASSERT_INT_WITHIN(2, (int)(rig.latched_count - latched), (int)(rig.taken_count - taken));
        TEST_ASSERT_TRUE(rig.off_us <= 1000u * period_ms);
        hal_host_faults()->int1_cut = false;
        TEST_ASSERT_TRUE(ms_until_fault(false) <= 2.0 * period_ms);
        rig_run_ms(50.0);
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60.0 + 2.0 * period_ms));
    }
}

/* A sensor that stops measuring while it is read by the clock: that is no silence of INT1 any more. */
TEST(test_without_int1_a_sensor_that_stops_is_noticed)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(200);
    hal_host_faults()->int1_cut = true;
    rig_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
    adxl345_model_power(hal_host_sensor(), false);
    rig_run_ms(20);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
    adxl345_model_power(hal_host_sensor(), true);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    hal_host_faults()->int1_cut = false;
    rig_run_ms(30);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}
