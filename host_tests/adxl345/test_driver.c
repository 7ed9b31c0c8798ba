/* The ADXL345 driver and its bus on the host's HAL, against the sensor model and with scripted bus events. */
#include "adxl345.h"
#include "adxl345_registers.h"
#include "hal_drdy.h"
#include "hal_host.h"
#include "hal_i2c.h"
#include "support/rig.h"
#include "support/test.h"

/* START, address, register, repeated START, address, two bytes, six of data, two more. */
enum { FIRST_DATA_EVENT = 7, EVENTS_PER_BURST = 15 };

static const adxl345_config_t at_100_hz = { 1000, 16, false, 0 };

void setUp(void)
{
    rig_begin(100.0, (hal_host_config_t){ .time_start_us = 0xFFFFFFFFu - 300000u });
    rig.limit_us = UINT32_MAX; /* each test says what it may be */
}

TEST(test_configures_as_designed)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(50);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0x0A, hal_host_sensor()->reg[ADXL345_BW_RATE]);
    TEST_ASSERT_EQUAL_HEX8(0x0B, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
    TEST_ASSERT_EQUAL_HEX8(0x8A, hal_host_sensor()->reg[ADXL345_FIFO_CTL]);
    TEST_ASSERT_EQUAL_HEX8(0x80, hal_host_sensor()->reg[ADXL345_INT_ENABLE]);
    TEST_ASSERT_EQUAL_HEX8(0x00, hal_host_sensor()->reg[ADXL345_INT_MAP]);
    TEST_ASSERT_EQUAL_HEX8(0x08, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
}

TEST(test_rates_and_ranges_reach_the_registers)
{
    static const struct {
        uint16_t rate_dhz;
        uint8_t code;
    } rates[] = { { 125, 7 }, { 250, 8 }, { 500, 9 }, { 1000, 10 }, { 2000, 11 }, { 4000, 12 }, { 8000, 13 } };
    static const struct {
        uint8_t range_g;
        uint8_t format;
    } ranges[] = { { 2, 0x08 }, { 4, 0x09 }, { 8, 0x0A }, { 16, 0x0B } };
    for (size_t i = 0; i < 7; i++) {
        adxl345_config_t config = { rates[i].rate_dhz, ranges[i % 4].range_g, false, 0 };
        TEST_ASSERT_TRUE(adxl345_config_valid(&config));
        adxl345_start(&config);
        rig_run_ms(300);
        TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
        TEST_ASSERT_EQUAL_HEX8(rates[i].code, hal_host_sensor()->reg[ADXL345_BW_RATE]);
        TEST_ASSERT_EQUAL_HEX8(ranges[i % 4].format, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
    }
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}

/* DATA_FORMAT's bit 7 (p. 26), in every reading too; the sensor keeps it over a reset of the MCU, and it is cleared. */
TEST(test_self_test_is_set_and_cleared)
{
    static const adxl345_config_t with_force = { 1000, 16, true, 0 };
    static const adxl345_part_t unmoved = { { 1.0, 1.0, 1.0 }, { 0, 0, 0 }, { 0, 0, 0 } }; /* as the rig checks */
    hal_host_sensor()->part = unmoved;
    adxl345_start(&with_force);
    rig_run_ms(300);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0x8B, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
    adxl345_readings_t readings;
    adxl345_readings(&readings);
    TEST_ASSERT_EQUAL_UINT16(0, readings.failed);
    adxl345_start(&at_100_hz);
    rig_run_ms(300);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0x0B, hal_host_sensor()->reg[ADXL345_DATA_FORMAT]);
}

/* Without SELF_TEST the configuration is not what was asked for: READ_BACK, never streaming. */
TEST(test_a_self_test_bit_that_is_not_kept_is_found)
{
    static const adxl345_config_t with_force = { 1000, 16, true, 0 };
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    hal_host_faults()->write_lost_register = ADXL345_DATA_FORMAT;
    adxl345_start(&with_force);
    rig_run_ms(300);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_READ_BACK, adxl345_fault());
    hal_host_faults()->write_lost_register = 0;
}

TEST(test_refuses_rates_and_ranges_the_chip_lacks)
{
    static const adxl345_config_t wrong[] = { { 0, 16, false, 0 },     { 124, 16, false, 0 },   { 1001, 16, false, 0 },
                                              { 16000, 16, false, 0 }, { 32000, 16, false, 0 }, { 1000, 0, false, 0 },
                                              { 1000, 3, false, 0 },   { 1000, 32, false, 0 } };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        TEST_ASSERT_FALSE(adxl345_config_valid(&wrong[i]));
    }
}

TEST(test_stamps_are_those_of_data_ready)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(2000);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    TEST_ASSERT_TRUE(rig.off_us <= 1);
    TEST_ASSERT_UINT32_WITHIN(1, 10000, adxl345_period_us());
}

TEST(test_finds_the_alternate_address)
{
    hal_host_sensor()->address = 0x1D;
    adxl345_start(&at_100_hz);
    rig_run_ms(60);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(0x1D, adxl345_address());
}

TEST(test_no_sensor_is_named_and_comes_back)
{
    adxl345_model_power(hal_host_sensor(), false);
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NO_SENSOR, adxl345_fault());
    adxl345_model_power(hal_host_sensor(), true);
    rig_run_ms(150);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}

TEST(test_wrong_identity_is_named)
{
    hal_host_faults()->id_wrong = true;
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_WRONG_ID, adxl345_fault());
    TEST_ASSERT_EQUAL_HEX8(0x00, adxl345_foreign_id());
    TEST_ASSERT_EQUAL_HEX8(0x53, adxl345_foreign_address());
}

