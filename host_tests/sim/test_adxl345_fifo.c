/* The FIFO of the virtual ADXL345 against the data sheet, Rev. E; pages in the comments. */
#include <stddef.h>

#include "support/sensor_bus.h"
#include "support/test.h"

void setUp(void)
{
    sensor_bus_begin();
}

/* p. 21, 27: stream mode keeps the newest 33; entries; one triplet per burst; DATA_READY while anything is left */
TEST(test_p21_stream_fifo)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    for (int i = 1; i <= 40; i++) {
        sensor_tick(i, 0, 0);
        uint8_t entries = (uint8_t)(i < 33 ? i : 33);
        TEST_ASSERT_EQUAL_HEX8(entries, sensor_read(FIFO_STATUS));
        TEST_ASSERT_EQUAL_HEX8(i >= 10 ? WATERMARK : 0, sensor_model.reg[INT_SOURCE] & WATERMARK);
        TEST_ASSERT_EQUAL_HEX8(i >= 32 ? OVERRUN : 0, sensor_model.reg[INT_SOURCE] & OVERRUN);
    }
    TEST_ASSERT_EQUAL_UINT32(7, sensor_model.overruns);
    TEST_ASSERT_EQUAL_UINT(40, sensor_seen.latched);
    for (int i = 8; i <= 40; i++) {
        TEST_ASSERT_TRUE(sensor_model.pin_high[1]);
        TEST_ASSERT_EQUAL_INT16(i, sensor_read_x());
        TEST_ASSERT_EQUAL_HEX8(0, sensor_model.reg[INT_SOURCE] & OVERRUN);
        TEST_ASSERT_EQUAL_HEX8(40 - i >= 10 ? WATERMARK : 0, sensor_model.reg[INT_SOURCE] & WATERMARK);
    }
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
    TEST_ASSERT_EQUAL_HEX8(0, sensor_read(FIFO_STATUS));
    TEST_ASSERT_EQUAL_UINT(1, sensor_seen.rises[1]);
    TEST_ASSERT_EQUAL_INT16(40, sensor_read_x()); /* empty: the last one again */
}

/* p. 21: FIFO mode stops collecting when it is full, so the oldest stay */
TEST(test_p21_fifo_mode_keeps_the_oldest)
{
    sensor_measure(FULL_RES_16G, 0x5F);
    for (int i = 1; i <= 40; i++) {
        sensor_tick(i, 0, 0);
    }
    TEST_ASSERT_EQUAL_UINT32(7, sensor_model.overruns);
    TEST_ASSERT_EQUAL_UINT(33, sensor_seen.latched);
    for (int i = 1; i <= 33; i++) {
        TEST_ASSERT_EQUAL_INT16(i, sensor_read_x());
    }
    TEST_ASSERT_EQUAL_HEX8(0, sensor_read(FIFO_STATUS));
    sensor_tick(50, 0, 0);
    TEST_ASSERT_EQUAL_INT16(50, sensor_read_x());
}

/* p. 21: trigger mode keeps the last n before the event, then fills up like FIFO mode; bypass resets it */
TEST(test_p21_trigger_mode)
{
    sensor_write(INT_MAP, 0x10);                   /* activity on INT2 */
    sensor_measure(FULL_RES_16G, 0xC0 | 0x20 | 4); /* trigger on INT2, 4 samples */
    sensor_write(INT_ENABLE, 0x10);
    for (int i = 1; i <= 50; i++) {
        sensor_tick(i, 0, 0);
    }
    TEST_ASSERT_EQUAL_HEX8(33, sensor_read(FIFO_STATUS));
    adxl345_model_event(&sensor_model, 0x10);
    TEST_ASSERT_TRUE(sensor_model.pin_high[2]);
    TEST_ASSERT_EQUAL_HEX8(0x80 | 4, sensor_read(FIFO_STATUS));
    for (int i = 51; i <= 90; i++) {
        sensor_tick(i, 0, 0);
    }
    for (int i = 47; i <= 79; i++) { /* 4 before, 29 after: 33 in all */
        TEST_ASSERT_EQUAL_INT16(i, sensor_read_x());
    }
    TEST_ASSERT_EQUAL_HEX8(0x10, sensor_read(INT_SOURCE) & 0x10);
    TEST_ASSERT_FALSE(sensor_model.pin_high[2]); /* p. 26: cleared by reading INT_SOURCE */
    TEST_ASSERT_EQUAL_HEX8(0x80, sensor_read(FIFO_STATUS));
    sensor_write(FIFO_CTL, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0x00, sensor_read(FIFO_STATUS));
}

