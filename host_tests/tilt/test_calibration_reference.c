/*
 * Calibration against double: errors of use, the mounting's rotation over a fine sphere and against paper 003, six
 * positions against a solver.
 *
 * Bounds of the mounting. The root is rounded down, at 0.85 g or more: |u| is too long by 1/13926 = 7.2e-5 at most, and
 * its components are rounded by 3.05e-5, so | |u|^2 - 1 | <= d = 2 (7.2e-5 + sqrt(3) 3.05e-5) = 2.5e-4. Elements are
 * w_i t_j - d_ij, t_j rounded by 3.05e-5 (t_3 = 1 exactly), the product too: 6.1e-5 in rows 1 and 2 (columns 1 and 2),
 * 9.2e-5 in row 3. The rows of the exact matrix of such a u have products off by d at most. So
 *   |M M' - I| <= d + 2 sqrt(2) 9.2e-5 = 5.1e-4,
 *   level: d (x^2 + y^2)^(1/2) / (1+z) + sqrt(2) 6.1e-5 + sqrt(3) 3.05e-5 = 3.9e-4,
 *   an element: radial 2 x 7.2e-5, 3 x 3.05e-5 by the components, 6.1e-5 = 3.0e-4.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "calibration.h"
#include "reference/calibration.h"
#include "support/random.h"
#include "support/test.h"

#define ORTHOGONALITY_BOUND 5.2e-4
#define ORTHOGONALITY_GOAL 1e-3
#define LEVEL_BOUND_RAD 3.9e-4
#define ELEMENT_BOUND 3.0e-4
#define USE_BOUND_RAD 5.2e-5      /* calibration.h: 3.9e-5 + 1.3e-5 */
#define MOUNTED_BOUND_RAD 1.33e-4 /* 1.2e-4 + 1.3e-5 */
#define DEG 57.29577951308232

static calibration_t c;
static calibration_applied_t applied;

