/* The parts of the HAL contracts that are logic: time over its wrap, reset cause, sleep, EEPROM timing, receive ring */
#include "hal_eeprom.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_led.h"
#include "hal_sleep.h"
#include "hal_strap.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "support/test.h"

void setUp(void)
{
    hal_host_config_t config = { .time_start_us = 0xFFFFF000u };
    hal_host_begin(&config, NULL, false);
    hal_time_init();
    hal_uart_init(115200);
}

TEST(test_time_comparison_over_the_wrap)
{
    TEST_ASSERT_TRUE(hal_time_reached(5, 5));
    TEST_ASSERT_TRUE(hal_time_reached(6, 5));
    TEST_ASSERT_FALSE(hal_time_reached(4, 5));
    TEST_ASSERT_TRUE(hal_time_reached(3, 0xFFFFFFF0u));
    TEST_ASSERT_FALSE(hal_time_reached(0xFFFFFFF0u, 3));
    TEST_ASSERT_TRUE(hal_time_reached(0x7FFFFFFFu, 0));
    TEST_ASSERT_FALSE(hal_time_reached(0x80000000u, 0));
}

TEST(test_clock_crosses_the_wrap)
{
    uint32_t before = hal_time_us();
    for (int i = 0; i < 4; i++) {
        hal_sleep_until_wake();
    }
    uint32_t after = hal_time_us();
    TEST_ASSERT_TRUE(after < before);
    TEST_ASSERT_UINT32_WITHIN(40, 4u * HAL_TICK_US, after - before);
}

/* Sleeps until main is woken; says for how long, or how often first, when one wake-up is not what was waited for. */
static double slept_until_us(uint32_t t_us, unsigned *wakes)
{
    uint64_t before = hal_host_now();
    for (*wakes = 0; !hal_time_reached(hal_time_us(), t_us); (*wakes)++) {
        hal_sleep_until_wake();
    }
    return (double)(hal_host_now() - before) / 16.0;
}

/* Ticks come every 8.2 ms; only the alarm wakes main in between, and at once where 32.768 ms look like none. */
TEST(test_alarm_wakes_at_its_moment)
{
    static const uint32_t ahead_us[] = { 100, 5000, 8000, 12345, 32767, 32768, 70000, 163000 };
    unsigned wakes;
    for (size_t i = 0; i < sizeof ahead_us / sizeof ahead_us[0]; i++) {
        uint32_t t_us = hal_time_us() + ahead_us[i];
        hal_wake_at(t_us);
        double slept_us = slept_until_us(t_us, &wakes);
        TEST_ASSERT_TRUE(slept_us >= ahead_us[i] - 1.0 && slept_us <= ahead_us[i] + 25.0);
        TEST_ASSERT_TRUE(wakes <= ahead_us[i] / HAL_TICK_US + ahead_us[i] / 32768u + 3u);
    }
}

/* A moved alarm does not come at its old moment. */
TEST(test_alarm_that_is_moved)
{
    unsigned wakes;
    hal_sleep_until_wake();
    uint32_t now_us = hal_time_us();
    hal_wake_at(now_us + 1000u);
    hal_wake_at(now_us + 3000u);
    double slept_us = slept_until_us(now_us + 1u, &wakes);
    TEST_ASSERT_TRUE(slept_us >= 2999.0 && slept_us <= 3025.0);
    TEST_ASSERT_EQUAL_UINT(1, wakes);
}

TEST(test_wake_before_sleep_is_not_lost)
{
    uint64_t before = hal_host_now();
    hal_wake();
    hal_sleep_until_wake();
    TEST_ASSERT_TRUE(hal_host_now() - before < HAL_TICK_US * 4u);
    before = hal_host_now();
    hal_sleep_until_wake();
    TEST_ASSERT_TRUE(hal_host_now() - before > HAL_TICK_US * 4u);
}

TEST(test_reset_cause_from_mcusr)
{
    TEST_ASSERT_EQUAL(HAL_RESET_POWER_ON, hal_reset_classify(0x01, true, 120));
    TEST_ASSERT_EQUAL(HAL_RESET_POWER_ON, hal_reset_classify(0x05, false, 0));
    TEST_ASSERT_EQUAL(HAL_RESET_BROWN_OUT, hal_reset_classify(0x04, true, 0));
    TEST_ASSERT_EQUAL(HAL_RESET_WATCHDOG, hal_reset_classify(0x08, true, 0));
    TEST_ASSERT_EQUAL(HAL_RESET_EXTERNAL, hal_reset_classify(0x02, true, 0));
}

/* The UNO's bootloader leaves MCUSR at 0. 250 ms are 30 ticks; a healthy loop feeds within a few. */
TEST(test_reset_cause_from_the_breadcrumb)
{
    TEST_ASSERT_EQUAL(HAL_RESET_POWER_ON, hal_reset_classify(0, false, 30));
    TEST_ASSERT_EQUAL(HAL_RESET_WATCHDOG, hal_reset_classify(0, true, 30));
    TEST_ASSERT_EQUAL(HAL_RESET_WATCHDOG, hal_reset_classify(0, true, 255));
    TEST_ASSERT_EQUAL(HAL_RESET_EXTERNAL, hal_reset_classify(0, true, 3));
}

