/*
 * adaptive among outliers and in noise alone: paper 002's Table 1, the README's stream, a jump among outliers, how
 * often noise shortens the memory and what of the slowest memory is left of the variance.
 */
#include "adaptive.h"
#include "kalman.h"
#include "stream.h"
#include "support/chain.h"
#include "support/random.h"
#include "support/roles.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>

enum { RUNS = 1500, SAMPLES = 400, FROM = 200, CLEAN = 5 };

/* Table 1 of paper 002 at 40.5 Hz, an LSB 0.02 degrees: R 0.0064 degree^2, q 0.0009 (degree/s)^2 a sample. */
static const double period_s = 0.0247, lsb_deg = 0.02, sigma_deg = 0.08, drive_deg_s = 0.03, times = 20.0;

/* Outliers: their share, and the probability that one follows another. */
typedef struct {
    double share, again;
} outliers_t;

static void begin_kalman(filter_t *f)
{
    const filter_law_t *law = filter_listed(plain_kind());
    filter_config_t config = filter_defaults(law, 405);
    config.value[KALMAN_R] = 16 * 256; /* the true one: (0.08 / 0.02)^2 LSB^2, 0.0009 / T / 0.02^2 LSB^2/s^3 */
    config.value[KALMAN_Q] = 91;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(f, law, &config));
}

/* K_ef: the Kalman filter's mean square error over that of adaptive, as shipped. */
static double efficiency(outliers_t outliers)
{
    double first = outliers.share;
    if (outliers.again > 0.0) {
        first = outliers.share * (1.0 - outliers.again) / (1.0 - outliers.share);
    }
    double square[2] = { 0.0, 0.0 };
    for (unsigned run = 0; run < RUNS; run++) {
        test_random_t random;
        random_seed(&random, 900 + run);
        filter_t kalman;
        begin_kalman(&kalman);
        chain_t chain;
        TEST_ASSERT_TRUE(chain_begin(&chain, FILTER_KIND_adaptive, 405, 16, 0));
        double angle_deg = 3.2;
        double rate_deg_s = 0.01;
        bool bad = false;
        for (int k = 0; k < SAMPLES; k++) {
            rate_deg_s += drive_deg_s * random_normal(&random);
            angle_deg += rate_deg_s * period_s;
            double p = (bad && outliers.again > 0.0) ? outliers.again : first;
            bad = random_uniform(&random) < p && k >= CLEAN;
            double y_deg = angle_deg + (bad ? times : 1.0) * sigma_deg * random_normal(&random);
            int16_t z = (int16_t)lrint(fmin(4094.0, fmax(-4095.0, y_deg / lsb_deg)));
            double one = filter_update(&kalman, z) / 65536.0 * lsb_deg - angle_deg;
            uint64_t t_us = (uint64_t)llround(1e6 * period_s * k);
            double other = chain_sample(&chain, t_us, z) / 65536.0 * lsb_deg - angle_deg;
            square[0] += (k >= FROM) ? one * one : 0.0;
            square[1] += (k >= FROM) ? other * other : 0.0;
        }
    }
    return square[0] / square[1];
}

