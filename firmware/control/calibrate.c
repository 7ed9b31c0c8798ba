/* Collects the means of cal6, and applies or refuses a calibration. */
#include "control/calibrate.h"

#include "base/notices.h"
#include "path/pipeline.h"
#include "settings/settings.h"

static calibrate_report_t report;

static int16_t means_lsb_q4[3 * CALIBRATION_POSITIONS]; /* x, y, z of each position in turn */
static uint8_t known;                                   /* one bit per position */

const calibrate_report_t *calibrate_report(void)
{
    return &report;
}

void calibrate_start(void)
{
    known = 0;
    report.left = CALIBRATION_POSITIONS;
    report.position = CALIBRATION_POSITIONS;
}

static uint16_t size_of(int16_t mean_lsb_q4)
{
    return (uint16_t)(mean_lsb_q4 < 0 ? -mean_lsb_q4 : mean_lsb_q4);
}

/*
 * Nearly as far along a second axis as along this one: 41 degrees off for an exact part. At 20 degrees the worst legal
 * part (10 % of gain, 40 LSB) has 136 LSB across and 176 along.
 */
static bool oblique(const int16_t mean_lsb_q4[3], uint8_t position)
{
    uint8_t along = position >> 1;
    uint16_t limit_q4 = size_of(mean_lsb_q4[along]);
    limit_q4 = (uint16_t)(limit_q4 - (limit_q4 >> 3));
    for (uint8_t axis = 0; axis < 3; axis++) {
        if (axis != along && size_of(mean_lsb_q4[axis]) > limit_q4) {
            return true;
        }
    }
    return false;
}

/* Adds a position; UNCHANGED, BEGUN when it was the last, and so on. */
static measure_outcome_t add_position(const int16_t mean_lsb_q4[3])
{
    uint8_t position = calibration_position(mean_lsb_q4);
    if (position == report.position || oblique(mean_lsb_q4, position)) {
        return MEASURE_UNCHANGED;
    }
    report.position = position;
    uint8_t bit = (uint8_t)(1u << position);
    if (known & bit) {
        return MEASURE_REPEATED;
    }
    known |= bit;
    report.left--;
    for (uint8_t axis = 0; axis < 3; axis++) {
        means_lsb_q4[3u * position + axis] = mean_lsb_q4[axis];
    }
    return report.left == 0 ? MEASURE_BEGUN : MEASURE_POSITION;
}

/* The outcome of a calibration, which is in the settings or was refused. */
static measure_outcome_t outcome_of(calibration_verdict_t verdict)
{
    report.verdict = verdict;
    if (verdict.why != CALIBRATION_GOOD) {
        return MEASURE_WRONG;
    }
    pipeline_calibrate(&settings()->calibration);
    return MEASURE_DONE;
}

measure_outcome_t calibrate_take(uint8_t kind, const int16_t mean_lsb_q4[3])
{
    if (kind == NOTICE_CAL6) {
        return add_position(mean_lsb_q4);
    }
    return outcome_of(kind == NOTICE_TARE ? calibration_tare(&settings()->calibration, mean_lsb_q4)
                                          : calibration_single(&settings()->calibration, mean_lsb_q4));
}

void calibrate_start_six(calibration_six_t *six)
{
    calibration_six_start(six, &settings()->calibration);
}

measure_outcome_t calibrate_step(calibration_six_t *six)
{
    if (calibration_six_step(six, means_lsb_q4)) {
        return MEASURE_BEGUN;
    }
    return outcome_of(calibration_six_end(six, &settings()->calibration, &report.residual_mg));
}
