/*
 * INT1 that is high without data, rises for nothing, or for which main comes late: no sample comes twice, none is lost
 * that the sensor kept, each has its time.
 */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_period.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "support/documented_limits.h"
#include "support/rig.h"
#include "support/test.h"

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };

void hal_host_drdy_handler(void);

static void begin(double rate_hz)
{
    rig_begin(rate_hz, (hal_host_config_t){ 0 });
}

static void stream_for_ms(double ms)
{
    begin(100.0);
    adxl345_start(&at_100_hz);
    rig_run_ms(ms);
}

/* Main does not look for so long. */
static void stall_ms(double ms)
{
    for (double end_ms = hal_host_now_ms() + ms; hal_host_now_ms() < end_ms;) {
        hal_sleep_until_wake();
    }
}

/*
 * D2 held high: every sample comes once, with a time as near as the reads are apart (a burst and a pass), and the fault
 * has its name; when D2 is free again it is over.
 */
TEST(test_int1_stuck_high)
{
    static const uint16_t rates_dhz[] = { 125, 250, 500, 1000, 2000, 4000, 8000 };
    for (unsigned r = 0; r < 7; r++) {
        double period_ms = 10000.0 / rates_dhz[r];
        adxl345_config_t config = { rates_dhz[r], 16, false, 0 };
        adxl345_readings_t readings;
        begin(rates_dhz[r] / 10.0);
        adxl345_start(&config);
        rig_run_ms(20 + 5 * period_ms);
        rig.limit_us = 500;
        hal_host_faults()->int1_high = true;
        rig_run_ms(3 * period_ms);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        rig_run_ms(20 * period_ms);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
        adxl345_readings(&readings);
        TEST_ASSERT_TRUE(readings.empty >= 3);
        hal_host_faults()->int1_high = false;
        rig_run_ms(30 * period_ms);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
        rig_run_ms(5 * period_ms);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    }
}

/* D2 is free again: the 32nd good reading that leaves INT1 low ends the fault, none before. */
TEST(test_int1_is_trusted_again_after_32_good_readings)
{
    stream_for_ms(300);
    rig.limit_us = 500;
    hal_host_faults()->int1_high = true;
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
    size_t before = rig.taken_count + 1; /* the newest is still read with INT1 high */
    while (rig.taken_count < before) {
        rig_pass();
    }
    hal_host_faults()->int1_high = false;
    for (unsigned passes = 0; rig.taken_count < before + 40 && passes < 20000; passes++) {
        rig_pass();
        TEST_ASSERT_EQUAL(rig.taken_count < before + 32 ? ADXL345_FAULT_INT1_STUCK : ADXL345_FAULT_NONE,
                          adxl345_fault());
    }
    TEST_ASSERT_EQUAL_size_t(before + 40, rig.taken_count);
}

/* The clock of the sensor is 9 % slower or faster than was measured: the times keep up with the samples. */
TEST(test_times_follow_while_int1_is_stuck)
{
    for (int percent = -9; percent <= 9; percent += 18) {
        stream_for_ms(300);
        hal_host_faults()->int1_high = true;
        rig.limit_us = 1100; /* by the clock: a millisecond between two looks, and a burst */
        adxl345_period_start((uint16_t)(5000 - percent * 50));
        rig_run_ms(3000);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    }
}

/* The same from the start, so that the period is never measured, with a sensor that is 5 % slow. */
TEST(test_times_of_a_slow_sensor_follow_while_int1_is_stuck)
{
    static const adxl345_config_t at_12_5_hz = { 125, 16, false, 0 };
    rig_begin(12.5, (hal_host_config_t){ .ppm = -50000.0 });
    rig.limit_us = 500;
    hal_host_faults()->int1_high = true;
    adxl345_start(&at_12_5_hz);
    rig_run_ms(10e3);
    TEST_ASSERT_UINT32_WITHIN(3, 118, (uint32_t)rig.taken_count);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(120));
}

/* INT1 was stuck once and is well; it falls silent now: the first sample read by the clock has its own time. */
TEST(test_an_int1_that_was_stuck_once_moves_no_later_stamp)
{
    stream_for_ms(300);
    rig.limit_us = 1100; /* by the clock: a millisecond between two looks, and a burst */
    hal_host_faults()->int1_high = true;
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
    hal_host_faults()->int1_high = false;
    rig_run_ms(600);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    rig_until_pause();
    hal_host_faults()->int1_cut = true;
    rig_run_ms(60);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
    hal_host_faults()->int1_cut = false;
    rig_run_ms(60);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}

