/*
 * Mean, variance and stillness of a sensor at rest, from consecutive readings of its three axes.
 *
 * Only sums over differences to the first reading are kept, so any number of readings up to REST_SAMPLES_MAX costs the
 * same memory and nothing is rounded before the end. A reading too far from the first ends it: such a board has moved.
 *
 * Scaling: |difference| <= 127 LSB and at most 512 readings, so |sum| <= 65,024, squares <= 8,258,048, |sums| <=
 * 127 x 512 x 513 / 2 = 16,678,656, and readings x squares <= 4,228,120,576 < 2^32: all exact in 32 bits.
 */
#ifndef REST_H
#define REST_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* More readings are not counted. Fewer than the least are never called still. */
#define REST_SAMPLES_MAX 512U
#define REST_SAMPLES_MIN 16U

/* A reading beyond it (7.4 g) is no rest, and a mean in Q4 must fit 16 bits: 1,900 < 2,048 LSB. */
#define REST_LIMIT_LSB 1900

typedef struct {
    int32_t sum;      /* of the differences to the first reading, LSB */
    int32_t sums;     /* sum of all these sums: what a drift shows in */
    uint32_t squares; /* LSB^2 */
    int16_t first_lsb;
} rest_axis_t;

typedef struct {
    rest_axis_t axes[3];
    uint16_t samples; /* counted */
    bool moved;       /* a reading was more than 127 LSB from the first, or beyond REST_LIMIT_LSB */
} rest_t;

/* Before the first reading. Main only, as all here. */
void rest_start(rest_t *rest);

/*
 * One reading of all axes, any numbers. After REST_SAMPLES_MAX none is counted any more; after one that is too far away
 * neither, and mean and variance mean nothing then.
 */
void rest_add(rest_t *rest, const int16_t lsb[3]);

/* Mean of an axis (0..2), LSB in Q4, rounded half up; 0 without readings. */
int16_t rest_mean_lsb_q4(const rest_t *rest, uint8_t axis);

/*
 * Variance of an axis (about the mean, divided by the number of readings), LSB^2 in Q8; at most 1 / readings LSB^2 too
 * small, never too large by more than half a unit. 0 without readings.
 */
uint32_t rest_variance_lsb2_q8(const rest_t *rest, uint8_t axis);

/*
 * The board lay still, at an output data rate in 0.1 Hz: REST_SAMPLES_MIN readings or more, none of them far away, and
 * on every axis
 * - a variance of at most 31 times the sensor's own, 0.02 LSB^2 per Hz on x and y (62.5 LSB^2 at 100 Hz) and 1.7 times
 *   that on z. A desk shows 1 to 3 times it, an airframe with running motors 16 to 30 (33-60 LSB^2 at 100 Hz,
 *   measured): that one is at rest, its mean is good. A hand that holds the board quite still may pass, its mean too.
 * - a straight line through the readings that rises by at most 4 LSB (0.9 degree) over them: slow turning, which a
 *   variance hides. White noise of variance V makes such a line rise by sqrt(12 V / readings) rms: on a desk at
 *   100 Hz, with 100 readings, 0.5 LSB.
 */
bool rest_still(const rest_t *rest, uint16_t rate_dhz);

#ifdef __cplusplus
}
#endif
#endif
