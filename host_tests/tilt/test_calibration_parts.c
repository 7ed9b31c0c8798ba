/*
 * Six positions and tare on whole parts: gains, offsets, noise and positions held sloppily, against the true numbers,
 * against a solver, and what is refused.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "calibration.h"
#include "reference/calibration.h"
#include "rest.h"
#include "support/random.h"
#include "support/test.h"

#define DEG 57.29577951308232

typedef struct {
    double offset[3];
    double scale[3];
} part_t;

static test_random_t noise_source;
static calibration_t c;

void setUp(void)
{
    random_seed(&noise_source, 85);
    calibration_plain(&c, CALIBRATION_SCALE_3V3_XY_UQ6, CALIBRATION_SCALE_3V3_Z_UQ6);
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double angle_deg(const double a[3], const double b[3])
{
    const double cross[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    return DEG * atan2(length(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

static void direction(double u[3])
{
    for (int i = 0; i < 3; i++) {
        u[i] = random_normal(&noise_source);
    }
    double size = length(u);
    for (int i = 0; i < 3; i++) {
        u[i] /= size;
    }
}

static part_t random_part(double gain, double offset)
{
    part_t part;
    for (int i = 0; i < 3; i++) {
        part.scale[i] = (i < 2 ? 265.0 : 256.0) * (1.0 + gain * (2.0 * random_uniform(&noise_source) - 1.0));
        part.offset[i] = offset * (2.0 * random_uniform(&noise_source) - 1.0);
    }
    return part;
}

/* The position's axis, turned by an angle towards any direction. */
static void held(int position, double tilt_deg, double u[3])
{
    double towards[3];
    double along = 0.0;
    direction(towards);
    for (int i = 0; i < 3; i++) {
        double axis = i == position / 2 ? (position % 2 == 0 ? 1.0 : -1.0) : 0.0;
        u[i] = axis;
        along += axis * towards[i];
    }
    for (int i = 0; i < 3; i++) {
        towards[i] -= along * u[i];
    }
    double size = length(towards);
    for (int i = 0; i < 3; i++) {
        u[i] = cos(tilt_deg / DEG) * u[i] + sin(tilt_deg / DEG) * towards[i] / size;
    }
}

/* Mean of readings at 100 Hz on a desk: 2 LSB^2 on x and y, 1.7 times that on z (0: one exact reading). */
static void rest_mean(const part_t *part, const double u[3], int readings, int16_t mean_lsb_q4[3])
{
    rest_t rest;
    rest_start(&rest);
    for (int k = 0; k < readings; k++) {
        int16_t lsb[3];
        for (int i = 0; i < 3; i++) {
            double sigma = sqrt(i == 2 ? 3.4 : 2.0);
            lsb[i] = as_sample(part->offset[i] + part->scale[i] * u[i] + sigma * random_normal(&noise_source));
        }
        rest_add(&rest, lsb);
    }
    TEST_ASSERT_TRUE(readings == 0 || rest_still(&rest, 1000));
    for (uint8_t i = 0; i < 3; i++) {
        mean_lsb_q4[i] = readings == 0 ? (int16_t)lround(16.0 * (part->offset[i] + part->scale[i] * u[i]))
                                       : rest_mean_lsb_q4(&rest.axes[i]);
    }
}

/* All six positions: exactly so far off, each read once and exactly, or up to so far off and as a board reads. */
static calibration_verdict_t six(const part_t *part, double tilt_deg, int readings, int16_t means[18],
                                 uint16_t *residual_mg)
{
    for (int position = 0; position < 6; position++) {
        double u[3];
        held(position, readings == 0 ? tilt_deg : tilt_deg * random_uniform(&noise_source), u);
        rest_mean(part, u, readings, &means[3 * position]);
        if (readings != 0) { /* parts of 10 % and 40 LSB */
            TEST_ASSERT_EQUAL_INT(position, calibration_position(&means[3 * position]));
        }
    }
    return calibration_six(&c, means, residual_mg);
}

/* Largest angle between truth and what a calibration makes of exact readings, over so many random attitudes. */
static double worst_attitude(const part_t *part, const calibration_t *calibration, int attitudes, double *sum2)
{
    calibration_applied_t applied;
    double worst = 0.0;
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, calibration).why);
    for (int k = 0; k < attitudes; k++) {
        double u[3];
        double out[3];
        int32_t a_q8[3];
        int32_t out_q8[3];
        direction(u);
        for (int i = 0; i < 3; i++) {
            a_q8[i] = (int32_t)lround(256.0 * (part->offset[i] + part->scale[i] * u[i]));
        }
        calibration_apply(&applied, a_q8, out_q8);
        for (int i = 0; i < 3; i++) {
            out[i] = out_q8[i];
        }
        double error = angle_deg(out, u);
        worst = fmax(worst, error);
        *sum2 += error * error;
    }
    return worst;
}

