/* auto on the tilt streams that it is made for, beside the filters that it is to beat. */
#include "support/random.h"
#include "support/test_law.h"
#include "support/tilt_phases.h"

#include <math.h>
#include <stdio.h>

#define SEED 80004u

enum { FRESH_RUNS = 200, FRESH_SEED = 5001 };

/* The streams are what their header says: shares of missing samples and of outliers, noise, by kind. */
TEST(test_streams_are_as_described)
{
    double missing = 0.0;
    double wide = 0.0;
    double squares[PHASES] = { 0.0 };
    double counts[PHASES] = { 0.0 };
    for (unsigned run = 0; run < FRESH_RUNS; run++) {
        static tilt_run_t s;
        tilt_run_make(&s, FRESH_SEED + run);
        for (int i = 0; i < TILT_RUN_SAMPLES; i++) {
            double off = s.z_deg[i] - s.truth_deg[i];
            squares[s.phase[i]] += off * off;
            counts[s.phase[i]] += 1.0;
            missing += s.missing[i];
            wide += s.phase[i] == PHASE_BURST && fabs(off) > 5.0 * TILT_SIGMA_DEG;
            TEST_ASSERT_TRUE(fabs(s.truth_deg[i]) * TILT_LSB_PER_DEGREE < 4000.0);
        }
    }
    double each = 2.0 * FRESH_RUNS * TILT_PHASE_SAMPLES;
    for (uint8_t p = 0; p < PHASES; p++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.5, each, counts[p]);
    }
    /* a quarter and 15 of 120 that are not missing already */
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.25 + 0.75 * 15.0 / 120.0, missing / each);
    /* not hit: 0.88 times no run over it, 1 - 0.05 (1, 3/4, 1/2, 1/4 of the runs reach the 1st to 4th) */
    double hit = 1.0 - 0.88 * 0.95 * (1.0 - 0.0375) * (1.0 - 0.025) * (1.0 - 0.0125);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, hit * 0.8028, wide / each); /* P(|N(0, 20.02)| > 5) = 0.8028 */
    TEST_ASSERT_DOUBLE_WITHIN(0.01, TILT_SIGMA_DEG, sqrt(squares[PHASE_STILL] / counts[PHASE_STILL]));
    /* mean square of a factor of 3 to 6: 21 */
    TEST_ASSERT_DOUBLE_WITHIN(0.08, TILT_SIGMA_DEG * sqrt(21.0),
                              sqrt(squares[PHASE_VIBRATION] / counts[PHASE_VIBRATION]));
}

