/* The settings as a person meets them: parameters of the filter, the listing, address, axes, calibration, numbers. */
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "filter_list.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "settings/settings_table.h"
#include "support/roles.h"
#include "support/talk.h"
#include "support/test.h"

/* R at 100 Hz: 1.5 x 0.02 x 100 = 3 LSB^2. */
TEST(test_parameters_are_shown_set_and_refused)
{
    static const struct {
        const char *typed, *answer;
    } talk[] = { { "filter {robust}", "# filter {robust}" },
                 { "gate", "# gate 3 sigma: 1 to 16, 0: off" },
                 { "gate 3.5", "# gate 3.5 sigma: 1 to 16, 0: off" },
                 { "GATE 16", "# gate 16 sigma: 1 to 16, 0: off" },
                 { "gate 16.01", "# refused 4: illegal value; gate 16 sigma: 1 to 16, 0: off" },
                 { "gate 0.99", "# refused 4: illegal value; gate 16 sigma: 1 to 16, 0: off" },
                 { "gate -1", "# refused 4: illegal value; gate 16 sigma: 1 to 16, 0: off" },
                 { "gate 1.2.3", "# refused 4: illegal value; gate 16 sigma: 1 to 16, 0: off" },
                 { "gate one", "# refused 4: illegal value; gate 16 sigma: 1 to 16, 0: off" },
                 { "gate 4294967298", "# refused 4: illegal value; gate 16 sigma: 1 to 16, 0: off" },
                 { "gate 0", "# gate 0 sigma: 1 to 16, 0: off" },
                 { "r", "# r 3 LSB2: 0.0117 to 1000" },
                 { "r 12.25", "# r 12.25 LSB2: 0.0117 to 1000" },
                 { "reacquire 4", "# refused 4: illegal value; reacquire 5 samples: 3 to 9, 0: off" },
                 { "reacquire 9", "# reacquire 9 samples: 3 to 9, 0: off" },
                 { "r 1000", "# r 1000 LSB2: 0.0117 to 1000" },
                 { "q 1000000000", "# q 1000000000 LSB2/s3: 1 to 1000000000" },
                 { "q 1.5", "# refused 4: illegal value; q 1000000000 LSB2/s3: 1 to 1000000000" },
                 { "a1", "# refused 1: unknown command (type help)" },
                 { "filter {light}", "# filter {light}" },
                 { "a1", "# a1 0: -0.9999 to 0.9999" },
                 { "a1 -0.5", "# a1 -0.5: -0.9999 to 0.9999" },
                 { "a1 -0.9999",
                   "# refused 4: illegal value; a1 -0.5: -0.9999 to 0.9999" }, /* unstable with b0 = 0.3 */
                 { "gate", "# refused 1: unknown command (type help)" },
                 { "filter {robust}", "# filter {robust}" },
                 { "gate", "# gate 3 sigma: 1 to 16, 0: off" } }; /* another filter: as shipped again */
    talk_start();
    for (size_t i = 0; i < sizeof talk / sizeof talk[0]; i++) {
        TEST_ASSERT_EQUAL_STRING_MESSAGE(by_role(talk[i].answer), talk_answer(talk[i].typed), talk[i].typed);
    }
}

TEST(test_an_unknown_filter_is_refused_with_the_list)
{
    char answer[200] = "# refused 4: filter is one of";
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        (void)strcat(strcat(answer, " "), filter_listed_name((filter_kind_t)kind));
    }
    talk_start();
    TEST_ASSERT_EQUAL_STRING(answer, talk_answer("filter median"));
}

/* Mean square of the x column's steps from row to row, mg^2. */
static double roughness(size_t from)
{
    double sum = 0.0;
    for (size_t i = from + 1; i < board.row_count; i++) {
        double step = board.rows[i].mg[0] - board.rows[i - 1].mg[0];
        sum += step * step;
    }
    return sum / (double)(board.row_count - 1 - from);
}

/* A Kalman filter's gain follows q / R. R as set, not as estimated: 1000 for a noise of 2 LSB smooths far more. */
TEST(test_parameters_reach_the_filter)
{
    static const char *const typed[] = {
        "filter {plain}", "r 1000", "r 0.1", "q 1", "filter {robust}", "filter {plain}"
    };
    double rough[6];
    stream_t stream = board_noisy_stream(2000, 100.0, 2.0, 7);
    board_start(&stream, 0.0, 0);
    talk_type("offset 5 0 0");
    for (size_t i = 0; i < 6; i++) {
        talk_type(typed[i]);
        board_run_ms(500);
        size_t from = board.row_count;
        board_run_ms(3000);
        rough[i] = roughness(from);
    }
    TEST_ASSERT_TRUE(rough[1] < rough[0] / 4.0);
    TEST_ASSERT_TRUE(rough[2] > rough[0] * 2.0);
    TEST_ASSERT_TRUE(rough[3] < rough[2] / 4.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.3 * rough[0], rough[0], rough[5]); /* as shipped again, and the calibration as it was */
    TEST_ASSERT_EQUAL_INT(5 * 16, settings()->calibration.offset_lsb_q4[0]);
}

