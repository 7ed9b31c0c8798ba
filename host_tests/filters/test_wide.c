/* The covariance of wide.h in integers, on the PC and on the chip: by hand, at both ends of its range. */
#include "kalman.h"
#include "support/laws.h"
#include "support/test.h"

#define ONE_UQ16 0x10000UL
#define ONE_UQ24 0x1000000UL
#define ONE_UQ28 0x10000000UL

static filter_t core;

/* The plainest law on this covariance: as published, with a gate. */
static const filter_law_t *published(void)
{
    const filter_law_t *law = NULL;
    FOR_EACH_KIND(kind)
    {
        const filter_law_t *each = filter_listed((filter_kind_t)kind);
        if ((flash_u8(&each->traits) & LAW_FIRST_SAMPLE) != 0U) {
            law = each;
        }
    }
    TEST_ASSERT_NOT_NULL(law);
    return law;
}

/* 100 Hz. */
static void make(int32_t r_lsb2_q8, int32_t q_lsb2_s3)
{
    filter_config_t config = filter_defaults(published(), 1000);
    config.value[KALMAN_R] = r_lsb2_q8;
    config.value[KALMAN_Q] = q_lsb2_s3;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&core, published(), &config));
}

/* R 1 LSB^2, q22 0.01. */
void setUp(void)
{
    make(256, 10000);
}

TEST(begin_is_limited_to_the_formats)
{
    wide_from(&core, INT32_MAX, INT32_MIN, (filter_covariance_t){ UINT32_MAX, UINT32_MAX, UINT32_MAX });
    TEST_ASSERT_EQUAL_INT32((int32_t)FILTER_X_MAX_LSB * 65536, core.x_lsb_q16);
    TEST_ASSERT_EQUAL_INT32((int32_t)FILTER_X_MAX_LSB * -65536, core.rate_lsb);
    TEST_ASSERT_EQUAL_HEX32(WIDE_P_END, core.own.wide.p.p11);
    TEST_ASSERT_EQUAL_HEX32(WIDE_P_END, core.own.wide.p.p12);
    TEST_ASSERT_EQUAL_HEX32(WIDE_P_END, core.own.wide.p.p22);
}

/* R is 1 LSB^2, Q8: the variance of one sample, until there is a P. */
TEST(variance_is_that_of_a_sample_until_the_filter_runs)
{
    filter_probe_t probe;
    core.own.wide.p.p11 = ONE_UQ16 / 2;
    filter_probe(&core, &probe);
    TEST_ASSERT_EQUAL_UINT32(256, probe.p_lsb2_q8);
    wide_from(&core, 0, 0, (filter_covariance_t){ ONE_UQ16 / 2, 0, 0 });
    filter_probe(&core, &probe);
    TEST_ASSERT_EQUAL_UINT32(128, probe.p_lsb2_q8);
}

/* P = (1, 1/2; 1/2, 1/4): P12' = 3/4, P11' = 1 + 1/2 + 3/4, P22' = 1/4 + q22; x' = 10 + 3. */
TEST(prediction_by_hand)
{
    wide_from(&core, 10 * 65536L, 3 * 65536L, (filter_covariance_t){ ONE_UQ16, ONE_UQ24 / 2, ONE_UQ28 / 4 });
    TEST_ASSERT_TRUE(filter_wide_predict(&core, 20));
    TEST_ASSERT_EQUAL_INT32(13 * 65536L, core.x_lsb_q16);
    TEST_ASSERT_EQUAL_UINT32(9 * ONE_UQ16 / 4, core.own.wide.p.p11);
    TEST_ASSERT_EQUAL_UINT32(3 * ONE_UQ24 / 4, core.own.wide.p.p12);
    TEST_ASSERT_EQUAL_UINT32(ONE_UQ28 / 4 + core.own.wide.q22_uq28, core.own.wide.p.p22);
    /* q22 = 10000 x 0.01^3 = 0.01 with 16-bit mantissas */
    TEST_ASSERT_UINT32_WITHIN(ONE_UQ28 / 100 / 8192, ONE_UQ28 / 100, core.own.wide.q22_uq28);
    /* r^2 / (R S) = 49 / 3.25 */
    TEST_ASSERT_UINT16_WITHIN(2, 3860, filter_wide_distance_uq8(&core));
}

