/*
 * lib/tilt in integers, on the PC and on the chip: exact cases, symmetries, the ends of the ranges. Errors against
 * double: test_tilt_reference.c.
 */
#include "support/filters.h"
#include "support/test.h"
#include "tilt.h"

/* root = floor(sqrt(v)) without a product of 64 bits: v - root^2 <= 2 root. */
static void check_root(uint32_t v)
{
    uint32_t root = tilt_isqrt32(v);
    TEST_ASSERT_TRUE(root * root <= v && v - root * root <= 2U * root);
}

TEST(test_isqrt_is_exact_around_every_square)
{
    for (uint32_t root = 0; root <= UINT16_MAX; root += ON_PC_OR_CHIP(1U, 31U)) {
        uint32_t square = root * root;
        check_root(square);
        check_root(square + 1U);
        check_root(square + 2U * root);
        check_root(square - (root != 0U ? 1U : 0U));
    }
}

TEST(test_atan2_on_axes_and_diagonals_is_exact)
{
    for (int32_t r = 1; r < (1L << 30); r = r * 2 + 1) {
        TEST_ASSERT_EQUAL_INT16(0, tilt_atan2_cdeg(0, r));
        TEST_ASSERT_EQUAL_INT16(4500, tilt_atan2_cdeg(r, r));
        TEST_ASSERT_EQUAL_INT16(9000, tilt_atan2_cdeg(r, 0));
        TEST_ASSERT_EQUAL_INT16(13500, tilt_atan2_cdeg(r, -r));
        TEST_ASSERT_EQUAL_INT16(18000, tilt_atan2_cdeg(0, -r));
        TEST_ASSERT_EQUAL_INT16(-13500, tilt_atan2_cdeg(-r, -r));
        TEST_ASSERT_EQUAL_INT16(-9000, tilt_atan2_cdeg(-r, 0));
        TEST_ASSERT_EQUAL_INT16(-4500, tilt_atan2_cdeg(-r, r));
    }
    TEST_ASSERT_EQUAL_INT16(0, tilt_atan2_cdeg(0, 0));
}

/* -180 degrees would be a second name of 180: the branch cut belongs to the positive side. */
TEST(test_atan2_just_below_the_cut_gives_180_not_minus_180)
{
    TEST_ASSERT_EQUAL_INT16(18000, tilt_atan2_cdeg(-1, -(1L << 30)));
    TEST_ASSERT_EQUAL_INT16(18000, tilt_atan2_cdeg(1, -(1L << 30)));
    TEST_ASSERT_EQUAL_INT16(-17999, tilt_atan2_cdeg(-175, -1000000)); /* -179.98997 */
}

TEST(test_atan2_accepts_every_int32)
{
    TEST_ASSERT_EQUAL_INT16(-13500, tilt_atan2_cdeg(INT32_MIN, INT32_MIN));
    TEST_ASSERT_EQUAL_INT16(4500, tilt_atan2_cdeg(INT32_MAX, INT32_MAX));
    TEST_ASSERT_EQUAL_INT16(-9000, tilt_atan2_cdeg(INT32_MIN, 0));
    TEST_ASSERT_EQUAL_INT16(18000, tilt_atan2_cdeg(0, INT32_MIN));
}

TEST(test_no_acceleration_is_defined)
{
    tilt_t tilt = { .roll_cdeg = -4321, .pitch_cdeg = 99, .roll_undefined = false };
    tilt_angles(&tilt, (const int32_t[]){ 0, 0, 0 });
    TEST_ASSERT_EQUAL_INT16(-4321, tilt.roll_cdeg);
    TEST_ASSERT_EQUAL_INT16(0, tilt.pitch_cdeg);
    TEST_ASSERT_TRUE(tilt.roll_undefined);
}

TEST(test_roll_is_kept_at_the_singularity_and_found_again)
{
    tilt_t tilt = { .roll_cdeg = 777 };
    tilt_angles(&tilt, (const int32_t[]){ -65536, 3 * 256, 2 * 256 }); /* |(y, z)| = 3.6 LSB: below 4 */
    TEST_ASSERT_TRUE(tilt.roll_undefined);
    TEST_ASSERT_EQUAL_INT16(777, tilt.roll_cdeg);
    TEST_ASSERT_INT16_WITHIN(3, 8919, tilt.pitch_cdeg);                /* atan(256 / 3.6056) = 89.193 degrees */
    tilt_angles(&tilt, (const int32_t[]){ -65536, 3 * 256, 3 * 256 }); /* 4.24 LSB */
    TEST_ASSERT_FALSE(tilt.roll_undefined);
    TEST_ASSERT_EQUAL_INT16(4500, tilt.roll_cdeg);
}

