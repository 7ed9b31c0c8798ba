/*
 * Generic property, over the list of filters: a filter that missed up to 200 samples, at rest or in motion, predicts
 * meanwhile and is soon back where one that missed none is. Runs on the PC and on the chip.
 */
#include "support/test_law.h"

/* Where two filters that have recovered may differ: each is within 1/4 LSB and 1/32 for rounding. */
#define RECOVERED_LSB_Q16 (2 * (65536 / 4 + 65536 / 32))

/*
 * Drift per coasted sample on a ramp: a settled filter's rate is wrong by at most 2/256 LSB per sample, because more
 * would carry the innovation from one end of the +-1/256 LSB that are rounded to 0 past the other within a sample.
 */
#define DRIFT_LSB_Q16 (65536 / 128)

enum { GAP_MAX = 200, SETTLING = 300, RAMP_LSB = 2 };

/*
 * After a gap the filter is back, recovery_samples later and for good, where one without a gap is. slope: of the motion
 * before the gap, LSB per sample; goes_on: during and after it too, and the prediction follows; else all is at rest
 * from the gap's start.
 */
static void assert_recovery(const filter_t *settled, int16_t slope, bool goes_on, uint8_t gap)
{
    filter_t without = *settled;
    filter_t coasted = *settled;
    uint16_t recovery = law_facts(kind_of(settled)).recovery_samples;
    TEST_ASSERT_TRUE(recovery > 0U);
    int16_t z = 0;
    for (uint16_t k = 0; k < (uint16_t)gap + recovery + 30U; k++) {
        z = (int16_t)(z + (goes_on ? slope : 0));
        int32_t x = filter_update(&without, z);
        int32_t y = (k < gap) ? coast_only(&coasted) : filter_update(&coasted, z);
        if (k < gap && goes_on) {
            TEST_ASSERT_INT32_WITHIN(DRIFT_LSB_Q16 * (k + 2L), x, y);
        }
        if (k >= (uint16_t)gap + recovery - 1U) {
            TEST_ASSERT_INT32_WITHIN(RECOVERED_LSB_Q16, x, y);
        }
    }
}

static void assert_recovery_from_all_gaps(uint8_t kind, int16_t slope, bool goes_on)
{
    filter_t f = made_kind(kind, 1000);
    filter_reset(&f, (int16_t)(-slope * SETTLING));
    for (int16_t k = 1; k <= SETTLING; k++) {
        (void)filter_update(&f, (int16_t)(-slope * (SETTLING - k)));
    }
    for (uint8_t gap = 1; gap <= GAP_MAX; gap = (uint8_t)(gap + ON_PC_OR_CHIP(1, 19))) {
        assert_recovery(&f, slope, goes_on, gap);
    }
}

TEST(coast_at_rest_and_recover)
{
    FOR_EACH_KIND(kind)
    {
        assert_recovery_from_all_gaps(kind, 0, true);
    }
}

TEST(coast_on_a_ramp_and_recover)
{
    FOR_EACH_KIND(kind)
    {
        assert_recovery_from_all_gaps(kind, RAMP_LSB, true);
        assert_recovery_from_all_gaps(kind, -RAMP_LSB, true);
    }
}

TEST(coast_through_the_end_of_a_ramp_and_recover)
{
    FOR_EACH_KIND(kind)
    {
        assert_recovery_from_all_gaps(kind, RAMP_LSB, false);
        assert_recovery_from_all_gaps(kind, -RAMP_LSB, false);
    }
}
