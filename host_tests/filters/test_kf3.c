/* kf3 in integers, on the PC and on the chip; against the double reference: test_kf3_reference.c. */
#include "support/test_law.h"

#define SEED 8004UL

static filter_t made_kf3(uint16_t rate_dhz, int32_t r_lsb2_q8, int32_t q_lsb2_s5)
{
    filter_config_t config = { rate_dhz, { [KF3_R_LSB2_Q8] = r_lsb2_q8, [KF3_Q_LSB2_S5] = q_lsb2_s5 } };
    return made(&filter_law_kf3, &config);
}

/*
 * q33 = q T^5 / R, in 2^-28: 1e7 x 3.2e-9 / 3 = 0.010667 at 50 Hz; 1e6 x 1e-10 / 3 x 256 = 0.0085333 at 100 Hz, where
 * the acceleration is counted in sixteenths. 16 roundings of 2^-14.
 */
TEST(noise_scales_the_drive)
{
    filter_t f = made_kf3(500, 768, 10000000);
    TEST_ASSERT_UINT32_WITHIN(2863311UL / 1024U, 2863311UL, f.own.kf3.q33_uq28);
    filter_set_noise(&f, 4 * 768);
    TEST_ASSERT_UINT32_WITHIN(2863311UL / 4U / 1024U, 2863311UL / 4U, f.own.kf3.q33_uq28);
    f = made_kf3(1000, 768, 1000000);
    TEST_ASSERT_UINT32_WITHIN(2290649UL / 1024U, 2290649UL, f.own.kf3.q33_uq28);
}

TEST(drive_keeps_to_its_range)
{
    TEST_ASSERT_EQUAL_UINT32(0x10000000UL, made_kf3(50, 3, 1000000000).own.kf3.q33_uq28);
    TEST_ASSERT_EQUAL_UINT32(0x10000000UL, made_kf3(999, 3, 1000000000).own.kf3.q33_uq28);
    TEST_ASSERT_EQUAL_UINT32(0x2000000UL, made_kf3(1000, 3, 1000000000).own.kf3.q33_uq28);
    TEST_ASSERT_EQUAL_UINT32(16UL, made_kf3(999, 256000, 1).own.kf3.q33_uq28);
    TEST_ASSERT_EQUAL_UINT32(16UL, made_kf3(40000, 256000, 1).own.kf3.q33_uq28);
}

/*
 * The sixth sample at 50 Hz, R 1.5: q33 = 3e5 x 3.2e-9 / 1.5 = 0.00064; P33 = 1/32 + q33 = 0.03189, P23 the same, P22 =
 * P12 = 1/2 + P33 = 0.53189, P11 = 1.53189, w1 = P11 / (P11 + 1) = 0.60504, w2 = 0.21008, w3 = 0.012595.
 */
TEST(start_is_that_of_the_recursion)
{
    filter_t f = made_kf3(500, 384, 300000);
    for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, 0));
        TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP, f.flags);
    }
    TEST_ASSERT_INT32_WITHIN(3 * 1000, 1000L * 39652, filter_update(&f, 1000));
    TEST_ASSERT_UINT16_WITHIN(3, 39652, f.gain_uq16);
    TEST_ASSERT_INT32_WITHIN(3 * 1000, 1000L * 13768, f.rate_lsb);
    TEST_ASSERT_INT32_WITHIN(1000, 1000L * 825, f.own.kf3.acceleration_q16);
    TEST_ASSERT_EQUAL_UINT8(0, f.flags);
}

/* Triangular numbers from one rail to the other: acceleration 1, x = k (k + 1) / 2, rate x(k) - x(k - 1) = k. */
static int16_t parabola(int16_t k, int16_t sign)
{
    return (int16_t)(sign * (k * (k + 1) / 2 - 4000));
}

/*
 * No lag: the innovation's rounding to 1/256 LSB stops the filter within 1/256 LSB of x, 2/256 of the rate (more would
 * carry x out of that within a sample) and 4/256 of the acceleration. At 50 Hz, q33 0.064, the poles (0.72) have
 * forgotten the start; at 100 Hz, q33 1e-5, the pole at 0.929 has left 1e-4 of what the start was off after 126
 * samples, at most 64 LSB.
 */