/*
 * The numbers to reach: parts with +-10 % gain and +-40 LSB offset per axis, positions up to 15 degrees off, noise of a
 * desk, 1 s each: <= 0.3 degree over 200 random attitudes. 300 parts.
 *
 * What to expect: a mean of 100 readings has a deviation of 0.14 LSB (z 0.18), an offset 0.10 to 0.13 (mean of two), a
 * gain about that in LSB at 1 g; some 0.2 LSB across 256: 0.04 degree rms. Uncalibrated, an offset of 40 LSB on two
 * axes alone makes 12 degrees.
 */
TEST(test_six_positions_reach_0_3_degree)
{
    calibration_t none;
    calibration_plain(&none, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6);
    double worst = 0.0;
    double worst_before = 0.0;
    double sum2 = 0.0;
    double sum2_before = 0.0;
    uint16_t worst_residual = 0;
    for (int run = 0; run < 300; run++) {
        int16_t means[18];
        uint16_t residual_mg = 999;
        part_t part = random_part(0.1, 40.0);
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, six(&part, 15.0, REST_SAMPLES, means, &residual_mg).why);
        worst_residual = residual_mg > worst_residual ? residual_mg : worst_residual;
        worst = fmax(worst, worst_attitude(&part, &c, 200, &sum2));
        worst_before = fmax(worst_before, worst_attitude(&part, &none, 200, &sum2_before));
    }
    printf("300 parts, 200 attitudes each (seed 85): worst %.3f degree, rms %.3f; uncalibrated %.2f, rms %.2f; "
           "residual %d mg at most\n",
           worst, sqrt(sum2 / 60000.0), worst_before, sqrt(sum2_before / 60000.0), worst_residual);
    TEST_ASSERT_TRUE(worst <= 0.3);
    TEST_ASSERT_TRUE(sqrt(sum2 / 60000.0) <= 0.06);
    TEST_ASSERT_TRUE(worst_before >= 12.0);
    TEST_ASSERT_TRUE(worst_residual <= 1);
}

/*
 * Against the solution of the six equations from the same means. A component of g is right to 6.1e-5 (root rounded
 * down), and the others of 20 degrees count by tan(20) sqrt(2) = 0.51: their rounding 3.05e-5 and that of their
 * offsets, 1/32 of 200 LSB = 1.6e-4. Together 1.6e-4, 1.3 times that after all rounds: 2.1e-4 of 330 LSB are 0.069 LSB.
 * Scales are kept in 1/64 (0.008), offsets in 1/16 (0.031), and the rounds leave 0.005.
 */
TEST(test_six_positions_against_a_solver)
{
    double worst_offset = 0.0;
    double worst_scale = 0.0;
    for (int run = 0; run < 3000; run++) {
        int16_t means[18];
        uint16_t residual_mg = 999;
        part_t part = random_part(0.2, 75.0);
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, six(&part, 20.0, 0, means, &residual_mg).why);
        double readings[18];
        for (int i = 0; i < 18; i++) {
            readings[i] = means[i] / 16.0;
        }
        reference_six(readings, part.offset, part.scale);
        for (int i = 0; i < 3; i++) {
            worst_offset = fmax(worst_offset, fabs(c.offset_lsb_q4[i] / 16.0 - part.offset[i]));
            worst_scale = fmax(worst_scale, fabs(c.scale_lsb_per_g_uq6[i] / 64.0 - part.scale[i]));
        }
        TEST_ASSERT_TRUE(residual_mg <= 1);
    }
    printf("20 degrees off: offsets within %.3f LSB of the solver's, scales within %.3f LSB/g\n", worst_offset,
           worst_scale);
    TEST_ASSERT_TRUE(worst_offset <= 0.105);
    TEST_ASSERT_TRUE(worst_scale <= 0.082);
}

static void expect_refusal(const int16_t means[18], calibration_why_t why, uint8_t where)
{
    const calibration_t before = c;
    uint16_t residual_mg = 0;
    calibration_verdict_t verdict = calibration_six(&c, means, &residual_mg);
    TEST_ASSERT_EQUAL_UINT8(why, verdict.why);
    TEST_ASSERT_EQUAL_UINT8(where, verdict.where);
    TEST_ASSERT_EQUAL_MEMORY(&before, &c, sizeof before);
}

