/* adaptive against its double twin step by step, and in theory. */
#include "adaptive.h"
#include "reference/adaptive.h"
#include "support/random.h"
#include "support/roll.h"
#include "support/test_law.h"

#include <math.h>
#include <stdio.h>

enum { SAMPLES = 20000, SEED = 9417 };
static uint32_t random_state;
void setUp(void)
{
    random_state = SEED;
}
static reference_adaptive_value_t value_of(const filter_t *f)
{
    const filter_adaptive_t *a = &f->own.adaptive;
    double towards = f->negative ? -1.0 : 1.0; /* the mean innovation's sign goes by the last one */
    return (reference_adaptive_value_t){ f->x_lsb_q16 / 65536.0, f->rate_lsb / 16777216.0,
                                         towards * a->mean_lsb_q24 / 16777216.0, a->k_uq32 / 4294967296.0,
                                         a->scatter_lsb_uq24 / 16777216.0 };
}

/* Of a filter behind its start. */
static reference_adaptive_t twin_of(const filter_t *f)
{
    reference_adaptive_t r = { .sigmas = f->own.adaptive.gate_sigma_q8 / 256.0,
                               .manoeuvre = f->own.adaptive.manoeuvre_uq16 / 65536.0,
                               .slow = f->own.adaptive.slow_uq16 / 65536.0,
                               .fast = f->own.adaptive.fast_uq16 / 65536.0,
                               .share = f->own.adaptive.share_uq16 / 65536.0,
                               .rate_max = f->rate_max_lsb / 16777216.0,
                               .confirm = f->own.adaptive.confirm,
                               .guarded = f->own.adaptive.guarded,
                               .identify = f->identifies };
    reference_adaptive_begin(&r, f->previous_lsb);
    return r;
}

static void assert_within(double bound, double expected, double got, const char *what)
{
    if (!(fabs(got - expected) <= bound + 1e-9)) {
        printf("%s: %.9f, reference %.9f, bound %.2g\n", what, got, expected, bound);
    }
    TEST_ASSERT_TRUE_MESSAGE(fabs(got - expected) <= bound + 1e-9, what);
}

static void assert_step(const filter_t *f, const reference_adaptive_t *r, const reference_adaptive_value_t *bound)
{
    reference_adaptive_value_t got = value_of(f);
    assert_within(bound->x, r->now.x, got.x, "x");
    assert_within(bound->rate, r->now.rate, got.rate, "rate");
    assert_within(bound->mean, r->now.mean, got.mean, "mean innovation");
    assert_within(bound->k, r->now.k, got.k, "k");
    assert_within(bound->scatter, r->now.scatter, got.scatter, "scatter");
    TEST_ASSERT_EQUAL_INT(r->verdict, f->own.adaptive.verdict);
}

/* At rest, and every 80 samples 20 of a turn there or back; bad reads, bursts to 20, jumps that stay; or anything. */
typedef struct {
    double sigma, level, outliers;
    int burst;
    bool wild;
} signal_t;

/* Of twelve uniform ones: normal enough. */
static double noise_of_one(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += roll_uniform(&random_state);
    }
    return sum;
}

static int16_t next_sample(signal_t *s, int k, double rate_lsb)
{
    if (s->wild) {
        return (int16_t)(random32(&random_state) >> 16);
    }
    if ((k / 20) % 8 == 1 || (k / 20) % 8 == 5) {
        s->level += (k / 20) % 8 == 5 ? -rate_lsb : rate_lsb;
    }
    if (random32_below(&random_state, 900) == 0) {
        s->level = random32_below(&random_state, 4000) - 2000.0;
    }
    if (s->burst > 0) {
        s->burst--;
    } else if (roll_uniform(&random_state) < 0.003) {
        s->burst = (int)random32_below(&random_state, 20);
    }
    double sum = noise_of_one();
    bool outlier = roll_uniform(&random_state) < s->outliers;
    double lsb = s->level + (outlier ? 20.0 : 1.0) * s->sigma * sum + (s->burst > 0 ? 700.0 : 0.0);
    return (int16_t)lrint(fmin(32767.0, fmax(-32768.0, lsb)));
}

