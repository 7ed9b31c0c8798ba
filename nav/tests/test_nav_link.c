/* Frames and records of the navigation image: answered once each, refused by name, nothing lost unseen. */
#include <math.h>
#include <string.h>

#include "hal_watchdog.h"
#include "nav_frame.h"
#include "nav_line.h"
#include "nav_link.h"
#include "support/random.h"
#include "support/test.h"

enum { REALS = 30, STATE_LENGTH = 57 };

static test_random_t dice;

/* nav_config_t's reals in its order, as docs/protocol.md has them */
static float parameter[REALS] = { 1,     0,     0,     0,     6,    0,       0,     0,     100,  0,
                                  0,     0,     0,     17818, 1951, 41847,   9.81F, 57.3F, 1.2F, 0.02F,
                                  1e-3F, 1e-6F, 2e-4F, 6e-5F, 0,    0.0349F, 0.1F,  5,     1,    5 };

static uint8_t put_parameters(uint8_t first)
{
    uint8_t body[25] = { first };
    memcpy(&body[1], &parameter[first], 24);
    return nav_line_ask(RECORD_PARAMETERS, body, sizeof body);
}

static uint8_t start_flight(void)
{
    uint32_t period_us = 10000;
    for (uint8_t first = 0; first < REALS; first = (uint8_t)(first + 6)) {
        TEST_ASSERT_EQUAL(NAV_TAKEN, put_parameters(first));
    }
    return nav_line_ask(RECORD_START, &period_us, sizeof period_us);
}

static uint8_t put_imu(uint32_t t_us, float rate, bool with_state)
{
    float measured[6] = { rate, 0, 0, 0, 0, -9.81F };
    uint8_t body[29];
    memcpy(body, &t_us, 4);
    memcpy(&body[4], measured, 24);
    body[28] = with_state;
    return nav_line_ask(RECORD_IMU, body, sizeof body);
}

void setUp(void)
{
    nav_line_begin();
}

/* The check value of CRC-16/CCITT with this start, in every catalogue of CRCs. */
TEST(test_crc_has_its_check_value)
{
    uint16_t crc = 0xFFFF;
    for (const char *at = "123456789"; *at != '\0'; at++) {
        crc = frame_crc(crc, (uint8_t)*at);
    }
    TEST_ASSERT_EQUAL_HEX16(0x29B1, crc);
}

TEST(test_frames_are_those_of_the_definition)
{
    random_seed(&dice, 11);
    for (int round = 0; round < 2000; round++) {
        uint8_t frame[128];
        uint8_t *record = &frame[1];
        uint8_t wanted[300];
        uint8_t length = (uint8_t)(1 + random_below(&dice, 100));
        for (uint8_t i = 0; i < length; i++) {
            record[i] = random_below(&dice, 3) == 0 ? 0 : (uint8_t)random_below(&dice, 256);
        }
        size_t count = nav_line_frame(record, length, wanted);
        size_t before;
        size_t sent;
        (void)nav_line_sent(&before);
        frame_send(frame, length);
        const uint8_t *bytes = nav_line_sent(&sent);
        TEST_ASSERT_EQUAL(count, sent - before);
        TEST_ASSERT_EQUAL(length + FRAME_OVERHEAD, count);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(wanted, &bytes[before], count);
        nav_line_begin();
    }
}

TEST(test_reader_takes_what_was_framed_and_nothing_else)
{
    frame_reader_t reader;
    frame_reader_init(&reader);
    random_seed(&dice, 12);
    for (int round = 0; round < 5000; round++) {
        uint8_t record[40];
        uint8_t frame[60];
        size_t length = 1 + random_below(&dice, 36);
        for (size_t i = 0; i < length; i++) {
            record[i] = random_below(&dice, 3) == 0 ? 0 : (uint8_t)random_below(&dice, 256);
        }
        size_t count = nav_line_frame(record, length, frame);
        bool damaged = random_below(&dice, 2) == 0;
        if (damaged) {
            frame[random_below(&dice, (uint32_t)count - 1)] ^= (uint8_t)(1u << random_below(&dice, 8));
        }
        frame_result_t last = FRAME_MORE;
        bool good = false;
        for (size_t i = 0; i < count; i++) {
            last = frame_take(&reader, frame[i]);
            good = good || last == FRAME_GOOD;
        }
        bool fits = length <= FRAME_TAKEN_MAX;
        TEST_ASSERT_EQUAL(fits && !damaged, good);
        if (good) {
            TEST_ASSERT_EQUAL(length, reader.length);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(record, reader.bytes, length);
        }
    }
}

