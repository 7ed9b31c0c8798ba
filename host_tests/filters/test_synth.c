/* synth: its start, its two-product form and its presets on integers; runs on the PC and on the chip. */
#include "support/test_law.h"

static filter_t made_synth(int32_t a1_q16, int32_t b0_uq16)
{
    filter_config_t config = filter_defaults(&filter_law_synth, 1000);
    config.value[SYNTH_A1_Q16] = a1_q16;
    config.value[SYNTH_B0_UQ16] = b0_uq16;
    config.value[SYNTH_RATE_MAX_LSB_S] = RATE_UNLIMITED_LSB_S;
    return made(&filter_law_synth, &config);
}

/* a1 and b0 of paper 001, -0.3 and 0.1 in units of 2^-16, rounded. */
static filter_config_t of_paper_001(void)
{
    filter_config_t config = filter_defaults(&filter_law_synth, 1000);
    config.value[SYNTH_A1_Q16] = -19661;
    config.value[SYNTH_B0_UQ16] = 6554;
    return config;
}

/* 0 and 0.3 in units of 2^-16, rounded; 0.003 LSB^2 per 0.1 Hz. */
TEST(shipped_values_are_those_of_paper_000)
{
    filter_config_t config = filter_defaults(&filter_law_synth, 1000);
    TEST_ASSERT_EQUAL_UINT16(1000, config.rate_dhz);
    TEST_ASSERT_EQUAL_INT32(0, config.value[SYNTH_A1_Q16]);
    TEST_ASSERT_EQUAL_INT32(19661, config.value[SYNTH_B0_UQ16]);
    TEST_ASSERT_EQUAL_INT32(3 * 256, config.value[SYNTH_R_LSB2_Q8]);
}

/*
 * 1 + 2 a1 (1 - b0) = 0 lies at a1 = -2/3 = -43690.7 / 65536 for b0 = 1/4, and for a1 = -65535 / 65536 at
 * b0 = 32767.5 / 65536. With a1 >= 0 any gain is stable, at the corners of the range too.
 */
TEST(border_of_the_region_is_outside)
{
    static const struct {
        int32_t a1_q16;
        uint16_t b0_uq16;
        bool stable;
    } cases[] = {
        { -43690, 16384, true }, { -43691, 16384, false }, { -65535, 32768, true }, { -65535, 32767, false },
        { -65535, 65535, true }, { -65535, 656, false },   { 65535, 656, true },    { 65535, 65535, true },
        { 0, 656, true },        { 0, 65535, true },
    };
    for (uint8_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        filter_t f;
        filter_config_t config = filter_defaults(&filter_law_synth, 1000);
        config.value[SYNTH_B0_UQ16] = cases[i].b0_uq16;
        config.value[SYNTH_A1_Q16] = cases[i].a1_q16;
        TEST_ASSERT_EQUAL_UINT8(cases[i].stable ? FILTER_ACCEPTED : FILTER_REFUSED_TOGETHER,
                                filter_init(&f, &filter_law_synth, &config));
    }
}

/*
 * A ramp of s LSB a sample: the median is two samples behind, and at rest, so the last two estimates are -2 s and -s
 * off. From there the errors are e(n) = (1 - b0(n)) (2 e(n - 1) - e(n - 2)) with the gains of the start, 1 - b0(n) = (n
 * - 1) (n -
 * 2) / (n (n + 1)). A gain is off by 2^-17 of an innovation, and these sum to less than 10 s; each product is rounded
 * by half a count: 10 s + 60 counts.
 */
TEST(start_on_a_ramp_catches_up)
{
    static const int16_t slopes_lsb[] = { 3, 8, -8, 40 };
    for (uint8_t i = 0; i < sizeof slopes_lsb / sizeof slopes_lsb[0]; i++) {
        int32_t slope = slopes_lsb[i];
        int64_t before = -slope * 65536;
        int64_t off = -2 * slope * 65536;
        filter_t f = made_synth(0, 656);
        for (int32_t n = 1; n <= 63; n++) {
            int32_t x = filter_update(&f, (int16_t)(slope * n));
            if (n > FILTER_WARM_UP_SAMPLES) {
                int64_t next = (2 * off - before) * ((n - 1) * (n - 2)) / (n * (n + 1));
                before = off;
                off = next;
                TEST_ASSERT_INT32_WITHIN(10 * (slope < 0 ? -slope : slope) + 60, (int32_t)off, x - slope * n * 65536);
            }
        }
    }
}

