/* synth_plus: its taps, its region and its start on integers; runs on the PC and on the chip. */
#include "support/test_law.h"

static filter_config_t with(uint16_t k, uint16_t b0_uq16, int32_t b1_q16, int32_t b2_q16)
{
    filter_config_t config = { 1000,
                               { [SYNTH_PLUS_B0_UQ16] = b0_uq16,
                                 [SYNTH_PLUS_K] = k,
                                 [SYNTH_PLUS_B1_Q16] = b1_q16,
                                 [SYNTH_PLUS_B2_Q16] = b2_q16,
                                 [SYNTH_PLUS_R_LSB2_Q8] = 768 } };
    return config;
}

static filter_t made_plus(uint16_t k, uint16_t b0_uq16, int32_t b1_q16, int32_t b2_q16)
{
    filter_config_t config = with(k, b0_uq16, b1_q16, b2_q16);
    filter_t f = made(&filter_law_synth_plus, &config);
    filter_reset(&f, 0);
    return f;
}

/*
 * b0 = 1/2, b1 = -1/4, b2 = 1/8, rho = 3/4, by hand from the equation, exact in Q16. 1024 after rest at 0:
 *   x_e 0, u 1024, x 512
 *   x_e 2 x 512 + 3/4 x 512 - 1/4 x 1024 = 1152, u -1152, x 576
 *   x_e 2 x 576 - 512 + 3/4 (576 - 1024) + 288 + 128 = 720, u -720, x 360
 *   x_e 720 - 576 + 3/4 (360 - 1152 + 512) + 180 - 144 = -30, u 30, x -15
 * and a missing sample: -30 - 360 + 3/4 (-15 - 720 + 576) - 7.5 - 90 = -606.75, then u is 0 in its place
 *   -1213.5 + 15 + 3/4 (-606.75 + 30 + 360) + 3.75 = -1357.3125
 */
TEST(answers_are_those_of_the_equation)
{
    static const int32_t expected_lsb_q4[] = { 512 * 16, 576 * 16, 360 * 16, -15 * 16, -9708, -21717 };
    filter_t f = made_plus(2, 32768, -16384, 8192);
    for (uint8_t i = 0; i < 6; i++) {
        int32_t x = (i < 4) ? filter_update(&f, (i == 0) ? 1024 : 0) : coast(&f);
        TEST_ASSERT_EQUAL_INT32(expected_lsb_q4[i] * 4096, x);
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED, f.flags);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_INT32(0, probe.innovation_lsb_q16);
    TEST_ASSERT_EQUAL_UINT16(0, probe.gain_uq16);
}

/*
 * rho = 1 goes on with the second difference of 10: 0, 10, 30 give 60. With rho = 1 - 2^-7 less 10 / 128 = 5120/65536.
 */
TEST(rho_is_a_shift)
{
    static const struct {
        uint16_t k;
        int32_t less;
    } cases[] = { { 8, 0 }, { 7, 5120 }, { 1, 5 * 65536L }, { 0, 10 * 65536L } };
    for (uint8_t i = 0; i < 4; i++) {
        for (int8_t sign = -1; sign <= 1; sign = (int8_t)(sign + 2)) {
            filter_t f = made_plus(cases[i].k, 45000, -30000, 0);
            f.x_lsb_q16 = sign * 10L * 65536;
            f.rate_lsb = f.x_lsb_q16;
            f.own.synth.memory_lsb_q16 = sign * 10L * 65536;
            (void)coast(&f); /* 30 */
            TEST_ASSERT_EQUAL_INT32(sign * (60 * 65536L - cases[i].less), coast(&f));
        }
    }
}

/*
 * On the borders, refused, and one count inside, taken: b0 + b1 + b2 > 0; b0 - b1 + b2 + 4 (1 - b0) (1 + rho) > 0 (with
 * rho = 0 and b0 = 3/4: 7/4 - b1 + b2); b0 - b2 > (1 - b0) rho (2 b0 + b1), with b0 = 1/2, rho = 1/2, b1 = 0: 1/4, so
 * b2 < 1/4. What is beyond 16 bits decides with rho = 1 - 2^-7 and b1 = 1 count: b2 < 255.504 counts, and with b0 =
 * 1 - 2^-16 and rho = 1: b2 < 65533.00003 counts.
 */
TEST(border_of_the_region_is_outside)
{
    static const struct {
        uint16_t k, b0_uq16;
        int32_t b1_q16, b2_q16;
        bool stable;
    } cases[] = {
        { 2, 37959, 45539, -373, true },    { 2, 37959, 45539, -372, false },  { 0, 32768, -32768, 0, false },
        { 0, 32768, -32767, 0, true },      { 3, 10000, -15000, 5000, false }, { 3, 10000, -15000, 5001, true },
        { 0, 49152, 65535, -49153, false }, { 0, 49152, 65535, -49152, true }, { 0, 49152, 65534, -49154, false },
        { 0, 65535, 65535, -4, false },     { 0, 65535, 65535, -3, true },     { 1, 32768, 0, 16384, false },
        { 1, 32768, 0, 16383, true },       { 7, 32768, 1, 255, true },        { 7, 32768, 1, 256, false },
        { 8, 32768, 0, 0, false },          { 8, 32768, -1, 0, true },         { 8, 65535, 0, 65532, true },
        { 8, 65535, 0, 65533, true },       { 8, 65535, 0, 65534, false },
    };
    for (uint8_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        filter_config_t config = with(cases[i].k, cases[i].b0_uq16, cases[i].b1_q16, cases[i].b2_q16);
        filter_t f;
        uint8_t expected = cases[i].stable ? FILTER_ACCEPTED : FILTER_REFUSED_TOGETHER;
        if (filter_init(&f, &filter_law_synth_plus, &config) != expected) {
            TEST_ASSERT_EQUAL_UINT8(255, i);
        }
    }
}

