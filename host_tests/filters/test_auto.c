/* auto: gate and restart of the members, the choice by the bounded scores, gaps. */
#include "support/auto.h"
#include "support/test_law.h"

/* At rest without noise: four on end beyond every gate move nothing, the fifth restarts, and it stays there. */
TEST(test_four_outliers_move_nothing_and_the_fifth_restarts)
{
    for (int16_t side = -1; side <= 1; side = (int16_t)(side + 2)) {
        filter_t f = made_at_rest(100);
        int16_t away = (int16_t)(100 + side * (2 * GATE_LSB + 1));
        for (int n = 0; n < 4; n++) {
            TEST_ASSERT_EQUAL_INT32(100L * 65536, filter_update(&f, away));
            TEST_ASSERT_EQUAL_HEX8(FILTER_GATED, f.flags);
        }
        TEST_ASSERT_EQUAL_INT32(away * 65536L, filter_update(&f, away));
        TEST_ASSERT_EQUAL_HEX8(FILTER_REACQUIRED, f.flags);
        TEST_ASSERT_EQUAL_INT32(away * 65536L, filter_update(&f, away));
    }
}

/* By turns to either side no run becomes long. */
TEST(test_refused_to_either_side_never_restart)
{
    filter_t f = made_at_rest(0);
    for (int n = 0; n < 400; n++) {
        int side = (n / 4 % 2 == 0) ? 1 : -1;
        TEST_ASSERT_EQUAL_INT32(0, filter_update(&f, (int16_t)(side * 500)));
        TEST_ASSERT_EQUAL_HEX8(FILTER_GATED, f.flags);
    }
}

/* Six sigmas, the slow member twelve: at it a sample is used, a count beyond it is not. */
TEST(test_the_slow_member_has_twice_the_gate)
{
    for (int16_t z = GATE_LSB; z <= 2 * GATE_LSB + 1; z++) {
        filter_t f = made_at_rest(0);
        (void)filter_update(&f, z);
        TEST_ASSERT_EQUAL_INT(z > 2 * GATE_LSB, f.own.bank.members[AUTO_SLOW].refused);
        TEST_ASSERT_EQUAL_INT(z > GATE_LSB, f.own.bank.members[AUTO_MIDDLE].refused);
        TEST_ASSERT_EQUAL_INT(z > GATE_LSB, f.own.bank.members[AUTO_FAST].refused);
    }
}

/* Without a gate all are used, up to the rails. */
TEST(test_without_a_gate_nothing_is_refused)
{
    filter_config_t config = filter_defaults(&filter_law_auto, 1000);
    config.value[AUTO_GATE_SIGMA_Q8] = 0;
    filter_t f = made(&filter_law_auto, &config);
    filter_reset(&f, -4096);
    (void)filter_update(&f, 4095);
    TEST_ASSERT_EQUAL_HEX8(0, f.flags & FILTER_GATED);
    TEST_ASSERT_TRUE(f.gain_uq16 != 0);
}

static void set_scores(filter_t *f, uint32_t slow, uint32_t middle, uint32_t fast)
{
    f->own.bank.members[AUTO_SLOW].score_lsb2_uq8 = slow;
    f->own.bank.members[AUTO_MIDDLE].score_lsb2_uq8 = middle;
    f->own.bank.members[AUTO_FAST].score_lsb2_uq8 = fast;
}

/* Samples on the prediction take an eighth off every score, which leaves their order. */
TEST(test_the_least_score_is_chosen_beyond_the_hysteresis)
{
    static const struct {
        uint32_t slow, middle, fast;
        uint8_t before, after;
    } cases[] = { { 32000, 31500, 40000, AUTO_SLOW, AUTO_SLOW },     { 32000, 30900, 40000, AUTO_SLOW, AUTO_MIDDLE },
                  { 32000, 30900, 20000, AUTO_SLOW, AUTO_FAST },     { 10000, 30900, 20000, AUTO_FAST, AUTO_SLOW },
                  { 31500, 32000, 31500, AUTO_MIDDLE, AUTO_MIDDLE }, { 0, 0, 0, AUTO_FAST, AUTO_FAST } };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        filter_t f = made_at_rest(7);
        f.own.bank.chosen = cases[i].before;
        set_scores(&f, cases[i].slow, cases[i].middle, cases[i].fast);
        (void)filter_update(&f, 7);
        TEST_ASSERT_EQUAL_UINT8(cases[i].after, f.own.bank.chosen);
        TEST_ASSERT_EQUAL_UINT8(cases[i].after, f.own.bank.shown);
        bool told = (f.flags & FILTER_SWITCHED) != 0;
        TEST_ASSERT_EQUAL_INT(cases[i].before != cases[i].after, told);
    }
}