TEST(test_reader_finds_its_place_behind_anything)
{
    frame_reader_t reader;
    frame_reader_init(&reader);
    random_seed(&dice, 13);
    const uint8_t record[] = { 'V', 0 };
    uint8_t frame[16];
    size_t count = nav_line_frame(record, sizeof record, frame);
    for (int round = 0; round < 20000; round++) {
        for (uint32_t junk = random_below(&dice, 80); junk != 0; junk--) {
            (void)frame_take(&reader, (uint8_t)random_below(&dice, 256));
        }
        (void)frame_take(&reader, 0);
        frame_result_t last = FRAME_MORE;
        for (size_t i = 0; i < count; i++) {
            last = frame_take(&reader, frame[i]);
        }
        TEST_ASSERT_EQUAL(FRAME_GOOD, last);
        TEST_ASSERT_EQUAL(sizeof record, reader.length);
    }
}

TEST(test_greets_with_its_window_and_the_reset)
{
    TEST_ASSERT_EQUAL(1, nav_line_said_count);
    const uint8_t hello[] = { 'h', LINK_VERSION, NAV_STATES, 127, 0, HAL_RESET_WATCHDOG };
    TEST_ASSERT_EQUAL(sizeof hello, nav_line_said[0].length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(hello, nav_line_said[0].bytes, sizeof hello);
}

TEST(test_nothing_is_believed_before_the_start)
{
    TEST_ASSERT_EQUAL(LINK_NOT_STARTED, put_imu(0, 0, true));
    TEST_ASSERT_EQUAL(1, nav_line_said_count);
    TEST_ASSERT_EQUAL(LINK_NOT_STARTED, nav_line_ask(RECORD_VARIANCES, NULL, 0));
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(10000, 0, false));
}

TEST(test_a_start_wants_each_parameter_in_its_range)
{
    uint32_t period_us = 10000;
    TEST_ASSERT_EQUAL(LINK_START_REFUSED, nav_line_ask(RECORD_START, &period_us, 4));
    for (uint8_t first = 0; first < 24; first = (uint8_t)(first + 6)) {
        (void)put_parameters(first);
    }
    TEST_ASSERT_EQUAL(LINK_START_REFUSED, nav_line_ask(RECORD_START, &period_us, 4));
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_parameters(24));
    TEST_ASSERT_EQUAL(NAV_TAKEN, nav_line_ask(RECORD_START, &period_us, 4));
    TEST_ASSERT_EQUAL(LINK_START_REFUSED, nav_line_ask(RECORD_START, &period_us, 4));
    for (uint8_t wrong = 1; wrong < REALS; wrong++) {
        float kept = parameter[wrong];
        parameter[wrong] = NAN;
        TEST_ASSERT_EQUAL(LINK_START_REFUSED, start_flight());
        parameter[wrong] = kept;
        TEST_ASSERT_EQUAL(LINK_NOT_STARTED, put_imu(10000, 0, false));
    }
    uint8_t between[25] = { 3 };
    TEST_ASSERT_EQUAL(LINK_START_REFUSED, nav_line_ask(RECORD_PARAMETERS, between, sizeof between));
    between[0] = 30;
    TEST_ASSERT_EQUAL(LINK_START_REFUSED, nav_line_ask(RECORD_PARAMETERS, between, sizeof between));
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
}

/* A turn of 0.5 rad/s about x for one period: the quaternion's x is the sine of half of 5 mrad. */
TEST(test_the_state_is_that_of_the_filter)
{
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(0x01020304, 0.5F, true));
    TEST_ASSERT_EQUAL(2, nav_line_said_count);
    TEST_ASSERT_EQUAL_CHAR(ANSWER_STATE, nav_line_said[0].bytes[0]);
    TEST_ASSERT_EQUAL(STATE_LENGTH, nav_line_said[0].length);
    float state[13];
    uint32_t t_us;
    memcpy(&t_us, &nav_line_said[0].bytes[1], 4);
    memcpy(state, &nav_line_said[0].bytes[5], sizeof state);
    TEST_ASSERT_EQUAL_HEX32(0x01020304, t_us);
    TEST_ASSERT_FLOAT_WITHIN(1e-7F, 2.5e-3F, state[1]);
    TEST_ASSERT_FLOAT_WITHIN(1e-5F, 6.0F, state[4]);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 0.06F, state[7]);
    TEST_ASSERT_FLOAT_WITHIN(1e-4F, 100.0F, state[8]);
}

