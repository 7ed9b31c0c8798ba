/* The sensors that resemble an ADXL345, each against figures of its data sheet (named in adxl345_variants.c). */
#include <stddef.h>

#include "adxl345_variants.h"
#include "support/sensor_bus.h"
#include "support/test.h"

void setUp(void)
{
    sensor_bus_begin();
}

static void become(const char *name)
{
    const adxl345_variant_t *variant = adxl345_variant_named(name);
    TEST_ASSERT_NOT_NULL_MESSAGE(variant, name);
    adxl345_model_become(&sensor_model, variant);
}

/* What is read of so many g on x with this DATA_FORMAT. */
static int16_t reads(uint8_t format, int g)
{
    sensor_measure(format, 0x00);
    TEST_ASSERT_TRUE(sensor_tick(g * 256, 0, 0));
    int16_t lsb = sensor_read_x();
    sensor_write(POWER_CTL, 0x00);
    return lsb;
}

TEST(test_the_name_decides)
{
    TEST_ASSERT_NULL(adxl345_variant_named("adxl34"));
    TEST_ASSERT_NULL(adxl345_variant_named("adxl3455"));
    TEST_ASSERT_NULL(adxl345_variant_named(""));
    for (size_t i = 0; i < adxl345_variant_count; i++) {
        TEST_ASSERT_EQUAL_PTR(&adxl345_variants[i], adxl345_variant_named(adxl345_variants[i].name));
    }
    TEST_ASSERT_EQUAL_PTR(adxl345_itself, adxl345_variant_named("adxl345"));
}

TEST(test_devid)
{
    static const struct {
        const char *name;
        uint8_t devid;
    } known[] = { { "adxl345", 0xE5 }, { "adxl343", 0xE5 }, { "adxl344", 0xE6 }, { "adxl346", 0xE6 },
                  { "adxl375", 0xE5 }, { "adxl312", 0xE5 }, { "adxl313", 0xAD }, { "adxl314", 0xE5 } };
    TEST_ASSERT_EQUAL_size_t(adxl345_variant_count, sizeof known / sizeof known[0]);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        become(known[i].name);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(known[i].devid, sensor_read(DEVID), known[i].name);
        adxl345_model_power(&sensor_model, false);
        adxl345_model_power(&sensor_model, true);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(known[i].devid, sensor_read(DEVID), known[i].name);
    }
}

/* 3.9 mg/LSB in full resolution, 31.2 mg/LSB in 10 bits at 16 g */
TEST(test_scale_of_those_like_an_adxl345)
{
    static const char *const names[] = { "adxl345", "adxl343", "adxl344", "adxl346" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        become(names[i]);
        TEST_ASSERT_EQUAL_INT16(256, reads(0x0B, 1));
        TEST_ASSERT_EQUAL_INT16(32, reads(0x03, 1));
        TEST_ASSERT_EQUAL_INT16(511, reads(0x08, 3));
        TEST_ASSERT_EQUAL_DOUBLE(2.0, adxl345_model_range_g(&sensor_model));
    }
}

/* 2.9 mg/LSB in full resolution at each range; 10 bits at 1.5 g and 13 at 12 g */
TEST(test_scale_of_an_adxl312)
{
    become("adxl312");
    TEST_ASSERT_EQUAL_INT16(345, reads(0x0B, 1));
    TEST_ASSERT_EQUAL_INT16(3448, reads(0x0B, 10));
    TEST_ASSERT_EQUAL_INT16(4095, reads(0x0B, 13));
    TEST_ASSERT_EQUAL_DOUBLE(12.0, adxl345_model_range_g(&sensor_model));
    TEST_ASSERT_EQUAL_INT16(43, reads(0x03, 1)); /* 2.9 mg times 8 */
    TEST_ASSERT_EQUAL_INT16(345, reads(0x08, 1));
    TEST_ASSERT_EQUAL_INT16(511, reads(0x08, 2));
    TEST_ASSERT_EQUAL_DOUBLE(1.5, adxl345_model_range_g(&sensor_model));
}

/* 49 and 48.83 mg/LSB in 13 bits, whatever is written; DATA_FORMAT holds what was written */
TEST(test_scale_of_those_of_200_g)
{
    static const char *const names[] = { "adxl375", "adxl314" };
    static const uint8_t formats[] = { 0x0B, 0x00, 0x08, 0x03 };
    for (size_t i = 0; i < 2; i++) {
        become(names[i]);
        for (size_t k = 0; k < sizeof formats; k++) {
            TEST_ASSERT_INT16_WITHIN(1, 205, reads(formats[k], 10));
            TEST_ASSERT_EQUAL_HEX8(formats[k], sensor_read(DATA_FORMAT));
            TEST_ASSERT_EQUAL_DOUBLE(200.0, adxl345_model_range_g(&sensor_model));
        }
        TEST_ASSERT_INT16_WITHIN(2, 2049, reads(0x08, 100));
    }
}

/* in g, within the limits of each data sheet; x and y of those of 200 g have none */
TEST(test_self_test)
{
    static const struct {
        const char *name;
        double lsb_per_g, z_low_g, z_high_g, x_low_g, x_high_g;
    } known[] = {
        /* at 3.3 V: limits of 2.5 V times 1.77 on x and 1.47 on z */
        { "adxl345", 256, 0.30 * 1.47, 3.40 * 1.47, 0.20 * 1.77, 2.10 * 1.77 },
        { "adxl343", 256, 0.30 * 1.47, 3.40 * 1.47, 0.20 * 1.77, 2.10 * 1.77 },
        { "adxl312", 344.8, 0.30 * 1.47, 3.40 * 1.47, 8 * 0.0234 * 1.77, 90 * 0.0234 * 1.77 },
        { "adxl313", 1024, 0.30, 3.70, 0.20, 2.36 },
        { "adxl375", 20.5, 6.35, 6.45, 0, 0 },
        { "adxl314", 20.48, 0.1, 8.0, 0, 0 },
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        become(known[i].name);
        const int16_t *shift = sensor_model.part.self_test_lsb;
        double x_g = shift[0] / known[i].lsb_per_g, z_g = shift[2] / known[i].lsb_per_g;
        TEST_ASSERT_TRUE_MESSAGE(known[i].z_low_g <= z_g && z_g <= known[i].z_high_g, known[i].name);
        TEST_ASSERT_TRUE_MESSAGE(known[i].x_low_g <= x_g && x_g <= known[i].x_high_g, known[i].name);
        TEST_ASSERT_EQUAL_INT16(-shift[0], shift[1]);
    }
}

TEST(test_another_in_its_place_has_just_been_powered)
{
    sensor_measure(FULL_RES_16G, 0x80);
    sensor_tick(1, 2, 3);
    become("adxl375");
    TEST_ASSERT_EQUAL_HEX8(0x00, sensor_read(POWER_CTL));
    TEST_ASSERT_EQUAL_HEX8(0x00, sensor_read(FIFO_STATUS));
    TEST_ASSERT_EQUAL_DOUBLE(0.0, adxl345_model_odr_hz(&sensor_model));
}
