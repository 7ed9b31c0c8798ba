/*
 * Noise estimator in integers, on the PC and on the chip; its constants, its level and healthy recordings:
 * test_noise_reference.c.
 */
#include "noise.h"
#include "support/filters.h"
#include "support/test.h"

#define SEED 99UL

/* 1.5 x 0.02 x 100 = 3 LSB^2, z 5.1; 800 Hz: 24, z 40.8. 223 for 131.07 x 1.7 = 222.8, 131 for 131.07: 0.1 %. */
TEST(starts_at_the_floor_and_stays_there_on_silence)
{
    static const uint16_t rates[] = { 1000, 8000 };
    static const uint16_t floors_lsb2_q8[] = { 768, 1306, 6144, 10445 };
    for (uint8_t i = 0; i < 4; i++) {
        noise_t n;
        filter_noise_init(&n, rates[i / 2], (i & 1) != 0);
        for (uint16_t k = 0; k < 1000; k++) {
            TEST_ASSERT_FALSE(filter_noise_update(&n, 17));
        }
        TEST_ASSERT_UINT32_WITHIN(floors_lsb2_q8[i] / 500U, floors_lsb2_q8[i], filter_noise_r_lsb2_q8(&n));
    }
}

TEST(gap_forgets_the_differences)
{
    noise_t n;
    filter_noise_init(&n, 1000, false);
    for (uint16_t k = 0; k < 300; k++) {
        (void)filter_noise_update(&n, 0);
        if (k % 20 == 19) {
            filter_noise_gap(&n);
            for (uint8_t j = 0; j < 5; j++) {
                TEST_ASSERT_FALSE(filter_noise_update(&n, 4000));
            }
            filter_noise_gap(&n);
        }
    }
    TEST_ASSERT_UINT32_WITHIN(2, 3 * 256, filter_noise_r_lsb2_q8(&n));
}

TEST(any_input_keeps_r_legal)
{
    uint32_t random = SEED;
    for (uint8_t run = 0; run < ON_PC_OR_CHIP(50, 10); run++) {
        noise_t n;
        filter_noise_init(&n, (uint16_t)(50U + random32_below(&random, 39951)), (run & 1) != 0);
        uint32_t floor_q8 = filter_noise_r_lsb2_q8(&n);
        uint8_t fewer_bits = (uint8_t)random32_below(&random, 15);
        for (uint16_t k = 0; k < ON_PC_OR_CHIP(5000, 500); k++) {
            int32_t any = (int32_t)(random32(&random) >> 16) - 32768;
            (void)filter_noise_update(&n, (int16_t)(any / (1L << fewer_bits)));
            TEST_ASSERT_TRUE(filter_noise_r_lsb2_q8(&n) >= floor_q8 && filter_noise_r_lsb2_q8(&n) <= 256000U);
        }
    }
}

/* How much one term far beyond the limit raises a mean of 4 LSB^2 after so many terms; Q16. */
static uint32_t rise(uint8_t terms)
{
    noise_t n;
    filter_noise_init(&n, 125, false);
    n.mean_lsb2_q16 = (uint32_t)4 << 16;
    n.terms = terms;
    static const int16_t far[] = { 0, 100, 0, 100, 0, 100 };
    for (uint8_t k = 0; k < 6; k++) {
        (void)filter_noise_update(&n, far[k]);
    }
    return n.mean_lsb2_q16 - ((uint32_t)4 << 16);
}

/*
 * noise.h: a term counts at most three times the mean, 4.5 times among the first 64; the window is the same from 32 to
 * 63 terms and from 64 to 127, and twice as long.
 */
TEST(the_first_64_terms_may_count_more)
{
    TEST_ASSERT_TRUE(rise(63) > 0);
    TEST_ASSERT_UINT32_WITHIN(1, rise(32), rise(63));
    TEST_ASSERT_UINT32_WITHIN(1, rise(64), rise(127));
    TEST_ASSERT_UINT32_WITHIN(rise(63) / 100U, rise(63), rise(64) * 35U / 10U); /* (4.5 - 1) / (3 - 1), twice */
}