TEST(test_register_that_does_not_keep_its_value_is_named)
{
    hal_host_faults()->write_lost_register = ADXL345_BW_RATE;
    static const adxl345_config_t at_400_hz = { 4000, 16, false, 0 };
    adxl345_start(&at_400_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_READ_BACK, adxl345_fault());
    hal_host_faults()->write_lost_register = 0;
    rig_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

TEST(test_silent_int1_is_named)
{
    hal_host_faults()->int1_cut = true;
    adxl345_start(&at_100_hz);
    rig_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_INT1_SILENT, adxl345_fault());
    hal_host_faults()->int1_cut = false;
    rig_run_ms(200);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/* A reset in the middle of a read leaves the sensor holding SDA until it has been clocked through its byte. */
TEST(test_slave_hung_in_a_byte_is_clocked_free)
{
    hal_host_faults()->hang_clocks = 9;
    adxl345_start(&at_100_hz);
    rig_run_ms(50);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    hal_host_faults()->hang_clocks = 9;
    rig_run_ms(100);
    TEST_ASSERT_EQUAL_UINT8(0, hal_host_faults()->hang_clocks);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

TEST(test_sensor_power_cycle_is_noticed)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(500);
    adxl345_model_power(hal_host_sensor(), false);
    adxl345_model_power(hal_host_sensor(), true);
    for (double end_ms = hal_host_now_ms() + 15; adxl345_fault() != ADXL345_FAULT_NO_DATA;) {
        TEST_ASSERT_TRUE(hal_host_now_ms() < end_ms);
        rig_pass();
    }
    rig_run_ms(40);
    TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
}

/* The classic: the UNO was reset, the sensor was not. INT1 has been high for long and no edge will come. */
TEST(test_latched_int1_after_an_mcu_reset)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(500);
    rig.leaves = true;
    rig_run_ms(1000);
    TEST_ASSERT_TRUE(hal_drdy_high());
    hal_host_reset_mcu(1);
    rig_reset();
    rig.leaves = false;
    rig.taken_count = 0;
    rig.next = rig.latched_count; /* no sample of before the reset may come */
    adxl345_start(&at_100_hz);
    rig_run_ms(1000);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_INT_WITHIN(5, 100, (int)rig.taken_count);
}

/* Main stalls for 300 ms: 30 samples wait, 7 in the queue, the rest in the FIFO; none is lost, stamps within 1 %. */
TEST(test_late_reads_are_drained_with_interpolated_stamps)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(1000);
    rig.leaves = true;
    rig_run_ms(300);
    rig.leaves = false;
    rig_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    TEST_ASSERT_TRUE(rig.off_us <= 100);
    adxl345_counters_t counters;
    adxl345_counters(&counters);
    TEST_ASSERT_GREATER_THAN(15, counters.samples_drained);
}

static const uint8_t disturbances[] = { HAL_I2C_BUS_ERROR,
                                        HAL_I2C_WRITE_ADDRESS_NACK,
                                        HAL_I2C_READ_ADDRESS_NACK,
                                        HAL_I2C_SENT_NACK,
                                        HAL_I2C_ARBITRATION_LOST,
                                        HAL_I2C_NOTHING,
                                        0x60,
                                        0xA8,
                                        0xC0,
                                        0x70 };

static void disturb_bursts(unsigned first_event, unsigned end_event)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    for (size_t s = 0; s < sizeof disturbances; s++) {
        for (unsigned event = first_event; event < end_event; event++) {
            while (hal_drdy_high()) {
                rig_run_ms(0.1); /* the burst that runs is not the one to disturb */
            }
            hal_host_faults()->status_skip = event;
            hal_host_faults()->next_status = disturbances[s];
            rig_run_ms(25);
            TEST_ASSERT_EQUAL(-1, hal_host_faults()->next_status);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_NONE, adxl345_fault());
        }
    }
    rig_run_ms(100);
}

/* Before the first data byte the sample is still in the sensor: it is read again with the stamp of its edge. */
TEST(test_disturbed_before_the_data_nothing_is_lost)
{
    disturb_bursts(0, FIRST_DATA_EVENT);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
    TEST_ASSERT_TRUE(rig.off_us <= 1);
}

/* A burst cut inside its data takes the entry out of the FIFO (p. 21): that sample is lost, no other; none is wrong. */
TEST(test_disturbed_inside_the_data_loses_that_sample_only)
{
    disturb_bursts(FIRST_DATA_EVENT, EVENTS_PER_BURST);
    size_t faults = sizeof disturbances * (EVENTS_PER_BURST - FIRST_DATA_EVENT);
    TEST_ASSERT_TRUE(rig_lost(60) <= faults);
}

/* A change of rate at any phase of a burst delivers what was latched before and after. */
TEST(test_rate_change_at_every_phase)
{
    static const uint16_t rates[] = { 1000, 4000, 2000, 8000 };
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    for (unsigned i = 0; i < 200; i++) {
        adxl345_config_t config = { rates[i % 4], 16, false, 0 };
        rig_run_ms(20.0 + (double)i * 0.053);
        adxl345_start(&config);
    }
    rig_run_ms(200);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(60));
}

TEST(test_stop_delivers_the_last_samples_and_stands_by)
{
    adxl345_start(&at_100_hz);
    rig_run_ms(333);
    TEST_ASSERT_EQUAL_size_t(0, rig_lost(50));
    TEST_ASSERT_EQUAL_HEX8(0x00, hal_host_sensor()->reg[ADXL345_POWER_CTL]);
    adxl345_start(&at_100_hz);
    rig_run_ms(100);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
}