/* RAM that lost its content counts nothing; a saturated count does not begin anew. */
TEST(test_watchdog_resets_in_a_row_are_counted)
{
    TEST_ASSERT_EQUAL_UINT8(1, hal_reset_count(HAL_RESET_WATCHDOG, true, 0));
    TEST_ASSERT_EQUAL_UINT8(3, hal_reset_count(HAL_RESET_WATCHDOG, true, 2));
    TEST_ASSERT_EQUAL_UINT8(1, hal_reset_count(HAL_RESET_WATCHDOG, false, 77));
    TEST_ASSERT_EQUAL_UINT8(255, hal_reset_count(HAL_RESET_WATCHDOG, true, 255));
    TEST_ASSERT_EQUAL_UINT8(0, hal_reset_count(HAL_RESET_EXTERNAL, true, 2));
    TEST_ASSERT_EQUAL_UINT8(0, hal_reset_count(HAL_RESET_BROWN_OUT, true, 2));
    TEST_ASSERT_EQUAL_UINT8(0, hal_reset_count(HAL_RESET_POWER_ON, true, 2));
}

TEST(test_watchdog_bites_after_250_ms)
{
    hal_watchdog_start();
    while (hal_host_watchdog_bite() == 0) {
        hal_sleep_until_wake();
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 250.0, (double)hal_host_watchdog_bite() / 16000.0);
}

TEST(test_eeprom_is_busy_for_a_write)
{
    TEST_ASSERT_TRUE(hal_eeprom_ready());
    TEST_ASSERT_EQUAL_UINT8(0xFF, hal_eeprom_read(1023));
    hal_eeprom_write_start(1023, 0x5A);
    TEST_ASSERT_FALSE(hal_eeprom_ready());
    hal_sleep_until_wake();
    TEST_ASSERT_TRUE(hal_eeprom_ready());
    TEST_ASSERT_EQUAL_UINT8(0x5A, hal_eeprom_read(1023));
}

/* A hundred digits, of which it has room for 63. */
static void overfill_receive_ring(void)
{
    for (int i = 0; i < 10; i++) {
        hal_host_type("0123456789");
    }
    for (int i = 0; i < 200; i++) {
        hal_sleep_until_wake();
    }
}

TEST(test_receive_ring_counts_what_it_loses)
{
    uint8_t byte;
    overfill_receive_ring();
    int received = 0;
    while (hal_uart_rx(&byte)) {
        TEST_ASSERT_EQUAL_CHAR('0' + received % 10, byte);
        received++;
    }
    TEST_ASSERT_EQUAL(63, received);
    TEST_ASSERT_EQUAL_UINT8(37, hal_uart_rx_lost());
}

/* The first byte after the gap is a 0; those after it are as sent. */
TEST(test_a_gap_is_marked_once)
{
    uint8_t byte;
    overfill_receive_ring();
    while (hal_uart_rx(&byte)) {
    }
    hal_host_type("abc");
    for (int i = 0; i < 10; i++) {
        hal_sleep_until_wake();
    }
    static const uint8_t received[] = { 0, 'b', 'c' };
    for (size_t i = 0; i < sizeof received; i++) {
        TEST_ASSERT_TRUE(hal_uart_rx(&byte));
        TEST_ASSERT_EQUAL_UINT8(received[i], byte);
    }
    TEST_ASSERT_FALSE(hal_uart_rx(&byte));
}

/* The pull-up and the output are off again after each reset of the MCU, whose pins are all inputs then. */
TEST(test_pins_work_once_they_are_initialised)
{
    for (int resets = 0; resets < 2; resets++) {
        hal_led_set(true);
        TEST_ASSERT_FALSE(hal_host_led());
        TEST_ASSERT_TRUE(hal_strap_low());
        hal_led_init();
        hal_strap_init();
        TEST_ASSERT_TRUE(hal_host_led());
        TEST_ASSERT_FALSE(hal_strap_low());
        hal_host_reset_mcu(HAL_RESET_EXTERNAL);
    }
}

/* What hal/host takes from the same headers, so no other test on the PC sees it: tables 26-3 and 26-4, 11.9.1, 8.4. */
TEST(numbers_of_the_chip_are_those_of_its_data_sheet)
{
    static const struct {
        unsigned number, of_data_sheet;
    } rows[] = { { HAL_I2C_BUS_ERROR, 0x00 },
                 { HAL_I2C_STARTED, 0x08 },
                 { HAL_I2C_RESTARTED, 0x10 },
                 { HAL_I2C_WRITE_ADDRESS_ACK, 0x18 },
                 { HAL_I2C_WRITE_ADDRESS_NACK, 0x20 },
                 { HAL_I2C_SENT_ACK, 0x28 },
                 { HAL_I2C_SENT_NACK, 0x30 },
                 { HAL_I2C_ARBITRATION_LOST, 0x38 },
                 { HAL_I2C_READ_ADDRESS_ACK, 0x40 },
                 { HAL_I2C_READ_ADDRESS_NACK, 0x48 },
                 { HAL_I2C_RECEIVED_ACK, 0x50 },
                 { HAL_I2C_RECEIVED_NACK, 0x58 },
                 { HAL_I2C_NOTHING, 0xF8 },
                 { HAL_MCUSR_POWER_ON, 1u << 0 },
                 { HAL_MCUSR_EXTERNAL, 1u << 1 },
                 { HAL_MCUSR_BROWN_OUT, 1u << 2 },
                 { HAL_MCUSR_WATCHDOG, 1u << 3 },
                 { HAL_EEPROM_SIZE, 1024 },
                 { 4000000 / HAL_I2C_100_KHZ, 100000 },
                 { 4000000 / HAL_I2C_400_KHZ, 400000 },
                 { 4000000 / HAL_I2C_364_KHZ, 363636 } };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_HEX32(rows[i].of_data_sheet, rows[i].number);
    }
}
