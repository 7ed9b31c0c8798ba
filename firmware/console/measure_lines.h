/* Numbers and verdicts in the replies of measuring commands. Main only. */
#ifndef MEASURE_LINES_H
#define MEASURE_LINES_H

#include <stdint.h>

/* An axis' shift by the self-test, in the direction in which the force should act, LSB. */
int16_t measure_shift_q4(uint8_t axis);

/* One of the numbers SAY_RMS to SAY_OFF (enum say), in its unit, Q8; axis: 0..2, not used by SAY_OFF. */
int32_t measure_number_q8(uint8_t what, uint8_t axis);

/* The verdict of the self-test's limits on an axis' shift, in the order of its texts. */
enum { VERDICT_FAIL, VERDICT_PASS, VERDICT_HIGH };
uint8_t measure_verdict(uint8_t axis);

#endif