void setUp(void)
{
    calibration_plain(&c, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6);
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Angle between two vectors, by the cross product: right for small ones. */
static double angle_between(const double a[3], const double b[3])
{
    const double cross[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    return atan2(length(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

static void direction(test_random_t *random, double u[3])
{
    for (int i = 0; i < 3; i++) {
        u[i] = random_normal(random);
    }
    double size = length(u);
    for (int i = 0; i < 3; i++) {
        u[i] /= size;
    }
}

/* The matrix in force is the mounting itself when scales are 256. */
static void mounting_of(const int16_t level_q14[3], double m[9])
{
    memcpy(c.level_q14, level_q14, sizeof c.level_q14);
    TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
    for (int i = 0; i < 9; i++) {
        m[i] = applied.matrix_q14[i] / 16384.0;
    }
}

/* Every 0.5 degree of the sphere, at 0.86, 1 and 1.14 g. */
TEST(test_mounting_on_a_fine_sphere)
{
    double worst_product = 0.0;
    double worst_level = 0.0;
    double worst_element = 0.0;
    for (int elevation = -180; elevation <= 180; elevation++) {
        for (int turn = 0; turn < 720; turn++) {
            double g = (elevation + turn) % 3 == 0 ? 14090.0 : (elevation + turn) % 3 == 1 ? 16384.0 : 18670.0;
            double e = elevation / 2.0 / DEG;
            double t = turn / 2.0 / DEG;
            const int16_t level[3] = { (int16_t)lround(g * cos(e) * cos(t)), (int16_t)lround(g * cos(e) * sin(t)),
                                       (int16_t)lround(g * sin(e)) };
            const double exact[3] = { level[0], level[1], level[2] };
            double m[9];
            double reference[9];
            mounting_of(level, m);
            reference_mounting(exact, reference);
            worst_product = fmax(worst_product, reference_orthogonality(m));
            double up[3];
            for (int i = 0; i < 3; i++) {
                up[i] = m[3 * i] * exact[0] + m[3 * i + 1] * exact[1] + m[3 * i + 2] * exact[2];
            }
            worst_level = fmax(worst_level, atan2(hypot(up[0], up[1]), up[2]));
            for (int i = 0; i < 9; i++) {
                worst_element = fmax(worst_element, fabs(m[i] - reference[i]));
            }
        }
    }
    printf("mounting: |M M' - I| %.2e, level off by %.2e rad, element %.2e at most\n", worst_product, worst_level,
           worst_element);
    TEST_ASSERT_TRUE(worst_product <= ORTHOGONALITY_BOUND && ORTHOGONALITY_BOUND <= ORTHOGONALITY_GOAL);
    TEST_ASSERT_TRUE(worst_level <= LEVEL_BOUND_RAD);
    TEST_ASSERT_TRUE(worst_element <= ELEMENT_BOUND);
}

/* tau takes its vector to the first axis; with the axes (z, x, y) for (1, 2, 3) it is the smallest turn to z. */
TEST(test_tau_of_paper_003_is_the_smallest_turn)
{
    test_random_t random;
    random_seed(&random, 81);
    for (int run = 0; run < 10000; run++) {
        double u[3];
        direction(&random, u);
        if (u[2] < -0.99) {
            continue; /* both are ill defined at -1 */
        }
        const double permuted[3] = { u[2], u[0], u[1] };
        double tau[9];
        double turn[9];
        reference_tau(permuted, tau);
        reference_smallest_turn(u, turn);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                TEST_ASSERT_DOUBLE_WITHIN(1e-12, turn[3 * i + j], tau[3 * ((i + 1) % 3) + (j + 1) % 3]);
            }
        }
    }
}

/* The field of the paper: notes on paper 003, tau of H = (17818, 1951, 41847) nT to nine digits. */
TEST(test_tau_has_the_papers_numbers)
{
    static const double field[3] = { 17818, 1951, 41847 };
    static const double printed[9] = { .391395644,  .042856263,  .919224015,  -.042856263, .998679988,
                                       -.028312944, -.919224015, -.028312944, .392715656 };
    double tau[9];
    reference_tau(field, tau);
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, printed[i], tau[i]);
    }
}

/* A mounting that is turned about x keeps the x axis: row 1 is (1, 0, 0) whichever way up. */
TEST(test_mounting_about_x_keeps_the_heading_of_x)
{
    for (int tenth = 0; tenth < 3600; tenth++) {
        double t = tenth / 10.0 / DEG;
        const int16_t level[3] = { 0, (int16_t)lround(16384 * sin(t)), (int16_t)lround(16384 * cos(t)) };
        double m[9];
        mounting_of(level, m);
        TEST_ASSERT_TRUE(m[0] == 1.0 && m[1] == 0.0 && m[2] == 0.0 && m[3] == 0.0 && m[6] == 0.0);
    }
}

static void random_part(test_random_t *random, double offset[3], double scale[3])
{
    for (int i = 0; i < 3; i++) {
        c.offset_lsb_q4[i] = (int16_t)((int)random_below(random, 2561) - 1280);
        c.scale_lsb_per_g_uq6[i] = (uint16_t)(12800U + random_below(random, 8321));
        offset[i] = c.offset_lsb_q4[i] / 16.0;
        scale[i] = c.scale_lsb_per_g_uq6[i] / 64.0;
    }
}

/* Direction of 1 g after the calibration against double, any legal part; with its own mounting the matrix is given. */
static double worst_use(bool mounted, uint64_t seed)
{
    test_random_t random;
    random_seed(&random, seed);
    double worst = 0.0;
    for (int run = 0; run < 300000; run++) {
        double offset[3], scale[3], u[3], mounting[9], out[3], exact[3];
        setUp();
        direction(&random, u);
        int16_t level[3] = { 0, 0, 16384 };
        for (int i = 0; i < 3 && mounted; i++) {
            level[i] = (int16_t)lround(16384.0 * u[i]);
        }
        mounting_of(level, mounting);
        random_part(&random, offset, scale);
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
        direction(&random, u);
        int32_t a_q8[3];
        int32_t out_q8[3];
        double turned[3];
        for (int i = 0; i < 3; i++) {
            a_q8[i] = (int32_t)lround(256.0 * (offset[i] + scale[i] * u[i]));
            turned[i] = (a_q8[i] / 256.0 - offset[i]) / scale[i];
        }
        calibration_apply(&applied, a_q8, out_q8);
        for (int i = 0; i < 3; i++) {
            out[i] = out_q8[i];
            exact[i] = mounting[3 * i] * turned[0] + mounting[3 * i + 1] * turned[1] + mounting[3 * i + 2] * turned[2];
        }
        worst = fmax(worst, angle_between(out, exact));
    }
    return worst;
}

TEST(test_direction_after_use)
{
    double plain = worst_use(false, 82);
    double mounted = worst_use(true, 83);
    printf("use at 1 g: %.2e rad = %.4f degree, with a mounting %.2e rad = %.4f degree\n", plain, plain * DEG, mounted,
           mounted * DEG);
    TEST_ASSERT_TRUE(plain <= USE_BOUND_RAD && USE_BOUND_RAD * DEG <= 0.003);
    TEST_ASSERT_TRUE(mounted <= MOUNTED_BOUND_RAD);
}

/* All of it against matrices of double: 0.01 LSB of readings to 1 g, all namings of the axes. */
TEST(test_the_whole_formula)
{
    test_random_t random;
    random_seed(&random, 84);
    static const signed char names[6][3] = { { 1, 2, 3 }, { 2, 3, 1 }, { 3, 1, 2 },
                                             { 2, 1, 3 }, { 1, 3, 2 }, { 3, 2, 1 } };
    for (int run = 0; run < 100000; run++) {
        double offset[3], scale[3], u[3], a[3], exact[3];
        int32_t a_q8[3];
        int32_t out_q8[3];
        setUp();
        random_part(&random, offset, scale);
        direction(&random, u);
        double level[3];
        for (int i = 0; i < 3; i++) {
            c.axes[i] = (int8_t)(names[run % 6][i] * (random_below(&random, 2) != 0 ? 1 : -1));
            c.level_q14[i] = (int16_t)lround(16384.0 * u[i]);
            level[i] = c.level_q14[i];
        }
        direction(&random, u);
        for (int i = 0; i < 3; i++) {
            a_q8[i] = (int32_t)lround(256.0 * (offset[i] + scale[i] * u[i]));
            a[i] = a_q8[i] / 256.0;
        }
        TEST_ASSERT_EQUAL_UINT8(CALIBRATION_GOOD, calibration_prepare(&applied, &c).why);
        calibration_apply(&applied, a_q8, out_q8);
        reference_calibrated(offset, scale, c.axes, level, a, exact);
        for (int i = 0; i < 3; i++) { /* a row: sqrt(3) (element + rounding 2^-15 x 1.29), in units of 1/65536 g */
            TEST_ASSERT_DOUBLE_WITHIN(65536.0 * 1.7321 * (ELEMENT_BOUND + 3.94e-5) + 0.6, 256.0 * exact[i], out_q8[i]);
        }
    }
}