typedef struct {
    const char *name;
    uint16_t rate_dhz, guard_q8, identify;
    double sigma, outliers;
    bool wild;
} case_t;

/* A decision that the bound leaves open tells the twin what was decided. */
static void tell(reference_adaptive_t *r, const filter_t *f)
{
    r->verdict = (reference_verdict_t)f->own.adaptive.verdict;
    r->run = f->own.adaptive.run;
    r->strays = f->own.adaptive.strays;
    r->side = f->negative ? -1 : 1;
}

/* One sample into both. False: a decision hangs on less than is rounded, nothing was compared. */
static bool compare_step(filter_t *f, reference_adaptive_t *r, int16_t z)
{
    reference_adaptive_value_t bound;
    r->now = value_of(f);
    (void)filter_update(f, z);
    if (!reference_adaptive_step(r, fmin(4095.0, fmax(-4096.0, z)), &bound)) {
        tell(r, f);
        return false;
    }
    assert_step(f, r, &bound);
    return true;
}

/* Decisions that the bound leaves open are counted. */
static void run_case(const case_t *c, int verdicts[5])
{
    filter_config_t config = filter_defaults(&filter_law_adaptive, c->rate_dhz);
    config.value[ADAPTIVE_GUARD_SIGMA_Q8] = c->guard_q8;
    config.value[ADAPTIVE_IDENTIFY] = c->identify;
    config.value[ADAPTIVE_R_LSB2_Q8] = (int32_t)lrint(fmin(256000.0, c->sigma * c->sigma * 256.0));
    filter_t f = made(&filter_law_adaptive, &config);
    signal_t signal = { c->sigma, 0.0, c->outliers, 0, c->wild };
    for (int k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        (void)filter_update(&f, next_sample(&signal, k, 7000.0 / c->rate_dhz));
    }
    reference_adaptive_t r = twin_of(&f);
    int open = 0;
    for (int k = FILTER_WARM_UP_SAMPLES; k < SAMPLES; k++) {
        if (k > 100 && random32_below(&random_state, 200) == 0) {
            r.now = value_of(&f);
            (void)coast(&f);
            reference_adaptive_coast(&r);
            assert_within(1.0 / 65536.0, r.now.x, f.x_lsb_q16 / 65536.0, "coasted x");
        } else if (compare_step(&f, &r, next_sample(&signal, k, 7000.0 / c->rate_dhz))) {
            verdicts[f.own.adaptive.verdict]++;
        } else {
            open++;
        }
    }
    printf("%s: %d of %d steps hang on less than is rounded\n", c->name, open, SAMPLES);
    TEST_ASSERT_TRUE(open < SAMPLES / 20);
}

TEST(every_step_is_that_of_the_reference)
{
    static const case_t cases[] = {
        { "10 Hz", 100, 768, 1, 12.0, 0.05, false },
        { "100 Hz", 1000, 1152, 1, 3.0, 0.02, false },
        { "800 Hz", 8000, 1152, 1, 6.0, 0.01, false },
        { "100 Hz, R given", 1000, 1152, 0, 4.0, 0.02, false },
        { "10 Hz, unguarded", 100, 0, 1, 12.0, 0.05, false },
        { "100 Hz, unguarded, R given", 1000, 0, 0, 5.0, 0.02, false },
        { "100 Hz, any numbers", 1000, 256, 1, 90.0, 0.0, true },
        { "50 Hz, 40 LSB", 500, 512, 1, 40.0, 0.05, false },
    };
    int verdicts[5] = { 0, 0, 0, 0, 0 };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        run_case(&cases[i], verdicts);
    }
    for (int i = 0; i < 5; i++) {
        printf("verdict %d: %d\n", i, verdicts[i]);
        TEST_ASSERT_TRUE(verdicts[i] > 10); /* motion beyond the gate is within an eighth of ratemax: rare */
    }
}

/*
 * Starts with a bad read among the first samples, guarded or not: the scatter's opening, term by term. The R that they
 * begin with is 80 times too small.
 */