/* Mean of eight: a score goes (7/8)^n of its way to the square of the innovation, held to 64 R. */
TEST(test_a_score_is_the_bounded_mean_over_eight_samples)
{
    filter_t f = made_at_rest(0);
    /* eight times the mean of 1024 LSB^2 each: 1024, 1920, 2704, 3390 */
    static const uint16_t expected_lsb2[] = { 1024, 1920, 2704, 3390 };
    for (uint8_t n = 0; n < 4U; n++) { /* all refused: the innovation stays */
        (void)filter_update(&f, (n % 2U == 0U) ? 200 : 4000);
        for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
            TEST_ASSERT_UINT32_WITHIN(4, expected_lsb2[n] * 256UL, f.own.bank.members[i].score_lsb2_uq8);
        }
    }
    f = made_at_rest(0);
    (void)filter_update(&f, 20);
    TEST_ASSERT_EQUAL_UINT32(400L * 256, f.own.bank.members[AUTO_FAST].score_lsb2_uq8);
}

/* What all members meet alike does not decide: whatever its size, one outlier changes no choice. */
TEST(test_one_outlier_changes_no_choice)
{
    for (int16_t size = 100; size <= 4000; size = (int16_t)(size + 100)) {
        filter_t f = made_at_rest(0);
        f.own.bank.chosen = AUTO_MIDDLE;
        set_scores(&f, 30000, 20000, 30000);
        (void)filter_update(&f, size);
        TEST_ASSERT_EQUAL_UINT8(AUTO_MIDDLE, f.own.bank.chosen);
        TEST_ASSERT_EQUAL_HEX8(FILTER_GATED, f.flags);
    }
}

TEST(test_the_middle_member_predicts_what_is_missing)
{
    filter_t f = made_at_rest(0);
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        f.own.bank.members[i].x_lsb_q16 = (i + 1) * 65536L;
        f.own.bank.members[i].rate_lsb_q16 = (i + 1) * 32768L;
    }
    TEST_ASSERT_EQUAL_INT32(2 * 65536L + 2 * 32768L, coast(&f));
    TEST_ASSERT_EQUAL_HEX8(FILTER_COASTED, f.flags);
    filter_probe_t probe = probe_of(&f);
    TEST_ASSERT_EQUAL_INT32(2 * 65536L + 2 * 32768L, probe.x_lsb_q16);
    TEST_ASSERT_EQUAL_INT32(2 * 32768L, probe.rate_lsb_q16);
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        TEST_ASSERT_EQUAL_INT32((i + 1) * 98304L, f.own.bank.members[i].x_lsb_q16);
    }
    (void)filter_update(&f, 1);
    TEST_ASSERT_EQUAL_UINT8(f.own.bank.chosen, f.own.bank.shown);
}

static void assert_default_memory(uint16_t rate_dhz, uint32_t samples, uint32_t least_ms, int32_t ms)
{
    uint32_t wanted_ms = samples * 10000U / rate_dhz;
    wanted_ms = (wanted_ms < least_ms) ? least_ms : wanted_ms;
    TEST_ASSERT_EQUAL_INT32((wanted_ms < 60000U) ? (int32_t)wanted_ms : 60000, ms);
}

/* 28, 11 and 5 samples, at least 500, 200 and 80 ms; within the range, not wrapped, at a rate that init refuses too. */
TEST(test_default_memories_are_in_range_at_every_rate)
{
    for (uint32_t rate_dhz = 1; rate_dhz <= FILTER_RATE_MAX_DHZ; rate_dhz++) {
        filter_t f;
        filter_config_t config = filter_defaults(&filter_law_auto, (uint16_t)rate_dhz);
        assert_default_memory((uint16_t)rate_dhz, 28, 500, config.value[AUTO_SLOW_MS]);
        assert_default_memory((uint16_t)rate_dhz, 11, 200, config.value[AUTO_MIDDLE_MS]);
        assert_default_memory((uint16_t)rate_dhz, 5, 80, config.value[AUTO_FAST_MS]);
        TEST_ASSERT_EQUAL_UINT8(rate_dhz >= FILTER_RATE_MIN_DHZ ? FILTER_ACCEPTED : FILTER_REFUSED_RATE,
                                filter_init(&f, &filter_law_auto, &config));
    }
}
