/*
 * Guards that ordinary samples hardly reach: the borrow of P22, the hysteresis of R's estimate, the range of a sample.
 */

#include "kalman.h"
#include "noise.h"
#include "support/roles.h"
#include "support/test_law.h"

#define ONE_UQ26 0x4000000u

static filter_t started(uint32_t p11, uint32_t p12, uint32_t p22)
{
    filter_config_t config = filter_defaults(filter_listed(plain_kind()), 1000);
    filter_t f = made(filter_listed(plain_kind()), &config);
    filter_reset(&f, 0);
    f.own.kalman.p = (filter_covariance_t){ p11, p12, p22 };
    return f;
}

/*
 * P / R = (0, 1; 1, 1/2) is no covariance. Predicted: P12 = 1.5, P11 = 2.5, P22 = 0.5 + q; update:
 * P22 - P12^2 / (P11 + 1) = 0.5 - 0.643 + q < 0: rounded to 0, not wrapped to 63.9.
 */
TEST(test_p22_does_not_wrap_below_zero)
{
    filter_t f = started(0, ONE_UQ26, ONE_UQ26 / 2);
    TEST_ASSERT_TRUE(f.own.kalman.q22_uq26 < ONE_UQ26 / 10);
    (void)filter_update(&f, 10);
    TEST_ASSERT_NOT_EQUAL_UINT16(0, f.gain_uq16);
    TEST_ASSERT_EQUAL_HEX32(0, f.own.kalman.p.p22);
}

/*
 * The twin: with P22 = 1 the update leaves 1 - 0.643 + q, exact to the gain's 1.5 counts of 2^-16 (0.643 x 3.5 x
 * 2.3e-5).
 */
TEST(test_p22_that_stays_positive_is_kept)
{
    filter_t f = started(0, ONE_UQ26, ONE_UQ26);
    /* predicted: P12 = 2, P11 = 3, P22 = 1 + q; P12^2 / (P11 + 1) = 1: with q left over, in UQ6.26 */
    double expected = (double)f.own.kalman.q22_uq26 / ONE_UQ26;
    (void)filter_update(&f, 10);
    TEST_ASSERT_NOT_EQUAL_UINT16(0, f.gain_uq16);
    TEST_ASSERT_DOUBLE_WITHIN(4.0 * 1.5 / 65536.0, expected, (double)f.own.kalman.p.p22 / ONE_UQ26);
}

/* R = 1.5 times the mean, Q16 to Q8. */
static double wanted_r(const noise_t *n)
{
    return 1.5 * (double)n->mean_lsb2_q16 / 256.0;
}

/*
 * R is passed on when it has left the one in force by more than an eighth, and only then: the amplitude of the readings
 * rises and falls, so that both happen often.
 */
TEST(test_r_follows_with_a_hysteresis_of_an_eighth)
{
    noise_t n;
    filter_noise_init(&n, 1000, false);
    unsigned passed_on = 0;
    unsigned kept_though_different = 0;
    uint32_t random = 1;
    for (int i = 0; i < 20000; i++) {
        random = random * 1664525u + 1013904223u;
        int amplitude = 2 + (i / 1000) % 7 * 6;
        double before = filter_noise_r_lsb2_q8(&n);
        bool changed = filter_noise_update(&n, (int16_t)((int)(random >> 16) % (2 * amplitude + 1) - amplitude));
        double after = filter_noise_r_lsb2_q8(&n);
        double distance = wanted_r(&n) > before ? wanted_r(&n) - before : before - wanted_r(&n);
        if (changed) {
            TEST_ASSERT_TRUE(distance > before / 8.0 - 1.5); /* R and its eighth are whole numbers */
            TEST_ASSERT_DOUBLE_WITHIN(0.6, wanted_r(&n), after);
            passed_on++;
        } else {
            TEST_ASSERT_TRUE(distance <= before / 8.0 + 1.5 || n.filled < 5);
            TEST_ASSERT_TRUE(after >= before && after <= before);
            kept_though_different += distance > before / 16.0;
        }
    }
    TEST_ASSERT_TRUE(passed_on > 20);
    TEST_ASSERT_TRUE(kept_though_different > 100);
}

/* While warming up and when running, a sample outside -4096..4095 is the nearest one inside, and flagged. */
static void assert_clamped(uint8_t kind, uint8_t before, int16_t z_lsb, int16_t nearest_lsb)
{
    filter_t f = made_kind(kind, 1000);
    for (uint8_t i = 0; i < before; i++) {
        (void)filter_update(&f, (int16_t)(nearest_lsb - nearest_lsb / 100));
    }
    filter_t of_nearest = f;
    (void)filter_update(&of_nearest, nearest_lsb);
    (void)filter_update(&f, z_lsb);
    TEST_ASSERT_BITS_HIGH(FILTER_SATURATED, f.flags);
    TEST_ASSERT_EQUAL_HEX8(of_nearest.flags | FILTER_SATURATED, f.flags);
    f.flags = of_nearest.flags;
    TEST_ASSERT_EQUAL_MEMORY(&of_nearest, &f, sizeof f);
}

TEST(test_a_sample_outside_the_range_is_clamped_and_flagged)
{
    FOR_EACH_KIND(kind)
    {
        for (uint8_t before = 0; before < 20U; before = (uint8_t)(before + 3U)) {
            assert_clamped(kind, before, 4096, 4095);
            assert_clamped(kind, before, INT16_MAX, 4095);
            assert_clamped(kind, before, -4097, -4096);
            assert_clamped(kind, before, INT16_MIN, -4096);
        }
    }
}

TEST(test_a_sample_at_the_end_of_the_range_is_not_flagged)
{
    static const int16_t ends[] = { 4095, -4096 };
    FOR_EACH_KIND(kind)
    {
        for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
            filter_t f = made_kind(kind, 1000);
            for (uint8_t k = 0; k < 20U; k++) {
                (void)filter_update(&f, ends[i]);
                TEST_ASSERT_BITS_LOW(FILTER_SATURATED, f.flags);
            }
        }
    }
}