/* D2 is high for ever and the sensor measures no more: that is what is told. */
TEST(test_int1_stuck_high_on_a_sensor_without_data)
{
    stream_for_ms(300);
    rig.limit_us = 500;
    hal_host_faults()->int1_high = true;
    hal_host_sensor()->reg[ADXL345_POWER_CTL] = 0;
    for (double end_ms = hal_host_now_ms() + 60; adxl345_fault() != ADXL345_FAULT_NO_DATA;) {
        TEST_ASSERT_TRUE(hal_host_now_ms() < end_ms);
        rig_pass();
    }
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    hal_host_faults()->int1_high = false;
    rig_run_ms(400);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/* What the sensor still shows of before a reset of the MCU is no sample, however high INT1 is. */
TEST(test_what_was_shown_before_the_first_sample_is_none)
{
    stream_for_ms(305);
    TEST_ASSERT_TRUE(rig.last_x > 8);
    hal_host_reset_mcu(1);
    rig_reset();
    hal_host_faults()->int1_high = true;
    rig.limit_us = 500;
    size_t before = rig.taken_count;
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    TEST_ASSERT_TRUE(rig.taken_count > before);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_STUCK, adxl345_fault());
}

/* Edges for nothing, with INT1 still high when they are looked at, at many phases: no sample comes twice. */
TEST(test_edges_for_nothing_bring_no_sample)
{
    stream_for_ms(300);
    rig.limit_us = 500;
    for (unsigned i = 0; i < 500; i++) {
        rig_run_ms(1.3);
        if (!hal_drdy_high()) {
            hal_host_faults()->int1_high = true;
            hal_host_drdy_handler();
            hal_host_faults()->int1_high = false;
        }
    }
    adxl345_readings_t readings;
    adxl345_readings(&readings);
    TEST_ASSERT_TRUE(readings.empty > 200);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60)); /* what is latched between INT_SOURCE and the data comes too */
}

/*
 * INT1 goes high for nothing shortly before a sample, of a sensor that is 5 % slow and not
 * measured yet: one nominal period after the last sample it had none, so the new one is not that old.
 */
TEST(test_a_sample_is_not_older_than_the_sensor_was_empty)
{
    static const adxl345_config_t at_12_5_hz = { 125, 16, false, 0 };
    unsigned met_empty = 0;
    for (unsigned phase = 0; phase < 25; phase++) {
        adxl345_readings_t before;
        adxl345_readings_t after;
        rig_begin(12.5, (hal_host_config_t){ .ppm = -50000.0 });
        adxl345_start(&at_12_5_hz);
        while (rig.taken_count < 3) {
            rig_pass();
        }
        rig_away(4160 + phase); /* 83.2 ms or more; a period is 84.2 */
        adxl345_readings(&before);
        rig.limit_us = 500;
        hal_host_faults()->int1_high = true;
        hal_host_drdy_handler();
        while (rig.taken_count == 3) {
            rig_pass();
        }
        adxl345_readings(&after);
        unsigned empty = (unsigned)after.empty - before.empty;
        met_empty += empty != 0;
        TEST_ASSERT_EQUAL_size_t(4, rig.latched_count);
        TEST_ASSERT_EQUAL(empty < 3 ? ADXL345_FAULT_NONE : ADXL345_FAULT_INT1_STUCK, adxl345_fault());
    }
    TEST_ASSERT_TRUE(met_empty > 5);
}

/* An edge whose level is gone puts nothing on the bus, and leaves no time for another sample. */
TEST(test_edges_without_a_level_are_noise)
{
    stream_for_ms(300);
    for (unsigned i = 0; i < 300; i++) {
        rig_run_ms(1.3);
        if (!hal_drdy_high()) {
            uint32_t begun_us = adxl345_burst_begun_us();
            hal_host_drdy_handler();
            TEST_ASSERT_EQUAL_UINT32(begun_us, adxl345_burst_begun_us());
        }
    }
    adxl345_readings_t readings;
    adxl345_readings(&readings);
    TEST_ASSERT_EQUAL_UINT16(0, readings.empty);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}

static void run_until_tick(void)
{
    for (uint32_t before = hal_time_us() / HAL_TICK_US; hal_time_us() / HAL_TICK_US == before;) {
        rig_pass();
    }
    rig_away(1);
}

/* Not heard for so long, in whole ticks, and counted in one more. */
enum { DEAF_TICKS = (1000 * LIMIT_DEAF_MS - 1) / (int)HAL_TICK_US + 2 };