TEST(a_start_with_a_bad_read_is_that_of_the_reference)
{
    int compared = 0;
    for (int start = 0; start < 2000; start++) {
        filter_config_t config = filter_defaults(&filter_law_adaptive, 100);
        config.value[ADAPTIVE_GUARD_SIGMA_Q8] = (start % 2 == 0) ? config.value[ADAPTIVE_GUARD_SIGMA_Q8] : 0;
        filter_t f = made(&filter_law_adaptive, &config);
        reference_adaptive_t r;
        for (int k = 0; k < 60; k++) {
            int16_t z = (k == start % 13) ? 4095 : (int16_t)lrint(200.0 + 5.0 * noise_of_one());
            if (k < FILTER_WARM_UP_SAMPLES) {
                (void)filter_update(&f, z);
                r = twin_of(&f);
            } else {
                compared += compare_step(&f, &r, z);
            }
        }
    }
    TEST_ASSERT_TRUE(compared > 110000 - 110000 / 20);
}

/* k = 2 / memory, share 0.4 k, threshold 2.9 sqrt(share / 2) but at most 0.845; the factor is rounded to 2^-8. */
TEST(parameters_are_those_of_the_equations)
{
    static const uint16_t rates_dhz[] = { 100, 250, 500, 1000, 4000, 8000 };
    for (int i = 0; i < 6; i++) {
        filter_config_t config = filter_defaults(&filter_law_adaptive, rates_dhz[i]);
        filter_t f = made(&filter_law_adaptive, &config);
        double fast = fmin(0.6, 20000.0 / ((double)config.value[ADAPTIVE_FAST_MS] * rates_dhz[i]));
        double slow = 20000.0 / ((double)config.value[ADAPTIVE_SLOW_MS] * rates_dhz[i]);
        double share = 0.4 * fast;
        assert_within(2e-5, fast, f.own.adaptive.fast_uq16 / 65536.0, "fast");
        assert_within(2e-5, slow, f.own.adaptive.slow_uq16 / 65536.0, "slow");
        assert_within(4e-5, share, f.own.adaptive.share_uq16 / 65536.0, "share");
        double error = 2.9 * 4e-5 / sqrt(2.0 * share) + 0.004 * sqrt(share) + 2e-5;
        double threshold = fmin(0.845, 2.9 * sqrt(share / 2.0));
        assert_within(error, threshold, f.own.adaptive.manoeuvre_uq16 / 65536.0, "threshold");
    }
}

/* Fading memory: noise gain by the Lyapunov equation, by the impulse response, and in closed form. */
TEST(fading_memory_has_its_closed_forms)
{
    for (int i = 1; i < 60; i++) {
        double k = 0.01 * i;
        double closed = k * (10.0 - 14.0 * k + 5.0 * k * k) / pow(2.0 - k, 3.0);
        double sum = 0.0;
        for (int n = 0; n < 3000; n++) {
            double h = reference_fading_impulse(k, n);
            sum += h * h;
            if (n < 200) { /* alpha = 2 k - k^2, beta = k^2 is least squares with weights (1 - k)^n */
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, reference_fading_line_weight(1.0 - k, n), h);
            }
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, closed, reference_fading_noise_gain(k));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, closed, sum);
        double alpha = 2.0 * k - k * k;
        double prediction = (closed - alpha * alpha) / ((1.0 - alpha) * (1.0 - alpha));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, prediction, reference_fading_prediction_gain(k));
        TEST_ASSERT_DOUBLE_WITHIN(0.06, 1.0, (1.0 + k) / sqrt(1.0 + prediction)); /* as adaptive.h says */
    }
}

/* Mean of the scatter over the noise's sigma at rest; memories in ms at 100 Hz, bad: share of samples 60 sigmas off. */
static double settled_scatter(int32_t slow_ms, int32_t fast_ms, double bad, int32_t guard_q8, filter_t *f)
{
    const double sigma = 20.0;
    const int from = 2000;
    filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
    config.value[ADAPTIVE_GUARD_SIGMA_Q8] = guard_q8;
    config.value[ADAPTIVE_SLOW_MS] = slow_ms;
    config.value[ADAPTIVE_FAST_MS] = fast_ms;
    config.value[ADAPTIVE_RATE_MAX_LSB_S] = 12700; /* six sigmas a sample: out of the way */
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(f, &filter_law_adaptive, &config));
    test_random_t random;
    random_seed(&random, SEED);
    double sum = 0.0;
    for (int k = 0; k < from + 10 * SAMPLES; k++) {
        double off = (random_uniform(&random) < bad) ? 60.0 : 0.0;
        (void)filter_update(f, as_sample(sigma * (off + random_normal(&random))));
        sum += (k < from) ? 0.0 : f->own.adaptive.scatter_lsb_uq24 / 16777216.0 / sigma;
    }
    return sum / (10.0 * SAMPLES);
}