/* Predicted P = (3, 1; 1, 1) less q22: S = 4, w1 = 3/4, w2 = 1/4, what the update takes: (9/4, 3/4, 1/4); r = 100. */
static void begin_by_hand(void)
{
    wide_from(&core, 0, 0, (filter_covariance_t){ 2 * ONE_UQ16, 0, ONE_UQ28 });
    TEST_ASSERT_TRUE(filter_wide_predict(&core, 100));
    core.own.wide.p.p22 = ONE_UQ28;
    TEST_ASSERT_EQUAL_UINT32(3 * ONE_UQ16, core.own.wide.p.p11);
    TEST_ASSERT_EQUAL_UINT32(ONE_UQ24, core.own.wide.p.p12);
}

/* The reciprocal's 1.25 counts of 2^-16, shifted with S, and one of rounding down: 2 counts of UQ0.16 per unit. */
static void assert_covariance(uint32_t p11_uq16, uint32_t p12_uq16, uint32_t p22_uq16)
{
    TEST_ASSERT_UINT32_WITHIN(8, p11_uq16, core.own.wide.p.p11);
    TEST_ASSERT_UINT32_WITHIN(8 << 8, p12_uq16 << 8, core.own.wide.p.p12);
    TEST_ASSERT_UINT32_WITHIN(8UL << 12, p22_uq16 << 12, core.own.wide.p.p22);
}

TEST(kalman_update_by_hand)
{
    begin_by_hand();
    filter_wide_correct(&core, 0, 0);
    TEST_ASSERT_INT32_WITHIN(200, 75 * 65536L, core.x_lsb_q16);
    TEST_ASSERT_INT32_WITHIN(200, 25 * 65536L, core.rate_lsb);
    TEST_ASSERT_UINT16_WITHIN(2, 3 * ONE_UQ16 / 4, core.gain_uq16);
    assert_covariance(3 * ONE_UQ16 / 4, ONE_UQ16 / 4, 3 * ONE_UQ16 / 4);
}

/* loss 1/2 halves both steps; back 1/2 leaves half of what is taken away. */
TEST(loss_and_back_by_hand)
{
    begin_by_hand();
    filter_wide_correct(&core, 0x8000, 0x8000);
    TEST_ASSERT_INT32_WITHIN(200, 75 * 32768L, core.x_lsb_q16);
    TEST_ASSERT_INT32_WITHIN(200, 25 * 32768L, core.rate_lsb);
    assert_covariance(15 * ONE_UQ16 / 8, 5 * ONE_UQ16 / 8, 7 * ONE_UQ16 / 8);
}

/* back 1: P stays; 3: twice as much more as Kalman's update would take, from P22 = 3/4 and so in its growing range. */
TEST(covariance_grows_by_hand)
{
    begin_by_hand();
    filter_wide_correct(&core, 0xFFFF, ONE_UQ16);
    assert_covariance(3 * ONE_UQ16, ONE_UQ16, ONE_UQ16);
    begin_by_hand();
    core.own.wide.p.p22 = 3 * ONE_UQ28 / 4;
    filter_wide_correct(&core, 0xFFFF, 3 * ONE_UQ16);
    assert_covariance(15 * ONE_UQ16 / 2, 5 * ONE_UQ16 / 2, 5 * ONE_UQ16 / 4);
}

/* Above an eighth of the range it does not grow; below, by less than eight times. */
TEST(growth_ends_in_range)
{
    wide_from(&core, 0, 0, (filter_covariance_t){ WIDE_GROWTH_END, 0, 0 });
    TEST_ASSERT_TRUE(filter_wide_predict(&core, 100));
    uint32_t before = core.own.wide.p.p11;
    filter_wide_correct(&core, 0xFFFF, WIDE_BACK_MAX_UQ16);
    TEST_ASSERT_EQUAL_HEX32(before, core.own.wide.p.p11);
    wide_from(&core, 0, 0, (filter_covariance_t){ WIDE_GROWTH_END - 1U, 0, 0 });
    TEST_ASSERT_TRUE(filter_wide_predict(&core, 100));
    filter_wide_correct(&core, 0xFFFF, WIDE_BACK_MAX_UQ16);
    TEST_ASSERT_UINT32_WITHIN(0x100000U, WIDE_P_END, core.own.wide.p.p11);
    TEST_ASSERT_TRUE(core.own.wide.p.p11 <= WIDE_P_END);
}

