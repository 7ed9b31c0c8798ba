/*
 * Gaps of a moving and of a resting board, through pipeline and clock of the missing samples, for every filter: no jump
 * when data return, rows as many as the nominal rate asks for, and where the estimate goes meanwhile.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/counters.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "path/silence.h"
#include "settings/settings.h"
#include "support/documented_limits.h"
#include "support/filters.h"
#include "support/path.h"
#include "support/random.h"
#include "support/roles.h"
#include "support/test.h"

#define DEGREES (3.14159265358979323846 / 180.0)
#define NOISE_LSB_PER_ROOT_HZ 0.141 /* of real boards, docs/results/recordings.md; z 1.3 times */

enum { SEED = 61006, ROLL_CDEG = 2000 };

static struct {
    test_random_t random;
    uint16_t rate_dhz;
    uint32_t period_us;
    uint32_t t_us; /* of the newest sample, or of the one that is missing */

    double slope;    /* degrees per second */
    bool quiet;      /* no noise */
    double roll_deg; /* true, at the newest sample */
    row_t row;
    row_t before;
    unsigned rows;
    int jump_cdeg; /* largest change from row to row since begin_jumps */
} world;

void setUp(void)
{
    random_seed(&world.random, SEED);
}

static void take_row(void)
{
    world.before = world.row;
    pipeline_finish();
    pipeline_row(&world.row);
    pipeline_row_done();
    world.rows++;
    int change = abs(world.row.roll_cdeg - world.before.roll_cdeg);
    world.jump_cdeg = change > world.jump_cdeg ? change : world.jump_cdeg;
}

static void begin(uint8_t kind, uint16_t rate_dhz, double slope)
{
    world.rate_dhz = rate_dhz;
    world.period_us = 10000000u / rate_dhz;
    world.t_us = 4294900000u; /* wraps in the first second */
    world.slope = slope;
    world.roll_deg = ROLL_CDEG / 100.0;
    path_start(kind, rate_dhz, 16, world.t_us);
}

static bool missing_by(uint32_t t_us, bool sample)
{
    return coast_due(t_us) && coast_over(world.period_us, sample);
}

static void sample(void)
{
    double sigma = world.quiet ? 0.0 : NOISE_LSB_PER_ROOT_HZ * sqrt(world.rate_dhz / 10.0);
    adxl345_sample_t s = {
        .t_us = world.t_us,
        .lsb = { (int16_t)lround(sigma * random_normal(&world.random)),
                 (int16_t)lround(265.0 * sin(world.roll_deg * DEGREES) + sigma * random_normal(&world.random)),
                 (int16_t)lround(256.0 * cos(world.roll_deg * DEGREES) + 1.3 * sigma * random_normal(&world.random)) }
    };
    while (missing_by(s.t_us, true)) {
        take_row();
    }
    TEST_ASSERT_TRUE(coast_sample(s.t_us, world.period_us));
    pipeline_sample(&s);
    take_row();
}

static void pass_time(uint32_t us)
{
    world.t_us += us;
    world.roll_deg += world.slope * us * 1e-6;
}

static void samples(unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        pass_time(world.period_us);
        sample();
    }
}

/* Main looks at the clock each 4 ms, until a period less a microsecond before the sample that ends the gap. */
static void gap(unsigned missing)
{
    uint32_t end_us = world.t_us + (missing + 1u) * world.period_us;
    uint32_t now_us = world.t_us;
    while (end_us - now_us > 4000u) {
        now_us += 4000u;
        while (missing_by(now_us, false)) {
            take_row();
        }
    }
    pass_time(missing * world.period_us);
}

static const char *about(uint8_t kind, unsigned missing)
{
    static char text[80];
    snprintf(text, sizeof text, "%s, %u Hz, %u missing", filter_listed_name((filter_kind_t)kind), world.rate_dhz / 10u,
             missing);
    return text;
}

#define FOR_EACH_FILTER(kind) for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++)

static bool rate_is_a_difference(uint8_t kind)
{
    return law_facts((filter_kind_t)kind).rate_is_a_difference;
}

/* At rest. Those whose rate is a difference jump as far from any row to the next: a gap must not add to it. */
TEST(test_no_jump_at_rest_when_data_return)
{
    static const uint16_t rates_dhz[] = { 125, 1000, 4000, 8000 };
    static const unsigned gaps_ms[] = { 20, 40, 90, 120, 300, 1000, 5000, 60000 };
    FOR_EACH_FILTER(kind)
    {
        for (int i = 0; i < 4 * 8 * 6; i++) {
            begin(kind, rates_dhz[i % 4], 0.0);
            samples(20u + world.rate_dhz / 10u);
            world.jump_cdeg = 0;
            samples(world.rate_dhz / 10u);
            int limit_cdeg = rate_is_a_difference(kind) && world.jump_cdeg > 50 ? 2 * world.jump_cdeg : 100;
            int before_cdeg = world.row.roll_cdeg;
            unsigned missing = gaps_ms[i / 4 % 8] * 1000u / world.period_us;
            gap(missing);
            TEST_ASSERT_INT_WITHIN_MESSAGE(100, before_cdeg, world.row.roll_cdeg, about(kind, missing));
            world.jump_cdeg = 0;
            samples(world.rate_dhz / 10u);
            TEST_ASSERT_LESS_OR_EQUAL_INT_MESSAGE(limit_cdeg, world.jump_cdeg, about(kind, missing));
        }
    }
}