/* No parameter of one filter is taken for one of another while the pipeline changes. */
TEST(test_changes_in_quick_succession)
{
    talk_start();
    size_t before = board.note_count;
    hal_host_type(
        by_role("filter {robust}\ngate 2\nfilter {plain}\nr 7\nfilter {default}\nslow 500\nfilter {robust}\n"));
    board_run_ms(1500);
    TEST_ASSERT_EQUAL_size_t(before + 7, board.note_count);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("refused", before));
    for (int axis = 0; axis < 3; axis++) {
        TEST_ASSERT_EQUAL_PTR(filter_listed(robust_kind()), pipeline_axes()[axis].filter.law);
        TEST_ASSERT_EQUAL_UINT(3 * 256, pipeline_axes()[axis].filter.own.kalman.of.gated.gate_sigma_q8);
    }
    TEST_ASSERT_EQUAL_UINT(0, settings()->choice.own);
}

/* Each line names a setting, its value and what is legal; each, typed as it is told, changes nothing. */
TEST(test_the_listing_can_be_typed_again)
{
    char listed[40][BOARD_NOTE_LENGTH];
    talk_start();
    talk_type("filter {robust}");
    talk_type("gate 3.37");
    talk_type("r 2.71");
    size_t before = talk_typed("settings", 400);
    size_t lines = board.note_count - before;
    TEST_ASSERT_EQUAL_size_t(SETTING_PARAMETERS + 5, lines);
    for (size_t i = 0; i < lines; i++) {
        snprintf(listed[i], sizeof listed[i], "%s", board.notes[before + i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(listed[i], ": "), listed[i]);
    }
    for (size_t i = 1; i < lines; i++) { /* all but the filter, which would be as shipped */
        char line[40];
        snprintf(line, sizeof line, "%.*s", (int)strcspn(listed[i] + 2, ",:"), listed[i] + 2);
        char *unit = strpbrk(strchr(line, ' ') + 1, "LHgs");
        if (unit != NULL && unit[-1] == ' ') {
            *unit = '\0';
        }
        size_t reply = board.note_count; /* `mode csv` sends the header too */
        talk_type(line);
        TEST_ASSERT_EQUAL_STRING_LEN(listed[i], board.notes[reply], strcspn(listed[i], ":,"));
    }
    before = talk_typed("settings", 400);
    for (size_t i = 0; i < lines; i++) {
        TEST_ASSERT_EQUAL_STRING(listed[i], board.notes[before + i]);
    }
}

/* The virtual sensor is at 0x53. */
TEST(test_address)
{
    talk_start();
    TEST_ASSERT_EQUAL_STRING("# address auto", talk_answer("address"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: address is one of auto 53 1D", talk_answer("address 54"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: address is one of auto 53 1D", talk_answer("address 0x53"));
    size_t before = talk_typed("address 1D", 400);
    board_run_ms(1000);
    TEST_ASSERT_EQUAL_STRING("# address 1D", board.notes[before]);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 1: ", before)); /* it is not looked for elsewhere */
    talk_type("address 53");
    board_run_ms(500);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("lost, sensor at 0x53", before));
    talk_type("address 1d");
    board_run_ms(500);
    talk_type("address auto");
    size_t rows = board.row_count;
    board_run_ms(2000);
    TEST_ASSERT_TRUE(board.row_count > rows + 100);
    talk_type("address 53");
    rows = board.row_count;
    board_run_ms(1000);
    TEST_ASSERT_INT_WITHIN(10, 100, (int)(board.row_count - rows));
}

/* The speed is in force with the reply, is saved, and stands in the line of the rate. */
TEST(test_i2c)
{
    talk_start();
    TEST_ASSERT_EQUAL_STRING("# i2c auto", talk_answer("i2c"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: i2c is one of auto 100 400", talk_answer("i2c 363.6"));
    TEST_ASSERT_EQUAL_STRING("# i2c 100", talk_answer("i2c 100"));
    board_run_ms(500);
    TEST_ASSERT_EQUAL_STRING("# rate 50 Hz, I2C at 100 kHz", talk_answer("rate 50"));
    TEST_ASSERT_EQUAL_STRING("# saved", talk_answer("save"));
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_STRING("# i2c 100", talk_answer("i2c"));
    TEST_ASSERT_EQUAL_STRING("# rate 50 Hz, I2C at 100 kHz", talk_answer("rate"));
    TEST_ASSERT_EQUAL_STRING("# i2c 400", talk_answer("i2c 400"));
    TEST_ASSERT_EQUAL_STRING("# rate 50 Hz, I2C at 363.6 kHz", talk_answer("rate"));
    size_t before = talk_typed("rate 800", 400);
    TEST_ASSERT_EQUAL_STRING("# rate 800 Hz, I2C at 400 kHz", board.notes[before]);
    size_t rows = board.row_count;
    board_run_ms(1000);
    TEST_ASSERT_TRUE(board.row_count > rows + 100);
}

static bool is_axes(char a, char b, char c)
{
    char line[16];
    snprintf(line, sizeof line, "axes %s%c%s%c%s%c", a < 'a' ? "-" : "", a < 'a' ? a + 32 : a, b < 'a' ? "-" : "",
             b < 'a' ? b + 32 : b, c < 'a' ? "-" : "", c < 'a' ? c + 32 : c);
    size_t before = talk_typed(line, 60);
    bool taken = strncmp(board.notes[before] + 2, line, strlen(line)) == 0;
    TEST_ASSERT_TRUE(taken || strncmp(board.notes[before], "# refused 4: axes is one of ", 28) == 0);
    return taken;
}

/* Determinant of the signed permutation that three letters name, a capital for a reversed axis. */
static int determinant(const char name[3])
{
    int m[3][3] = { { 0 } };
    for (int i = 0; i < 3; i++) {
        bool reversed = name[i] < 'a';
        m[i][(reversed ? name[i] + 32 : name[i]) - 'x'] = reversed ? -1 : 1;
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Of 216 triples the 24 that are rotations. */
TEST(test_axes)
{
    static const char letters[] = "xyzXYZ";
    int taken = 0;
    talk_start();
    for (int i = 0; i < 216; i++) {
        char name[3] = { letters[i / 36], letters[i / 6 % 6], letters[i % 6] };
        bool legal = is_axes(name[0], name[1], name[2]);
        TEST_ASSERT_EQUAL_MESSAGE(determinant(name) == 1, legal, name);
        taken += legal;
    }
    TEST_ASSERT_EQUAL_INT(24, taken);
    TEST_ASSERT_EQUAL_STRING("# refused 4: axes is one of 24 like xyz or -yxz", talk_answer("axes xy"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: axes is one of 24 like xyz or -yxz", talk_answer("axes xyzx"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: axes is one of 24 like xyz or -yxz", talk_answer("axes x-"));
}

/* The resting board reads (31, -53, 248): by hand what offsets, scales and axes make of it. */
TEST(test_calibration_reaches_the_rows)
{
    stream_t stream = board_constant_stream(200, 100.0, 31, -53, 248);
    board_start(&stream, 0.0, 0);
    board_run_ms(500);
    talk_type("offset 11 -3.5 -8");
    talk_type("scale 265 230 256");
    const board_row_t *row = &board.rows[board.row_count - 1];
    TEST_ASSERT_EQUAL_INT(31, row->lsb[0]);
    TEST_ASSERT_INT_WITHIN(1, 75, row->mg[0]);   /* 20 / 265 */
    TEST_ASSERT_INT_WITHIN(1, -215, row->mg[1]); /* -49.5 / 230 */
    TEST_ASSERT_INT_WITHIN(1, 1000, row->mg[2]); /* 256 / 256 */
    talk_type("axes -yxz");
    row = &board.rows[board.row_count - 1];
    TEST_ASSERT_INT_WITHIN(1, 215, row->mg[0]);
    TEST_ASSERT_INT_WITHIN(1, 75, row->mg[1]);
    TEST_ASSERT_INT_WITHIN(3, 429, row->roll_cdeg); /* atan2(0.0755, 1) */
    talk_type("level 0 0 -1");                      /* upside down: turned about x */
    row = &board.rows[board.row_count - 1];
    TEST_ASSERT_INT_WITHIN(1, 215, row->mg[0]);
    TEST_ASSERT_INT_WITHIN(1, -75, row->mg[1]);
    TEST_ASSERT_INT_WITHIN(1, -1000, row->mg[2]);
    TEST_ASSERT_EQUAL_STRING("# refused 4: illegal value; offset 11 -3.5 -8 LSB: -80 to 80", talk_answer("offset 1 2"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: illegal value; offset 11 -3.5 -8 LSB: -80 to 80",
                             talk_answer("offset 1 2 3 4"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: illegal value; offset 11 -3.5 -8 LSB: -80 to 80",
                             talk_answer("offset 1 2 80.1"));
    TEST_ASSERT_EQUAL_STRING("# refused 4: illegal value; level 0 0 -1: -1.1499 to 1.1499",
                             talk_answer("level 0 0.1 0"));
    talk_type("stop");
    talk_type("save");
    talk_power_cycle(false);
    TEST_ASSERT_EQUAL_STRING("# offset 11 -3.5 -8 LSB: -80 to 80", talk_answer("offset"));
    TEST_ASSERT_EQUAL_STRING("# scale 265 230 256 LSB/g: 200 to 330", talk_answer("scale"));
    talk_type("go");
    board_run_ms(300);
    TEST_ASSERT_INT_WITHIN(1, 215, board.rows[board.row_count - 1].mg[0]);
    talk_type("defaults");
    board_run_ms(300);
    TEST_ASSERT_INT_WITHIN(1, 117, board.rows[board.row_count - 1].mg[0]);
}

/* What tare makes of a part that reads more than 1 g is told, and can be typed again: 264 / 256 = 1.03125. */
TEST(test_a_level_of_more_than_1_g_can_be_typed_again)
{
    stream_t stream = board_constant_stream(800, 100.0, 0, 0, 264);
    for (size_t i = 0; i < stream.count; i++) { /* else it is stuck */
        stream.rows[i].lsb[0] = i % 2 == 0 ? 1 : -1;
    }
    board_start(&stream, 0.0, 0);
    board_run_ms(300);
    (void)talk_typed("tare", 4000);
    TEST_ASSERT_EQUAL_INT16(16896, settings()->calibration.level_q14[2]); /* 264 / 256 */
    TEST_ASSERT_EQUAL_STRING("# level 0 0 1.0312: -1.1499 to 1.1499", board.notes[board.note_count - 2]);
    TEST_ASSERT_EQUAL_STRING("# level 0 0 1.0311: -1.1499 to 1.1499",
                             talk_answer("level 0 0 1.0312")); /* 16895 / 16384 */
}

/* b0 0.05 is stable beside the b1 of 800 Hz (-0.0407), not beside that of 400 Hz (-0.0780): the sum is negative. */
TEST(test_a_rate_at_which_the_parameters_do_not_go_together)
{
    char line[40];
    talk_start();
    snprintf(line, sizeof line, "filter %s", filter_listed_name(kind_with("b1")));
    talk_type(line);
    talk_type("rate 800");
    TEST_ASSERT_EQUAL_STRING_LEN("# b0 0.05", talk_answer("b0 0.05"), 9);
    talk_type("rate 400");
    TEST_ASSERT_EQUAL_STRING_LEN("# b0 0.0814", talk_answer("b0"), 11); /* 5339 / 65536, as shipped */
    board_run_ms(3000);
    const board_row_t *row = &board.rows[board.row_count - 1];
    for (int axis = 0; axis < 3; axis++) {
        TEST_ASSERT_INT_WITHIN(8, row->lsb[axis] * 1000 / 256, row->mg[axis]);
    }
}

TEST(test_numbers)
{
    static const struct {
        const char *text;
        uint8_t bits;
        bool legal;
        uint32_t value;
    } cases[] = { { "0", 0, true, 0 },
                  { "12.5", 6, true, 800 },
                  { "-12.5", 4, true, (uint32_t)-200 },
                  { "0.0039", 8, true, 1 },   /* 0.9984 */
                  { "0.0019", 8, true, 0 },   /* 0.4864 */
                  { "0.00001", 8, false, 0 }, /* five decimals */
                  { "2147483647", 0, true, 2147483647u },
                  { "2147483648", 0, false, 0 },
                  { "9999999999", 0, false, 0 },
                  { "1.0", 0, false, 0 },
                  { "1.", 8, false, 0 },
                  { ".5", 8, false, 0 },
                  { "-", 8, false, 0 },
                  { "", 8, false, 0 },
                  { "1 2", 8, true, 256 },
                  { "1x", 8, false, 0 },
                  { "--1", 8, false, 0 },
                  { "+1", 8, false, 0 },
                  { "1.5.", 8, false, 0 } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *at = cases[i].text;
        uint32_t value = 0;
        TEST_ASSERT_EQUAL_MESSAGE(cases[i].legal, number_parse(&at, cases[i].bits, &value), cases[i].text);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(cases[i].value, value, cases[i].text);
    }
    const char *rest = "1   2";
    uint32_t value;
    TEST_ASSERT_TRUE(number_parse(&rest, 0, &value));
    TEST_ASSERT_EQUAL_STRING("2", rest);
}