static uint16_t gain_of_next_sample(filter_t *f)
{
    (void)filter_update(f, 7);
    filter_probe_t probe = probe_of(f);
    return probe.gain_uq16;
}

/* (4 n - 2) / (n (n + 1)) in 2^-16, rounded, for n = 6..63; b0 = 0.01 stays below all of them, then it is the gain. */
TEST(start_gains_are_those_of_a_line)
{
    filter_t f = made_synth(0, 656);
    for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        TEST_ASSERT_EQUAL_UINT16(0, gain_of_next_sample(&f));
    }
    for (uint32_t n = 6; n <= 63; n++) {
        uint32_t below = n * (n + 1U);
        TEST_ASSERT_EQUAL_UINT16((65536U * (4U * n - 2U) + below / 2U) / below, gain_of_next_sample(&f));
    }
    TEST_ASSERT_EQUAL_UINT16(656, gain_of_next_sample(&f));
}

/* n = 11: 42/132 = 0.318; n = 12: 46/156 = 0.295 is no longer above 0.3. */
TEST(start_ends_at_the_first_gain_that_is_not_above)
{
    filter_t f = made_synth(0, 19661);
    feed(&f, 7, 10);
    TEST_ASSERT_EQUAL_UINT16(20852, gain_of_next_sample(&f));
    TEST_ASSERT_EQUAL_UINT16(19661, gain_of_next_sample(&f));
}

/* What a person reads: value / 2^fraction bits is 0.3, -0.3, 3 LSB^2 (to the last bit of the format). */
TEST(descriptor_has_the_binary_points)
{
    filter_config_t config = of_paper_001();
    TEST_ASSERT_EQUAL_UINT8(4, parameter_count(FILTER_KIND_synth));
    const filter_parameter_t parameter[3] = { parameter_at(FILTER_KIND_synth, 0), parameter_at(FILTER_KIND_synth, 1),
                                              parameter_at(FILTER_KIND_synth, 2) };
    TEST_ASSERT_EQUAL_STRING("a1", parameter_name(FILTER_KIND_synth, 0));
    TEST_ASSERT_INT32_WITHIN(5, -3 * (int32_t)(1UL << parameter[0].fraction_bits), 10 * config.value[SYNTH_A1_Q16]);
    TEST_ASSERT_EQUAL_STRING("b0", parameter_name(FILTER_KIND_synth, 1));
    TEST_ASSERT_EQUAL_STRING("r", parameter_name(FILTER_KIND_synth, 2));
    TEST_ASSERT_EQUAL_STRING("ratemax", parameter_name(FILTER_KIND_synth, 3));
    TEST_ASSERT_TRUE(parameter[0].min < 0 && parameter[1].min > 0 && parameter[2].min > 0);
    TEST_ASSERT_INT32_WITHIN(5, (int32_t)(1UL << parameter[1].fraction_bits),
                             10 * (int32_t)config.value[SYNTH_B0_UQ16]);
    TEST_ASSERT_EQUAL_INT32(3UL << parameter[2].fraction_bits, config.value[SYNTH_R_LSB2_Q8]);
}

/*
 * ratemax 800 LSB/s at 100 Hz is 8 LSB a sample, b0 = 1/2: after rest at 0 a sample of 16 gives a rate of 8, one of 18
 * would give 9. The estimate itself moves all the same, and the next prediction goes on by 8.
 */