TEST(table_1_is_stood)
{
    static const struct {
        const char *name;
        outliers_t outliers;
        double least;
    } cases[] = {
        { "15 % independent", { 0.15, 0.0 }, 18.0 },
        { "15 % in runs of five", { 0.15, 0.8 }, 1.0 },
        { "clean", { 0.0, 0.0 }, 0.75 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double k_ef = efficiency(cases[i].outliers);
        printf("%s: K_ef %.2f, at least %.2f\n", cases[i].name, k_ef, cases[i].least);
        TEST_ASSERT_TRUE(k_ef >= cases[i].least);
    }
}

static double roll_deg(chain_t chains[3], const stream_row_t *row)
{
    (void)chain_sample(&chains[0], row->t_us, row->lsb[0]);
    double y = chain_sample(&chains[1], row->t_us, row->lsb[1]) / 265.0;
    double z = chain_sample(&chains[2], row->t_us, row->lsb[2]) / 256.0;
    return atan2(y, z) * 57.295779513082321;
}

/* The picture that `make sim` draws: 0.32 degrees rms and 2.2 at most behind the first second. */
TEST(the_readmes_stream_is_stood)
{
    stream_t stream;
    TEST_ASSERT_TRUE(stream_load(&stream, "sim/streams/outliers-15pct.csv"));
    chain_t chains[3];
    for (int axis = 0; axis < 3; axis++) {
        TEST_ASSERT_TRUE(chain_begin(&chains[axis], FILTER_KIND_adaptive, 1000, 16, axis));
    }
    double sum = 0.0;
    double most = 0.0;
    for (size_t i = 0; i < stream.count; i++) {
        double error = roll_deg(chains, &stream.rows[i]) - stream.rows[i].truth_cdeg[0] / 100.0;
        sum += (i >= 100) ? error * error : 0.0;
        most = (i >= 100) ? fmax(most, fabs(error)) : most;
    }
    double rms = sqrt(sum / (double)(stream.count - 100));
    stream_free(&stream);
    printf("roll: %.3f degrees rms, %.2f at most\n", rms, most);
    TEST_ASSERT_TRUE(rms <= 0.32);
    TEST_ASSERT_TRUE(most <= 2.2);
}

/* White noise at rest, ten minutes: variance over that of the slowest memory, and how often it was shortened. */
static void at_rest(uint16_t rate_dhz, double sigma_lsb, double *variance, double *per_minute)
{
    filter_t f = made_default(&filter_law_adaptive, rate_dhz);
    test_random_t random;
    random_seed(&random, rate_dhz);
    long samples = 60L * rate_dhz;
    long counted = 0;
    long openings = 0;
    double sum = 0.0;
    bool open = true;
    for (long i = 0; i < samples; i++) {
        double x = filter_update(&f, (int16_t)lrint(30.3 + sigma_lsb * random_normal(&random))) / 65536.0 - 30.3;
        bool now = f.own.adaptive.k_uq32 >> 16 >= f.own.adaptive.fast_uq16;
        if (i >= 2L * rate_dhz) {
            sum += x * x;
            counted++;
            openings += now && !open;
        }
        open = now;
    }
    double k = f.own.adaptive.slow_uq16 / 65536.0;
    double slowest = (sigma_lsb * sigma_lsb + 1.0 / 12.0) * k * (10.0 - 14.0 * k + 5.0 * k * k) / pow(2.0 - k, 3.0);
    *variance = sum / (double)counted / slowest;
    *per_minute = 6.0 * (double)openings * rate_dhz / (double)counted;
}

TEST(noise_alone_seldom_shortens_the_memory)
{
    static const uint16_t rates_dhz[] = { 250, 500, 1000, 2000, 4000, 8000 };
    for (size_t i = 0; i < sizeof rates_dhz / sizeof rates_dhz[0]; i++) {
        double variance;
        double per_minute;
        at_rest(rates_dhz[i], 2.0 * sqrt(rates_dhz[i] / 1000.0), &variance, &per_minute);
        printf("%d Hz: %.3f of the slowest memory's variance, shortened %.1f times a minute\n", rates_dhz[i] / 10,
               variance, per_minute);
        TEST_ASSERT_TRUE(variance <= (rates_dhz[i] >= 1000 ? 1.15 : 1.3));
        TEST_ASSERT_TRUE(rates_dhz[i] != 1000 || per_minute <= 2.0);
    }
}

/* One bad sample among good ones is a stray; a second within 64 makes the gate half as wide, good ones undo it. */
TEST(strays_tighten_the_gate_and_good_samples_open_it)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    config.value[ADAPTIVE_IDENTIFY] = 0;
    filter_t f = made(&filter_law_adaptive, &config);
    feed(&f, 100, 300);
    uint32_t wide = f.own.adaptive.gate_lsb_uq16;
    for (int bad = 0; bad < 2; bad++) {
        (void)filter_update(&f, 900);
        TEST_ASSERT_EQUAL_UINT8(ADAPTIVE_UNUSED, f.own.adaptive.verdict);
        TEST_ASSERT_EQUAL_UINT32(wide, f.own.adaptive.gate_lsb_uq16);
        (void)filter_update(&f, 100);
    }
    TEST_ASSERT_EQUAL_UINT32(wide / 2U, f.own.adaptive.gate_lsb_uq16);
    (void)filter_missing(&f);
    for (int k = 0; k < 62; k++) { /* of 128 less 1 between them and 1 after, to 64 */
        (void)filter_update(&f, 100);
        TEST_ASSERT_EQUAL_UINT32(wide / 2U, f.own.adaptive.gate_lsb_uq16);
    }
    (void)filter_update(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(wide, f.own.adaptive.gate_lsb_uq16);
    (void)filter_update(&f, 900);
    filter_restart(&f);
    (void)filter_update(&f, 100);
    feed(&f, 100, 9);
    TEST_ASSERT_EQUAL_UINT8(0, f.own.adaptive.strays);
}

/* What is expected of an innovation stops at 256 LSB: 144 of noise and 128 of its mean would pass 16 bits. */
TEST(the_gate_does_not_wrap)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    config.value[ADAPTIVE_GUARD_SIGMA_Q8] = 4096;
    filter_t f = made(&filter_law_adaptive, &config);
    filter_reset(&f, 0);
    f.own.adaptive.scatter_lsb_uq24 = ADAPTIVE_SCATTER_MAX_UQ24;
    f.own.adaptive.k_uq32 = (uint32_t)TRACKER_K_MAX_UQ16 << 16;
    f.own.adaptive.mean_lsb_q24 = INT32_MAX;
    (void)filter_update(&f, 1);
    TEST_ASSERT_UINT32_WITHIN((uint32_t)16 << 16, (uint32_t)4096 << 16, f.own.adaptive.gate_lsb_uq16);
}

/* LSB that are shown 80 ms after a jump of 30 degrees, 132 LSB, at 100 Hz, in the mean of so many runs. */
static double followed_lsb(double share)
{
    const int runs = 500;
    const int at = 600;
    double mean_lsb = 0.0;
    for (int run = 0; run < runs; run++) {
        test_random_t random;
        random_seed(&random, 300 + (unsigned)run);
        chain_t chain;
        TEST_ASSERT_TRUE(chain_begin(&chain, FILTER_KIND_adaptive, 1000, 16, 1));
        double x_lsb = 0.0;
        for (int k = 0; k <= at + 8; k++) {
            double sigma = (random_uniform(&random) < share) ? 40.0 : 2.0;
            double z = (k >= at ? 132.0 : 0.0) + sigma * random_normal(&random);
            x_lsb = chain_sample(&chain, (uint64_t)k * 10000U, (int16_t)lrint(z)) / 65536.0;
        }
        mean_lsb += x_lsb / runs;
    }
    return mean_lsb;
}

/* Until it is believed, after 120 ms, the estimate follows as far among 15 % outliers as without them. */
TEST(a_jump_among_outliers_is_not_late)
{
    double clean_lsb = followed_lsb(0.0);
    double among_lsb = followed_lsb(0.15);
    printf("80 ms after a jump of 132 LSB: %.1f LSB, among outliers %.1f\n", clean_lsb, among_lsb);
    TEST_ASSERT_TRUE(among_lsb >= clean_lsb);
}
