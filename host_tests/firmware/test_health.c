/* The watchdog's feeding place alone: how long a driver that stands still passes for healthy. */
#include "adxl345.h"
#include "base/health.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/test.h"

/* A pass of main takes 20 us on the host. */
#define PASS_MS 0.021

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static stream_t stream;

/* No sensor, no line: only what a test does reports progress. Time begins 1 s before its wrap. */
void setUp(void)
{
    hal_host_config_t config = { .time_start_us = 0xFFFFFFFFu - 1000000u };
    hal_host_begin(&config, NULL, false);
    hal_host_sensor()->powered = false;
    hal_uart_init(115200);
    hal_time_init();
    hal_drdy_enable();
    adxl345_init();
    health_start();
}

/* Here, because a test that fails does not reach its end. */
void tearDown(void)
{
    stream_free(&stream);
}

static void pass(void)
{
    health_pass(hal_time_us());
    hal_wake();
    hal_sleep_until_wake();
}

static double bitten_ms(void)
{
    return (double)hal_host_watchdog_bite() / 16000.0;
}

/* Says that it has been polled, and is not: as when its state machine misses a state. Returns when the watchdog bit. */
static double bitten_with_the_driver_standing_ms(double limit_ms)
{
    while (hal_host_watchdog_bite() == 0 && hal_host_now_ms() < limit_ms) {
        health_driver_polled();
        pass();
    }
    return bitten_ms();
}

/* The deadline, its grace, the watchdog's time: the last feed is the last pass before the grace is up. */
static void assert_bitten_after_deadline(double deadline_ms)
{
    double bite_ms = bitten_with_the_driver_standing_ms(deadline_ms + 1000.0);
    TEST_ASSERT_TRUE(bite_ms <= deadline_ms + LIMIT_GRACE_MS + LIMIT_WATCHDOG_MS);
    TEST_ASSERT_TRUE(bite_ms >= deadline_ms + LIMIT_GRACE_MS + LIMIT_WATCHDOG_MS - PASS_MS);
    hal_host_reset_mcu(HAL_RESET_WATCHDOG);
    TEST_ASSERT_EQUAL_HEX8(HEALTH_SAMPLING, hal_reset_note());
}

/* The probe of the sensor has 3 ms. */
TEST(test_a_driver_past_its_deadline_has_20_ms_of_grace)
{
    adxl345_start(&at_100_hz);
    TEST_ASSERT_EQUAL_UINT32(hal_time_us() + 3000u, adxl345_deadline_us());
    assert_bitten_after_deadline(hal_host_now_ms() + 3.0);
}

/* The same with a deadline on the other side of the wrap of the microseconds. */
TEST(test_grace_over_the_wrap_of_the_clock)
{
    while (hal_time_us() > 0x80000000u && hal_host_now_ms() < 998.0) {
        health_driver_polled();
        pass();
    }
    adxl345_start(&at_100_hz);
    TEST_ASSERT_TRUE_MESSAGE(adxl345_deadline_us() < hal_time_us(), "no wrap between them");
    assert_bitten_after_deadline(hal_host_now_ms() + 3.0);
}

/* A poll moves the deadline: without a sensor the driver tries again and again, which is healthy. */
TEST(test_a_driver_that_is_polled_is_healthy)
{
    adxl345_start(&at_100_hz);
    while (hal_host_now_ms() < 2000.0) {
        adxl345_poll(hal_time_us());
        health_driver_polled();
        pass();
    }
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
    TEST_ASSERT_TRUE(hal_host_watchdog_bite() == 0);
}

/* Its last deadline means nothing then. */
TEST(test_a_stopped_driver_is_never_late)
{
    adxl345_start(&at_100_hz);
    adxl345_stop();
    while (adxl345_phase() != ADXL345_STOPPED && hal_host_now_ms() < 100.0) {
        adxl345_poll(hal_time_us());
        health_driver_polled();
        pass();
    }
    TEST_ASSERT_EQUAL(ADXL345_STOPPED, adxl345_phase());
    (void)bitten_with_the_driver_standing_ms(2000.0);
    TEST_ASSERT_TRUE(hal_host_watchdog_bite() == 0);
}

/* A main loop that does not poll it has no grace. */
TEST(test_a_driver_that_nobody_polls_is_not_healthy)
{
    double begun_ms = hal_host_now_ms();
    while (hal_host_watchdog_bite() == 0 && hal_host_now_ms() < 1000.0) {
        pass();
    }
    TEST_ASSERT_DOUBLE_WITHIN(PASS_MS, begun_ms + LIMIT_WATCHDOG_MS, bitten_ms());
}

/* Samples that nobody takes wait in the queue: a pause of filtering excuses that for its own passes, no longer. */
TEST(test_a_pause_of_filtering_ends_with_its_last_pass)
{
    enum { PAUSE = 100, EVERY_MS = 4 };
    double next_ms = 0.0;
    stream = board_constant_stream(1000, 100.0, 1, 2, 250);
    hal_host_config_t config = { .time_start_us = 0 };
    hal_host_begin(&config, &stream, true);
    hal_uart_init(115200);
    hal_time_init();
    hal_drdy_enable();
    health_start();
    adxl345_start(&at_100_hz);
    health_pause_filtering(PAUSE);
    while (hal_host_watchdog_bite() == 0 && hal_host_now_ms() < 2000.0) {
        adxl345_poll(hal_time_us());
        health_driver_polled();
        if (hal_host_now_ms() >= next_ms) {
            health_pass(hal_time_us());
            next_ms += EVERY_MS;
        }
        hal_wake();
        hal_sleep_until_wake();
    }
    TEST_ASSERT_DOUBLE_WITHIN(PASS_MS, (PAUSE - 1) * EVERY_MS + LIMIT_WATCHDOG_MS, bitten_ms());
    hal_host_reset_mcu(HAL_RESET_WATCHDOG);
    TEST_ASSERT_EQUAL_HEX8(HEALTH_FILTERING, hal_reset_note());
}