/* p. 21: a burst ends at the step from 0x37 to 0x38, so reading on shows FIFO_CTL and the entries that are left */
TEST(test_p21_reading_on_into_fifo_ctl_and_status)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    sensor_tick(5, 6, 7);
    sensor_tick(8, 9, 10);
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_INT16(5, sensor_read_word());
    TEST_ASSERT_EQUAL_INT16(6, sensor_read_word());
    TEST_ASSERT_EQUAL_INT16(7, sensor_read_word());
    TEST_ASSERT_EQUAL_HEX8(0x8A, adxl345_model_read(&sensor_model));
    TEST_ASSERT_EQUAL_HEX8(1, adxl345_model_read(&sensor_model));
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_INT16(8, sensor_read_x());
    TEST_ASSERT_EQUAL_UINT32(2, sensor_model.data_reads);
}

/* p. 27: a short read of a FIFO entry loses the rest of it */
TEST(test_p27_short_read_loses_the_rest)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    sensor_tick(5, 6, 7);
    sensor_tick(8, 9, 10);
    (void)sensor_read(DATAX0);
    TEST_ASSERT_EQUAL_INT16(8, sensor_read_x());
}

/*
 * A sample that arrives while the only entry is being read: nothing is torn or lost, and INT1 stays high without an
 * edge.
 */
TEST(test_stream_fifo_sample_inside_a_burst)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    sensor_tick(0x0101, 0x0101, 0x0101);
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    sensor_tick(0x0202, 0x0202, 0x0202);
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_TRUE(sensor_model.pin_high[1]);
    TEST_ASSERT_EQUAL_UINT(1, sensor_seen.rises[1]);
    TEST_ASSERT_EQUAL_INT16(0x0202, sensor_read_x());
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
}

/* The same with the FIFO full: the burst still shows one sample, and exactly one is lost afterwards. */
TEST(test_stream_fifo_full_inside_a_burst)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    for (int i = 1; i <= 33; i++) {
        sensor_tick(i * 0x0101, i * 0x0101, 0);
    }
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    sensor_tick(34 * 0x0101 % 4096, 0, 0);
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    (void)sensor_read_word();
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_UINT32(0, sensor_model.overruns);
    TEST_ASSERT_EQUAL_HEX8(33, sensor_read(FIFO_STATUS));
    TEST_ASSERT_EQUAL_INT16(0x0202, sensor_read_x());
}

/* p. 27: Samples = 0 sets the watermark at once; in bypass mode other values never do */
TEST(test_p27_watermark_of_zero_and_in_bypass)
{
    sensor_write(FIFO_CTL, 0x80);
    TEST_ASSERT_EQUAL_HEX8(WATERMARK, sensor_read(INT_SOURCE));
    sensor_write(FIFO_CTL, 0x01);
    sensor_write(POWER_CTL, MEASURE);
    sensor_tick(1, 1, 1);
    TEST_ASSERT_EQUAL_HEX8(DATA_READY, sensor_read(INT_SOURCE));
}

/* p. 14, 21: standby keeps the FIFO, bypass clears it */
TEST(test_p21_standby_keeps_bypass_clears)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    sensor_tick(1, 0, 0);
    sensor_tick(2, 0, 0);
    sensor_write(POWER_CTL, 0x00);
    TEST_ASSERT_FALSE(sensor_tick(3, 0, 0));
    TEST_ASSERT_EQUAL_HEX8(2, sensor_read(FIFO_STATUS));
    TEST_ASSERT_EQUAL_INT16(1, sensor_read_x());
    TEST_ASSERT_TRUE(sensor_model.pin_high[1]);
    sensor_write(FIFO_CTL, 0x00);
    TEST_ASSERT_EQUAL_HEX8(0, sensor_read(FIFO_STATUS));
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
}

/* A sample that arrives while the empty FIFO is being read does not tear the registers. */
TEST(test_stream_fifo_empty_inside_a_burst)
{
    sensor_measure(FULL_RES_16G, 0x8A);
    sensor_tick(0x0101, 0x0101, 0x0101);
    (void)sensor_read_x();
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_HEX8(0x01, adxl345_model_read(&sensor_model));
    sensor_tick(0x0202, 0x0202, 0x0202);
    TEST_ASSERT_EQUAL_HEX8(0x01, adxl345_model_read(&sensor_model));
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    TEST_ASSERT_EQUAL_INT16(0x0101, sensor_read_word());
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_HEX8(1, sensor_read(FIFO_STATUS));
    TEST_ASSERT_EQUAL_INT16(0x0202, sensor_read_x());
}
