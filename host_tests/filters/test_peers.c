/* The filters that ours are compared with: each against values derived by hand. */
#include "support/peers.h"
#include "support/robust_peers.h"
#include "support/test.h"

#include <math.h>
#include <stddef.h>

#define PI 3.14159265358979324

/* At this rate the weight of the EMA is a half. */
#define HALF_HZ (2.0 * PI * PEER_EMA_HZ / log(2.0))

static double last_of(peer_kind_t kind, double rate_hz, const double *z_lsb, size_t count)
{
    peer_t peer;
    double x_lsb = 0.0;
    peer_begin(&peer, kind, rate_hz);
    for (size_t i = 0; i < count; i++) {
        x_lsb = peer_sample(&peer, z_lsb[i]);
    }
    return x_lsb;
}

TEST(the_first_sample_is_taken_as_it_is)
{
    static const double z_lsb[] = { -37.0 };
    for (peer_kind_t kind = (peer_kind_t)0; kind < PEERS; kind++) {
        TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(-37.0, last_of(kind, 100.0, z_lsb, 1), peer_name(kind));
    }
}

TEST(ema_goes_half_the_way)
{
    static const double z_lsb[] = { 0.0, 8.0, 8.0, -1.0 };
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.0, last_of(PEER_EMA_ALONE, HALF_HZ, z_lsb, 2));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6.0, last_of(PEER_EMA_ALONE, HALF_HZ, z_lsb, 3));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 2.5, last_of(PEER_EMA_ALONE, HALF_HZ, z_lsb, 4));
}

/* t after a step 1 - exp(-2 pi cut t), whatever the rate. */
TEST(ema_has_one_cut_off_at_all_rates)
{
    for (int rate_hz = 25; rate_hz <= 800; rate_hz *= 2) {
        peer_t peer;
        double x_lsb = 0.0;
        peer_begin(&peer, PEER_EMA_ALONE, rate_hz);
        (void)peer_sample(&peer, 0.0);
        for (int i = 0; i < rate_hz / 25; i++) {
            x_lsb = peer_sample(&peer, 1.0);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1.0 - exp(-2.0 * PI * PEER_EMA_HZ / 25.0), x_lsb);
    }
}

/* Medians 0 0 0 0 0 0 9: two of five are not seen, the third is. */
TEST(the_median_of_five_does_not_see_two)
{
    static const double z_lsb[] = { 0.0, 0.0, 0.0, 0.0, 9.0, 9.0, 9.0 };
    TEST_ASSERT_EQUAL_DOUBLE(0.0, last_of(PEER_MEDIAN_EMA, HALF_HZ, z_lsb, 6));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.5, last_of(PEER_MEDIAN_EMA, HALF_HZ, z_lsb, 7));
}

/* Of 6 1 2 3 4 5 and the last the median is 4 or 3, the median deviation 2: limits 3 x 1.4826 x 2 = 8.9 off. */
TEST(hampel_replaces_what_is_too_far_off)
{
    double z_lsb[] = { 6.0, 1.0, 2.0, 3.0, 4.0, 5.0, 0.0 };
    double before_lsb = last_of(PEER_HAMPEL_EMA, HALF_HZ, z_lsb, 6);
    z_lsb[6] = 12.8; /* 8.8 from the median of 1 2 3 4 5 6 12.8 */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, (before_lsb + 12.8) / 2.0, last_of(PEER_HAMPEL_EMA, HALF_HZ, z_lsb, 7));
    z_lsb[6] = 13.0; /* 9 */
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, (before_lsb + 4.0) / 2.0, last_of(PEER_HAMPEL_EMA, HALF_HZ, z_lsb, 7));
    z_lsb[6] = -100.0;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, (before_lsb + 3.0) / 2.0, last_of(PEER_HAMPEL_EMA, HALF_HZ, z_lsb, 7));
}

/*
 * At 2 pi Hz the weight of a cut-off f is f / (1 + f): 1/2 at 1 Hz. A step by A has a slope of 2 pi A, half of which
 * is taken: with A = 1 / (0.007 pi) the cut-off is 2 Hz, and 2/3 of the step are taken.
 */
