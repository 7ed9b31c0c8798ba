/*
 * `tare`, `cal` and `cal6` of the whole firmware, on parts of known gain and offset that lie as a person lays them,
 * judged by the truth of the model's part.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "base/notices.h"
#include "calibration.h"
#include "control/calibrate.h"
#include "control/measure.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/random.h"
#include "support/talk.h"
#include "support/test.h"

enum { HZ = 100, LIES_S = 6, TURNS_S = 1, LAY_ROWS = (LIES_S + TURNS_S) * HZ };

typedef struct {
    double g[3];
} attitude_t;

static test_random_t dice;

static const attitude_t ups[] = { { { 1, 0, 0 } },  { { -1, 0, 0 } }, { { 0, 1, 0 } },
                                  { { 0, -1, 0 } }, { { 0, 0, 1 } },  { { 0, 0, -1 } } };

void setUp(void)
{
    random_seed(&dice, 5);
}

/* One g in the direction of a, tilted: up to `degrees` off, by random shares across. */
static attitude_t tilted(attitude_t a, double degrees)
{
    double size = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        a.g[axis] += tan(degrees / 57.29578) / 1.7320508 * (2.0 * random_below(&dice, 1001) / 1000.0 - 1.0);
        size += a.g[axis] * a.g[axis];
    }
    for (int axis = 0; axis < 3; axis++) {
        a.g[axis] /= sqrt(size);
    }
    return a;
}

/* Each of the attitudes for LIES_S, then turned to the next one for TURNS_S; noise of 1 LSB. */
static void start_lays(const attitude_t *lays, size_t count, adxl345_part_t part)
{
    stream_t stream = board_constant_stream(count * LAY_ROWS, HZ, 0, 0, 0);
    for (size_t i = 0; i < stream.count; i++) {
        size_t lay = i / LAY_ROWS;
        size_t row = i % LAY_ROWS;
        const attitude_t *next = &lays[lay + 1 < count ? lay + 1 : lay];
        double share = row < LIES_S * HZ ? 0.0 : (double)(row - LIES_S * HZ) / (TURNS_S * HZ);
        for (size_t axis = 0; axis < 3; axis++) {
            double g = lays[lay].g[axis] * (1.0 - share) + next->g[axis] * share;
            stream.rows[i].lsb[axis] = (int16_t)lround(256.0 * g + random_normal(&dice));
        }
    }
    board_start(&stream, 0.0, 0);
    hal_host_sensor()->part = part;
    memcpy(hal_host_sensor()->part.self_test_lsb, adxl345_part_typical.self_test_lsb, sizeof part.self_test_lsb);
    board_run_ms(300);
}

/* Lays in this order (indices of ups), each tilted by up to so many degrees. */
static void start_order(const char *order, double degrees, adxl345_part_t part)
{
    attitude_t lays[16];
    size_t count = strlen(order);
    for (size_t i = 0; i < count; i++) {
        lays[i] = tilted(ups[order[i] - '0'], degrees);
    }
    start_lays(lays, count, part);
}

static double between(double low, double high)
{
    return low + (high - low) * random_below(&dice, 10001) / 10000.0;
}

/* Gains of 0.9 to 1.1 of a typical part at 3.3 V and offsets of up to 40 LSB. */
static adxl345_part_t any_part(void)
{
    adxl345_part_t part = adxl345_part_typical;
    for (int axis = 0; axis < 3; axis++) {
        part.gain[axis] = (axis < 2 ? 265.0 / 256.0 : 1.0) * between(0.9, 1.1);
        part.offset_lsb[axis] = (int16_t)lround(between(-40.0, 40.0));
    }
    return part;
}

static double angle_deg(const double a[3], const double b[3])
{
    double aa = 0.0;
    double bb = 0.0;
    double ab = 0.0;
    for (int i = 0; i < 3; i++) {
        aa += a[i] * a[i];
        bb += b[i] * b[i];
        ab += a[i] * b[i];
    }
    return 57.29578 * acos(fmin(1.0, ab / sqrt(aa * bb)));
}

