/*
 * Two sensors that answer at one address pull SDA low together, and now and then one of their bits slips: an axis reads
 * double its value for one or a few samples, while the others are unaffected (recorded on a drone: one in five
 * readings).
 *
 * A jump counts if one axis alone changes by at least as much as a doubling of MIN_LSB, to double its value or back,
 * within a sixteenth. Each jump raises a score by RAISE, every other sample lowers it by one. In 32 recordings of
 * sensors in motion, up to 9 minutes long, the score stays below a third of LIMIT, in a stream with 1 % of bad readings
 * below a half; in the recording with two sensors it reaches LIMIT within 2 s.
 */
#include "adxl345_watch.h"

enum { MIN_LSB = 64, TOLERANCE_SHIFT = 4, LEAST_JUMP_LSB = MIN_LSB - (MIN_LSB >> TOLERANCE_SHIFT) };
enum { CALM_LSB = LEAST_JUMP_LSB - 1, CALM_SPAN_LSB = CALM_LSB + CALM_LSB };
enum { RAISE = 16, LIMIT = 128, SCORE_MAX = 255 };

static uint8_t score;
static bool suspected;

void adxl345_watch_start(void)
{
    score = 0;
    suspected = false;
}

static int16_t magnitude(int16_t lsb)
{
    return (int16_t)(lsb < 0 ? -lsb : lsb);
}

static bool is_double(int16_t lsb, int16_t of_lsb)
{
    int16_t level_lsb = magnitude(of_lsb);
    return level_lsb >= MIN_LSB &&
           magnitude((int16_t)(lsb - of_lsb - of_lsb)) <= (int16_t)((uint16_t)level_lsb >> TOLERANCE_SHIFT);
}

static bool doubled(const int16_t *now_lsb, const int16_t *before_lsb)
{
    int16_t from_lsb = 0;
    int16_t to_lsb = 0;
    uint8_t jumps = 0;
    for (uint8_t axis = 0; axis < 3; axis++) {
        int16_t before = *before_lsb++;
        int16_t now = *now_lsb++;
        if ((uint16_t)(now - before + CALM_LSB) > (uint16_t)CALM_SPAN_LSB) {
            jumps++;
            from_lsb = before;
            to_lsb = now;
        }
    }
    return jumps == 1 && (is_double(to_lsb, from_lsb) || is_double(from_lsb, to_lsb));
}

void adxl345_watch_sample(const int16_t now_lsb[3], const int16_t before_lsb[3])
{
    if (doubled(now_lsb, before_lsb)) {
        score = score > SCORE_MAX - RAISE ? SCORE_MAX : (uint8_t)(score + RAISE);
    } else if (score != 0) {
        score--;
    } else {
        suspected = false;
    }
    if (score >= LIMIT) {
        suspected = true;
    }
}

bool adxl345_watch_two_sensors(void)
{
    return suspected;
}
