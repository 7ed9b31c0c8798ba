/*
 * Lock-out: motion of 29 degrees at 0.5 Hz while 15 % of the samples are outliers in runs of 2 to 8, each drawn anew or
 * the first one held. Off the motion while they last are only laws whose facts say so; when they end every law is back
 * on it within four seconds, but for what is "as published", which is seen to stay away.
 *
 *   test_filter_bursts [TRIALS of each law; 1,000]
 */
#include "support/chain.h"
#include "support/filters.h"
#include "support/random.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { RATE_DHZ = 1000, RATE_HZ = 100, BAD_S = 8, BACK_S = 4, LOOK_S = 1 };

/* 256 LSB a g; sigma is that of the sensor at 100 Hz, an outlier has 20 times it. */
static const double swing_lsb = 256.0 * 0.4848, swing_hz = 0.5, sigma_lsb = 2.0, times = 20.0, share = 0.15;

/* On the motion: at 0.5 Hz every law that follows it at all lags by less than 0.1 s, 39 LSB at its fastest. */
static const double away_lsb = 40.0;

static int trials = 1000;

typedef struct {
    test_random_t random;
    unsigned left; /* of the run of outliers */
    bool held;
    double off_lsb;
} bursts_t;

static double bad_off_lsb(bursts_t *b)
{
    double starts = share / (1.0 - share) / 5.0; /* runs have five samples in the mean */
    if (b->left == 0U && random_uniform(&b->random) < starts) {
        b->left = 2U + (unsigned)(7.0 * random_uniform(&b->random));
        b->held = random_uniform(&b->random) < 0.5;
        b->off_lsb = times * sigma_lsb * random_normal(&b->random);
    }
    if (b->left == 0U) {
        return 0.0;
    }
    b->left--;
    return b->held ? b->off_lsb : times * sigma_lsb * random_normal(&b->random);
}

/* Mean distance from the motion in the last second of the outliers, and in the last of all, LSB. */
typedef struct {
    double during_lsb, after_lsb;
} distance_t;

static distance_t trial_of(filter_kind_t kind, unsigned trial)
{
    bursts_t bursts = { .left = 0 };
    random_seed(&bursts.random, 7000U + trial);
    chain_t chain;
    TEST_ASSERT_TRUE(chain_begin(&chain, kind, RATE_DHZ, 16, 1));
    double phase = random_uniform(&bursts.random);
    distance_t mean = { 0.0, 0.0 };
    for (int k = 0; k < RATE_HZ * (BAD_S + BACK_S + LOOK_S); k++) {
        double t_s = (double)k / RATE_HZ;
        double truth_lsb = swing_lsb * sin(6.283185307179586 * (swing_hz * t_s + phase));
        double off_lsb = (t_s < BAD_S && k >= FILTER_WARM_UP_SAMPLES) ? bad_off_lsb(&bursts) : 0.0;
        double z_lsb = truth_lsb + sigma_lsb * random_normal(&bursts.random) + off_lsb;
        uint64_t t_us = (uint64_t)k * (1000000U / RATE_HZ);
        double x_lsb = chain_sample(&chain, t_us, (int16_t)lrint(z_lsb)) / 65536.0;
        double share_lsb = fabs(x_lsb - truth_lsb) / (RATE_HZ * LOOK_S);
        mean.during_lsb += (t_s >= BAD_S - LOOK_S && t_s < BAD_S) ? share_lsb : 0.0;
        mean.after_lsb += (t_s >= BAD_S + BACK_S) ? share_lsb : 0.0;
    }
    return mean;
}

TEST(every_law_is_back_but_that_as_published)
{
    bool good = true;
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        int lost = 0;
        int away = 0;
        for (int trial = 0; trial < trials; trial++) {
            distance_t distance = trial_of((filter_kind_t)kind, (unsigned)trial);
            lost += distance.during_lsb > away_lsb;
            away += distance.after_lsb > away_lsb;
        }
        law_facts_t facts = law_facts((filter_kind_t)kind);
        printf("%-10s of %d trials %d off the motion among outliers, %d not back after them%s\n",
               filter_listed_name((filter_kind_t)kind), trials, lost, away, facts.locks_out ? ", as published" : "");
        good = good && (away != 0) == facts.locks_out && (lost != 0) == facts.loses_motion;
    }
    TEST_ASSERT_TRUE(good);
}

int main(int argc, char **argv)
{
    if (argc > 1) {
        trials = atoi(argv[1]);
    }
    return test_all();
}