TEST(follows_constant_acceleration_without_lag)
{
    for (int16_t sign = -1; sign <= 1; sign = (int16_t)(sign + 2)) {
        filter_t slow = made_kf3(500, 384, 30000000);
        filter_t fine = made_default(&filter_law_kf3, 1000);
        filter_config_t config = { 500, { [KF_R_LSB2_Q8] = 384, [KF_Q_LSB2_S3] = 10000 } };
        filter_t two = made(&filter_law_kf, &config);
        for (int16_t k = 0; k <= 126; k++) {
            (void)filter_update(&slow, parabola(k, sign));
            (void)filter_update(&fine, parabola(k, sign));
            (void)filter_update(&two, parabola(k, sign));
        }
        int32_t truth = (int32_t)parabola(126, sign) * 65536;
        TEST_ASSERT_INT32_WITHIN(2 * 256, truth, slow.x_lsb_q16);
        TEST_ASSERT_INT32_WITHIN(3 * 256, sign * 126L * 65536, slow.rate_lsb);
        TEST_ASSERT_INT32_WITHIN(5 * 256, sign * 65536L, slow.own.kf3.acceleration_q16);
        TEST_ASSERT_INT32_WITHIN(65536 / 50, truth, fine.x_lsb_q16);
        TEST_ASSERT_INT32_WITHIN(65536 / 50, sign * 126L * 65536, fine.rate_lsb);
        TEST_ASSERT_INT32_WITHIN(16 * 65536L / 100, 16 * sign * 65536L, fine.own.kf3.acceleration_q16);
        /* kf's lag is (1 - w1) / w2 accelerations, w2 = w1^2 / (2 - w1): 3.1 at w1 = 0.4964 */
        TEST_ASSERT_INT32_WITHIN(65536 / 10, (int32_t)(3.08 * 65536), sign * (truth - two.x_lsb_q16));
    }
}

/* scipy's steady gains at q33 = 1e-5: the answer to a step peaks at 1.26681 at its sample 12, within 2 % from 46 on. */
TEST(step_is_answered_as_by_the_steady_gains)
{
    filter_t f = made_kf3(1000, 768, 300000);
    feed(&f, 0, 400);
    int32_t peak = 0;
    uint8_t at = 0;
    for (uint8_t k = 1; k <= 100; k++) {
        int32_t x = filter_update(&f, 1000);
        if (x > peak) {
            peak = x;
            at = k;
        }
        if (k >= 46U) {
            TEST_ASSERT_INT32_WITHIN(20L * 65536 + 65536, 1000L * 65536, x);
        }
    }
    TEST_ASSERT_INT32_WITHIN(2L * 65536, (int32_t)(1266.81 * 65536), peak);
    TEST_ASSERT_EQUAL_UINT8(12, at);
}

/*
 * Missing samples: x(k) = x + k v + k (k + 1) / 2 a while P is predicted, 11 samples at q33 = 1e-5 (P11 = 4.17 then);
 * later along the straight line, because the acceleration is not believed any more.
 */
/* Rate and acceleration halved: P is that of (x, v / 2, a / 2). */
TEST(damp_halves_what_moves_and_its_covariance)
{
    filter_t f = made_default(&filter_law_kf3, 1000);
    filter_reset(&f, 0);
    for (int16_t k = 0; k < 20; k++) {
        (void)filter_update(&f, (int16_t)(k * k));
    }
    filter_t damped = f;
    filter_tracker_damp(&damped);
    TEST_ASSERT_EQUAL_INT32(f.rate_lsb >> 1, damped.rate_lsb);
    TEST_ASSERT_EQUAL_INT32(f.own.kf3.acceleration_q16 >> 1, damped.own.kf3.acceleration_q16);
    TEST_ASSERT_EQUAL_UINT32(f.own.kf3.p.p11, damped.own.kf3.p.p11);
    TEST_ASSERT_EQUAL_UINT32(f.own.kf3.p.p12 / 2U, damped.own.kf3.p.p12);
    TEST_ASSERT_EQUAL_UINT32(f.own.kf3.p.p22 / 4U, damped.own.kf3.p.p22);
    TEST_ASSERT_EQUAL_UINT32(f.own.kf3.p13_uq28 / 2U, damped.own.kf3.p13_uq28);
    TEST_ASSERT_EQUAL_UINT32(f.own.kf3.p23_uq28 / 4U, damped.own.kf3.p23_uq28);
    TEST_ASSERT_EQUAL_UINT32(f.own.kf3.p33_uq28 / 4U, damped.own.kf3.p33_uq28);
}

TEST(coast_goes_on_along_the_parabola_and_then_the_line)
{
    filter_t f = made_kf3(1000, 768, 300000);
    for (int16_t k = 0; k <= 100; k++) {
        (void)filter_update(&f, parabola(k, 1));
    }
    int32_t x = f.x_lsb_q16;
    int32_t rate = f.rate_lsb;
    int32_t acceleration = (f.own.kf3.acceleration_q16 + 8) >> 4;
    for (int16_t k = 1; k <= 11; k++) {
        TEST_ASSERT_INT32_WITHIN(k * k, x + k * rate + k * (k + 1) / 2 * acceleration, coast(&f));
        TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED, f.flags);
    }
    rate = f.rate_lsb;
    x = f.x_lsb_q16;
    TEST_ASSERT_INT32_WITHIN(0, x + rate, coast(&f));
    TEST_ASSERT_INT32_WITHIN(0, x + 2 * rate, coast(&f));
    TEST_ASSERT_EQUAL_INT32(0, f.own.kf3.acceleration_q16);
}

/*
 * 10,000 samples missing in motion: it stands at the bound, tells once, and is back 117 samples after its end (double
 * recursion of P, held at P11 = 4.17, from 4608 LSB off at rest to within 1/4 LSB), and for good.
 */