/*
 * With a memory that is held: the fixed point, but for 0.7 %, which the scatter's own fluctuation takes (0.15 sigma:
 * half of its variance times the curvature 0.55 over 1 - slope, 0.87), and 0.8 % for chance (three standard errors).
 * With one that changes it lies between those of the slowest and the shortest.
 */
TEST(the_scatter_settles_where_its_terms_say)
{
    static const int32_t memories_ms[] = { 33, 100, 200, 500 };
    filter_t f;
    for (int i = 0; i < 12; i++) {
        int32_t ms = memories_ms[i % 4];
        bool guarded = i < 8;
        double bad = (i / 4 == 1) ? 0.01 : 0.0;
        double got = settled_scatter(ms, ms, bad, guarded ? 8 * 256 : 0, &f);
        double expected = reference_adaptive_scatter(f.own.adaptive.slow_uq16 / 65536.0,
                                                     f.own.adaptive.share_uq16 / 65536.0, bad, guarded);
        printf("%d ms, guard %d, %.0f %% bad: %.4f sigma, %.4f expected\n", (int)ms, guarded, 100.0 * bad, got,
               expected);
        assert_within(0.008 * expected, (guarded ? 0.993 : 1.0) * expected, got, "settled scatter");
    }
    for (int guarded = 0; guarded < 2; guarded++) {
        double got = settled_scatter(500, 100, 0.0, guarded * 8 * 256, &f);
        double share = f.own.adaptive.share_uq16 / 65536.0;
        double slowest = reference_adaptive_scatter(f.own.adaptive.slow_uq16 / 65536.0, share, 0.0, guarded != 0);
        double shortest = reference_adaptive_scatter(f.own.adaptive.fast_uq16 / 65536.0, share, 0.0, guarded != 0);
        printf("memories of 100 to 500 ms: %.4f sigma, %.4f to %.4f expected\n", got, shortest, slowest);
        double centre = (guarded != 0) ? 0.993 : 1.0;
        TEST_ASSERT_TRUE(got >= (centre - 0.008) * shortest && got <= (centre + 0.008) * slowest);
    }
}

static void assert_probed_variance(const filter_t *f, double r_lsb2)
{
    filter_probe_t probe = probe_of(f);
    double expected = r_lsb2 * reference_fading_noise_gain(f->own.adaptive.k_uq32 / 4294967296.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.002 * expected + 1.0 / 256.0, expected, probe.p_lsb2_q8 / 256.0);
}

/*
 * The probe's variance is R times that noise gain, at every memory; identified, R is the scatter's square (8.8 bits).
 */
TEST(variance_of_the_probe_is_the_closed_form)
{
    for (int identify = 0; identify < 2; identify++) {
        filter_config_t config = filter_defaults(&filter_law_adaptive, 1000);
        config.value[ADAPTIVE_IDENTIFY] = identify;
        config.value[ADAPTIVE_R_LSB2_Q8] = 100u * 256u;
        filter_t f = made(&filter_law_adaptive, &config);
        for (int k = 0; k < 100; k++) {
            (void)filter_update(&f, (identify != 0) ? (int16_t)lrint(20.0 * noise_of_one()) : 0);
            if (k >= FILTER_WARM_UP_SAMPLES) {
                double sigma = floor(f.own.adaptive.scatter_lsb_uq24 / 65536.0) / 256.0;
                assert_probed_variance(&f, (identify != 0) ? sigma * sigma : 100.0);
            }
        }
        TEST_ASSERT_EQUAL_INT(identify, f.own.adaptive.scatter_lsb_uq24 > 12UL << 24);
    }
}
