/* How fast SCL is: what is asked for, what 800 Hz needs, and what the driver changes by itself on a garbled bus. */
#include "adxl345.h"
#include "adxl345_burst.h"
#include "adxl345_registers.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "support/board.h"
#include "support/documented_limits.h"
#include "support/rig.h"
#include "support/test.h"

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };
static uint8_t spoilt_reg;      /* slow wires: a one of it reads as zero at 363.6 kHz, */
static uint8_t spoilt_bits;     /* one of these; 0: none */
static bool in_bursts_only;     /* not while the sensor is configured */
static uint8_t foreign_id;      /* another's DEVID, */
static unsigned foreign, asked; /* so many times; reads of DEVID */

static bool slow(void)
{
    return adxl345_scl_025us(1000) == HAL_I2C_100_KHZ;
}

static uint8_t on_rx(uint8_t reg, uint8_t byte)
{
    if (reg == ADXL345_DEVID && asked++ < foreign) {
        return foreign_id;
    }
    bool spoilt = reg == spoilt_reg && !slow() && (!in_bursts_only || adxl345_burst_running());
    return spoilt ? (uint8_t)(byte & ~spoilt_bits) : byte;
}

void setUp(void)
{
    rig_begin(100.0, (hal_host_config_t){ .on_rx = on_rx });
    spoilt_bits = 0;
    in_bursts_only = false;
    foreign_id = 0x60;
    foreign = 0;
    asked = 0;
}

static const adxl345_i2c_t speeds[] = { ADXL345_I2C_FALLS_BACK, ADXL345_I2C_100_KHZ, ADXL345_I2C_364_KHZ };

static void begin_at(uint16_t rate_dhz, adxl345_i2c_t speed)
{
    adxl345_config_t config = { rate_dhz, 16, false, 0 };
    rig_begin(rate_dhz / 10.0, (hal_host_config_t){ .on_rx = on_rx });
    adxl345_set_i2c(speed);
    adxl345_start(&config);
}

static uint32_t burst_us(void)
{
    rig_until_pause();
    while (!adxl345_burst_running()) {
        adxl345_poll(hal_time_us());
        board_driver_sleep();
    }
    while (adxl345_burst_bus_state() == I2C_BUS_BUSY) {
        hal_sleep_until_wake(); /* its end wakes */
    }
    return hal_time_us() - adxl345_burst_begun_us();
}

/*
 * A burst has 119 bits: START, address, register, START, address, ten bytes, 9 each. At 363.6 kHz that is 327 us, at
 * 400 kHz, which 800 Hz needs and no other rate gets (data sheet p. 18), 297.5 us, at 100 kHz, up to 200 Hz, 1190.
 * Main's pass takes 20 us here. Nothing is lost at any rate.
 */
TEST(test_a_burst_takes_the_time_of_its_bits)
{
    static const uint16_t rates_dhz[] = { 125, 250, 500, 1000, 2000, 4000, 8000 };
    for (size_t s = 0; s < sizeof speeds / sizeof speeds[0]; s++) {
        for (size_t r = 0; r < sizeof rates_dhz / sizeof rates_dhz[0]; r++) {
            bool is_slow = speeds[s] == ADXL345_I2C_100_KHZ && rates_dhz[r] <= 2000;
            uint32_t bits_us = is_slow ? 1190 : rates_dhz[r] == 8000 ? 297 : 327;
            begin_at(rates_dhz[r], speeds[s]);
            rig_run_ms(50.0 + 300000.0 / rates_dhz[r]);
            TEST_ASSERT_UINT32_WITHIN(12, bits_us + 10, burst_us());
            TEST_ASSERT_EQUAL(is_slow, adxl345_scl_025us(rates_dhz[r]) == HAL_I2C_100_KHZ);
            TEST_ASSERT_FALSE(adxl345_i2c_fell_back());
            rig_run_ms(500.0);
            TEST_ASSERT_EQUAL_size_t(0, rig_lost(30.0 + 20000.0 / rates_dhz[r]));
        }
    }
}