TEST(comes_back_from_a_gap_of_ten_thousand)
{
    for (int32_t sign = -1; sign <= 1; sign += 2) {
        filter_t f = made_kf3(1000, 768, 300000);
        for (int16_t k = 0; k <= 100; k++) {
            (void)filter_update(&f, parabola(k, (int16_t)sign));
        }
        uint8_t told = 0;
        for (uint16_t k = 0; k < 10000; k++) {
            (void)coast(&f);
            told = (uint8_t)(told + ((f.flags & FILTER_SATURATED) != 0U ? 1U : 0U));
        }
        TEST_ASSERT_EQUAL_UINT8(1, told);
        TEST_ASSERT_EQUAL_INT32(sign * FILTER_X_MAX_LSB * 65536L, f.x_lsb_q16);
        TEST_ASSERT_EQUAL_INT32(0, f.rate_lsb);
        for (uint16_t k = 1; k < 300; k++) {
            int32_t x = filter_update(&f, 0);
            if (k >= 118U) {
                TEST_ASSERT_INT32_WITHIN(65536 / 4 + 65536 / 32, 0, x);
            }
        }
    }
}

/* After a reset the gain is that of a filter which has read the same value for long. */
TEST(reset_is_as_if_read_for_ever)
{
    filter_t read = made_kf3(1000, 16 * 256, 300000);
    filter_t reset = read;
    feed(&read, 100, 2000);
    filter_reset(&reset, 100);
    TEST_ASSERT_EQUAL_INT32(100L * 65536, reset.x_lsb_q16);
    TEST_ASSERT_EQUAL_UINT8(0, reset.flags);
    int32_t of_read = filter_update(&read, 140);
    TEST_ASSERT_INT32_WITHIN(65536 / 4, of_read, filter_update(&reset, 140));
    TEST_ASSERT_UINT16_WITHIN(read.gain_uq16 / 50U, read.gain_uq16, reset.gain_uq16);
}

/* One corner of the legal parameters: any samples, gaps and R; every bound holds, and after them it settles. */
static void assert_corner(uint16_t rate_dhz, int32_t r_lsb2_q8, int32_t q_lsb2_s5, uint32_t *random)
{
    filter_t f = made_kf3(rate_dhz, r_lsb2_q8, q_lsb2_s5);
    filter_probe_t probe;
    for (uint16_t k = 0; k < ON_PC_OR_CHIP(5000, 300); k++) {
        uint32_t what = random32_below(random, 64);
        int16_t rail = ((random32(random) & 1U) != 0U) ? INT16_MAX : INT16_MIN;
        int32_t x = (what < 4U) ? coast(&f)
                    : (what < 34U)
                        ? filter_update(&f, (k & 64U) != 0U ? rail : (int16_t)((k & 1U) != 0U ? 4095 : -4096))
                        : filter_update(&f, (int16_t)random32(random));
        if (what == 63U) {
            filter_set_noise(&f, random32(random) >> 12);
        }
        filter_probe(&f, &probe);
        TEST_ASSERT_NULL(broken_bound(&f, &probe, x));
    }
    filter_set_noise(&f, (uint32_t)r_lsb2_q8);
    feed(&f, 1000, 1500);
    TEST_ASSERT_INT32_WITHIN(65536 / 16, 1000L * 65536, f.x_lsb_q16);
}

TEST(extreme_parameters_stay_within_bounds_and_settle)
{
    static const uint16_t rates[] = { 50, 999, 1000, 40000 };
    uint32_t random = SEED;
    for (uint8_t i = 0; i < 16U; i++) {
        assert_corner(rates[i & 3U], (i & 4U) != 0U ? (int32_t)FILTER_R_MIN_LSB2_Q8 : (int32_t)FILTER_R_MAX_LSB2_Q8,
                      (i & 8U) != 0U ? 1 : 1000000000, &random);
    }
}

/* P at its widest in every element, as after no legal history: one update brings it where it can be predicted. */
TEST(any_covariance_can_be_predicted_after_an_update)
{
    const uint32_t one_uq28 = 0x10000000UL;
    filter_t f = made_kf3(500, 384, 300000);
    uint32_t random = SEED + 1U;
    for (uint16_t k = 0; k < 500; k++) {
        filter_reset(&f, 0);
        f.own.kf3.p.p11 = random32_below(&random, 13U * one_uq28);
        f.own.kf3.p.p12 = random32_below(&random, 7U * one_uq28);
        f.own.kf3.p.p22 = random32_below(&random, 5U * one_uq28);
        f.own.kf3.p13_uq28 = random32_below(&random, 4U * one_uq28);
        f.own.kf3.p23_uq28 = random32_below(&random, 3U * one_uq28);
        f.own.kf3.p33_uq28 = random32_below(&random, 2U * one_uq28);
        (void)filter_update(&f, 100);
        bool small = f.own.kf3.p.p11 < one_uq28 && f.own.kf3.p.p12 < one_uq28 && f.own.kf3.p.p22 < one_uq28 &&
                     f.own.kf3.p13_uq28 < one_uq28 && f.own.kf3.p23_uq28 < one_uq28 && f.own.kf3.p33_uq28 < one_uq28;
        TEST_ASSERT_TRUE(small);
    }
}
