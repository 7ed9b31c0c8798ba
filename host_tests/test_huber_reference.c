/* huber against its equations in double, on clean noise and on outliers. */
#include "support_filters.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>

#define SEED 1964

void setUp(void) {}

void tearDown(void) {}

/* Rate in LSB per sample, P per R. */
typedef struct {
    double x, v, p11, p12, p22, q22, c, r, rate_max, weight, gain;
} reference_t;

static void reference_step(reference_t *f, double z)
{
    f->x += f->v;
    if (f->p11 < 2.0 && f->p12 < 2.0 && f->p22 < 2.0) { /* the range of kalman.h */
        f->p11 += 2.0 * f->p12 + f->p22;
        f->p12 += f->p22;
        f->p22 += f->q22;
    }
    double s = f->p11 + 1.0;
    double u = z - f->x;
    double limit = f->c * sqrt(f->r * s);
    f->weight = (f->c > 0.0 && fabs(u) > limit) ? limit / fabs(u) : 1.0;
    f->gain = f->weight * f->p11 / s;
    double w2 = f->weight * f->p12 / s;
    f->x += f->gain * u;
    f->v = fmax(-f->rate_max, fmin(f->rate_max, f->v + w2 * u));
    f->p22 -= w2 * f->p12;
    f->p12 -= f->gain * f->p12;
    f->p11 -= f->gain * f->p11;
}

static void start_both(filter_t *f, reference_t *r, const filter_config_t *config)
{
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(f, &filter_law_huber, config));
    for (int k = 0; k < FILTER_WARM_UP_SAMPLES; k++) {
        (void)filter_update(f, 0);
    }
    double period_s = 10.0 / config->rate_dhz;
    double r_lsb2 = config->value[HUBER_R_LSB2_Q8] / 256.0;
    *r = (reference_t){ .p11 = 1.0,
                        .p22 = fmin(1.0, 40000.0 * period_s * period_s / r_lsb2),
                        .q22 = fmin(1.0, config->value[HUBER_Q_LSB2_S3] * pow(period_s, 3.0) / r_lsb2),
                        .c = config->value[HUBER_SIGMA_Q8] / 256.0,
                        .r = r_lsb2,
                        .rate_max = config->value[HUBER_RATE_MAX_LSB_S] * period_s };
}

/* The limit of the core is c^2 R in 1/16 LSB^2, half a count off; its root in 2^-8 LSB. */
static double weight_error(const reference_t *r)
{
    double limit2 = r->c * r->c * r->r;
    return 0.5 * (1.0 / 32.0) / limit2 + 1.0 / 256.0 / sqrt(limit2);
}

/*
 * As test_kf_reference.c: 2 (dw1 reach + w1 / 256) / w1, where the gain's error has that of the weight beside kf's
 * (reciprocal, q22), and the reach is five sigmas of the innovation. From 50 Hz on: below, P comes to the end of its
 * range, where single decisions to predict it fall differently.
 */
static void estimate_equals_the_reference(void)
{
    static const uint16_t rates[] = { 500, 1000, 4000, 8000 };
    test_random_t random;
    random_seed(&random, SEED);
    for (int i = 0; i < 8; i++) {
        filter_config_t config = filter_defaults(&filter_law_huber, rates[i % 4]);
        filter_t f;
        reference_t r;
        start_both(&f, &r, &config);
        double sigma = sqrt(config.value[HUBER_R_LSB2_Q8] / 256.0);
        double worst = 0.0;
        for (int k = 0; k < 4000; k++) {
            double spread = (i >= 4 && random_uniform(&random) < 0.15) ? 20.0 * sigma : sigma;
            int16_t z = as_sample(100.0 * sin(0.5 * k / (rates[i % 4] / 10.0)) + spread * random_normal(&random));
            double x = filter_update(&f, z) / 65536.0;
            reference_step(&r, z);
            double w1 = r.p11 / (1.0 + r.p11);
            w1 = fmax(w1, r.gain);
            double error = 1.5 / 65536.0 / w1 + w1 * 0.5 * (4.0 / 16384.0 + 1.0 / f.own.kalman.q22_uq28) +
                           weight_error(&r) * w1;
            double bound = 2.0 * (error * 5.0 * sigma / sqrt(1.0 - w1) / w1 + 1.0 / 256.0);
            worst = fmax(worst, fabs(x - r.x) / bound);
        }
        printf("%d dHz%s: worst share of the bound %.3f\n", rates[i % 4], i >= 4 ? ", outliers" : "", worst);
        TEST_ASSERT_TRUE(worst <= 1.0);
    }
}

/* Beyond the limit the step is that of a sample at it: 4,000 LSB moves x as far as 1,000 LSB does. */
static void steps_are_bounded(void)
{
    filter_config_t config = filter_defaults(&filter_law_huber, 1000);
    filter_t far;
    TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&far, &filter_law_huber, &config));
    filter_reset(&far, 0);
    filter_t near = far;
    double w1 = 0.21; /* more than the steady gain of q T^3 / R = 1/300 */
    double most = 1.345 * sqrt(3.0 / (1.0 - w1)) * w1;
    int32_t x_far = filter_update(&far, 4000);
    TEST_ASSERT_INT32_WITHIN(65536 / 64, filter_update(&near, 1000), x_far);
    TEST_ASSERT_TRUE(x_far > 0 && x_far / 65536.0 < most * 1.6);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(estimate_equals_the_reference);
    RUN_TEST(steps_are_bounded);
    return UNITY_END();
}