TEST(one_euro_opens_with_the_slope)
{
    double step_lsb = 1.0 / (PEER_EURO_BETA * PI);
    double z_lsb[] = { 5.0, 5.0 + step_lsb, 5.0 + step_lsb };
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0 + 2.0 / 3.0 * step_lsb, last_of(PEER_EURO, 2.0 * PI, z_lsb, 2));
    /* then a slope of 2/3 pi A, halfway to it from pi A: 5/6 pi A, a cut-off of 11/6 Hz, 11/17 of the last third */
    double x_lsb = 5.0 + (2.0 / 3.0 + 11.0 / 51.0) * step_lsb;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, x_lsb, last_of(PEER_EURO, 2.0 * PI, z_lsb, 3));
}

/* Medians 0 0 0 0 9: one of three is not seen, the second is. */
TEST(the_median_of_three_does_not_see_one)
{
    static const double z_lsb[] = { 0.0, 0.0, 0.0, 9.0, 9.0 };
    TEST_ASSERT_EQUAL_DOUBLE(0.0, last_of(PEER_MEDIAN3_EMA, HALF_HZ, z_lsb, 4));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 4.5, last_of(PEER_MEDIAN3_EMA, HALF_HZ, z_lsb, 5));
}

/*
 * R = 1, no growth, P11 = 1 and a rate of 0 that is known: predicted P11 = 1, S = 2, so a sample off by u goes in by
 * u / (1 + R'), where R' is 1 up to 1.345 standard deviations of sqrt 2 and then R' = |u| / sqrt 2 / 1.345.
 */
static double robust_step(robust_kind_t kind, double u)
{
    static const robust_state_t start = { 0.0, 0.0, 1.0, 0.0, 0.0 };
    robust_peer_t peer;
    robust_peer_begin(&peer, kind, 1.0, 0.0, 0.0);
    robust_peer_from(&peer, &start);
    return robust_peer_sample(&peer, u);
}

TEST(huber_takes_a_far_sample_in_part)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.9, robust_step(ROBUST_HUBER, 1.8));
    double r = 20.0 / sqrt(2.0) / 1.345;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 20.0 / (1.0 + r), robust_step(ROBUST_HUBER, 20.0));
}

/* u = 6: 18 = 36 / 2 standard deviations squared, R' = exp(18 / 18) = e. */
TEST(correntropy_weighs_by_its_kernel)
{
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 6.0 / (1.0 + exp(1.0)), robust_step(ROBUST_CORRENTROPY, 6.0));
}

/*
 * u = 0 stays 0. Far off what is left is u kept: R' = (4 + u^2 / 4 + 1/2) / 5 after one step, and grows: next to
 * nothing of u = 100 is taken, about half of u = 1.
 */
TEST(student_takes_little_of_what_is_far)
{
    TEST_ASSERT_EQUAL_DOUBLE(0.0, robust_step(ROBUST_STUDENT, 0.0));
    TEST_ASSERT_TRUE(robust_step(ROBUST_STUDENT, 100.0) < 0.1);
    double near = robust_step(ROBUST_STUDENT, 1.0);
    TEST_ASSERT_TRUE_MESSAGE(near > 0.45 && near < 0.6, "of 1 about half");
}

/* A sample at 30 sigma is the bad model's; a hundred equal ones in a row are a motion, and are followed. */
TEST(imm_ignores_one_and_follows_many)
{
    robust_peer_t peer;
    double x = 0.0;
    robust_peer_begin(&peer, ROBUST_IMM, 1.0, 0.01, 1.0);
    for (int k = 0; k < 50; k++) {
        (void)robust_peer_sample(&peer, 0.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1.0, 0.0, robust_peer_sample(&peer, 30.0));
    for (int k = 0; k < 100; k++) {
        x = robust_peer_sample(&peer, 30.0);
    }
    TEST_ASSERT_DOUBLE_WITHIN(3.0, 30.0, x);
    for (robust_kind_t kind = (robust_kind_t)0; kind < ROBUST_PEERS; kind++) {
        TEST_ASSERT_NOT_NULL(robust_peer_name(kind));
    }
}