TEST(one_sample_turns_the_rate_up_to_its_limit)
{
    for (int16_t sign = -1; sign <= 1; sign = (int16_t)(sign + 2)) {
        for (int16_t z_lsb = 14; z_lsb <= 18; z_lsb = (int16_t)(z_lsb + 2)) {
            filter_config_t config = filter_defaults(&filter_law_synth, 1000);
            config.value[SYNTH_B0_UQ16] = 32768;
            filter_t f = made(&filter_law_synth, &config);
            filter_reset(&f, 0);
            TEST_ASSERT_EQUAL_INT32(sign * z_lsb * 32768L, filter_update(&f, (int16_t)(sign * z_lsb)));
            TEST_ASSERT_EQUAL_UINT8(z_lsb > 16 ? FILTER_SATURATED : 0, f.flags);
            int32_t rate_lsb = z_lsb > 16 ? 8 : z_lsb / 2;
            TEST_ASSERT_EQUAL_INT32(sign * (z_lsb * 32768L + rate_lsb * 65536L), coast(&f));
        }
    }
}

/* a1 = -1/2, b0 = 1/2: 100 after rest at 0 gives 50 and a rate of 8; bent, x_e would go on by 12, then by 10. */
TEST(bent_predictions_are_limited_too)
{
    filter_config_t config = filter_defaults(&filter_law_synth, 1000);
    config.value[SYNTH_A1_Q16] = -32768;
    config.value[SYNTH_B0_UQ16] = 32768;
    filter_t f = made(&filter_law_synth, &config);
    filter_reset(&f, 0);
    TEST_ASSERT_EQUAL_INT32(50L * 65536, filter_update(&f, 100));
    TEST_ASSERT_EQUAL_INT32(62L * 65536, coast(&f));
    TEST_ASSERT_EQUAL_INT32(70L * 65536, coast(&f));
}

/* Two bad samples among the first five change nothing: the start is their median. */
TEST(outliers_in_the_start_cost_nothing)
{
    for (uint8_t one = 0; one < FILTER_WARM_UP_SAMPLES; one++) {
        for (uint8_t other = 0; other < FILTER_WARM_UP_SAMPLES; other++) {
            filter_t f = made_synth(0, 656);
            for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
                (void)filter_update(&f, (int16_t)((k == one) ? 4000 : (k == other) ? -900 : 7));
            }
            for (uint8_t k = 0; k < 20; k++) {
                TEST_ASSERT_EQUAL_INT32(7L * 65536, filter_update(&f, 7));
            }
        }
    }
}

/* Impulse response by hand from equation (7), a1 = -0.3, b0 = 0.1: 0.1, 0.207, 0.28449, 0.317814 (x 4000 LSB). */
TEST(impulse_response_is_that_of_equation_7)
{
    static const int32_t expected_milli_lsb[] = { 400000, 828000, 1137960, 1271256 };
    filter_t f = made_synth(-19661, 6554);
    filter_reset(&f, 0);
    for (uint8_t k = 0; k < 4; k++) {
        int32_t x = filter_update(&f, (k == 0) ? 4000 : 0);
        /* a1 and b0 are off by 2^-18: b0 by 6e-5 of itself, up to four times over */
        int32_t milli = (int32_t)(((int64_t)x * 1000) / 65536);
        TEST_ASSERT_INT32_WITHIN(expected_milli_lsb[k] / 4000, expected_milli_lsb[k], milli);
    }
}

/* Coasting is the extrapolation: after a settled ramp of 2 LSB a sample it goes on by 2. */
TEST(coast_goes_on_along_the_line)
{
    filter_t f = made_synth(0, 32768);
    for (int16_t k = 0; k < 200; k++) {
        (void)filter_update(&f, (int16_t)(2 * k));
    }
    (void)coast(&f);
    (void)coast(&f);
    TEST_ASSERT_INT32_WITHIN(655, 2L * 202 * 65536, coast(&f));
    TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED, f.flags);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_INT32(0, probe.innovation_lsb_q16);
    TEST_ASSERT_EQUAL_UINT16(0, probe.gain_uq16);
    TEST_ASSERT_INT32_WITHIN(655, 2L * 65536, probe.rate_lsb_q16);
}

