/* What does and what does not end or clear something in the virtual ADXL345. Pages: data sheet, Rev. E. */
#include "support/sensor_bus.h"
#include "support/test.h"

enum { STREAM_MODE = 0x8A };

void setUp(void)
{
    sensor_bus_begin();
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT(0, sensor_seen.wrong);
}

/* p. 21: only bypass mode clears the FIFO; standby and Measure again leave what it holds. */
TEST(test_p21_entering_measure_does_not_clear_the_fifo)
{
    sensor_measure(FULL_RES_16G, STREAM_MODE);
    sensor_tick(1, 0, 0);
    sensor_tick(2, 0, 0);
    sensor_write(POWER_CTL, 0x00);
    TEST_ASSERT_EQUAL_HEX8(2, sensor_read(FIFO_STATUS));
    sensor_write(POWER_CTL, MEASURE);
    sensor_tick(3, 0, 0);
    TEST_ASSERT_EQUAL_HEX8(3, sensor_read(FIFO_STATUS));
    for (int16_t x = 1; x <= 3; x++) {
        TEST_ASSERT_EQUAL_INT16(x, sensor_read_x());
    }
    TEST_ASSERT_FALSE(sensor_model.pin_high[1]);
}

/* p. 26: "DATA_READY ... cleared only when the data is read": not by reading INT_SOURCE, with the FIFO on either. */
TEST(test_p26_reading_int_source_keeps_data_ready)
{
    sensor_measure(FULL_RES_16G, STREAM_MODE);
    sensor_tick(1, 0, 0);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_HEX8(DATA_READY, sensor_read(INT_SOURCE) & DATA_READY);
        TEST_ASSERT_TRUE(sensor_model.pin_high[1]);
    }
    TEST_ASSERT_EQUAL_INT16(1, sensor_read_x());
    TEST_ASSERT_EQUAL_HEX8(0, sensor_read(INT_SOURCE) & DATA_READY);
    TEST_ASSERT_EQUAL_UINT(1, sensor_seen.falls[1]);
}

/* p. 26: the bits of events are those that reading INT_SOURCE clears. */
TEST(test_p26_reading_int_source_clears_events)
{
    sensor_measure(FULL_RES_16G, STREAM_MODE);
    sensor_tick(1, 0, 0);
    adxl345_model_event(&sensor_model, 0x40);
    TEST_ASSERT_EQUAL_HEX8(0x40 | DATA_READY, sensor_read(INT_SOURCE) & (0x7C | DATA_READY));
    TEST_ASSERT_EQUAL_HEX8(DATA_READY, sensor_read(INT_SOURCE) & (0x7C | DATA_READY));
}

/* p. 21: the read of an entry ends with the transfer or a repeated START. Two bytes read: the entry is gone. */
TEST(test_p21_a_repeated_start_ends_a_data_read)
{
    sensor_measure(FULL_RES_16G, STREAM_MODE);
    sensor_tick(1, 0, 0);
    sensor_tick(2, 0, 0);
    sensor_begin_read(DATAX0);
    TEST_ASSERT_EQUAL_INT16(1, sensor_read_word());
    TEST_ASSERT_EQUAL_UINT8(2, sensor_model.fifo_count);
    TEST_ASSERT_TRUE(adxl345_model_start(&sensor_model, ADDRESS_WRITE)); /* no STOP before */
    TEST_ASSERT_EQUAL_UINT8(1, sensor_model.fifo_count);
    TEST_ASSERT_TRUE(adxl345_model_write(&sensor_model, DATAX0));
    TEST_ASSERT_TRUE(adxl345_model_start(&sensor_model, ADDRESS_READ));
    TEST_ASSERT_EQUAL_UINT8(1, sensor_model.fifo_count); /* no data read since: nothing to end */
    TEST_ASSERT_EQUAL_INT16(2, sensor_read_word());
    adxl345_model_stop(&sensor_model);
    TEST_ASSERT_EQUAL_UINT8(0, sensor_model.fifo_count);
    TEST_ASSERT_EQUAL_UINT32(2, sensor_model.data_reads);
}
