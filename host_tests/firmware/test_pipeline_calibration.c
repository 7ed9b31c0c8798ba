/* The calibration's place in the sample path: what it changes of a row, what it leaves, when it counts. */
#include "filter_list.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/roles.h"
#include "support/test.h"

enum { SAMPLES = 200, RANGE_G = 16 };

static calibration_t c;
static uint32_t now_us;

void setUp(void)
{
    calibration_plain(&c, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6);
    pipeline_calibrate(&c);
    pipeline_reset();
    settings_take_filter(plain_kind());
    pipeline_forget();
    pipeline_change(&settings()->choice, 1000, RANGE_G);
    pipeline_finish();
}

/* One reading for 2 s: every filter has it then. */
static row_t row_of(int x, int y, int z)
{
    row_t row;
    for (int i = 0; i < SAMPLES; i++) {
        now_us += 10000;
        adxl345_sample_t sample = { .t_us = now_us, .lsb = { (int16_t)x, (int16_t)y, (int16_t)z } };
        pipeline_sample(&sample);
        pipeline_finish();
        pipeline_row(&row);
        pipeline_row_done();
    }
    return row;
}

/* 1000 x 256/265 = 966.04 mg and 256 LSB less an offset of 20: 921.875; the readings stay as they were read. */
TEST(test_mg_are_calibrated_and_readings_are_not)
{
    c.scale_lsb_per_g_uq6[0] = CALIBRATION_SCALE_3V3_XY_UQ6;
    c.offset_lsb_q4[2] = 320;
    pipeline_calibrate(&c);
    row_t row = row_of(256, 0, 256);
    TEST_ASSERT_EQUAL_INT16(256, row.lsb[0]);
    TEST_ASSERT_EQUAL_INT16(256, row.lsb[2]);
    TEST_ASSERT_EQUAL_INT16(966, row.mg[0]);
    TEST_ASSERT_EQUAL_INT16(0, row.mg[1]);
    TEST_ASSERT_EQUAL_INT16(922, row.mg[2]);
}

/* (0, 3, 4) / 5 g with y and z changed and x reversed: roll atan2(4, 3) = 53.13 degrees in place of 36.87. */
TEST(test_angles_are_those_of_the_axes_named_anew)
{
    row_t row = row_of(0, 154, 205);
    TEST_ASSERT_INT16_WITHIN(3, 3691, row.roll_cdeg); /* atan(154 / 205) = 36.914 */
    c.axes[0] = -1;
    c.axes[1] = 3;
    c.axes[2] = 2;
    pipeline_calibrate(&c);
    row = row_of(0, 154, 205);
    TEST_ASSERT_INT16_WITHIN(3, 5309, row.roll_cdeg);
    const tilt_t *raw = pipeline_raw_tilt();
    TEST_ASSERT_INT16_WITHIN(3, 5309, raw->roll_cdeg);
    TEST_ASSERT_INT16_WITHIN(3, 0, raw->pitch_cdeg);
}

/* Tared on its side, that attitude is level, raw and filtered. */
TEST(test_a_tared_attitude_is_level)
{
    const int16_t mean_lsb_q4[3] = { 16 * 100, 16 * -200, 16 * 125 };
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_tare(&c, mean_lsb_q4).why);
    pipeline_calibrate(&c);
    row_t row = row_of(100, -200, 125);
    TEST_ASSERT_INT16_WITHIN(5, 0, row.roll_cdeg); /* 0.022 + 0.008 + 0.02 degree */
    TEST_ASSERT_INT16_WITHIN(6, 0, row.pitch_cdeg);
    const tilt_t *raw = pipeline_raw_tilt();
    TEST_ASSERT_INT16_WITHIN(5, 0, raw->roll_cdeg);
    TEST_ASSERT_INT16_WITHIN(6, 0, raw->pitch_cdeg);
}

/* A part of 296 LSB/g shows 1.156 g at rest: not to be trusted, until its scale is known. */
TEST(test_gravity_is_judged_after_the_calibration)
{
    TEST_ASSERT_EQUAL_UINT16(ROW_NOT_GRAVITY, row_of(0, 0, 296).flags);
    c.scale_lsb_per_g_uq6[2] = CALIBRATION_SCALE_UQ6(296U);
    pipeline_calibrate(&c);
    TEST_ASSERT_EQUAL_UINT16(0, row_of(0, 0, 296).flags);
}

