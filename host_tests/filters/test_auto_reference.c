/* auto: its members against the linear filter in double, what follows from its equations. */
#include "support/auto.h"
#include "support/random.h"
#include "support/test_law.h"

#include <math.h>

#define SEED 80004u

static const double memories[AUTO_MEMBERS] = { 50.0, 20.0, 8.0 };

TEST(test_memories_are_those_of_the_configuration)
{
    filter_t f = made_at_rest(0);
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1.0 / 65536.0, 2.0 / memories[i], f.own.bank.members[i].k_uq16 / 65536.0);
    }
    filter_config_t config = filter_defaults(&filter_law_auto, 40000); /* 4 kHz: 2000 samples are limited to 512 */
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_auto, &config));
    TEST_ASSERT_EQUAL_UINT16(65536 * 2 / 512, f.own.bank.final_k_uq16[AUTO_SLOW]);
    config.value[AUTO_FAST_MS] = 1; /* 4 samples: 2 / 4; 3 samples of 3 kHz: 0.6 */
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_auto, &config));
    TEST_ASSERT_EQUAL_UINT16(32768, f.own.bank.final_k_uq16[AUTO_FAST]);
    config.rate_dhz = 30000;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&f, &filter_law_auto, &config));
    TEST_ASSERT_EQUAL_UINT16(39321.6 + 0.5, f.own.bank.final_k_uq16[AUTO_FAST]);
}

typedef struct {
    double x, v;
} line_t;

static void step_line(line_t *s, double k, double z)
{
    s->x += s->v;
    double u = z - s->x;
    s->x += (2.0 * k - k * k) * u;
    s->v += k * k * u;
}

/* What an error of dx in each step of x and of dv in each of v can sum up to. */
static double response_bound(double k, double dx, double dv)
{
    line_t to_x = { 1.0, 0.0 };
    line_t to_v = { 0.0, 1.0 };
    double sum = 0.0;
    for (int i = 0; i < 5000; i++) {
        sum += fabs(to_x.x) * dx + fabs(to_v.x) * dv;
        step_line(&to_x, k, 0.0);
        step_line(&to_v, k, 0.0);
    }
    return sum;
}

/*
 * Per step: the innovation cut to 2^-8 LSB times the gain, products rounded to 2^-17, the gains cut to 2^-16 and 2^-24
 * times an innovation of at most 5 sigmas.
 */
static double member_bound(double k)
{
    double alpha = 2.0 * k - k * k;
    double dx = alpha / 256.0 + 0x1p-17 + 5.0 * SIGMA_LSB * 0x1p-16;
    double dv = k * k / 256.0 + 0x1p-17 + 5.0 * SIGMA_LSB * 0x1p-24;
    return response_bound(k, dx, dv);
}

TEST(test_members_are_fading_memories)
{
    test_random_t random;
    random_seed(&random, SEED);
    filter_t f = made_at_rest(0);
    line_t reference[AUTO_MEMBERS] = { { 0.0, 0.0 } };
    for (int n = 0; n < 20000; n++) {
        int16_t z = as_sample(3.0 * sin(n * 0.01) + fmax(-3.5, fmin(3.5, random_normal(&random))) * SIGMA_LSB);
        int32_t x = filter_update(&f, z);
        TEST_ASSERT_EQUAL_INT32(f.own.bank.members[f.own.bank.chosen].x_lsb_q16, x);
        TEST_ASSERT_EQUAL_HEX8(0, f.flags & (FILTER_GATED | FILTER_REACQUIRED | FILTER_SATURATED));
        for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
            double k = f.own.bank.final_k_uq16[i] / 65536.0;
            step_line(&reference[i], k, z);
            TEST_ASSERT_DOUBLE_WITHIN(member_bound(k), reference[i].x, f.own.bank.members[i].x_lsb_q16 / 65536.0);
        }
    }
}

/* Behind a restart k = 0.6 and then k - k^2 / 4: half a sample of memory more per sample, up to the member's own. */
TEST(test_the_memory_grows_by_half_a_sample_per_sample)
{
    filter_t f = made_at_rest(0);
    feed(&f, 1000, 5);
    double k = 0.6;
    for (int n = 0; n < 200; n++) {
        for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
            double expected = fmax(k, 2.0 / memories[i]);
            TEST_ASSERT_DOUBLE_WITHIN(0.02 * expected, expected, f.own.bank.members[i].k_uq16 / 65536.0);
        }
        (void)filter_update(&f, 1000);
        k -= k * k / 4.0;
    }
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        TEST_ASSERT_EQUAL_UINT16(f.own.bank.final_k_uq16[i], f.own.bank.members[i].k_uq16);
    }
}

/* Two sigmas of its rate: sqrt(2 t^3) sigmas of a sample, t = k / (2 - k), as the linear filter's equations have it. */
TEST(test_a_gap_stops_a_rate_within_two_of_its_sigmas)
{
    double k = 2.0 / memories[AUTO_MIDDLE];
    double t = k / (2.0 - k);
    double two_sigmas_lsb = 2.0 * sqrt(2.0 * t * t * t) * SIGMA_LSB;
    filter_t f = made_at_rest(0);
    filter_member_t *m = &f.own.bank.members[AUTO_MIDDLE];
    for (int side = -1; side <= 1; side += 2) {
        int32_t within = (int32_t)(side * two_sigmas_lsb * 0.99 * 65536.0);
        int32_t beyond = (int32_t)(side * two_sigmas_lsb * 1.01 * 65536.0);
        m->rate_lsb_q16 = beyond;
        filter_tracker_fade(&f, true);
        TEST_ASSERT_EQUAL_INT32(beyond, m->rate_lsb_q16);
        m->rate_lsb_q16 = within;
        filter_tracker_fade(&f, true);
        TEST_ASSERT_EQUAL_INT32(0, m->rate_lsb_q16);
        m->k_uq16++; /* growing: four times that */
        m->rate_lsb_q16 = 3 * beyond;
        filter_tracker_fade(&f, true);
        TEST_ASSERT_EQUAL_INT32(0, m->rate_lsb_q16);
        m->rate_lsb_q16 = 4 * beyond;
        filter_tracker_fade(&f, true);
        TEST_ASSERT_EQUAL_INT32(4 * beyond, m->rate_lsb_q16);
        m->k_uq16--;
    }
}

/* R k (10 - 14 k + 5 k^2) / (2 - k)^3 is what the linear recursion gives: sum of the squared response. */
TEST(test_the_variance_reported_is_that_of_the_member_shown)
{
    for (uint8_t i = 0; i < AUTO_MEMBERS; i++) {
        filter_t f = made_at_rest(0);
        f.own.bank.shown = i;
        line_t s = { 0.0, 0.0 };
        double k = f.own.bank.final_k_uq16[i] / 65536.0;
        double sum = 0.0;
        for (int n = 0; n < 5000; n++) {
            step_line(&s, k, (n == 0) ? 1.0 : 0.0);
            sum += s.x * s.x;
        }
        filter_probe_t probe = probe_of(&f);
        TEST_ASSERT_DOUBLE_WITHIN(0.002 * sum * R_LSB2_Q8 + 1.0, sum * R_LSB2_Q8, probe.p_lsb2_q8);
    }
}
