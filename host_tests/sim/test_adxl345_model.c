/* The virtual ADXL345 against the data sheet, Rev. E; pages in the comments. */
#include <stddef.h>

#include "support/sensor_bus.h"
#include "support/test.h"

void setUp(void)
{
    sensor_bus_begin();
}

/* p. 23, register map: DEVID 0xE5, BW_RATE 0x0A, INT_SOURCE 0x02, everything else 0 */
TEST(test_p23_reset_values)
{
    for (uint8_t address = 0; address < 64; address++) {
        uint8_t expected = address == DEVID ? 0xE5 : address == BW_RATE ? 0x0A : address == INT_SOURCE ? 0x02 : 0x00;
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(expected, sensor_read(address), "register at reset");
    }
}

/* p. 23: 0x01..0x1C are reserved; DEVID, ACT_TAP_STATUS, INT_SOURCE, the data and FIFO_STATUS are read only */
TEST(test_p23_read_only_and_reserved_registers)
{
    for (uint8_t address = 0; address < 64; address++) {
        bool read_only = address < 0x1D || address == ACT_TAP_STATUS || address == INT_SOURCE ||
                         (address >= DATAX0 && address <= 0x37) || address >= FIFO_STATUS;
        uint8_t before = sensor_read(address);
        uint8_t value = address == POWER_CTL || address == INT_ENABLE ? 0x03 : 0x05;
        sensor_write(address, value);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(read_only ? before : value, sensor_model.reg[address], "register after a write");
    }
}

/* p. 24-27: bits that the register descriptions give as 0 stay 0 */
TEST(test_p24_unused_bits)
{
    sensor_write(BW_RATE, 0xFF);
    TEST_ASSERT_EQUAL_HEX8(0x1F, sensor_read(BW_RATE));
    sensor_write(POWER_CTL, 0xF4);
    TEST_ASSERT_EQUAL_HEX8(0x34, sensor_read(POWER_CTL));
    sensor_write(DATA_FORMAT, 0xFF);
    TEST_ASSERT_EQUAL_HEX8(0xEF, sensor_read(DATA_FORMAT));
}

/* p. 18: addresses 0x53 and 0x1D; a byte to another address is not acknowledged */
TEST(test_p18_address)
{
    TEST_ASSERT_FALSE(adxl345_model_start(&sensor_model, 0x1D << 1));
    TEST_ASSERT_FALSE(adxl345_model_write(&sensor_model, 0x00));
    TEST_ASSERT_FALSE(adxl345_model_start(&sensor_model, (0x1D << 1) | 1));
    TEST_ASSERT_EQUAL_HEX8(0xFF, adxl345_model_read(&sensor_model));
    sensor_model.address = 0x1D;
    TEST_ASSERT_TRUE(adxl345_model_start(&sensor_model, 0x1D << 1));
    TEST_ASSERT_FALSE(adxl345_model_start(&sensor_model, ADDRESS_WRITE));
}

/* p. 18-19, multiple-byte access: the pointer counts up and stays over a STOP */
TEST(test_p18_pointer)
{
    TEST_ASSERT_TRUE(adxl345_model_start(&sensor_model, ADDRESS_WRITE));
    TEST_ASSERT_TRUE(adxl345_model_write(&sensor_model, OFSX));
    for (uint8_t value = 1; value <= 3; value++) {
        TEST_ASSERT_TRUE(adxl345_model_write(&sensor_model, value));
    }
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_HEX8(1, sensor_model.reg[OFSX]);
    TEST_ASSERT_EQUAL_HEX8(3, sensor_model.reg[OFSX + 2]);
    sensor_begin_read(OFSX);
    TEST_ASSERT_EQUAL_HEX8(1, adxl345_model_read(&sensor_model));
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_TRUE(adxl345_model_start(&sensor_model, ADDRESS_READ)); /* without writing the pointer again */
    TEST_ASSERT_EQUAL_HEX8(2, adxl345_model_read(&sensor_model));
    TEST_ASSERT_EQUAL_HEX8(3, adxl345_model_read(&sensor_model));
}

