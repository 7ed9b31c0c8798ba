/* Two sensors on one address: what a jump to the double is, and who must not be suspected. */
#include "adxl345_watch.h"
#include "stream.h"
#include "support/documented_limits.h"
#include "support/random.h"
#include "support/recordings.h"
#include "support/shipped.h"
#include "support/test.h"

#include <string.h>

enum { SENSOR_AT_REST_LSB = 248, END_SAMPLES = LIMIT_JUMPS_END };

void setUp(void)
{
    adxl345_watch_start();
}

static void jump(size_t axis, int16_t from_lsb, int16_t to_lsb)
{
    int16_t from[] = { 10, -20, 30 };
    int16_t to[] = { 13, -22, 28 };
    from[axis] = from_lsb;
    to[axis] = to_lsb;
    adxl345_watch_sample(to, from);
}

static void rest(unsigned samples)
{
    static const int16_t a[] = { 10, -20, 248 };
    static const int16_t b[] = { 12, -21, 245 };
    for (unsigned i = 0; i < samples; i++) {
        adxl345_watch_sample(i % 2 ? a : b, i % 2 ? b : a);
    }
}

/* On every axis, with either sign, up or down. */
TEST(test_the_eighth_jump_is_told_and_quiet_ends_it)
{
    for (unsigned which = 0; which < 12; which++) {
        int16_t lsb = (int16_t)(which & 1u ? SENSOR_AT_REST_LSB : -SENSOR_AT_REST_LSB);
        bool up = (which & 2u) != 0;
        adxl345_watch_start();
        for (unsigned jumps = 1; jumps <= 20; jumps++) {
            jump(which / 4, up ? lsb : (int16_t)(2 * lsb), up ? (int16_t)(2 * lsb) : lsb);
            TEST_ASSERT_EQUAL(jumps >= LIMIT_JUMPS, adxl345_watch_two_sensors());
        }
        rest(END_SAMPLES);
        TEST_ASSERT_TRUE(adxl345_watch_two_sensors());
        rest(1);
        TEST_ASSERT_FALSE(adxl345_watch_two_sensors());
    }
}

/* One reading in ten doubled is two jumps in ten samples: told soon; one in forty is not told. */
TEST(test_share_of_doubled_readings)
{
    for (unsigned i = 0; i < 40; i++) {
        jump(2, 250, 500);
        jump(2, 500, 250);
        rest(8);
    }
    TEST_ASSERT_TRUE(adxl345_watch_two_sensors());
    adxl345_watch_start();
    for (unsigned i = 0; i < 1000; i++) {
        jump(2, 250, 500);
        jump(2, 500, 250);
        rest(38);
        TEST_ASSERT_FALSE(adxl345_watch_two_sensors());
    }
}

/*
 * A jump raises the score by 16 and another sample lowers it by 1: one in sixteen grows by 1, one in seventeen never.
 */
TEST(test_one_jump_in_sixteen_is_the_limit)
{
    for (unsigned calm = LIMIT_JUMP_SHARE - 2; calm <= LIMIT_JUMP_SHARE; calm++) {
        adxl345_watch_start();
        unsigned jumps = 0;
        while (!adxl345_watch_two_sensors() && jumps < 1000) {
            jump(2, 250, 500);
            jumps++;
            if (!adxl345_watch_two_sensors()) {
                rest(calm);
            }
        }
        unsigned growth = LIMIT_JUMP_SHARE - calm; /* with each jump, and the calm samples before it; from 16 to 128 */
        TEST_ASSERT_EQUAL_UINT(growth != 0 ? 1 + (128 - 16 + growth - 1) / growth : 1000, jumps);
    }
}

/*
 * Eight jumps reach 128 and are reported; with a single calm sample among them they are one short, and the ninth is
 * reported.
 */
TEST(test_eight_jumps_with_a_calm_sample_are_one_short)
{
    for (unsigned before = 1; before < 8; before++) {
        adxl345_watch_start();
        for (unsigned jumps = 1; jumps <= 9; jumps++) {
            jump(0, 250, 500);
            TEST_ASSERT_EQUAL(jumps == 9, adxl345_watch_two_sensors());
            if (jumps == before) {
                rest(1);
            }
        }
    }
}

static bool suspected_after(int16_t from_lsb, int16_t to_lsb)
{
    adxl345_watch_start();
    for (unsigned i = 0; i < 100; i++) {
        jump(2, from_lsb, to_lsb);
    }
    return adxl345_watch_two_sensors();
}