/* P / R reaches 1,100 on the way to its end, whatever drives it, and then stays. */
TEST(range_is_at_least_1100)
{
    static const int32_t q_lsb2_s3[] = { 1000, 10000, 100000, 1000000 };
    static const uint16_t steps[] = { 2500, 1200, 600, 400 };
    for (uint8_t i = 0; i < 4; i++) {
        make(256, q_lsb2_s3[i]); /* q22 = 0.001 .. 1 */
        run_from(&core, 0, 0);
        uint16_t k = 0;
        while (filter_wide_predict(&core, 0) && k < steps[i]) {
            k++;
        }
        TEST_ASSERT_TRUE(k < steps[i]);
        TEST_ASSERT_TRUE(core.own.wide.p.p11 >= 1100 * ONE_UQ16);
        uint32_t p11 = core.own.wide.p.p11;
        TEST_ASSERT_FALSE(filter_wide_predict(&core, 0));
        TEST_ASSERT_EQUAL_UINT32(p11, core.own.wide.p.p11);
        TEST_ASSERT_TRUE(core.own.wide.p.p22 <= WIDE_P_END + ONE_UQ28);
    }
}

/* A refused sample leaves prediction and P; where P cannot grow it is taken: S = 32769, x is 1/32769 from it. */
TEST(refused_sample_is_taken_at_the_end_of_the_range)
{
    wide_from(&core, 0, 0, (filter_covariance_t){ 1000 * ONE_UQ16, 0, 0 });
    bool grows = filter_wide_predict(&core, 4000);
    filter_wide_refuse(&core, grows);
    TEST_ASSERT_EQUAL_UINT8(FILTER_GATED, core.flags);
    TEST_ASSERT_EQUAL_INT32(0, core.x_lsb_q16);
    TEST_ASSERT_EQUAL_UINT16(0, core.gain_uq16);
    wide_from(&core, 0, 0, (filter_covariance_t){ WIDE_P_END, 0, 0 });
    grows = filter_wide_predict(&core, 4000);
    filter_wide_refuse(&core, grows);
    TEST_ASSERT_EQUAL_UINT8(FILTER_REACQUIRED, core.flags);
    TEST_ASSERT_INT32_WITHIN(16000, 4000 * 65536L, core.x_lsb_q16);
}

/* r^2 / R from the smallest innovation to the largest, any R: never beyond the format, never 0 for a large one. */
TEST(distance_saturates)
{
    make(FILTER_R_MIN_LSB2_Q8, 10000);
    wide_from(&core, -4608 * 65536L, 0, (filter_covariance_t){ 0, 0, 0 });
    (void)filter_wide_predict(&core, 4095);
    TEST_ASSERT_EQUAL_UINT16(UINT16_MAX, filter_wide_distance_uq8(&core));
    make(FILTER_R_MAX_LSB2_Q8, 10000);
    wide_from(&core, 256, 0, (filter_covariance_t){ WIDE_P_END, 0, 0 });
    (void)filter_wide_predict(&core, 0);
    TEST_ASSERT_EQUAL_UINT16(0, filter_wide_distance_uq8(&core));
    wide_from(&core, 0, 0, (filter_covariance_t){ 0, 0, 0 });
    (void)filter_wide_predict(&core, 316); /* 99,856 / 1,000 */
    TEST_ASSERT_UINT16_WITHIN(10, 25563, filter_wide_distance_uq8(&core));
}

/* Fast motion ends at both bounds. */
TEST(states_saturate)
{
    wide_from(&core, 4600 * 65536L, 4600 * 65536L, (filter_covariance_t){ ONE_UQ16, 0, 0 });
    (void)filter_wide_predict(&core, 0);
    TEST_ASSERT_EQUAL_INT32((int32_t)FILTER_X_MAX_LSB * 65536, core.x_lsb_q16);
    TEST_ASSERT_EQUAL_UINT8(FILTER_SATURATED, core.flags);
    wide_from(&core, 0, -4600 * 65536L, (filter_covariance_t){ 2 * ONE_UQ16, 0, ONE_UQ28 });
    (void)filter_wide_predict(&core, -4096);
    core.size_lsb_uq16 = (uint32_t)4000 << 16;
    core.negative = true;
    filter_wide_correct(&core, 0, 0);
    TEST_ASSERT_EQUAL_INT32((int32_t)FILTER_X_MAX_LSB * -65536, core.rate_lsb);
    TEST_ASSERT_EQUAL_UINT8(FILTER_SATURATED, core.flags);
}
