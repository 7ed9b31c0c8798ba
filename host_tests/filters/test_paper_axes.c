/* Paper 002's filters on three axes (support/paper_axes.h) beside the shipped laws, and what one gate decides. */
#include "support/chain.h"
#include "support/paper_axes.h"
#include "support/random.h"
#include "support/roles.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define ROWS 4000
#define RATE_DHZ 1000

static int16_t row[ROWS][3];
static double truth[ROWS][3];

/* A slow turn with 2 LSB of noise, on z 1.3 times that. */
static void turn(void)
{
    test_random_t random;
    random_seed(&random, 11);
    for (int k = 0; k < ROWS; k++) {
        double angle = 0.5 * sin(0.01 * k);
        const double z[3] = { 20.0, 256.0 * sin(angle), 256.0 * cos(angle) };
        for (int axis = 0; axis < 3; axis++) {
            truth[k][axis] = z[axis];
            row[k][axis] = as_sample(z[axis] + (axis == 2 ? 2.6 : 2.0) * random_normal(&random));
        }
    }
}

static double rms_of(paper_kind_t kind, int axis)
{
    static paper_axes_t of;
    double sum = 0.0;
    paper_axes_begin(&of, kind, RATE_DHZ);
    for (int k = 0; k < ROWS; k++) {
        double error = paper_axes_sample(&of, row[k], axis) - truth[k][axis];
        sum += k < 100 ? 0.0 : error * error;
    }
    return sqrt(sum / (ROWS - 100));
}

static double rms_shipped(paper_kind_t kind, int axis)
{
    chain_t chain;
    double sum = 0.0;
    TEST_ASSERT_TRUE(chain_begin(&chain, paper_axes_law(kind), RATE_DHZ, 16, axis));
    for (int k = 0; k < ROWS; k++) {
        double error = chain_sample(&chain, 10000U * (uint64_t)k, row[k][axis]) / 65536.0 - truth[k][axis];
        sum += k < 100 ? 0.0 : error * error;
    }
    return sqrt(sum / (ROWS - 100));
}

/* Every twentieth row off by 40 LSB on the axes given. */
static void plant(bool x, bool y, bool z)
{
    const bool hit[3] = { x, y, z };
    turn();
    for (int k = 200; k < ROWS; k += 20) {
        for (int axis = 0; axis < 3; axis++) {
            row[k][axis] = (int16_t)(row[k][axis] + (hit[axis] ? 40 : 0));
        }
    }
}

TEST(test_as_shipped_they_are_the_shipped_laws)
{
    plant(true, false, true);
    for (int axis = 0; axis < 3; axis++) {
        const paper_kind_t as_shipped[] = { PAPER_OWN_GATES, PAPER_ALONE };
        for (int i = 0; i < 2; i++) {
            double ours = rms_of(as_shipped[i], axis);
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.005 * ours, ours, rms_shipped(as_shipped[i], axis),
                                              paper_axes_name(as_shipped[i]));
        }
    }
}

/*
 * 2.3 sigma on each of three axes are within a gate of 3 sigma each, but 3 x 2.3^2 = 15.9 is beyond 14.156. 3.5 sigma
 * on one are beyond its gate, but 12.3 is not; 3.8 sigma are 14.4.
 */
TEST(test_one_gate_decides_by_the_sum)
{
    robust_reference_t f[3];
    double x[3];
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(robust_reference_table1(&f[i], filter_listed_name(robust_kind())));
    }
    double sigma = sqrt(0.7 + 0.04 * 0.0247 * 0.0247 + 0.0064); /* of the first innovation: P11 + T^2 P22 + R */
    double expected = 2.8 + 0.0247 * 0.008;
    const double all[3] = { expected + 2.3 * sigma, expected - 2.3 * sigma, expected + 2.3 * sigma };
    const double one[3] = { expected + 2.3 * sigma, expected, expected };
    const double far[3] = { expected + 3.5 * sigma, expected, expected };
    const double farther[3] = { expected + 3.8 * sigma, expected, expected };
    const struct {
        const double *z;
        bool taken;
    } cases[] = { { all, false }, { one, true }, { far, true }, { farther, false } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        robust_reference_t g[3];
        memcpy(g, f, sizeof g);
        robust_reference_step_joint(g, 3, cases[i].z, 14.156, x);
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_EQUAL(!cases[i].taken, g[axis].gated);
        }
    }
}

/* A twentieth of the samples is lost: their noise is that of a filter at 95 % of the rate, a few per cent more. */
TEST(test_an_outlier_on_one_axis_costs_the_others_a_sample)
{
    plant(false, false, false);
    double clean = rms_of(PAPER_ONE_GATE, 1);
    plant(true, false, false);
    double lost = rms_of(PAPER_ONE_GATE, 1);
    TEST_ASSERT_TRUE(lost > 1.005 * clean && lost < 1.1 * clean);
    double own = rms_of(PAPER_OWN_GATES, 1);
    plant(false, false, false);
    TEST_ASSERT_EQUAL_DOUBLE(own, rms_of(PAPER_OWN_GATES, 1));
}