/* p. 14, Table 7: 0x6 is 6.25 Hz and every step doubles up to 0xF, 3200 Hz; p. 25: standby and sleep give no data */
TEST(test_p14_output_data_rate)
{
    TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(&sensor_model));
    TEST_ASSERT_FALSE(sensor_tick(1, 2, 3));
    sensor_write(POWER_CTL, MEASURE);
    static const double rates[10] = { 6.25, 12.5, 25.0, 50.0, 100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0 };
    for (uint8_t i = 0; i < 10; i++) {
        sensor_write(BW_RATE, (uint8_t)(0x06 + i));
        TEST_ASSERT_EQUAL_DOUBLE(rates[i], adxl345_model_odr_hz(&sensor_model));
    }
    sensor_write(BW_RATE, 0x00);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.10, adxl345_model_odr_hz(&sensor_model));
    sensor_write(POWER_CTL, MEASURE | 0x04);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(&sensor_model));
    TEST_ASSERT_FALSE(sensor_tick(1, 2, 3));
    TEST_ASSERT_EQUAL_UINT(0, sensor_seen.latched);
}

/* p. 26: DATA_READY is a latched level that reading the data clears; the pin follows INT_ENABLE, the bit does not */
TEST(test_p26_data_ready)
{
    sensor_write(POWER_CTL, MEASURE);
    TEST_ASSERT_TRUE(sensor_tick(10, -20, 256));
    TEST_ASSERT_EQUAL_HEX8(DATA_READY | WATERMARK, sensor_read(INT_SOURCE));
    TEST_ASSERT_EQUAL_HEX8(DATA_READY | WATERMARK, sensor_read(INT_SOURCE)); /* reading INT_SOURCE does not */
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
    sensor_write(INT_ENABLE, DATA_READY);
    TEST_ASSERT_TRUE(sensor_model.pin_high[1]);
    TEST_ASSERT_FALSE(sensor_model.pin_high[2]);
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_INT16(10, sensor_read_word());
    TEST_ASSERT_EQUAL_INT16(-20, sensor_read_word());
    TEST_ASSERT_EQUAL_INT16(256, sensor_read_word());
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
    TEST_ASSERT_EQUAL_HEX8(WATERMARK, sensor_read(INT_SOURCE));
    TEST_ASSERT_EQUAL_UINT(1, sensor_seen.rises[1]);
    TEST_ASSERT_EQUAL_UINT(1, sensor_seen.falls[1]);
    TEST_ASSERT_EQUAL_UINT(1, sensor_seen.latched);
    TEST_ASSERT_EQUAL_INT16(-20, sensor_seen.last[1]);
    TEST_ASSERT_EQUAL_INT16(10, sensor_read_x()); /* the registers keep the value */
}

/* p. 26: INT_MAP 1 sends a bit to INT2; p. 27: INT_INVERT makes the pins active low */
TEST(test_p26_map_and_invert)
{
    sensor_write(INT_MAP, DATA_READY);
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(1, 1, 1);
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
    TEST_ASSERT_TRUE(sensor_model.pin_high[2]);
    sensor_write(DATA_FORMAT, FULL_RES_16G | 0x20);
    TEST_ASSERT_TRUE(sensor_model.pin_high[1]);
    TEST_ASSERT_FALSE(sensor_model.pin_high[2]);
    (void)sensor_read_x();
    TEST_ASSERT_TRUE(sensor_model.pin_high[2]);
}

/* p. 21: in bypass mode overrun means that new data replaced unread data */
TEST(test_p21_overrun_in_bypass)
{
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(1, 0, 0);
    TEST_ASSERT_EQUAL_HEX8(DATA_READY | WATERMARK, sensor_model.reg[INT_SOURCE]);
    sensor_tick(2, 0, 0);
    TEST_ASSERT_EQUAL_HEX8(DATA_READY | WATERMARK | OVERRUN, sensor_model.reg[INT_SOURCE]);
    TEST_ASSERT_EQUAL_UINT32(1, sensor_model.overruns);
    TEST_ASSERT_EQUAL_INT16(2, sensor_read_x());
    TEST_ASSERT_EQUAL_HEX8(WATERMARK, sensor_model.reg[INT_SOURCE]);
}

/* p. 21: a burst is not torn by a sample that arrives in it; that sample is there afterwards, with its own edge */
TEST(test_p21_burst_is_not_torn)
{
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(0x0101, 0x0101, 0x0101);
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_HEX8(0x01, adxl345_model_read(&sensor_model));
    sensor_tick(0x0202, 0x0202, 0x0202);
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_HEX8(0x01, adxl345_model_read(&sensor_model));
    }
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_UINT(2, sensor_seen.rises[1]);
    TEST_ASSERT_EQUAL_INT16(0x0202, sensor_read_x());
    TEST_ASSERT_EQUAL_UINT32(0, sensor_model.torn);
    TEST_ASSERT_EQUAL_UINT32(0, sensor_model.overruns);
}

