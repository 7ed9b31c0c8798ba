/* A law on its own model: see the header. */
#include "support/own_model.h"

#include "reference/filters.h"
#include "support/random.h"
#include "support/roles.h"
#include "unity.h"

#include <math.h>

enum { R, Q, SAMPLES = 30000, RUN_S = 8, RUN_LEAST = 80, SETTLING = 2000 };

typedef struct {
    filter_t filter;
    robust_reference_t reference;
    double x, v;
} run_t;

typedef struct {
    long used, refused;
    double nis, square, reference_square;
} sums_t;

static void one_sample(run_t *run, const filter_config_t *config, test_random_t *random)
{
    const double period_s = 10.0 / config->rate_dhz;
    run->x += run->v * period_s;
    run->v += sqrt(config->value[Q] * period_s) * random_normal(random);
    const double noise = sqrt(config->value[R] / 256.0 - 1.0 / 12.0) * random_normal(random);
    const int16_t z = as_sample(run->x + noise);
    (void)filter_update(&run->filter, z);
    (void)robust_reference_step(&run->reference, z);
}

static void judge(sums_t *sums, const run_t *run, double r_lsb2)
{
    const filter_t *f = &run->filter;
    const double error = f->x_lsb_q16 / 65536.0 - run->x;
    const double reference_error = run->reference.x[0] - run->x;
    sums->square += error * error;
    sums->reference_square += reference_error * reference_error;
    if ((f->flags & (FILTER_GATED | FILTER_REACQUIRED)) != 0) {
        sums->refused++;
        return;
    }
    const double u = f->size_lsb_uq16 / 65536.0;
    sums->nis += u * u * (1.0 - f->gain_uq16 / 65536.0) / r_lsb2; /* 1 / S = (1 - w1) / R */
    sums->used++;
}

own_model_t own_model(const filter_law_t *law, const filter_config_t *config, uint64_t seed)
{
    const double rate_hz = config->rate_dhz / 10.0;
    const double r_lsb2 = config->value[R] / 256.0;
    const int length = config->rate_dhz > 100 ? RUN_S * config->rate_dhz / 10 : RUN_LEAST;
    test_random_t random;
    random_seed(&random, seed);
    sums_t sums = { 0, 0, 0, 0, 0 };
    robust_reference_t settled;
    reference_library(&settled, filter_listed_name(plain_kind()), rate_hz, r_lsb2, config->value[Q], 0, 0.0, 0.0);
    for (int k = 0; k < SETTLING; k++) {
        (void)robust_reference_step(&settled, 0.0);
    }
    while (sums.used + sums.refused < SAMPLES) {
        run_t run = { .reference = settled, .x = 0.0, .v = 0.0 };
        TEST_ASSERT_EQUAL_UINT8(FILTER_ACCEPTED, filter_init(&run.filter, law, config));
        filter_reset(&run.filter, 0);
        for (int k = 0; k < length; k++) {
            one_sample(&run, config, &random);
            judge(&sums, &run, r_lsb2);
        }
    }
    return (own_model_t){ .nis = sums.nis / (double)sums.used,
                          .gated = (double)sums.refused / (double)(sums.used + sums.refused),
                          .rmse = sqrt(sums.square / sums.reference_square) };
}
