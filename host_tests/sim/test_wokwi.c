/*
 * The chip for Wokwi on the PC: this file is Wokwi's side of the API, and the master of its I2C bus. What Wokwi itself
 * does is not tested here (wokwi/README.md).
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "adxl345_model.h"
#include "adxl345_registers.h"
#include "support/test.h"
#include "wokwi-api.h"

enum { PINS = 4, ATTRIBUTES = 5, NAME_SIZE = 16, ADDRESS = 0x53 };

static char pins[PINS][NAME_SIZE];
static uint32_t level[PINS], pin_count;
static char attributes[ATTRIBUTES][NAME_SIZE];
static float value[ATTRIBUTES], alt_address;
static uint32_t attribute_count;
static timer_config_t timer;
static uint64_t timer_ns; /* 0: stopped */
static i2c_config_t bus;

pin_t pin_init(const char *name, uint32_t mode)
{
    strcpy(pins[pin_count], name);
    level[pin_count] = mode == OUTPUT_LOW ? LOW : HIGH;
    return (pin_t)pin_count++;
}

void pin_write(pin_t pin, uint32_t now)
{
    level[pin] = now;
}

uint32_t attr_init_float(const char *name, float default_value)
{
    strcpy(attributes[attribute_count], name);
    value[attribute_count] = default_value;
    return attribute_count++;
}

uint32_t attr_init(const char *name, uint32_t default_value)
{
    TEST_ASSERT_EQUAL_STRING("altAddress", name);
    return attr_init_float(name, (float)default_value + alt_address);
}

uint32_t attr_read(uint32_t attribute)
{
    return (uint32_t)value[attribute];
}

float attr_read_float(uint32_t attribute)
{
    return value[attribute];
}

timer_t timer_init(const timer_config_t *config)
{
    timer = *config;
    return 7;
}

void timer_start_ns(timer_t which, uint64_t nanos, bool repeat)
{
    TEST_ASSERT_EQUAL_UINT32(7, which);
    TEST_ASSERT_FALSE(repeat);
    timer_ns = nanos;
}

void timer_stop(timer_t which)
{
    TEST_ASSERT_EQUAL_UINT32(7, which);
    timer_ns = 0;
}

i2c_dev_t i2c_init(const i2c_config_t *config)
{
    bus = *config;
    return 0;
}