/* Ones that are late: in the identity, in a register that is read back, in the frame of a reading. */
TEST(test_slow_wires_get_a_slow_clock)
{
    static const struct {
        uint8_t reg, bits;
        bool in_bursts_only;
        adxl345_fault_t fault;
    } wires[] = { { ADXL345_DEVID, 0x85, false, ADXL345_FAULT_WRONG_ID },
                  { ADXL345_BW_RATE, 0x0F, false, ADXL345_FAULT_READ_BACK },
                  { ADXL345_FIFO_CTL, 0x8A, true, ADXL345_FAULT_TORN } };
    for (size_t w = 0; w < sizeof wires / sizeof wires[0]; w++) {
        setUp();
        spoilt_reg = wires[w].reg;
        spoilt_bits = wires[w].bits;
        in_bursts_only = wires[w].in_bursts_only;
        begin_at(1000, ADXL345_I2C_FALLS_BACK);
        rig_run_ms(150);
        TEST_ASSERT_EQUAL(wires[w].fault, adxl345_fault());
        rig_run_ms(2000);
        TEST_ASSERT_TRUE(slow() && adxl345_i2c_fell_back());
        TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    }
}

/* It stays slow until another speed is set; 400 Hz gets 363.6 kHz all the same, which the fault outlasts. */
TEST(test_a_slow_clock_stays_until_another_is_set)
{
    static const adxl345_config_t at_400_hz = { 4000, 16, false, 0 };
    foreign = LIMIT_GARBLED;
    begin_at(1000, ADXL345_I2C_FALLS_BACK);
    rig_run_ms(1000);
    const adxl345_config_t *const configs[] = { &at_400_hz, &at_100_hz };
    for (size_t i = 0; i < 2; i++) {
        adxl345_set_i2c(ADXL345_I2C_FALLS_BACK);
        adxl345_start(configs[i]);
        rig_run_ms(1000);
        TEST_ASSERT_TRUE(adxl345_i2c_fell_back());
        TEST_ASSERT_UINT32_WITHIN(12, (configs[i] == &at_400_hz ? 327 : 1190) + 10, burst_us());
    }
    adxl345_set_i2c(ADXL345_I2C_364_KHZ);
    TEST_ASSERT_FALSE(adxl345_i2c_fell_back());
    adxl345_set_i2c(ADXL345_I2C_FALLS_BACK);
    adxl345_start(&at_100_hz);
    rig_run_ms(1000);
    TEST_ASSERT_FALSE(slow());
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
}

/* Sixteen faults; sixteen more, and the faster one is tried again. A speed that was asked for stays. */
TEST(test_the_clock_changes_after_sixteen_faults)
{
    for (unsigned faults = 0; faults <= 3 * LIMIT_GARBLED; faults++) {
        for (size_t s = 0; s < sizeof speeds / sizeof speeds[0]; s++) {
            asked = 0;
            foreign = faults;
            begin_at(1000, speeds[s]);
            rig_run_ms(50.0 + 30.0 * faults);
            TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
            bool fell_back = speeds[s] == ADXL345_I2C_FALLS_BACK && faults / LIMIT_GARBLED % 2 != 0;
            TEST_ASSERT_EQUAL(fell_back, adxl345_i2c_fell_back());
            TEST_ASSERT_EQUAL(fell_back || speeds[s] == ADXL345_I2C_100_KHZ, slow());
        }
    }
}

/* Another part, whose identity has other ones; faults at a rate that has its own clock. */
TEST(test_faults_that_a_slower_clock_does_not_cure)
{
    foreign = 3 * LIMIT_GARBLED;
    foreign_id = 0xE6;
    begin_at(1000, ADXL345_I2C_FALLS_BACK);
    rig_run_ms(2000);
    TEST_ASSERT_FALSE(slow());
    asked = 0;
    foreign_id = 0x60;
    begin_at(8000, ADXL345_I2C_FALLS_BACK);
    rig_run_ms(2000);
    TEST_ASSERT_FALSE(adxl345_i2c_fell_back());
}

/* A sensor that is not there, or lines that are held low, say nothing about the clock. */
TEST(test_other_faults_leave_the_clock)
{
    begin_at(1000, ADXL345_I2C_FALLS_BACK);
    rig_run_ms(300);
    adxl345_model_power(hal_host_sensor(), false);
    rig_run_ms(2000);
    adxl345_model_power(hal_host_sensor(), true);
    rig_run_ms(300);
    hal_host_faults()->sda_low = true;
    rig_run_ms(2000);
    hal_host_faults()->sda_low = false;
    rig_run_ms(300);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_FALSE(slow());
}