/* A refused record leaves the state where it was, and its time with it. */
TEST(test_the_state_has_the_time_of_the_last_record_taken)
{
    uint32_t t_us;
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(10000, 0, false));
    TEST_ASSERT_EQUAL(NAV_NOT_FINITE, put_imu(5000000, NAN, true));
    TEST_ASSERT_EQUAL_CHAR(ANSWER_STATE, nav_line_said[0].bytes[0]);
    memcpy(&t_us, &nav_line_said[0].bytes[1], 4);
    TEST_ASSERT_EQUAL_UINT32(10000, t_us);
}

TEST(test_every_length_but_the_right_one_is_refused)
{
    static const struct {
        uint8_t type;
        uint8_t length;
    } types[] = { { 'P', 25 }, { 'S', 4 }, { 'I', 29 }, { 'G', 28 }, { 'A', 8 },
                  { 'M', 16 }, { 'V', 0 }, { 'C', 0 },  { 'H', 0 } };
    const uint8_t body[32] = { 0 };
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        for (uint8_t length = 0; length < 30; length++) {
            if (length != types[i].length) {
                TEST_ASSERT_EQUAL(LINK_LENGTH, nav_line_ask(types[i].type, body, length));
            }
        }
    }
    for (unsigned type = 0; type < 256; type++) {
        if (type == 0 || strchr("PSIGAMVCH", (int)type) == NULL) {
            TEST_ASSERT_EQUAL(LINK_UNKNOWN, nav_line_ask((uint8_t)type, body, 4));
        }
    }
    uint8_t frame[8];
    const uint8_t alone = RECORD_COUNTS; /* a type without a number */
    nav_line_type(frame, nav_line_frame(&alone, 1, frame));
    nav_line_run();
    TEST_ASSERT_EQUAL(LINK_LENGTH, nav_line_answer());
    TEST_ASSERT_EQUAL_HEX8_ARRAY("k\0C", nav_line_said[0].bytes, 3);
    nav_line_forget();
}

/* places among the counts */
enum {
    BROKEN = NAV_ANSWERS,
    UNKNOWN,
    ORDER = NAV_ANSWERS + LINK_ORDER - LINK_BROKEN,
    MISSING = NAV_ANSWERS + LINK_ANSWERS_END - LINK_BROKEN
};

static unsigned count_at(size_t place)
{
    return nav_line_said[0].bytes[1 + 2 * place] | (unsigned)nav_line_said[0].bytes[2 + 2 * place] << 8;
}

TEST(test_order_damage_and_loss_are_counted)
{
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(10000, 0, false));
    nav_line_sequence--;
    TEST_ASSERT_EQUAL(LINK_ORDER, put_imu(20000, 0, false)); /* a second time */
    nav_line_sequence = (uint8_t)(nav_line_sequence + 3);
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(20000, 0, false)); /* three never came */
    const uint8_t broken[] = { 5, 'I', 1, 2, 3, 0 };
    nav_line_type(broken, sizeof broken);
    nav_line_run();
    TEST_ASSERT_EQUAL(LINK_BROKEN, nav_line_answer());
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(30000, 0, false));
    TEST_ASSERT_EQUAL(NAV_BACKWARDS, put_imu(30000, 0, false));
    TEST_ASSERT_EQUAL(NAV_NOT_FINITE, put_imu(40000, NAN, false));
    TEST_ASSERT_EQUAL(NAV_NOT_FINITE, put_imu(40000, INFINITY, false));
    TEST_ASSERT_EQUAL(NAV_OUT_OF_RANGE, put_imu(40000, 41.0F, false));
    TEST_ASSERT_EQUAL(NAV_TAKEN, nav_line_ask(RECORD_COUNTS, NULL, 0));
    TEST_ASSERT_EQUAL_CHAR(ANSWER_COUNTS, nav_line_said[0].bytes[0]);
    TEST_ASSERT_EQUAL(1 + 2 * (MISSING + 1), nav_line_said[0].length);
    TEST_ASSERT_EQUAL(3, count_at(NAV_TAKEN));
    TEST_ASSERT_EQUAL(1, count_at(NAV_BACKWARDS));
    TEST_ASSERT_EQUAL(2, count_at(NAV_NOT_FINITE));
    TEST_ASSERT_EQUAL(1, count_at(NAV_OUT_OF_RANGE));
    TEST_ASSERT_EQUAL(1, count_at(BROKEN));
    TEST_ASSERT_EQUAL(1, count_at(ORDER));
    TEST_ASSERT_EQUAL(3, count_at(MISSING));
}