/* After a reset there is no innovation to remember, whatever came before. */
TEST(reset_forgets_the_innovations)
{
    filter_t f = made_plus(2, 32768, -16384, 8192);
    for (uint8_t k = 0; k < 7; k++) {
        (void)filter_update(&f, (int16_t)(100 * k * k));
    }
    filter_reset(&f, 40);
    for (uint8_t k = 0; k < 3; k++) {
        TEST_ASSERT_EQUAL_INT32(40L * 65536, (k == 1) ? filter_update(&f, 40) : coast(&f));
    }
}

/* With b1 = b2 = 0 it is synth with that a1, bit for bit. */
TEST(without_memory_it_is_synth)
{
    filter_config_t config;
    uint32_t random = 4711;
    filter_t f = made_plus(0, 19661, 0, 0);
    config = filter_defaults(&filter_law_synth, 1000);
    config.value[SYNTH_RATE_MAX_LSB_S] = RATE_UNLIMITED_LSB_S;
    filter_t plain = made(&filter_law_synth, &config);
    filter_reset(&plain, 0);
    for (uint16_t k = 0; k < 300; k++) {
        int16_t z = (int16_t)random32_below(&random, 1000);
        TEST_ASSERT_EQUAL_INT32(filter_update(&plain, z), filter_update(&f, z));
    }
}

/*
 * On a ramp of s LSB a sample the start is a line of least squares through all samples, the first five of them at their
 * median, so (3 - k) s off: its end lags by the sum of (6 k - 2 n - 2) (3 - k) s / (n (n + 1)) = 60 s / (n (n + 1)).
 * What is left where the own gains take over dies away with the poles: nothing of it at sample 150.
 */
TEST(start_on_a_ramp_finds_its_slope)
{
    filter_t f = made_default(&filter_law_synth_plus, 1000);
    for (int16_t n = 1; n <= 200; n++) {
        int32_t off = filter_update(&f, (int16_t)(3 * n)) - (int32_t)3 * n * 65536;
        if (n == FILTER_WARM_UP_SAMPLES + 1) {
            TEST_ASSERT_INT32_WITHIN(90, -(int32_t)60 * 3 * 65536 / (6 * 7), off); /* 10 s + 60, as there */
        }
        TEST_ASSERT_TRUE(n < 150 || (off <= 48 && off >= -48));
    }
    TEST_ASSERT_EQUAL_UINT8(255, f.own.synth.count);
}

/* The gains of the start are those of the line, the own from where they are larger, or from sample 32 on. */
TEST(start_ends_with_sample_31)
{
    filter_config_t config = with(0, 2000, -1900, 0);
    filter_t f = made(&filter_law_synth_plus, &config);
    feed(&f, 7, 31);
    TEST_ASSERT_EQUAL_UINT16(8060, f.gain_uq16); /* 122 / 992 */
    (void)filter_update(&f, 7);
    TEST_ASSERT_EQUAL_UINT16(2000, f.gain_uq16);
    config = with(0, 32768, -16384, 0);
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_synth_plus, &config));
    feed(&f, 7, 6);
    TEST_ASSERT_EQUAL_UINT16(34328, f.gain_uq16); /* 22 / 42 */
    (void)filter_update(&f, 7);
    TEST_ASSERT_EQUAL_UINT16(32768, f.gain_uq16);
}

/* An outlier among the first five changes nothing: the start is their median. */
TEST(outlier_in_the_start_costs_nothing)
{
    filter_t f = made_default(&filter_law_synth_plus, 1000);
    for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        (void)filter_update(&f, (k == 4) ? 4000 : 0);
    }
    TEST_ASSERT_EQUAL_INT32(0, coast(&f));
    TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, 0));
}

/* R = 3 LSB^2: alpha-beta of 1/2 and 1/4 has (1/2 + 1/8) / (1/2 x 2.75) = 5/11. A sample's in the start. */
TEST(probe_reports_the_variance)
{
    filter_config_t config = with(0, 32768, -16384, 0);
    filter_t f = made(&filter_law_synth_plus, &config);
    (void)filter_update(&f, 5);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_UINT32(768, probe.p_lsb2_q8);
    filter_reset(&f, 5);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(1, 349, probe.p_lsb2_q8);
    filter_set_noise(&f, 4 * 768);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(1, 1396, probe.p_lsb2_q8);
}

/* What leaves the format is cut off and flagged, whatever the taps. */
TEST(overshoot_beyond_the_format_is_flagged)
{
    uint8_t flags = 0;
    filter_t f = made_plus(8, 28266, -48056, 20895);
    filter_reset(&f, -4096);
    for (uint8_t k = 0; k < 40; k++) {
        int32_t x = filter_update(&f, 4095);
        TEST_ASSERT_TRUE(x <= (int32_t)FILTER_X_MAX_LSB * 65536);
        flags |= f.flags;
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_SATURATED, flags);
}