/* As shipped at 10 Hz; the others with the parameters that board_phases of make papers finds on other runs. */
TEST(test_errors_on_the_tilt_streams)
{
    filter_config_t of_auto = filter_defaults(&filter_law_auto, TILT_RATE_DHZ);
    of_auto.value[AUTO_R_LSB2_Q8] = (int32_t)TILT_R_LSB2_Q8;
    filter_config_t of_sprf = filter_defaults(&filter_law_sprf, TILT_RATE_DHZ);
    of_sprf.value[SPRF_R_LSB2_Q8] = (int32_t)TILT_R_LSB2_Q8;
    of_sprf.value[SPRF_Q_LSB2_S3] = 80;
    of_sprf.value[SPRF_GATE_SIGMA_Q8] = 7 * 256;
    filter_config_t of_pbf = filter_defaults(&filter_law_pbf, TILT_RATE_DHZ);
    of_pbf.value[MIXTURE_R_LSB2_Q8] = (int32_t)TILT_R_LSB2_Q8;
    of_pbf.value[MIXTURE_Q_LSB2_S3] = 700;
    of_pbf.value[MIXTURE_CLEAN_UQ16] = 32768;
    of_pbf.value[MIXTURE_RATIO_UQ8] = 10 * 256;
    const filter_t bank = made(&filter_law_auto, &of_auto);
    const filter_t sprf = made(&filter_law_sprf, &of_sprf);
    const filter_t pbf = made(&filter_law_pbf, &of_pbf);
    const tilt_guarded_t guarded = { 30.0, 8.0, 5 };
    const tilt_bayes_t bayes = { 1000.0, 0.15, 30.0 };
    static tilt_errors_t errors[5];
    static tilt_bank_t members;
    for (unsigned run = 0; run < FRESH_RUNS; run++) {
        static tilt_run_t stream;
        tilt_run_make(&stream, FRESH_SEED + run);
        tilt_judge(&bank, &stream, &errors[0], &members);
        tilt_judge(&sprf, &stream, &errors[1], NULL);
        tilt_judge(&pbf, &stream, &errors[2], NULL);
        tilt_judge_guarded(&guarded, &stream, &errors[3]);
        tilt_judge_bayes(&bayes, &stream, &errors[4]);
    }
    double all = tilt_rms_of_all(&errors[0]);
    printf("rms degree: auto %.3f, sprf %.3f, pbf %.3f, in double %.3f, %.3f\n", all, tilt_rms_of_all(&errors[1]),
           tilt_rms_of_all(&errors[2]), tilt_rms_of_all(&errors[3]), tilt_rms_of_all(&errors[4]));
    TEST_ASSERT_TRUE(all <= 0.87 * tilt_rms_of_all(&errors[1]));
    TEST_ASSERT_TRUE(all <= 0.87 * tilt_rms_of_all(&errors[3]));
    TEST_ASSERT_TRUE(all <= 1.03 * tilt_rms_of_all(&errors[2]));
    TEST_ASSERT_TRUE(all <= 1.03 * tilt_rms_of_all(&errors[4]));
    static const uint8_t better_than_each[] = { PHASE_STILL, PHASE_RAMP, PHASE_SINE, PHASE_ACCELERATION };
    for (size_t p = 0; p < sizeof better_than_each; p++) {
        for (uint8_t m = 0; m < AUTO_MEMBERS; m++) {
            TEST_ASSERT_TRUE(tilt_rms(&errors[0], better_than_each[p]) <
                             tilt_rms(&members.members[m], better_than_each[p]));
        }
    }
    /* chosen as expected: motion that bends is the fast one's, noise beyond its sigma the slow one's */
    TEST_ASSERT_TRUE(members.phase_chosen[PHASE_SINE][AUTO_FAST] > 2.0 * members.phase_chosen[PHASE_SINE][AUTO_SLOW]);
    TEST_ASSERT_TRUE(members.phase_chosen[PHASE_ACCELERATION][AUTO_FAST] >
                     2.0 * members.phase_chosen[PHASE_ACCELERATION][AUTO_SLOW]);
    TEST_ASSERT_TRUE(members.phase_chosen[PHASE_VIBRATION][AUTO_SLOW] >
                     2.0 * members.phase_chosen[PHASE_VIBRATION][AUTO_FAST]);
}

/* 40 degrees at the streams' rate and noise: back within the five of the run and ten more, to a sigma of the noise. */
TEST(test_a_step_is_acquired_within_fifteen_samples)
{
    test_random_t random;
    random_seed(&random, SEED);
    double sigma_lsb = TILT_SIGMA_DEG * TILT_LSB_PER_DEGREE;
    for (int run = 0; run < 200; run++) {
        filter_config_t config = filter_defaults(&filter_law_auto, TILT_RATE_DHZ);
        config.value[AUTO_R_LSB2_Q8] = TILT_R_LSB2_Q8;
        filter_t f = made(&filter_law_auto, &config);
        for (int n = 0; n < 200; n++) {
            (void)filter_update(&f, as_sample(sigma_lsb * random_normal(&random)));
        }
        double step_lsb = 40.0 * TILT_LSB_PER_DEGREE;
        int32_t x = 0;
        for (int n = 0; n < 15; n++) {
            x = filter_update(&f, as_sample(step_lsb + sigma_lsb * random_normal(&random)));
        }
        TEST_ASSERT_DOUBLE_WITHIN(3.0 * sigma_lsb, step_lsb, x / 65536.0);
    }
}