TEST(test_signs_follow_the_data_sheet_orientations)
{
    tilt_t tilt = { 0 };
    tilt_angles(&tilt, (const int32_t[]){ 0, 0, 65536 });
    TEST_ASSERT_TRUE(tilt.roll_cdeg == 0 && tilt.pitch_cdeg == 0);
    tilt_angles(&tilt, (const int32_t[]){ 0, 65536, 0 });
    TEST_ASSERT_TRUE(tilt.roll_cdeg == 9000 && tilt.pitch_cdeg == 0);
    tilt_angles(&tilt, (const int32_t[]){ 0, 0, -65536 });
    TEST_ASSERT_TRUE(tilt.roll_cdeg == 18000 && tilt.pitch_cdeg == 0);
    tilt_angles(&tilt, (const int32_t[]){ 65536, 0, 0 });
    TEST_ASSERT_TRUE(tilt.roll_undefined && tilt.pitch_cdeg == -9000);
    tilt_angles(&tilt, (const int32_t[]){ -65536, 0, 0 });
    TEST_ASSERT_TRUE(tilt.roll_undefined && tilt.pitch_cdeg == 9000);
}

TEST(test_mirrored_vectors_give_mirrored_angles)
{
    uint32_t random = 20250103U;
    for (uint32_t i = 0; i < ON_PC_OR_CHIP(200000U, 2000U); i++) {
        int32_t x = (int32_t)random32_below(&random, 131072U) + 1;
        int32_t y = (int32_t)random32_below(&random, 131072U) + 1024;
        int32_t z = (int32_t)random32_below(&random, 131072U) + 1;
        tilt_t first = { 0 };
        tilt_t opposite = { 0 };
        tilt_angles(&first, (const int32_t[]){ x, y, z });
        tilt_angles(&opposite, (const int32_t[]){ -x, -y, z });
        TEST_ASSERT_EQUAL_INT16(first.roll_cdeg, -opposite.roll_cdeg);
        TEST_ASSERT_EQUAL_INT16(first.pitch_cdeg, -opposite.pitch_cdeg);
        tilt_angles(&opposite, (const int32_t[]){ x, y, -z });
        TEST_ASSERT_EQUAL_INT16(18000 - first.roll_cdeg, opposite.roll_cdeg);
        TEST_ASSERT_EQUAL_INT16(first.pitch_cdeg, opposite.pitch_cdeg);
    }
}

/* 0.85 g = 55705.6 and 1.15 g = 75366.4 in Q8. Each axis is cut to 1/64 LSB: the verdict may differ by 4 of Q8. */
TEST(test_gravity_limits_on_every_axis)
{
    for (uint8_t axis = 0; axis < 3; axis++) {
        for (int32_t sign = -1; sign <= 1; sign += 2) {
            int32_t a[3] = { 0, 0, 0 };
            const int32_t value_q8[4] = { 55701, 55710, 75366, 75371 };
            const bool plausible[4] = { false, true, true, false };
            for (uint8_t i = 0; i < 4; i++) {
                a[axis] = sign * value_q8[i];
                TEST_ASSERT_EQUAL(plausible[i], tilt_gravity_plausible(a));
            }
        }
    }
}

TEST(test_gravity_of_extreme_states_does_not_wrap)
{
    const int32_t limit_q8 = (int32_t)4608 * 256;
    TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ limit_q8, limit_q8, limit_q8 }));
    TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ -limit_q8, 0, 0 }));
    TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ 0, 0, 0 }));
    TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ INT32_MIN, INT32_MAX, INT32_MIN }));
    for (int32_t a = 43552; a <= limit_q8; a += 97) { /* 1.151 g / sqrt(3) in Q8 */
        TEST_ASSERT_FALSE(tilt_gravity_plausible((const int32_t[]){ a, -a, a }));
    }
}