/* The largest angle between gravity and what the calibration in force makes of the part's readings, 200 attitudes. */
static double worst_tilt_deg(const adxl345_part_t *part, double *uncalibrated_deg)
{
    calibration_applied_t applied;
    TEST_ASSERT_EQUAL(CALIBRATION_GOOD, calibration_prepare(&applied, &settings()->calibration).why);
    double worst = 0.0;
    for (int i = 0; i < 200; i++) {
        double g[3];
        double raw[3];
        double got[3];
        int32_t raw_q8[3];
        int32_t out_q8[3];
        double size = 0.0;
        for (int axis = 0; axis < 3; axis++) {
            g[axis] = random_normal(&dice);
            size += g[axis] * g[axis];
        }
        for (int axis = 0; axis < 3; axis++) {
            raw[axis] = 256.0 * g[axis] / sqrt(size) * part->gain[axis] + part->offset_lsb[axis];
            raw_q8[axis] = (int32_t)lround(256.0 * raw[axis]);
        }
        calibration_apply(&applied, raw_q8, out_q8);
        for (int axis = 0; axis < 3; axis++) {
            got[axis] = out_q8[axis];
        }
        worst = fmax(worst, angle_deg(got, g));
        *uncalibrated_deg = fmax(*uncalibrated_deg, angle_deg(raw, g));
    }
    return worst;
}

/*
 * Six positions in any order, up to 15 degrees off, some laid twice: 0.3 degree at 200 attitudes of each part. Each
 * position is told once, with how many are left; then offsets and scales.
 */
TEST(test_cal6_of_any_part)
{
    static const char *const orders[] = { "401523", "0123451", "5440213", "321054", "2244501133", "045321" };
    double worst = 0.0;
    double uncalibrated = 0.0;
    for (size_t i = 0; i < 12; i++) {
        adxl345_part_t part = any_part();
        const char *order = orders[i % 6];
        start_order(order, 15.0, part);
        size_t note = talk_typed("cal6", (double)strlen(order) * 7000.0 - 400.0);
        TEST_ASSERT_EQUAL_STRING("# cal6: hold still", board.notes[note]);
        for (int left = 5; left > 0; left--) {
            char told[40];
            snprintf(told, sizeof told, " up, %d to go", left);
            TEST_ASSERT_EQUAL_size_t_MESSAGE(1, board_notes_with(told, note), told);
        }
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: residual ", note));
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# offset ", note));
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# scale ", note));
        TEST_ASSERT_EQUAL_size_t(0, board_notes_with("refused", note));
        worst = fmax(worst, worst_tilt_deg(&part, &uncalibrated));
    }
    printf("worst tilt: %.3f degree after cal6, %.2f before\n", worst, uncalibrated);
    TEST_ASSERT_TRUE(worst <= 0.3);
    TEST_ASSERT_TRUE(uncalibrated > 5.0);
}

/* The rows' mg columns are calibrated from then on, the lsb columns as read: 1 g in the position in which it ended. */
TEST(test_rows_after_cal6)
{
    adxl345_part_t part = { { 1.1, 0.9, 1.05 }, { 40, -40, 25 }, { 0, 0, 0 } };
    start_order("012345", 0.0, part);
    (void)talk_typed("cal6", 41500.0);
    const board_row_t *row = &board.rows[board.row_count - 1];
    TEST_ASSERT_INT_WITHIN(5, 0, row->mg[0]);
    TEST_ASSERT_INT_WITHIN(5, 0, row->mg[1]);
    TEST_ASSERT_INT_WITHIN(5, -1000, row->mg[2]);
    TEST_ASSERT_INT_WITHIN(5, 40, row->lsb[0]);
    TEST_ASSERT_INT_WITHIN(6, 25 - 269, row->lsb[2]);
}

