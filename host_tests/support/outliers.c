#include "support/outliers.h"

#include "support/random.h"

#include <math.h>

static const char *const names[OUTLIERS_COUNT] = { "outliers 15 %", "outliers in runs", "outliers held" };

const char *outliers_name(outliers_t kind)
{
    return names[kind];
}

static bool next_is_outlier(outliers_t kind, bool before, test_random_t *random)
{
    double enters = OUTLIER_SHARE / (1.0 - OUTLIER_SHARE) / OUTLIER_RUN;
    double stays = 1.0 - 1.0 / OUTLIER_RUN;
    double p = kind == OUTLIERS_ALONE ? OUTLIER_SHARE : (before ? stays : enters);
    return random_uniform(random) < p;
}

static int16_t clamped(double lsb, uint8_t range_g)
{
    double rail_lsb = 256.0 * range_g;
    return as_sample(fmax(-rail_lsb, fmin(rail_lsb - 1.0, lsb)));
}

static void make_axis(faulty_t *f, outliers_t kind, int axis, double sigma_lsb, test_random_t *random)
{
    bool outlier = false;
    for (size_t i = 0; i < f->stream.count; i++) {
        bool before = outlier;
        int16_t *lsb = &f->stream.rows[i].lsb[axis];
        outlier = next_is_outlier(kind, before, random);
        if (outlier && before && kind == OUTLIERS_HELD) {
            *lsb = f->stream.rows[i - 1].lsb[axis];
        } else if (outlier) {
            *lsb = clamped(*lsb + sigma_lsb * random_normal(random), f->range_g);
        }
    }
}

static size_t rows_that_differ(const faulty_t *f, const stream_t *clean)
{
    size_t count = 0;
    for (size_t i = 0; i < clean->count; i++) {
        const int16_t *a = f->stream.rows[i].lsb;
        const int16_t *b = clean->rows[i].lsb;
        count += a[0] != b[0] || a[1] != b[1] || a[2] != b[2];
    }
    return count;
}

bool outliers_make(faulty_t *faulty, const stream_t *clean, outliers_t kind, uint16_t rate_dhz, uint8_t range_g,
                   uint64_t seed)
{
    if (!faulty_begin(faulty, clean, range_g)) {
        return false;
    }
    for (size_t i = 0; i < clean->count; i++) {
        faulty->stream.rows[i] = clean->rows[i];
        faulty->source[i] = i;
    }
    faulty->stream.count = clean->count;
    test_random_t random;
    random_seed(&random, seed);
    double sigma_lsb = 20.0 * 2.0 * sqrt(rate_dhz / 1000.0);
    for (int axis = 0; axis < 3; axis++) {
        make_axis(faulty, kind, axis, axis == 2 ? 1.3 * sigma_lsb : sigma_lsb, &random);
    }
    faulty->faulty = rows_that_differ(faulty, clean);
    return true;
}
