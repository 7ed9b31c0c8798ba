/* kf in integers, on the PC and on the chip; against the double reference: test_kf_reference.c. */
#include "support/test_law.h"

/* q22 = q T^3 / R at 100 Hz, R 3, q 10000: 1e4 x 1e-6 / 3 = 3.3333e-3 = 223696.2 / 2^26; after R x 4 a quarter. */
TEST(noise_scales_the_drive)
{
    filter_config_t config = { 1000, { [KF_R_LSB2_Q8] = 768, [KF_Q_LSB2_S3] = 10000 } };
    filter_t f = made(&filter_law_kf, &config);
    TEST_ASSERT_UINT32_WITHIN(223696UL / 4096U, 223696UL, f.own.kalman.q22_uq26);
    filter_set_noise(&f, 4 * 768);
    TEST_ASSERT_UINT32_WITHIN(223696UL / 4U / 4096U, 223696UL / 4U, f.own.kalman.q22_uq26);
}

/* Coasting is x += rate: three steps of a settled ramp of 2 LSB per sample. */
TEST(coast_goes_on_at_the_rate)
{
    filter_t f = made_default(&filter_law_kf, 1000);
    for (int16_t k = 0; k < 400; k++) {
        (void)filter_update(&f, (int16_t)(2 * k));
    }
    (void)coast(&f);
    (void)coast(&f);
    TEST_ASSERT_INT32_WITHIN(65536 / 20, 2 * 402 * (int32_t)65536, coast(&f));
    TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED, f.flags);
}

/* After a reset the gain is that of a filter which has read the same value for long. */
TEST(reset_is_as_if_read_for_ever)
{
    filter_config_t config = filter_defaults(&filter_law_kf, 1000);
    config.value[KF_R_LSB2_Q8] = 16U * 256U;
    filter_t read = made(&filter_law_kf, &config);
    filter_t reset = made(&filter_law_kf, &config);
    feed(&read, 100, 5000);
    filter_reset(&reset, 100);
    (void)filter_update(&read, 140);
    (void)filter_update(&reset, 140);
    filter_probe_t of_read = probe_of(&read);
    filter_probe_t of_reset = probe_of(&reset);
    TEST_ASSERT_UINT16_WITHIN(of_read.gain_uq16 / 50U, of_read.gain_uq16, of_reset.gain_uq16);
    TEST_ASSERT_INT32_WITHIN(65536 / 4, read.x_lsb_q16, reset.x_lsb_q16);
}

/* On its way to the rail and left to coast: it ends there, and says so. */
TEST(coasting_ends_at_the_bound)
{
    for (int8_t sign = -1; sign <= 1; sign = (int8_t)(sign + 2)) {
        filter_t f = made_default(&filter_law_kf, 125);
        for (int16_t k = 0; k < 40; k++) {
            (void)filter_update(&f, (int16_t)(sign * k * 60));
        }
        for (uint16_t k = 0; k < 100; k++) {
            (void)coast(&f);
        }
        TEST_ASSERT_EQUAL_INT32(sign * (int32_t)FILTER_X_MAX_LSB * 65536, coast(&f));
        TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED | FILTER_SATURATED, f.flags);
    }
}

/* Any 32-bit words: the state stands within the bounds of kalman.h, and stays there. */
TEST(begins_within_its_bounds)
{
    filter_t f = made_default(&filter_law_kf, 1000);
    kalman_from(&f, 65536, -32768, (filter_covariance_t){ 0x08000000UL, 0x08000000UL, 0x04000000UL });
    TEST_ASSERT_EQUAL_INT32(65536, f.x_lsb_q16);
    TEST_ASSERT_EQUAL_INT32(-32768, f.rate_lsb);
    TEST_ASSERT_EQUAL_UINT32(0x08000000UL, f.own.kalman.p.p11);
    TEST_ASSERT_EQUAL_UINT32(0x08000000UL, f.own.kalman.p.p12);
    TEST_ASSERT_EQUAL_UINT32(0x04000000UL, f.own.kalman.p.p22);
    /* at 4 the range of what is predicted ends, so P11 stays 8: S = 9, w1 = 8/9 */
    (void)filter_update(&f, 1);
    TEST_ASSERT_UINT32_WITHIN(2, 58254UL, f.gain_uq16);
    uint32_t random = 99;
    for (uint16_t k = 0; k < 300; k++) {
        int32_t x_lsb_q16 = (int32_t)random32(&random);
        int32_t rate_lsb_q16 = (int32_t)random32(&random);
        filter_covariance_t p = { random32(&random), random32(&random), random32(&random) };
        kalman_from(&f, x_lsb_q16, rate_lsb_q16, p);
        for (uint8_t step = 0; step < 4U; step++) {
            int32_t x = (step == 0U) ? f.x_lsb_q16 : filter_update(&f, (int16_t)random32(&random));
            filter_probe_t probe = probe_of(&f);
            TEST_ASSERT_NULL(broken_bound(&f, &probe, x));
            /* P12 <= P11, but g and w1 = 1 - g are wrong by up to 1.5 x 2^-16, w2 = P12 g by less than 32 times it */
            uint32_t rounding = (step == 0U) ? 0U : 32UL * 384U;
            TEST_ASSERT_LESS_OR_EQUAL_UINT32(f.own.kalman.p.p11 + rounding, f.own.kalman.p.p12 >> 2);
        }
    }
}
