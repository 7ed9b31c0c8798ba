/*
 * From the sensor's readings to accelerations in the axes of the object it is mounted on, and how to find the numbers
 * for it.
 *
 * Readings less the offset, over the scale, axes renamed, then rotated by the mounting: out = mounting x axes x
 * diag(256 / scale) x (reading - offset), in units of 1/256 g, which the rest of lib/tilt calls LSB. Offsets and scales
 * belong to the sensor's own axes, as printed on its board. An accelerometer at rest can observe neither heading nor a
 * misalignment of its axes with the mounting.
 */
#ifndef CALIBRATION_H
#define CALIBRATION_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sensitivity in LSB per g, UQ9.6. ADXL345 (Rev. E): p. 4 at 2.5 V, 256 (230..282); p. 33 at 3.3 V, 265 on x and y. */
#define CALIBRATION_SCALE_UQ6(lsb_per_g) ((uint16_t)((lsb_per_g)*64U))
#define CALIBRATION_SCALE_2V5_UQ6 CALIBRATION_SCALE_UQ6(256U)
#define CALIBRATION_SCALE_3V3_XY_UQ6 CALIBRATION_SCALE_UQ6(265U)
#define CALIBRATION_SCALE_3V3_Z_UQ6 CALIBRATION_SCALE_UQ6(256U)

/*
 * Legal values: 200..330 LSB per g (parts at rest show 226 to 296), and offsets up to 80 LSB (312 mg: p. 4 has 250 mg
 * on z, p. 33 another 20 mg at 3.3 V, and 1.2 mg per degree C for 30 degrees).
 */
#define CALIBRATION_SCALE_MIN_UQ6 CALIBRATION_SCALE_UQ6(200U)
#define CALIBRATION_SCALE_MAX_UQ6 CALIBRATION_SCALE_UQ6(330U)
#define CALIBRATION_OFFSET_MAX_LSB_Q4 1280

typedef struct {
    int16_t offset_lsb_q4[3]; /* reading at 0 g */
    uint16_t scale_lsb_per_g_uq6[3];
    int16_t level_q14[3]; /* gravity in our axes, 1 g = 16384, while the object that carries the board is level */
    int8_t axes[3];       /* our x, y, z: 1, 2, 3 for the sensor's x, y, z, negative if reversed */
    uint8_t unused;       /* no padding on any machine: the firmware saves the raw bytes */
} calibration_t;

/* The same, ready for use. */
typedef struct {
    int32_t bias_lsb_q14[3]; /* effect of the offsets, plus half a unit for rounding */
    int16_t matrix_q14[9];
} calibration_applied_t;

/*
 * No offsets, the sensor's own axes, these scales. With 256 on all axes the readings pass unchanged, to the last bit.
 */
void calibration_plain(calibration_t *c, uint16_t scale_xy_uq6, uint16_t scale_z_uq6);

/* Why a calibration was refused. */
typedef enum {
    CALIBRATION_GOOD,
    CALIBRATION_TILTED,    /* position `where` (0..5) is more than 20 degrees from its axis */
    CALIBRATION_OFFSET,    /* of axis `where` (0..2) is not legal */
    CALIBRATION_SCALE,     /* of axis `where` is not legal, or its two positions do not give one */
    CALIBRATION_RESIDUAL,  /* position `where` does not fit the others */
    CALIBRATION_AXES,      /* do not name each of the sensor's axes once */
    CALIBRATION_NO_GRAVITY /* level is not 0.85..1.15 g */
} calibration_why_t;

typedef struct {
    uint8_t why; /* calibration_why_t */
    uint8_t where;
} calibration_verdict_t;

/* Good, or the first value that is not legal. */
calibration_verdict_t calibration_check(const calibration_t *c);

/*
 * Prepares a calibration for use. If a value is not legal, refuses and writes nothing.
 *
 * The mounting rotation takes the direction u = (x, y, z) of level, |u| = 1, to (0, 0, 1). It is the tau matrix (3.34)
 * of the square-root navigation thesis (paper 003) with z in the place of its first axis,
 *
 *     1 - x^2/(1+z)   -x y/(1+z)      -x
 *     -x y/(1+z)      1 - y^2/(1+z)   -y
 *     x               y                z
 *
 * and that is the rotation by the smallest angle, about the level axis u x (0, 0, 1): it does not change the heading.
 * Upside down (z < 0) that axis is ill defined, and at z = -1 the matrix is infinite. There the sensor is first rotated
 * by half a turn about its x axis (y and z change sign), and x keeps its heading: exactly upside down gives diag(1, -1,
 * -1). For every mounting that is rotated about x alone both forms are the same rotation.
 *
 * Error: |u| is right to 7.2e-5 (root rounded down) and its components to 3.1e-5; a share x/(1+z) and an element are
 * rounded to Q14, 3.1e-5 each. |M M^T - I| <= 5.2e-4, an element is right to 3.0e-4, and level comes out within 3.9e-4
 * rad = 0.022 degree of (0, 0, 1); found 0.015 (derived in host_tests/tilt/test_calibration_reference.c).
 */
