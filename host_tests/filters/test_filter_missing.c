/*
 * Generic properties, over the list of filters, of samples that are missing: the verbs that filter_missing is made of
 * (tracker.h), and a filter that warms up again.
 */
#include "support/test_law.h"

#define SEED 60006UL

enum { RAMP_LSB = 3, SETTLING = 400, RAIL_LSB = 4095, CLIPPED = 1500, NO_RESTART = 60 };

static uint32_t random_state;

void setUp(void)
{
    random_state = SEED;
}

static int16_t any_sample(void)
{
    return (int16_t)((int32_t)(random32(&random_state) >> 16) - 32768);
}

/* On a ramp that ends at 0, long enough for every filter's rate to be right. */
static filter_t settled_on_ramp(uint8_t kind, int16_t slope_lsb)
{
    filter_t f = made_kind(kind, 1000);
    filter_reset(&f, (int16_t)(-slope_lsb * SETTLING));
    for (int16_t k = 1; k <= SETTLING; k++) {
        (void)filter_update(&f, (int16_t)(-slope_lsb * (SETTLING - k)));
    }
    return f;
}

/* Half of 3 LSB per sample, then a quarter: each missing sample moves the estimate by what is left. */
static void assert_damped(uint8_t kind, int16_t slope_lsb)
{
    filter_t f = settled_on_ramp(kind, slope_lsb);
    for (int32_t part = 2; part <= 16; part *= 2) {
        int32_t x = probe_of(&f).x_lsb_q16;
        uint8_t flags = f.flags;
        filter_tracker_damp(&f);
        TEST_ASSERT_EQUAL_INT32(x, probe_of(&f).x_lsb_q16);
        TEST_ASSERT_EQUAL_UINT8(flags, f.flags);
        for (uint8_t k = 0; k < 3; k++) {
            int32_t before = x;
            x = coast_only(&f);
            TEST_ASSERT_INT32_WITHIN(65536 / 64, slope_lsb * 65536L / part, x - before);
        }
    }
}

TEST(test_damp_halves_the_rate_and_moves_nothing)
{
    FOR_EACH_KIND(kind)
    {
        assert_damped(kind, RAMP_LSB);
        assert_damped(kind, -RAMP_LSB);
    }
}

/* R is 3 LSB^2 at 100 Hz, three sigmas 5.2 LSB: a rate of 5 LSB per sample may be noise, one of 6 is none. */
TEST(test_a_gap_stops_only_a_rate_that_may_be_noise)
{
    FOR_EACH_KIND(kind)
    {
        for (int16_t slope_lsb = 5; slope_lsb <= 6; slope_lsb++) {
            filter_t f = settled_on_ramp(kind, slope_lsb);
            filter_t told = f;
            filter_tracker_fade(&told, true);
            TEST_ASSERT_EQUAL_INT32(probe_of(&f).x_lsb_q16, probe_of(&told).x_lsb_q16);
            if (law_facts((filter_kind_t)kind).rate_is_a_difference && slope_lsb == 5) {
                TEST_ASSERT_EQUAL_INT32(probe_of(&f).x_lsb_q16, coast_only(&told));
                continue;
            }
            for (uint8_t k = 0; k < 3; k++) {
                TEST_ASSERT_EQUAL_INT32(coast_only(&f), coast_only(&told));
            }
        }
    }
}

/* Halved with its variance: the sample behind a gap is believed less than without, so its noise makes no jump. */
TEST(test_damp_leaves_less_gain_after_a_gap)
{
    FOR_EACH_KIND(kind)
    {
        filter_t damped = settled_on_ramp(kind, 0);
        uint16_t steady_uq16 = probe_of(&damped).gain_uq16;
        filter_t plain = damped;
        for (uint8_t k = 1; k <= 10U; k++) {
            if (k == 3U || k == 6U || k == 8U) { /* each 25 ms of 100 Hz */
                filter_tracker_damp(&damped);
            }
            (void)coast_only(&damped);
            (void)coast_only(&plain);
        }
        (void)filter_update(&damped, 0);
        (void)filter_update(&plain, 0);
        if (probe_of(&plain).gain_uq16 > steady_uq16) { /* those with a covariance */
            TEST_ASSERT_LESS_THAN_UINT16(probe_of(&plain).gain_uq16, probe_of(&damped).gain_uq16);
        } else {
            TEST_ASSERT_EQUAL_UINT16(probe_of(&plain).gain_uq16, probe_of(&damped).gain_uq16);
        }
    }
}

/* The start of the filters lies where their estimates will be: a sample missing in it changes none of them. */
TEST(test_a_missing_sample_leaves_a_start_alone)
{
    FOR_EACH_KIND_WITH_MEDIAN(kind)
    {
        filter_t plain = made_kind(kind, 1000);
        filter_t told = made_kind(kind, 1000);
        for (uint8_t k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
            int32_t before = told.x_lsb_q16;
            TEST_ASSERT_EQUAL_INT32(before, filter_missing(&told));
            int16_t z = any_sample();
            TEST_ASSERT_EQUAL_INT32(filter_update(&plain, z), filter_update(&told, z));
        }
    }
}