/* Full scale on all axes of a part of 200 LSB/g, along the level: 1.28 x sqrt(3) x 16 g = 35.5 g, limited. */
TEST(test_mg_are_limited)
{
    for (uint8_t i = 0; i < 3; i++) {
        c.scale_lsb_per_g_uq6[i] = CALIBRATION_SCALE_MIN_UQ6;
        c.level_q14[i] = 9459;
    }
    pipeline_calibrate(&c);
    TEST_ASSERT_EQUAL_INT16(32000, row_of(4094, 4094, 4094).mg[2]);
    TEST_ASSERT_EQUAL_INT16(-32000, row_of(-4094, -4094, -4094).mg[2]);
}

/* A sample that is missing has a prediction of its own, calibrated. */
TEST(test_a_missing_sample_is_calibrated_as_well)
{
    c.scale_lsb_per_g_uq6[2] = CALIBRATION_SCALE_UQ6(320U);
    pipeline_calibrate(&c);
    (void)row_of(0, 0, 320);
    for (int z = 320; z <= 340; z += 2) { /* on the move */
        now_us += 10000;
        adxl345_sample_t sample = { .t_us = now_us, .lsb = { 0, 0, (int16_t)z } };
        pipeline_sample(&sample);
        pipeline_finish();
    }
    row_t row;
    pipeline_row(&row);
    pipeline_row_done();
    int16_t before_mg = row.mg[2];
    pipeline_coast(now_us + 10000);
    pipeline_finish();
    pipeline_row(&row);
    TEST_ASSERT_EQUAL_UINT16(ROW_COASTED, row.flags);
    TEST_ASSERT_TRUE(row.mg[2] > before_mg && row.mg[2] < before_mg + 20); /* 2 LSB a sample: 6.25 mg */
}

/* What the filters hold of 1.156 g is as little to be trusted without a sample. */
TEST(test_gravity_is_judged_of_a_prediction_too)
{
    (void)row_of(0, 0, 296);
    row_t row;
    pipeline_coast(now_us + 10000);
    pipeline_finish();
    pipeline_row(&row);
    TEST_ASSERT_EQUAL_UINT16(ROW_COASTED | ROW_NOT_GRAVITY, row.flags);
}

/* A calibration is in force whole from the next row on, although its sample may be filtered already. */
TEST(test_a_row_is_calibrated_by_one_calibration)
{
    row_t row = row_of(256, 128, 64);
    TEST_ASSERT_INT16_WITHIN(1, 1000, row.mg[0]);
    TEST_ASSERT_INT16_WITHIN(1, 500, row.mg[1]);
    TEST_ASSERT_INT16_WITHIN(1, 250, row.mg[2]);
    static calibration_t another;
    another = c;
    for (uint8_t i = 0; i < 3; i++) {
        another.scale_lsb_per_g_uq6[i] = CALIBRATION_SCALE_UQ6(320U);
    }
    adxl345_sample_t sample = { .t_us = now_us + 10000, .lsb = { 256, 128, 64 } };
    pipeline_sample(&sample);
    pipeline_finish();
    pipeline_calibrate(&another);
    pipeline_row(&row);
    TEST_ASSERT_INT16_WITHIN(1, 800, row.mg[0]);
    TEST_ASSERT_INT16_WITHIN(1, 400, row.mg[1]);
    TEST_ASSERT_INT16_WITHIN(1, 200, row.mg[2]);
}

/* Of four samples for a row the last is judged: a jerk before it is not in the row's acceleration, nor in its flag. */
TEST(test_gravity_is_judged_of_the_rows_own_acceleration)
{
    (void)row_of(0, 0, 256);
    row_t row;
    unsigned not_gravity = 0;
    for (int i = 0; i < 2 * SAMPLES; i++) {
        now_us += 10000;
        adxl345_sample_t sample = { .t_us = now_us, .lsb = { 0, 0, (int16_t)(i < 100 ? 330 : 256) } };
        pipeline_sample(&sample);
        pipeline_finish();
        if (i % 4 == 3) {
            pipeline_row(&row);
            pipeline_row_done();
            bool outside = row.mg[2] < 850 || row.mg[2] > 1150;
            TEST_ASSERT_EQUAL_UINT16(outside ? ROW_NOT_GRAVITY : 0, row.flags & ROW_NOT_GRAVITY);
            not_gravity += outside;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(20, not_gravity);
    TEST_ASSERT_LESS_THAN_UINT(40, not_gravity);
}