/* Counts that are full stay full: 65535, of records of no type and of numbers that never came. */
TEST(test_counts_stay_at_their_end)
{
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    for (long round = 0; round < 65535L + 10L; round++) {
        nav_line_put('?', NULL, 0);
        nav_line_run();
        nav_line_forget();
    }
    for (int jump = 0; jump < 65535 / 127 + 2; jump++) { /* 127 never came, as often as makes more than 65535 */
        nav_line_sequence = (uint8_t)(nav_line_sequence + 127);
        nav_line_put(RECORD_COUNTS, NULL, 0);
        nav_line_run();
        nav_line_forget();
    }
    TEST_ASSERT_EQUAL(2, nav_line_said_count);
    TEST_ASSERT_EQUAL(65535U, count_at(UNKNOWN));
    TEST_ASSERT_EQUAL(65535U, count_at(MISSING));
}

TEST(test_a_greeting_on_demand_begins_the_order_anew)
{
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    nav_line_sequence = 200;
    TEST_ASSERT_EQUAL(NAV_TAKEN, nav_line_ask(RECORD_HELLO, NULL, 0));
    TEST_ASSERT_EQUAL(2, nav_line_said_count);
    TEST_ASSERT_EQUAL_CHAR(ANSWER_HELLO, nav_line_said[0].bytes[0]);
    nav_line_sequence = 3;
    TEST_ASSERT_EQUAL(NAV_TAKEN, put_imu(10000, 0, false));
}

/* What a record may cause has room before it is taken: nothing goes out by halves. */
TEST(test_waits_for_room_to_answer)
{
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    nav_line_room = STATE_LENGTH + 4 + 7 + 4 - 1;
    nav_line_put(RECORD_COUNTS, NULL, 0);
    nav_line_run();
    TEST_ASSERT_EQUAL(0, nav_line_said_count);
    nav_line_room++;
    nav_line_run();
    TEST_ASSERT_EQUAL(2, nav_line_said_count);
}

static uint8_t put_reals(uint8_t type, uint32_t t_us, const float *values, size_t count)
{
    uint8_t body[28];
    memcpy(body, &t_us, 4);
    memcpy(&body[4], values, 4 * count);
    return nav_line_ask(type, body, 4 + 4 * count);
}

/* A filter of the same parameters, spoken to without a line: what it answers and counts is what the line must say. */
TEST(test_each_sensor_reaches_the_filter)
{
    static nav_t direct;
    static const float velocity_position[6] = { 6.5F, 0.25F, -0.125F, 3, 95, -2 };
    static const float down = -1.5F;
    static const float field[3] = { 17000, 2500, 42000 };
    nav_config_t config = { .period_us = 10000 };
    memcpy(&config, parameter, sizeof parameter);
    TEST_ASSERT_TRUE(nav_init(&direct, &config));
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    for (uint32_t t_us = 10000; t_us <= 400000; t_us += 10000) {
        const float rate[3] = { 0.25F, 0, 0 };
        const float force[3] = { 0, 0, -9.81F };
        TEST_ASSERT_EQUAL(nav_imu(&direct, t_us, rate, force), put_imu(t_us, rate[0], true));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(nav_state(&direct), &nav_line_said[0].bytes[5], sizeof(nav_state_t));
        if (t_us % 200000 == 10000) {
            TEST_ASSERT_EQUAL(nav_gps(&direct, t_us - 1000, velocity_position, &velocity_position[3]),
                              put_reals(RECORD_GPS, t_us - 1000, velocity_position, 6));
            TEST_ASSERT_EQUAL(nav_down(&direct, t_us - 2000, down), put_reals(RECORD_DOWN, t_us - 2000, &down, 1));
            TEST_ASSERT_EQUAL(nav_field(&direct, t_us, field), put_reals(RECORD_FIELD, t_us, field, 3));
            TEST_ASSERT_EQUAL(9, nav_queued(&direct));
            TEST_ASSERT_EQUAL(9, nav_line_said[0].bytes[4]);
        }
    }
}

TEST(test_variances_begin_as_told)
{
    TEST_ASSERT_EQUAL(NAV_TAKEN, start_flight());
    TEST_ASSERT_EQUAL(NAV_TAKEN, nav_line_ask(RECORD_VARIANCES, NULL, 0));
    TEST_ASSERT_EQUAL(2 + 4 * NAV_STATES, nav_line_said[0].length);
    TEST_ASSERT_EQUAL(1, nav_line_said[0].bytes[1]);
    float variance[NAV_STATES];
    memcpy(variance, &nav_line_said[0].bytes[2], sizeof variance);
    TEST_ASSERT_FLOAT_WITHIN(1e-2F, 57.3F * 57.3F, variance[0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-6F, 1.44F, variance[3]);
    TEST_ASSERT_FLOAT_WITHIN(1e-9F, 4e-4F, variance[6]);
}