/* The twin: without shadowing the burst mixes two samples, and the model counts it. */
TEST(test_without_shadowing_a_burst_is_torn)
{
    sensor_model.shadowing = false;
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(0x0101, 0x0101, 0x0101);
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_HEX8(0x01, adxl345_model_read(&sensor_model));
    sensor_tick(0x0202, 0x0202, 0x0202);
    TEST_ASSERT_EQUAL_HEX8(0x02, adxl345_model_read(&sensor_model));
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_UINT32(1, sensor_model.torn);
}

/* p. 4, 27: full resolution is 256 LSB/g with rails at the range; 10-bit mode divides by 2, 4, 8, has rails at 511 */
TEST(test_p4_range_and_resolution)
{
    static const struct {
        uint8_t format;
        int in, out;
    } cases[] = {
        { 0x08, 4095, 511 },   { 0x08, -4096, -512 },  { 0x09, 4095, 1023 }, { 0x09, -4096, -1024 },
        { 0x0A, 4095, 2047 },  { 0x0A, -4096, -2048 }, { 0x0B, 4095, 4095 }, { 0x0B, -4096, -4096 },
        { 0x08, 511, 511 },    { 0x0A, 2046, 2046 },   { 0x00, 4095, 511 },  { 0x00, 100, 100 },
        { 0x01, 100, 50 },     { 0x02, 100, 25 },      { 0x03, 100, 12 },    { 0x03, 4095, 511 },
        { 0x03, -4096, -512 }, { 0x03, -1, -1 },       { 0x02, -101, -26 },  { 0x01, 4095, 511 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        sensor_measure(cases[i].format, 0x00);
        sensor_tick(cases[i].in, 0, 0);
        TEST_ASSERT_EQUAL_INT16(cases[i].out, sensor_read_x());
    }
}

/* p. 27: Justify puts the sign bit at bit 15: 10 bits shift by 6, full resolution at 16 g (13 bits) by 3 */
TEST(test_p27_left_justified)
{
    sensor_measure(0x04, 0x00);
    sensor_tick(-3, 0, 0);
    TEST_ASSERT_EQUAL_INT16(-3 * 64, sensor_read_x());
    sensor_measure(0x0F, 0x00);
    sensor_tick(4095, 0, 0);
    TEST_ASSERT_EQUAL_INT16(4095 * 8, sensor_read_x());
    sensor_tick(-4096, 0, 0);
    TEST_ASSERT_EQUAL_INT16(-32768, sensor_read_x());
}

/* p. 32: at 1600 and 3200 Hz the LSB is always 0, in full resolution and in +-2 g 10-bit mode, not in the others */
TEST(test_p32_lsb_at_1600_and_3200_hz)
{
    for (uint8_t code = 0x0D; code <= 0x0F; code++) {
        sensor_write(BW_RATE, code);
        bool coarse = code >= 0x0E;
        sensor_measure(FULL_RES_16G, 0x00);
        sensor_tick(7, -7, 0);
        TEST_ASSERT_EQUAL_INT16(coarse ? -8 : -7, sensor_seen.last[1]);
        TEST_ASSERT_EQUAL_INT16(coarse ? 6 : 7, sensor_read_x());
        sensor_measure(0x00, 0x00);
        sensor_tick(7, 0, 0);
        TEST_ASSERT_EQUAL_INT16(coarse ? 6 : 7, sensor_read_x());
        sensor_measure(0x01, 0x00);
        sensor_tick(14, 0, 0);
        TEST_ASSERT_EQUAL_INT16(7, sensor_read_x());
    }
}

/* p. 24: offsets are 15.6 mg per LSB (4 LSB of 3.9 mg) at any range, added before the rails */
TEST(test_p24_offsets)
{
    sensor_write(OFSX, 0x7F);
    sensor_write(OFSX + 1, 0x80);
    sensor_write(OFSX + 2, 0xFF);
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(0, 0, 0);
    TEST_ASSERT_EQUAL_INT16(508, sensor_seen.last[0]);
    TEST_ASSERT_EQUAL_INT16(-512, sensor_seen.last[1]);
    TEST_ASSERT_EQUAL_INT16(-4, sensor_seen.last[2]);
    sensor_tick(4000, -4000, 256);
    TEST_ASSERT_EQUAL_INT16(4095, sensor_seen.last[0]);
    TEST_ASSERT_EQUAL_INT16(-4096, sensor_seen.last[1]);
    sensor_measure(0x03, 0x00); /* 10 bits at 16 g: 31.2 mg per LSB */
    sensor_tick(0, 0, 0);
    TEST_ASSERT_EQUAL_INT16(63, sensor_seen.last[0]);
}

/*
 * Limits of the self-test shift in full resolution at 2.5 V (p. 5 and Table 15, p. 31), times 1.77 on x and y and 1.47
 * on z for 3.3 V (Table 14): 89..955, -955..-89, 111..1286.
 */
TEST(test_p31_self_test_shift_is_within_the_limits)
{
    sensor_measure(FULL_RES_16G | 0x80, 0x00);
    for (int sample = 1; sample <= 5; sample++) {
        sensor_tick(0, 0, 256);
        TEST_ASSERT_EQUAL(sample < 5, sensor_seen.last[0] < 522);
    }
    TEST_ASSERT_INT_WITHIN(433, 522, sensor_seen.last[0]);
    TEST_ASSERT_INT_WITHIN(433, -522, sensor_seen.last[1]);
    TEST_ASSERT_INT_WITHIN(587, 698, sensor_seen.last[2] - 256);
}

/* 1.1 x 200 + 30 = 250; 0.9 x -100 - 7 = -97; 1.1 x 5 = 5.5, half up 6; OFSX adds 4; self-test comes on top of it. */
TEST(test_a_part_has_gain_offset_and_shift_of_its_own)
{
    sensor_model.part = (adxl345_part_t){ { 1.1, 0.9, 1.1 }, { 30, -7, 0 }, { 100, 0, -50 } };
    sensor_write(OFSX, 1);
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(200, -100, 5);
    TEST_ASSERT_EQUAL_INT16(254, sensor_seen.last[0]);
    TEST_ASSERT_EQUAL_INT16(-97, sensor_seen.last[1]);
    TEST_ASSERT_EQUAL_INT16(6, sensor_seen.last[2]);
    sensor_measure(FULL_RES_16G | 0x80, 0x00);
    for (int sample = 1; sample <= 5; sample++) {
        sensor_tick(200, -100, 5);
    }
    TEST_ASSERT_EQUAL_INT16(354, sensor_seen.last[0]);
    TEST_ASSERT_EQUAL_INT16(-97, sensor_seen.last[1]);
    TEST_ASSERT_EQUAL_INT16(-44, sensor_seen.last[2]);
    adxl345_model_power(&sensor_model, false);
    adxl345_model_power(&sensor_model, true);
    sensor_measure(FULL_RES_16G, 0x00);
    sensor_tick(200, -100, 5);
    TEST_ASSERT_EQUAL_INT16_MESSAGE(250, sensor_seen.last[0], "the part is the same after a power cycle, OFSX is 0");
}

/*
 * Power off: no acknowledge, pins low even when inverted. Power on: registers at reset, FIFO empty (p. 13, p. 30 for
 * offsets).
 */
TEST(test_power_cycle)
{
    sensor_write(OFSX, 9);
    sensor_measure(FULL_RES_16G | 0x20, 0x8A);
    sensor_tick(1, 1, 1);
    adxl345_model_power(&sensor_model, false);
    TEST_ASSERT_FALSE(adxl345_model_start(&sensor_model, ADDRESS_WRITE));
    TEST_ASSERT_FALSE(sensor_tick(2, 2, 2));
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
    TEST_ASSERT_FALSE(sensor_model.pin_high[2]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(&sensor_model));
    adxl345_model_power(&sensor_model, true);
    test_p23_reset_values();
}

/* A transfer that ends without STOP (the MCU was reset): the next START finds the sensor in order. */
TEST(test_start_after_an_abandoned_transfer)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    sensor_tick(1, 0, 0);
    sensor_tick(2, 0, 0);
    sensor_begin_read(DATAX0);
    (void)adxl345_model_read(&sensor_model);
    TEST_ASSERT_EQUAL_HEX8(0xE5, sensor_read(DEVID));
    TEST_ASSERT_EQUAL_INT16(2, sensor_read_x());
}

TEST(test_writes_while_measuring_are_counted)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    TEST_ASSERT_EQUAL_UINT32(0, sensor_model.writes_while_measuring);
    sensor_write(BW_RATE, 0x0B);
    TEST_ASSERT_EQUAL_UINT32(1, sensor_model.writes_while_measuring);
    sensor_write(POWER_CTL, 0x00);
    sensor_write(BW_RATE, 0x0A);
    TEST_ASSERT_EQUAL_UINT32(1, sensor_model.writes_while_measuring);
}