/* 256 LSB/g, no offset, every position exact: each fault alone. */
TEST(test_six_positions_refused_with_the_reason)
{
    static const int16_t exact[18] = { 4096, 0, 0, -4096, 0, 0, 0, 4096, 0, 0, -4096, 0, 0, 0, 4096, 0, 0, -4096 };
    for (uint8_t axis = 0; axis < 3; axis++) {
        int16_t means[18];
        const int upper = 7 * axis;
        const int lower = 7 * axis + 3;
        memcpy(means, exact, sizeof means);
        means[lower] = 4096; /* the same position twice */
        expect_refusal(means, CALIBRATION_SCALE, axis);
        means[lower] = (int16_t)-means[upper];
        means[upper] = 199 * 16; /* 199 LSB/g */
        means[lower] = -199 * 16;
        expect_refusal(means, CALIBRATION_SCALE, axis);
        means[upper] = 331 * 16;
        means[lower] = -331 * 16;
        expect_refusal(means, CALIBRATION_SCALE, axis);
        means[upper] = 4096 + 81 * 16; /* offset 81 LSB */
        means[lower] = -4096 + 81 * 16;
        expect_refusal(means, CALIBRATION_OFFSET, axis);
        for (uint8_t position = 0; position < 6; position++) {
            if (position / 2U != axis) {
                memcpy(means, exact, sizeof means);
                means[3 * position + axis] = 2900; /* 0.71 g across: 45 degrees */
                expect_refusal(means, CALIBRATION_TILTED, position);
            }
        }
    }
}

/* One position 15 degrees off changes by 1 - cos(15 degrees) = 34 mg in the first round: ended there, it is refused. */
TEST(test_six_positions_that_have_not_settled_are_refused)
{
    static const int16_t tilted[18] = { 4096, 0, 0, -4096, 0, 0, 0, 4096, 0, 0, -3956, 1060, 0, 0, 4096, 0, 0, -4096 };
    calibration_plain(&c, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6);
    const calibration_t before = c;
    calibration_six_t solver;
    calibration_six_start(&solver, &c);
    TEST_ASSERT_TRUE(calibration_six_step(&solver, tilted));
    uint16_t residual_mg = 0;
    calibration_verdict_t verdict = calibration_six_end(&solver, &c, &residual_mg);
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_RESIDUAL, verdict.why);
    TEST_ASSERT_EQUAL_UINT8(3, verdict.where);
    TEST_ASSERT_UINT_WITHIN(1, 34, residual_mg);
    TEST_ASSERT_EQUAL_MEMORY(&before, &c, sizeof before);
    while (calibration_six_step(&solver, tilted)) {
    }
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_six_end(&solver, &c, &residual_mg).why);
    TEST_ASSERT_EQUAL_UINT(0, residual_mg);
}

/* Whatever is read: a verdict, legal numbers if it is good, the old ones if not. */
TEST(test_six_positions_of_anything)
{
    int good = 0;
    for (int run = 0; run < 200000; run++) {
        int16_t means[18];
        for (int i = 0; i < 18; i++) {
            int range = run % 2 == 0 ? 65536 : 3000;
            int centre = run % 2 == 0 || (i % 3) != i / 6 ? 0 : ((i / 3) % 2 == 0 ? 4096 : -4096);
            means[i] = (int16_t)(centre + (int)random_below(&noise_source, (uint32_t)range) - range / 2);
        }
        calibration_plain(&c, CALIBRATION_SCALE_3V3_XY_UQ6, CALIBRATION_SCALE_3V3_Z_UQ6);
        const calibration_t before = c;
        uint16_t residual_mg;
        calibration_verdict_t verdict = calibration_six(&c, means, &residual_mg);
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_check(&c).why);
        if (verdict.why == (uint8_t)CALIBRATION_GOOD) {
            good++;
        } else {
            TEST_ASSERT_EQUAL_MEMORY(&before, &c, sizeof before);
        }
    }
    TEST_ASSERT_TRUE(good > 10000 && good < 100000); /* both ends of the test are met */
}

/* A calibrated part, mounted anyhow, tared with the noise of a desk: level reads as level but for that noise. */
TEST(test_tare_of_any_mounting)
{
    double worst = 0.0;
    for (int run = 0; run < 2000; run++) {
        part_t part = random_part(0.1, 40.0);
        double u[3];
        double up[3];
        static const double level[3] = { 0.0, 0.0, 1.0 };
        int16_t mean[3];
        for (int i = 0; i < 3; i++) {
            c.offset_lsb_q4[i] = (int16_t)lround(16.0 * part.offset[i]);
            c.scale_lsb_per_g_uq6[i] = (uint16_t)lround(64.0 * part.scale[i]);
        }
        direction(u);
        rest_mean(&part, u, REST_SAMPLES, mean);
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_tare(&c, mean).why);
        calibration_applied_t applied;
        int32_t a_q8[3];
        int32_t out_q8[3];
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
        for (int i = 0; i < 3; i++) {
            a_q8[i] = (int32_t)lround(256.0 * (part.offset[i] + part.scale[i] * u[i]));
        }
        calibration_apply(&applied, a_q8, out_q8);
        for (int i = 0; i < 3; i++) {
            up[i] = out_q8[i];
        }
        worst = fmax(worst, angle_deg(up, level));
    }
    /* 4.5 deviations of 0.13 LSB on z, 0.10 on x and y: 0.13 degree; 0.022 + 0.008 of arithmetic, 1/32 LSB: 0.007 */
    printf("tare of 2000 mountings: level off by %.3f degree at most\n", worst);
    TEST_ASSERT_TRUE(worst <= 0.17);
}