static uint32_t pin_level(const char *name)
{
    for (uint32_t i = 0; i < pin_count; i++) {
        if (strcmp(pins[i], name) == 0) {
            return level[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return LOW;
}

static void set(const char *name, float to)
{
    for (uint32_t i = 0; i < attribute_count; i++) {
        if (strcmp(attributes[i], name) == 0) {
            value[i] = to;
            return;
        }
    }
    TEST_FAIL_MESSAGE(name);
}

static void write_register(uint8_t address, uint8_t byte)
{
    TEST_ASSERT_TRUE(bus.connect(bus.user_data, ADDRESS, false));
    TEST_ASSERT_TRUE(bus.write(bus.user_data, address));
    TEST_ASSERT_TRUE(bus.write(bus.user_data, byte));
    bus.disconnect(bus.user_data);
}

/* With a repeated START, as most masters read. */
static void read_registers(uint8_t address, uint8_t *bytes, int count)
{
    TEST_ASSERT_TRUE(bus.connect(bus.user_data, ADDRESS, false));
    TEST_ASSERT_TRUE(bus.write(bus.user_data, address));
    TEST_ASSERT_TRUE(bus.connect(bus.user_data, ADDRESS, true));
    for (int i = 0; i < count; i++) {
        bytes[i] = bus.read(bus.user_data);
    }
    bus.disconnect(bus.user_data);
}

static void read_xyz(int16_t lsb[3])
{
    uint8_t bytes[6];
    read_registers(ADXL345_DATAX0, bytes, 6);
    for (int axis = 0; axis < 3; axis++) {
        lsb[axis] = (int16_t)(bytes[2 * axis] | bytes[2 * axis + 1] << 8);
    }
}

/* The timer fires once. */
static void sample(void)
{
    TEST_ASSERT_NOT_EQUAL_UINT64(0, timer_ns);
    timer.callback(timer.user_data);
}

static void measure(void)
{
    write_register(ADXL345_DATA_FORMAT, 0x0B); /* full resolution, 16 g */
    write_register(ADXL345_INT_ENABLE, 0x80);
    write_register(ADXL345_POWER_CTL, 0x08);
}

void setUp(void)
{
    pin_count = attribute_count = 0;
    timer_ns = 0;
    alt_address = 0.0F;
    chip_init();
    set("noise", 0.0F);
}

void tearDown(void)
{
    free(bus.user_data);
}

TEST(test_the_master_finds_the_part)
{
    uint8_t id = 0;
    TEST_ASSERT_EQUAL_HEX32(ADDRESS, bus.address);
    read_registers(ADXL345_DEVID, &id, 1);
    TEST_ASSERT_EQUAL_HEX8(0xE5, id);
    TEST_ASSERT_FALSE(bus.connect(bus.user_data, 0x1D, false));
}

TEST(test_alt_address_moves_it)
{
    tearDown();
    pin_count = attribute_count = 0;
    alt_address = 1.0F;
    chip_init();
    TEST_ASSERT_EQUAL_HEX32(0x1D, bus.address);
    TEST_ASSERT_TRUE(bus.connect(bus.user_data, 0x1D, false));
    TEST_ASSERT_FALSE(bus.connect(bus.user_data, ADDRESS, false));
}

TEST(test_it_measures_the_tilt_of_the_sliders)
{
    static const struct {
        float roll, pitch;
        int16_t lsb[3];
    } cases[] = { { 0, 0, { 0, 0, 256 } },    { 90, 0, { 0, 256, 0 } },    { 0, 90, { -256, 0, 0 } },
                  { 30, 0, { 0, 128, 222 } }, { 0, -30, { 128, 0, 222 } }, { 180, 0, { 0, 0, -256 } } };
    measure();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int16_t lsb[3];
        set("roll", cases[i].roll);
        set("pitch", cases[i].pitch);
        sample();
        read_xyz(lsb);
        TEST_ASSERT_EQUAL_INT16_ARRAY(cases[i].lsb, lsb, 3);
    }
}

/* Data sheet p. 5: the first sample comes 1.1 ms and a period after Measure is set. */
TEST(test_samples_come_at_the_output_data_rate)
{
    TEST_ASSERT_EQUAL_UINT64(0, timer_ns);
    measure();
    TEST_ASSERT_EQUAL_UINT64(11100000, timer_ns);
    sample();
    TEST_ASSERT_EQUAL_UINT64(10000000, timer_ns);
    write_register(ADXL345_BW_RATE, 0x0F);
    TEST_ASSERT_EQUAL_UINT64(312500, timer_ns);
    write_register(ADXL345_POWER_CTL, 0x00);
    TEST_ASSERT_EQUAL_UINT64(0, timer_ns);
}

TEST(test_int1_rises_with_a_sample_and_falls_when_it_is_read)
{
    int16_t lsb[3];
    measure();
    TEST_ASSERT_EQUAL_UINT32(LOW, pin_level("INT1"));
    sample();
    TEST_ASSERT_EQUAL_UINT32(HIGH, pin_level("INT1"));
    TEST_ASSERT_EQUAL_UINT32(LOW, pin_level("INT2"));
    read_xyz(lsb);
    TEST_ASSERT_EQUAL_UINT32(LOW, pin_level("INT1"));
}

/* 4,000 samples: mean and number of outliers within 5 standard errors, the deviation within 10 %. */
TEST(test_noise_and_outliers_are_as_large_as_the_sliders_say)
{
    enum { COUNT = 4000 };
    double sum = 0.0, squares = 0.0;
    int outliers = 0;
    set("noise", 4.0F);
    measure();
    for (int i = 0; i < COUNT; i++) {
        int16_t lsb[3];
        sample();
        read_xyz(lsb);
        sum += lsb[0];
        squares += (double)lsb[0] * lsb[0];
    }
    TEST_ASSERT_DOUBLE_WITHIN(5.0 * 4.0 / sqrt(COUNT), 0.0, sum / COUNT);
    TEST_ASSERT_DOUBLE_WITHIN(0.4, 4.0, sqrt(squares / COUNT));
    set("noise", 0.0F);
    set("outliers", 10.0F);
    for (int i = 0; i < COUNT; i++) {
        int16_t lsb[3];
        sample();
        read_xyz(lsb);
        outliers += lsb[0] != 0;
        TEST_ASSERT_INT16_WITHIN(512, 0, lsb[0]);
    }
    TEST_ASSERT_INT_WITHIN(95, COUNT / 10, outliers);
}