/* 30 degrees a second through gaps: how many samples of the ten behind one are refused, and how far the roll is off. */
static void assert_rejoins(uint8_t kind, uint16_t rate_dhz, unsigned missing)
{
    begin(kind, rate_dhz, 30.0);
    world.roll_deg = -60.0;
    samples(rate_dhz / 5u);
    gap(missing);
    bool held = missing * world.period_us > 100000u;
    unsigned gated = 0;
    for (unsigned k = 0; k < rate_dhz / 10u; k++) {
        samples(1);
        int error_cdeg = abs(world.row.roll_cdeg - (int)lround(world.roll_deg * 100.0));
        gated += (world.row.flags & ROW_GATED) != 0 && k < 10u;
        bool began = (world.row.flags & ROW_REACQUIRED) != 0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(held && k == 1u, began, about(kind, missing));
        if (k >= 1u) {
            TEST_ASSERT_LESS_OR_EQUAL_INT_MESSAGE(300, error_cdeg, about(kind, missing));
        }
    }
    unsigned own = (filter_listed((filter_kind_t)kind)->traits & LAW_FIRST_SAMPLE) != 0
                       ? 2u
                       : 0u; /* as published: a gate of 2 sigma refuses 1 in 20 anyway */
    TEST_ASSERT_LESS_OR_EQUAL_UINT_MESSAGE((held ? 1u : 0u) + own, gated, about(kind, missing));
}

TEST(test_gaps_on_a_ramp_are_rejoined_within_the_gate)
{
    FOR_EACH_FILTER(kind)
    {
        for (int run = 0; run < 5; run++) {
            assert_rejoins(kind, 1000, 3);
            assert_rejoins(kind, 1000, 30);
            assert_rejoins(kind, 1000, 300);
            assert_rejoins(kind, 8000, 30);
            assert_rejoins(kind, 8000, 300);
        }
    }
}

/* Of the step of sample n, by the middle of it: 1, 1/2, 1/4, 1/8, then nothing. */
static double part_of_step(unsigned n)
{
    unsigned quarters = (2u * n - 1u) * (world.period_us / 2u) / (1000u * LIMIT_DAMP_MS);
    return quarters < LIMIT_HOLD_MS / LIMIT_DAMP_MS ? 1.0 / (1u << quarters) : 0.0;
}

/* 60 degrees a second, no noise. At 100 Hz that is within the noise of a rate that is a difference. */
TEST(test_rate_is_halved_every_25_ms_and_then_held)
{
    FOR_EACH_FILTER(kind)
    {
        begin(kind, rate_is_a_difference(kind) ? 250 : 1000, 60.0);
        world.quiet = true;
        world.roll_deg = -120.0;
        samples(world.rate_dhz / 5u);
        int before_cdeg = world.row.roll_cdeg;
        double moved_cdeg = 0.0;
        for (unsigned n = 1; n <= 600000u / world.period_us; n++) {
            TEST_ASSERT_TRUE(missing_by(world.t_us + n * world.period_us + world.period_us / 2u, false));
            take_row();
            moved_cdeg += 6000e-6 * world.period_us * part_of_step(n);
            int row_cdeg = world.row.roll_cdeg - before_cdeg;
            TEST_ASSERT_INT_WITHIN_MESSAGE(25, (int)lround(moved_cdeg), row_cdeg, about(kind, n));
        }
        world.quiet = false;
    }
}

/* Each has its row: at the time that it would have had, flag 2, from the third on 16; after a second ten a second. */
TEST(test_rows_of_missing_samples)
{
    begin(0, 4000, 0.0);
    samples(400);
    uint32_t last_us = world.t_us;
    const unsigned last = LIMIT_LONG_S * 400u + 1u; /* of those a period apart */
    for (unsigned n = 1; n <= 460u; n++) {
        uint32_t due_us = n <= last ? n * 2500u : last * 2500u + (n - last) * 1000u * LIMIT_LONG_STEP_MS;
        TEST_ASSERT_FALSE(missing_by(last_us + due_us + 1249u, false));
        TEST_ASSERT_TRUE(missing_by(last_us + due_us + 1250u, false));
        take_row();
        TEST_ASSERT_EQUAL_UINT32(last_us + due_us, world.row.t_us);
        TEST_ASSERT_EQUAL_HEX16(n < LIMIT_MISSING_FAULT ? ROW_COASTED : ROW_COASTED | ROW_FAULT, world.row.flags);
        TEST_ASSERT_EQUAL_INT(n >= last, silence_long());
    }
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_LOST));
    pass_time(7000000u + 2500u); /* counted when it is known how many they were */
    sample();
    TEST_ASSERT_EQUAL_UINT32(2800, counted(COUNT_LOST));
}

