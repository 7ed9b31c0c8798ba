/* The filters that ours are compared with: each against values derived by hand. */
#include "support/peers.h"
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