/*
 * a1 = -1/2, b0 = 1/2, exact in Q16: 1000 after rest at 0 gives 500, 0, 0; then 2 x1 - x2 + (x1 - 2 x2 + x3) / 2 again
 * and again: 1250, 2125, 3062.5, 4031.25, and 5015.625 is beyond the format.
 */
TEST(coast_bends_with_a1_up_to_the_bound)
{
    static const int32_t expected_quarter_lsb[] = { 5000, 8500, 12250, 16125 };
    filter_t f = made_synth(-32768, 32768);
    filter_reset(&f, 0);
    TEST_ASSERT_EQUAL_INT32(500L * 65536, filter_update(&f, 1000));
    for (uint8_t k = 0; k < 4; k++) {
        TEST_ASSERT_EQUAL_INT32(expected_quarter_lsb[k] * 16384, coast(&f));
        TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED, f.flags);
    }
    TEST_ASSERT_EQUAL_INT32((int32_t)FILTER_X_MAX_LSB * 65536, coast(&f));
    TEST_ASSERT_EQUAL_UINT8(FILTER_COASTED | FILTER_SATURATED, f.flags);
}

/* A sample that comes after a gap is not counted twice by the start: its gains go by samples seen. */
TEST(coast_in_the_start_does_not_count)
{
    filter_t f = made_synth(0, 19661);
    feed(&f, 7, FILTER_WARM_UP_SAMPLES);
    (void)coast(&f);
    (void)filter_update(&f, 7);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_UINT16(34328, probe.gain_uq16);
}

TEST(coast_before_any_sample_is_zero)
{
    filter_t f = made_synth(-19661, 6554);
    TEST_ASSERT_EQUAL_INT32(0, coast(&f));
    TEST_ASSERT_EQUAL_UINT8(FILTER_WARMING_UP | FILTER_COASTED, f.flags);
}

/*
 * R = 3 LSB^2: one sample's variance in the start, then 0.548387 x 3 = 1.645 (421 / 256) at (0, 0.3), 0.822358 x 3 at
 * the paper's.
 */
TEST(probe_reports_the_variance)
{
    filter_t f = made_synth(0, 19661);
    (void)filter_update(&f, 5);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_UINT32(768, probe.p_lsb2_q8);
    TEST_ASSERT_EQUAL_INT32(5L * 65536, probe.x_lsb_q16);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, probe.gate_lsb2_q8);
    filter_reset(&f, 5);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(1, 421, probe.p_lsb2_q8);
    f = made_synth(-19661, 6554);
    filter_reset(&f, 5);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(1, 632, probe.p_lsb2_q8);
    filter_set_noise(&f, 4 * 768);
    filter_probe(&f, &probe);
    TEST_ASSERT_UINT32_WITHIN(1, 2526, probe.p_lsb2_q8);
}

/* The paper's preset overshoots a full-range step by 69 %: the bound of the format cuts that off and the flag tells. */
TEST(overshoot_beyond_the_format_is_flagged)
{
    uint8_t flags = 0;
    filter_t f = made_synth(-19661, 6554);
    filter_reset(&f, -4096);
    for (uint8_t k = 0; k < 20; k++) {
        int32_t x = filter_update(&f, 4095);
        TEST_ASSERT_TRUE(x <= (int32_t)FILTER_X_MAX_LSB * 65536);
        flags |= f.flags;
    }
    TEST_ASSERT_EQUAL_UINT8(FILTER_SATURATED, flags);
}

/* With an extrapolation that sees the curvature, which a damp must not make. */
TEST(damp_bends_nothing)
{
    filter_config_t config = filter_defaults(&filter_law_synth, 1000);
    config.value[SYNTH_A1_Q16] = -19661; /* -0.3 */
    filter_t f = made(&filter_law_synth, &config);
    filter_reset(&f, 0);
    for (int16_t k = 1; k <= 400; k++) {
        (void)filter_update(&f, (int16_t)(k * 3));
    }
    int32_t x = coast_only(&f);
    filter_tracker_damp(&f);
    TEST_ASSERT_INT32_WITHIN(65536 / 64, 3 * 65536L / 2, coast_only(&f) - x);
}