/* A position that was known: told once each time it is laid anew, and it counts once. */
TEST(test_a_position_laid_again_is_refused)
{
    start_order("4044", 5.0, adxl345_part_typical);
    size_t note = talk_typed("cal6", 27500.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +z up, 5 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +x up, 4 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +z up again: try another", note));
    TEST_ASSERT_EQUAL_size_t(note + 4, board.note_count);
}

/* Held in between, 43 degrees off the axis that is nearest: no position, and no line until it lies straight. */
TEST(test_an_oblique_rest_is_no_position)
{
    static const attitude_t lays[] = {
        { { 0, 0, 1 } }, { { 0.7314, 0, 0.682 } }, { { 0, 0.682, -0.7314 } }, { { 1, 0, 0 } }
    };
    start_lays(lays, 4, adxl345_part_typical);
    size_t note = talk_typed("cal6", 27500.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +z up, 5 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +x up, 4 to go", note));
    TEST_ASSERT_EQUAL_size_t(note + 3, board.note_count);
}

/* Up to 40 degrees off it is a position, and is reported: 39, across either of the other axes, of an exact part. */
TEST(test_a_rest_39_degrees_off_is_a_position)
{
    static const attitude_t lays[] = {
        { { 0, 0, 1 } }, { { 0.7771, 0, 0.6293 } }, { { 0, 0.6293, -0.7771 } }, { { 0, -0.7771, -0.6293 } }
    };
    start_lays(lays, 4, adxl345_part_typical);
    size_t note = talk_typed("cal6", 27500.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +z up, 5 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +x up, 4 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: -z up, 3 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: -y up, 2 to go", note));
}

/* To a sixteenth of an LSB, with the part across on either axis and of either sign. */
TEST(test_seven_eighths_across_is_the_last_that_is_a_position)
{
    enum { ALONG = 4096, MOST = ALONG - ALONG / LIMIT_CAL6_EIGHTHS };
    for (int across = MOST - 1; across <= MOST + 1; across++) {
        for (int which = 0; which < 4; which++) {
            int16_t mean_lsb_q4[3] = { 0, 0, -ALONG };
            mean_lsb_q4[which / 2] = (int16_t)(which % 2 ? across : -across);
            calibrate_start();
            TEST_ASSERT_EQUAL(across <= MOST ? MEASURE_POSITION : MEASURE_UNCHANGED,
                              calibrate_take(NOTICE_CAL6, mean_lsb_q4));
        }
    }
}

/* x or y is 35 degrees off in its position: refused by name, and nothing changes. */
TEST(test_a_position_too_far_off_is_refused)
{
    attitude_t lays[6];
    memcpy(lays, ups, sizeof lays);
    lays[2] = (attitude_t){ { 0.5736, 0.8192, 0 } };
    start_lays(lays, 6, adxl345_part_typical);
    calibration_t before = settings()->calibration;
    size_t note = talk_typed("cal6", 41700.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 11: +y is 20 degrees off or more", note));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("residual", note));
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
}

/* Beyond the legal numbers: refused with the axis. An offset of 90 LSB on y; a gain that makes z 340 LSB/g. */
TEST(test_a_part_beyond_the_limits_is_refused)
{
    static const struct {
        adxl345_part_t part;
        const char *told;
    } parts[] = { { { { 1, 1, 1 }, { 0, 90, 0 }, { 0, 0, 0 } }, "# refused 11: illegal offset of y" },
                  { { { 1, 1, 1.328 }, { 0, 0, 0 }, { 0, 0, 0 } }, "# refused 11: illegal scale of z" } };
    for (size_t i = 0; i < 2; i++) {
        start_order("012345", 2.0, parts[i].part);
        calibration_t before = settings()->calibration;
        size_t note = talk_typed("cal6", 41700.0);
        TEST_ASSERT_EQUAL_size_t(1, board_notes_with(parts[i].told, note));
        TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
    }
}

/* `cal6 stop`: nothing is kept, and the next one begins with none of six. */
TEST(test_cal6_stops)
{
    start_order("0444", 5.0, adxl345_part_typical);
    calibration_t before = settings()->calibration;
    size_t note = talk_typed("cal6", 6000.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(", 5 to go", note));
    size_t stopped = talk_typed("cal6 stop", 2000.0);
    TEST_ASSERT_EQUAL_STRING("# cal6: stopped", board.notes[stopped]);
    TEST_ASSERT_EQUAL_size_t(stopped + 1, board.note_count);
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
    note = talk_typed("cal6", 5500.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# cal6: +z up, 5 to go", note));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("unknown command", talk_typed("cal6 go", 100.0)));
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 10", talk_typed("tare", 100.0)));
    (void)talk_typed("cal6 stop", 100.0);
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("refused", talk_typed("tare", 100.0)));
}

/* Also when all six are known and the calibration is being found, which takes several passes. */
TEST(test_cal6_stops_while_it_is_solved)
{
    start_order("012345", 2.0, adxl345_part_typical);
    calibration_t before = settings()->calibration;
    size_t note = talk_typed("cal6", 30000.0);
    while (calibrate_report()->left != 0) {
        TEST_ASSERT_TRUE(hal_host_now_ms() < 45000.0);
        app_pass();
    }
    measure_stop();
    board_run_ms(2000.0);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with(", 1 to go", note));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with("residual", note));
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
    TEST_ASSERT_FALSE(measure_runs());
}

/* Another rate, or the sensor gone, ends it; nothing of it is left. */
TEST(test_cal6_ends_with_the_sensor)
{
    start_order("0123", 5.0, adxl345_part_typical);
    calibration_t before = settings()->calibration;
    size_t note = talk_typed("cal6", 13000.0);
    adxl345_model_power(hal_host_sensor(), false);
    board_run_ms(100);
    adxl345_model_power(hal_host_sensor(), true);
    board_run_ms(5000);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# refused 9: samples lost or settings changed", note));
    TEST_ASSERT_EQUAL_size_t(0, board_notes_with(", 3 to go", note));
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
}

/*
 * Any mounting, upside down too: afterwards this attitude has roll and pitch 0. The rest's mean is good to 0.09 LSB an
 * axis, the filter's output in the row to about 1 LSB: 0.22 degree; 0.7 is three times that.
 */
TEST(test_tare_levels_any_mounting)
{
    for (int i = 0; i < 26; i++) {
        attitude_t lay = { { 0, 0, i == 0 ? -1 : 1 } };
        if (i > 1) {
            lay = tilted(ups[i % 6], 80.0);
        }
        start_lays(&lay, 1, adxl345_part_typical);
        size_t note = talk_typed("tare", 3300.0);
        TEST_ASSERT_EQUAL_STRING("# tare: hold still", board.notes[note]);
        TEST_ASSERT_EQUAL_STRING_LEN("# level ", board.notes[note + 1], 8);
        TEST_ASSERT_EQUAL_STRING("# in force now; type save to keep it", board.notes[note + 2]);
        TEST_ASSERT_EQUAL_size_t(note + 3, board.note_count);
        const board_row_t *row = &board.rows[board.row_count - 1];
        TEST_ASSERT_INT_WITHIN(70, 0, row->roll_cdeg);
        TEST_ASSERT_INT_WITHIN(70, 0, row->pitch_cdeg);
    }
}

/* Turning through the rest, or 1.5 g: refused in words, and the mounting stays. */
TEST(test_tare_of_what_is_no_rest_is_refused)
{
    static const attitude_t turning[] = { { { 0, 0, 1 } }, { { 0, 1, 0 } } };
    static const attitude_t pulled = { { 0, 0, 1.5 } };
    start_lays(turning, 2, adxl345_part_typical);
    calibration_t before = settings()->calibration;
    board_run_ms(5000.0);
    size_t note = talk_typed("tare", 3000.0);
    TEST_ASSERT_EQUAL_STRING("# refused 8: moving", board.notes[note + 1]);
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
    start_lays(&pulled, 1, adxl345_part_typical);
    note = talk_typed("tare", 3000.0);
    TEST_ASSERT_EQUAL_STRING("# refused 11: not 1 g", board.notes[note + 1]);
    TEST_ASSERT_EQUAL_MEMORY(&before, &settings()->calibration, sizeof before);
}

/* One level rest gives the offsets, whichever of the six is up; scales stay. */
TEST(test_cal_finds_offsets)
{
    static const int16_t offsets[] = { 30, -25, 44 };
    for (int i = 0; i < 6; i++) {
        adxl345_part_t part = adxl345_part_typical;
        start_lays(&ups[i], 1, part);
        for (int axis = 0; axis < 3; axis++) {
            hal_host_sensor()->part.gain[axis] = settings()->calibration.scale_lsb_per_g_uq6[axis] / 64.0 / 256.0;
            hal_host_sensor()->part.offset_lsb[axis] = offsets[axis];
        }
        board_run_ms(100);
        size_t note = talk_typed("cal", 3000.0);
        TEST_ASSERT_EQUAL_STRING_LEN("# offset ", board.notes[note + 1], 9);
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_INT_WITHIN(8, 16 * offsets[axis], settings()->calibration.offset_lsb_q4[axis]);
        }
    }
}
