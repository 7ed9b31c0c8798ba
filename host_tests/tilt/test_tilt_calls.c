/* What the facade's calls change between samples: a start, another law, a calibration. */
#include "filter_list.h"
#include "support/roles.h"
#include "support/test.h"
#include "tilt_filter.h"

#include <string.h>

static tilt_filter_t tilt;

void setUp(void)
{
    TEST_ASSERT_TRUE(tilt_filter_begin(&tilt, 100));
}

static void rest(int x, int y, int z)
{
    for (int i = 0; i < 200; i++) {
        tilt_filter_update(&tilt, (int16_t)x, (int16_t)y, (int16_t)z);
    }
}

/* All that a program may read has a value before the first sample, whatever the memory held. */
TEST(test_a_start_sets_every_result)
{
    tilt_filter_t t;
    memset(&t, 0x5A, sizeof t);
    TEST_ASSERT_TRUE(tilt_filter_begin(&t, 100));
    TEST_ASSERT_TRUE(t.angles.roll_cdeg == 0 && t.angles.pitch_cdeg == 0 && !t.angles.roll_undefined);
    TEST_ASSERT_EQUAL_HEX16(TILT_WARMING_UP, t.flags);
    TEST_ASSERT_EACH_EQUAL_INT32(0, t.a_q8, TILT_FILTER_AXES);
}

/* After a restart there is no held value to rejoin: the next sample is a first one, wherever it lies. */
TEST(test_a_restart_takes_the_first_sample)
{
    rest(0, 0, 256);
    for (int i = 0; i < 30; i++) {
        tilt_filter_missing(&tilt);
    }
    TEST_ASSERT_TRUE(tilt_filter_begin(&tilt, 100));
    tilt_filter_update(&tilt, 0, 265, 0);
    TEST_ASSERT_EQUAL_HEX16(TILT_WARMING_UP, tilt.flags);
    TEST_ASSERT_INT16_WITHIN(3, 9000, tilt.angles.roll_cdeg);
}

/* Between two samples: until the next one the angles stay where they are. */
TEST(test_another_law_in_a_gap_holds_the_angles)
{
    rest(-133, 154, 154);
    tilt_t held = tilt.angles;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, tilt_filter_use(&tilt, filter_listed(robust_kind()), NULL));
    tilt_filter_missing(&tilt);
    TEST_ASSERT_EQUAL_INT16(held.roll_cdeg, tilt.angles.roll_cdeg);
    TEST_ASSERT_EQUAL_INT16(held.pitch_cdeg, tilt.angles.pitch_cdeg);
    TEST_ASSERT_EQUAL_HEX16(TILT_COASTED | TILT_WARMING_UP, tilt.flags);
}

/* A board that is mounted on its edge, with offsets of 16 and -8 LSB on the sensor's x and z: its y points up. */
static calibration_t on_its_edge(void)
{
    calibration_t c;
    calibration_plain(&c, CALIBRATION_SCALE_UQ6(256U), CALIBRATION_SCALE_UQ6(256U));
    c.offset_lsb_q4[0] = 16 * 16;
    c.offset_lsb_q4[2] = -8 * 16;
    c.axes[0] = 3; /* ours: the sensor's z, x, y */
    c.axes[1] = 1;
    c.axes[2] = 2;
    return c;
}

/* Until a sensor is set: the calibration is not its own. */
TEST(test_a_calibration_is_in_force_at_once)
{
    calibration_t edge = on_its_edge();
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, tilt_filter_calibrate(&tilt, &edge).why);
    rest(16, 256, -8);
    TEST_ASSERT_INT16_WITHIN(3, 0, tilt.angles.roll_cdeg);
    TEST_ASSERT_INT16_WITHIN(3, 0, tilt.angles.pitch_cdeg);
    rest(16 + 154, 205, -8); /* 3, 4, 5: 36.87 degrees */
    TEST_ASSERT_INT16_WITHIN(10, 3691, tilt.angles.roll_cdeg);
    rest(16, 205, -8 - 154);
    TEST_ASSERT_INT16_WITHIN(10, 3691, tilt.angles.pitch_cdeg);
    TEST_ASSERT_TRUE(tilt_filter_sensor(&tilt, 13, 256, 256));
    rest(0, 0, 256);
    TEST_ASSERT_EQUAL_INT32(256 * 256, tilt.a_q8[2]);
}

TEST(test_an_illegal_calibration_is_named_and_changes_nothing)
{
    calibration_t edge = on_its_edge();
    edge.scale_lsb_per_g_uq6[1] = CALIBRATION_SCALE_UQ6(199U);
    tilt_filter_t before = tilt;
    calibration_verdict_t verdict = tilt_filter_calibrate(&tilt, &edge);
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_SCALE, verdict.why);
    TEST_ASSERT_EQUAL_UINT8(1, verdict.where);
    TEST_ASSERT_EQUAL_MEMORY(&before, &tilt, sizeof tilt);
}