calibration_verdict_t calibration_prepare(calibration_applied_t *applied, const calibration_t *c);

/*
 * LSB in Q8 to 1/256 g in Q8. a and out must not overlap. Any int32 is safe; meant for |a| <= 4,608 LSB.
 *
 * Scaling: a, out Q8; matrix Q14, |element| <= 1.28; sums Q14. |out| <= sqrt(3) x 256/200 x (4,608 + 80) = 10,394 LSB,
 * so |4 sums| < 2^30: nothing wraps.
 *
 * Error against the formula in real numbers, at 1 g, without a mounting: elements are rounded to 2^-15, which between
 * two axes of 330 LSB/g makes an angle of 3.9e-5 rad at most; products are truncated by 6/64 of a unit of Q8 in all and
 * the sum is rounded, 0.6 units of 2^-16 g per axis (1.3e-5 rad): 5.2e-5 rad = 0.003 degree. With a mounting all nine
 * elements are rounded, 1.2e-4 rad if all the same way: 0.008 degree. Takes the same number of cycles for any numbers.
 */
void calibration_apply(const calibration_applied_t *applied, const int32_t a_q8[3], int32_t out_q8[3]);

/* A position is the sensor's axis that points up: 0 +x, 1 -x, 2 +y, 3 -y, 4 +z, 5 -z. */
enum { CALIBRATION_POSITIONS = 6 };

/*
 * The position nearest to a mean at rest (LSB, Q4), uncalibrated: correct up to 26 degrees off its axis for gains
 * within 10 % and offsets up to 40 LSB.
 */
uint8_t calibration_position(const int16_t mean_lsb_q4[3]);

/*
 * Sets level from a mean at rest (LSB, Q4) with the offsets, scales and axes in force: from then on this attitude has
 * roll and pitch 0. Refused, and *c unchanged, if the vector is not 0.85..1.15 g.
 */
calibration_verdict_t calibration_tare(calibration_t *c, const int16_t mean_lsb_q4[3]);

/*
 * Finds the offsets from one mean at rest in the nearest of the six positions, which must be level, with the scales in
 * force. Refused, and *c unchanged, if an offset is not legal.
 */
calibration_verdict_t calibration_single(calibration_t *c, const int16_t mean_lsb_q4[3]);

/*
 * Finds offsets and scales from the means at rest in all six positions (x, y, z of position 0, x, y, z of position 1,
 * ...), each up to 20 degrees from its axis in any direction. Refused, and *c unchanged, with the reason. residual_mg:
 * the largest | |a| - 1 g | of the six, if not refused; above 160/16384 g (9.8 mg) they do not fit each other. Six
 * readings determine six numbers, so it shows whether the solution fits, not how good the readings were.
 */
calibration_verdict_t calibration_six(calibration_t *c, const int16_t mean_lsb_q4[3 * CALIBRATION_POSITIONS],
                                      uint16_t *residual_mg);

/* The same one round at a time, for a loop that must not wait 8 ms. The members are private. */
typedef struct {
    calibration_t found;
    uint16_t known_q14[CALIBRATION_POSITIONS];
    uint16_t off_q14;
    uint8_t where;
    uint8_t round;
    calibration_verdict_t verdict;
} calibration_six_t;

/* Starts with the axes and the level of this calibration, which is not changed. */
void calibration_six_start(calibration_six_t *six, const calibration_t *c);

/* One round; the means are the same each time. False: it was the last round, calibration_six_end is next. */
bool calibration_six_step(calibration_six_t *six, const int16_t mean_lsb_q4[3 * CALIBRATION_POSITIONS]);

/* Same result as calibration_six. */
calibration_verdict_t calibration_six_end(const calibration_six_t *six, calibration_t *c, uint16_t *residual_mg);

#ifdef __cplusplus
}
#endif
#endif