/* Below 64 LSB noise does it; a double is meant within a sixteenth of the single value. */
TEST(test_what_a_doubling_is)
{
    for (int16_t lsb = LIMIT_DOUBLE_MIN_LSB - 1; lsb <= LIMIT_DOUBLE_MIN_LSB + 1; lsb++) {
        TEST_ASSERT_EQUAL(lsb >= LIMIT_DOUBLE_MIN_LSB, suspected_after(lsb, (int16_t)(2 * lsb)));
        TEST_ASSERT_EQUAL(lsb >= LIMIT_DOUBLE_MIN_LSB, suspected_after((int16_t)(2 * lsb), lsb));
    }
    TEST_ASSERT_TRUE(suspected_after(64, 124));
    TEST_ASSERT_FALSE(suspected_after(64, 123));
    TEST_ASSERT_TRUE(suspected_after(-320, -660));
    TEST_ASSERT_FALSE(suspected_after(-320, -661));
    TEST_ASSERT_TRUE(suspected_after(-620, -320));
    TEST_ASSERT_FALSE(suspected_after(-619, -320));
    TEST_ASSERT_TRUE(suspected_after(2047, 4094));
    TEST_ASSERT_FALSE(suspected_after(250, -500));
    TEST_ASSERT_FALSE(suspected_after(4095, -4096));
    TEST_ASSERT_FALSE(suspected_after(250, 750));
}

/* A knock or a free fall moves them all. */
TEST(test_two_axes_at_once_are_a_movement)
{
    static const int16_t low[] = { 100, 5, 200 };
    static const int16_t both[] = { 200, 5, 400 };
    static const int16_t one[] = { 159, 5, 400 };
    static const int16_t moved[] = { 160, 5, 400 };
    for (unsigned i = 0; i < 100; i++) {
        adxl345_watch_sample(i % 2 ? low : both, i % 2 ? both : low);
        TEST_ASSERT_FALSE(adxl345_watch_two_sensors());
    }
    for (unsigned i = 0; i < 100; i++) {
        adxl345_watch_sample(i % 2 ? low : moved, i % 2 ? moved : low);
        TEST_ASSERT_FALSE(adxl345_watch_two_sensors());
    }
    for (unsigned i = 0; i < 8; i++) {
        adxl345_watch_sample(i % 2 ? low : one, i % 2 ? one : low);
    }
    TEST_ASSERT_TRUE(adxl345_watch_two_sensors());
}

/* 15 % of each axis' readings are 8 sigma off, where that comes nearest to a doubling: sigma 8 and 64 LSB. */
TEST(test_outliers_are_no_second_sensor)
{
    test_random_t random;
    random_seed(&random, 20261122u);
    int16_t lsb[2][3] = { { 0 }, { 0 } };
    for (unsigned i = 0; i < 1000000; i++) {
        for (unsigned axis = 0; axis < 3; axis++) {
            double outlier = random_uniform(&random) < 0.15 ? (random_u32(&random) & 1u ? 64.0 : -64.0) : 0.0;
            double level = i / 1000 % 3 == axis ? 64.0 : 0.0;
            lsb[i % 2][axis] = as_sample(level + outlier + 8.0 * random_normal(&random));
        }
        adxl345_watch_sample(lsb[i % 2], lsb[(i + 1) % 2]);
        TEST_ASSERT_FALSE(adxl345_watch_two_sensors());
    }
}

/* Samples until it is suspected; 0: never. */
static size_t suspected_in(const stream_t *stream)
{
    adxl345_watch_start();
    for (size_t i = 1; i < stream->count; i++) {
        adxl345_watch_sample(stream->rows[i].lsb, stream->rows[i - 1].lsb);
        if (adxl345_watch_two_sensors()) {
            return i;
        }
    }
    return 0;
}

TEST(test_no_shipped_stream_is_suspected)
{
    for (size_t i = 0; i < SHIPPED_STREAMS; i++) {
        stream_t stream;
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, shipped_streams[i].path), stream.error);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(0, suspected_in(&stream), shipped_streams[i].path);
        stream_free(&stream);
    }
}

/* Two sensors drove one address in one recording: known within 2 s. The others moved, vibrated, hit their rails. */
TEST(test_of_the_recordings_the_one_with_two_sensors_is_suspected)
{
    static recordings_t recordings;
    if (!recordings_there()) {
        TEST_IGNORE_MESSAGE("no recordings (../shared/streams, or RECORDINGS)");
    }
    TEST_ASSERT_TRUE_MESSAGE(recordings_load(&recordings), recordings.error);
    TEST_ASSERT_TRUE(recordings.count > 20);
    bool met = false;
    for (size_t i = 0; i < recordings.count; i++) {
        const recording_t *r = &recordings.list[i];
        bool contention = strcmp(r->name, "uav-buscontention-a") == 0;
        stream_t stream;
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, r->path), stream.error);
        size_t samples = suspected_in(&stream);
        TEST_ASSERT_EQUAL_MESSAGE(contention, samples != 0 && samples <= 300, r->name);
        TEST_ASSERT_EQUAL_MESSAGE(contention, samples != 0, r->name);
        met = met || contention;
        stream_free(&stream);
    }
    TEST_ASSERT_TRUE(met);
}