/* Whatever it went through: from the next sample on it is a filter that was begun just now. */
TEST(test_restart_is_as_after_init)
{
    FOR_EACH_KIND(kind)
    {
        for (uint8_t run = 0; run < 100U; run++) {
            filter_t fresh;
            uint32_t refused = 0;
            TEST_ASSERT_TRUE(init_random(&fresh, (filter_kind_t)kind, &random_state, &refused));
            filter_t used = fresh;
            for (uint8_t k = 0; k < run; k++) {
                (void)((k % 9U == 8U) ? filter_missing(&used) : filter_update(&used, any_sample()));
            }
            filter_restart(&used);
            uint8_t same = law_facts((filter_kind_t)kind).learns ? FILTER_WARM_UP_SAMPLES : 80U;
            for (uint8_t k = 0; k < same; k++) {
                int16_t z = any_sample();
                TEST_ASSERT_EQUAL_INT32(filter_update(&fresh, z), filter_update(&used, z));
                TEST_ASSERT_EQUAL_UINT8(fresh.flags, used.flags);
                TEST_ASSERT_EQUAL_INT32(probe_of(&fresh).rate_lsb_q16, probe_of(&used).rate_lsb_q16);
            }
        }
    }
}

/* How often a filter at rest restarted while the sensor stood at its rail. */
static uint16_t restarts_at_the_rail(filter_t *f, uint8_t kind, bool missing)
{
    uint16_t restarts = 0;
    *f = made_kind(kind, 1000);
    filter_reset(f, 0);
    for (uint16_t k = 0; k < CLIPPED; k++) {
        (void)(missing ? filter_missing(f) : filter_update(f, RAIL_LSB));
        restarts = (uint16_t)(restarts + ((f->flags & FILTER_REACQUIRED) != 0U));
        filter_probe_t probe = probe_of(f);
        TEST_ASSERT_NULL(broken_bound(f, &probe, probe.x_lsb_q16));
    }
    return restarts;
}

/* Those that gate; the others take a sample at the rail as any other. */
TEST(test_samples_reported_missing_restart_no_filter)
{
    FOR_EACH_KIND(kind)
    {
        filter_t f;
        TEST_ASSERT_EQUAL_UINT16(0, restarts_at_the_rail(&f, kind, true));
        TEST_ASSERT_EQUAL_INT32(0, f.x_lsb_q16);
        bool restarts = law_facts((filter_kind_t)kind).restarts;
        TEST_ASSERT_EQUAL_INT(restarts, restarts_at_the_rail(&f, kind, false) != 0U);
    }
}

/* The samples at the rail do not count: it takes those of a run to restart. */
TEST(test_a_filter_restarts_after_the_rail)
{
    FOR_EACH_KIND(kind)
    {
        filter_t f;
        (void)restarts_at_the_rail(&f, kind, true);
        int32_t x = 0;
        bool slow = law_facts((filter_kind_t)kind).recovery_samples > 100U; /* P has not grown while it held */
        for (uint16_t k = 0; k < (slow ? 400U : 60U); k++) {
            x = filter_update(&f, RAIL_LSB - 111);
            TEST_ASSERT_TRUE(k >= 2U || (f.flags & FILTER_REACQUIRED) == 0U);
        }
        if (!law_facts((filter_kind_t)kind).stays_away) {
            TEST_ASSERT_INT32_WITHIN(20L * 65536, (RAIL_LSB - 111) * 65536L, x);
        }
    }
}

/* Samples far away until a filter at rest restarts on one: refused ones, then missing ones, then more. */
static unsigned samples_to_restart(uint8_t kind, unsigned refused, unsigned missing)
{
    filter_t f = made_kind(kind, 1000);
    filter_reset(&f, 0);
    for (unsigned k = 0; k < refused; k++) {
        (void)filter_update(&f, RAIL_LSB - 111);
    }
    for (unsigned k = 0; k < missing; k++) {
        (void)filter_missing(&f);
    }
    unsigned count = 0;
    do {
        (void)filter_update(&f, RAIL_LSB - 111);
        count++;
    } while ((f.flags & FILTER_REACQUIRED) == 0U && count < NO_RESTART);
    return count;
}

/*
 * Missing ones in the run that restarts a filter, as those at the rail are, are worth nothing, however many they are.
 */
TEST(test_missing_samples_do_not_count_in_a_run)
{
    unsigned restarting = 0;
    FOR_EACH_KIND(kind)
    {
        unsigned whole = samples_to_restart(kind, 0, 0);
        restarting += whole < NO_RESTART;
        for (unsigned refused = 0; refused < 4U && whole < NO_RESTART; refused++) {
            for (unsigned missing = 1; missing < 4U; missing++) {
                TEST_ASSERT_EQUAL_UINT(whole - refused, samples_to_restart(kind, refused, missing));
            }
        }
    }
    TEST_ASSERT_TRUE(restarting > 0U);
}
/* However long samples were missing before: a filter that is reset begins its next gap anew. */
TEST(test_a_reset_ends_the_hold)
{
    for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        filter_t held, fresh;
        held = made_kind(kind, 1000);
        fresh = made_kind(kind, 1000);
        filter_reset(&held, 100);
        for (uint8_t k = 0; k < 30U; k++) {
            (void)filter_missing(&held);
        }
        filter_reset(&held, 100);
        filter_reset(&fresh, 100);
        TEST_ASSERT_EQUAL_INT32(filter_missing(&fresh), filter_missing(&held));
        TEST_ASSERT_EQUAL_UINT8(fresh.quarters, held.quarters);
        TEST_ASSERT_EQUAL_UINT32(probe_of(&fresh).p_lsb2_q8, probe_of(&held).p_lsb2_q8);
    }
}