/* Eight edges in a tick of the clock may be: seven of a sensor at 800 Hz, and one. The ninth is not heard any more. */
TEST(test_nine_edges_in_a_tick_flicker)
{
    static const adxl345_config_t at_12_5_hz = { 125, 16, false, 0 };
    rig_begin(12.5, (hal_host_config_t){ 0 });
    adxl345_start(&at_12_5_hz);
    rig_run_ms(330); /* the next sample comes in more than 60 ms */
    rig_until_pause();
    for (unsigned ticks = 0; ticks < 2; ticks++) {
        run_until_tick();
        rig_edges(LIMIT_EDGES - 1);
        TEST_ASSERT_FALSE(hal_drdy_flickers());
    }
    run_until_tick();
    rig_edges(LIMIT_EDGES);
    for (unsigned ticks = 1; ticks <= DEAF_TICKS; ticks++) {
        TEST_ASSERT_TRUE(hal_drdy_flickers());
        run_until_tick();
    }
    TEST_ASSERT_FALSE(hal_drdy_flickers());
    rig.limit_us = 20000; /* by the clock */
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(400));
}

/* In the tick in which they are counted again so many edges make it flicker on, one less ends that. */
TEST(test_eight_edges_are_too_many_to_be_believed_again)
{
    for (unsigned count = LIMIT_EDGES_AGAIN - 1; count <= LIMIT_EDGES_AGAIN + 1; count++) {
        stream_for_ms(300);
        run_until_tick();
        rig_edges(LIMIT_EDGES);
        for (unsigned ticks = 1; ticks < DEAF_TICKS; ticks++) {
            run_until_tick();
        }
        hal_host_faults()->int1_cut = true; /* no edge of a sample is among them */
        rig_edges(count);
        run_until_tick();
        TEST_ASSERT_EQUAL(count >= LIMIT_EDGES_AGAIN, hal_drdy_flickers());
    }
}

/* A wire off D2 picks up a noise of 250 kHz: every sample comes once, read by the clock, and the fault has its name. */
TEST(test_an_int1_that_flickers_is_not_heard)
{
    static const uint16_t rates_dhz[] = { 125, 1000, 8000 };
    for (unsigned r = 0; r < 3; r++) {
        double period_ms = 10000.0 / rates_dhz[r];
        adxl345_config_t config = { rates_dhz[r], 16, false, 0 };
        begin(rates_dhz[r] / 10.0);
        adxl345_start(&config);
        rig_run_ms(20 + 30 * period_ms);
        rig.limit_us = (uint32_t)(1000 * period_ms); /* of what an edge of the noise has read */
        double begun_ms = hal_host_now_ms();
        for (unsigned pass = 0; hal_host_now_ms() < begun_ms + 1000 + 10 * period_ms; pass++) {
            hal_host_faults()->int1_high = pass % 2 != 0;
            hal_host_faults()->int1_cut = !hal_host_faults()->int1_high;
            rig_edges(5);
            rig_pass();
            if (hal_host_now_ms() > begun_ms + 10 + 3 * period_ms) {
                TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_FLICKERS, adxl345_fault());
            }
        }
        hal_host_faults()->int1_high = false;
        hal_host_faults()->int1_cut = false;
        rig_run_ms(300 + 3 * period_ms);
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL_size_t(0, rig_lost(60 + 3 * period_ms));
    }
}

/* Main stalls for longer than the FIFO is deep: lost samples are counted, and the rest keep their time. */
TEST(test_overruns_are_counted)
{
    adxl345_readings_t readings;
    stream_for_ms(300);
    stall_ms(250);
    rig_run_ms(100);
    adxl345_readings(&readings);
    TEST_ASSERT_EQUAL_UINT16(0, readings.overruns);
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_sensor()->overruns);
    rig.limit_us =
        6000; /* how many are lost is not known; FIFO_STATUS says how many wait: half a period, and a burst */
    stall_ms(500);
    rig_run_ms(100);
    adxl345_readings(&readings);
    TEST_ASSERT_EQUAL_UINT16(1, readings.overruns);
    TEST_ASSERT_TRUE(hal_host_sensor()->overruns > 0);
    TEST_ASSERT_EQUAL_size_t(hal_host_sensor()->overruns, rig_lost(60));
}

/* INT1 comes back to a main that did not look for a while: the sample that the edge brings is older than the edge. */
TEST(test_int1_comes_back_to_a_full_sensor)
{
    stream_for_ms(300);
    hal_host_faults()->int1_cut = true;
    stall_ms(200);
    hal_host_faults()->int1_cut = false;
    hal_host_drdy_handler();
    rig.limit_us = 6000;
    rig_run_ms(300);
    TEST_ASSERT_EQUAL_UINT32(0, hal_host_sensor()->overruns);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}