/* Whether main looked in time or comes when the sample is there: the same rows, up to the hold. */
TEST(test_rows_do_not_depend_on_when_main_looks)
{
    row_t rows[2];
    FOR_EACH_FILTER(kind)
    {
        for (int turn = 0; turn < 2; turn++) {
            random_seed(&world.random, SEED);
            begin(kind, 1000, 30.0);
            samples(300);
            if (turn == 0) {
                gap(9);
            } else {
                pass_time(9u * world.period_us);
            }
            world.rows = 0;
            samples(1);
            TEST_ASSERT_EQUAL_UINT(turn == 0 ? 1 : 10, world.rows);
            rows[turn] = world.row;
        }
        TEST_ASSERT_EQUAL_MEMORY(&rows[0], &rows[1], sizeof rows[0]);
    }
}

/* Behind 120 ms the rows that nobody wrote are left out, but for the one that begins the hold. */
TEST(test_a_sample_behind_a_long_gap_is_not_kept_waiting)
{
    begin(0, 1000, 0.0);
    samples(300);
    pass_time(5000000u);
    world.rows = 0;
    samples(1);
    TEST_ASSERT_EQUAL_UINT(12, world.rows);
    TEST_ASSERT_EQUAL_HEX16(0, world.row.flags);
}

TEST(test_samples_older_than_the_newest_row_are_dropped)
{
    begin(0, 1000, 0.0);
    samples(100);
    uint32_t last_us = world.t_us;
    TEST_ASSERT_FALSE(coast_sample(last_us, world.period_us));
    TEST_ASSERT_TRUE(missing_by(last_us + 15000u, false));
    TEST_ASSERT_FALSE(coast_sample(last_us + 10000u, world.period_us));
    TEST_ASSERT_EQUAL_UINT32(2, counted(COUNT_LATE));
    TEST_ASSERT_TRUE(coast_sample(last_us + 10001u, world.period_us));
    TEST_ASSERT_EQUAL_UINT32(0, counted(COUNT_LOST)); /* late, not lost */
    coast_wait(last_us);                              /* stopped for an hour: any time may come */
    TEST_ASSERT_TRUE(coast_sample(last_us - 1u, world.period_us));
    TEST_ASSERT_EQUAL_UINT32(2, counted(COUNT_LATE));
}

/* Rows without samples begin 0.1 s after the start, but not where the first sample is just being read. */
TEST(test_no_row_in_the_place_of_a_first_sample_on_its_way)
{
    begin(0, 1000, 0.0);
    uint32_t late_us = world.t_us + 100001u;
    TEST_ASSERT_FALSE(missing_by(late_us, true));
    TEST_ASSERT_FALSE(missing_by(late_us, true));
    TEST_ASSERT_TRUE(missing_by(late_us, false));
}

/* One bad reading is all that comes back from a hold: refused, and the filter goes on from what was held. */
TEST(test_a_bad_reading_behind_a_hold_begins_nothing)
{
    FOR_EACH_FILTER(kind)
    {
        begin(kind, 1000, 0.0);
        samples(300);
        gap(100);
        int held_cdeg = world.row.roll_cdeg;
        world.roll_deg = 80.0;
        samples(1);
        TEST_ASSERT_EQUAL_HEX16(ROW_GATED, world.row.flags & (ROW_GATED | ROW_REACQUIRED));
        TEST_ASSERT_EQUAL_INT(held_cdeg, world.row.roll_cdeg);
        world.roll_deg = ROLL_CDEG / 100.0;
        samples(1);
        if (kind == (uint8_t)DEFAULT_KIND) { /* what others hold may be off by the noise of their rate */
            TEST_ASSERT_EQUAL_HEX16(0, world.row.flags & (ROW_REACQUIRED | ROW_WARMING_UP));
        }
    }
}

static void sample_of_y(int16_t y_lsb)
{
    pass_time(world.period_us);
    adxl345_sample_t s = { .t_us = world.t_us, .lsb = { 0, y_lsb, 241 } }; /* z as it was */
    TEST_ASSERT_TRUE(coast_sample(s.t_us, world.period_us));
    pipeline_sample(&s);
    take_row();
}

/* 30 seconds at the rail of 16 g, with a hold in the midst: the rows say so, and no filter begins anew on one. */
TEST(test_no_filter_begins_anew_at_the_rail)
{
    FOR_EACH_FILTER(kind)
    {
        begin(kind, 1000, 0.0);
        samples(300);
        for (unsigned k = 0; k < 3000u; k++) {
            if (k == 1500u) {
                gap(30);
            }
            sample_of_y(k < 4u ? 4094 : 4095);
            TEST_ASSERT_EQUAL_HEX16_MESSAGE(k < 4u ? 0 : ROW_CLIPPED, world.row.flags & (ROW_CLIPPED | ROW_REACQUIRED),
                                            about(kind, k));
        }
    }
}
