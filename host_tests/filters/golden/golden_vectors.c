/*
 * golden_vectors > filters_100hz.csv: one axis at 100 Hz through every filter of the list at its defaults. Tilting by a
 * sine, noise of 0.8 LSB, from row 100 on 6 % outliers of any size, a step at row 250, a gap of 12 missing samples at
 * row 300 (empty z), readings beyond the sensor's range at row 350. test_golden holds the filters to the file.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "support/filters.h"
#include "support/random.h"

enum { ROWS = 400, OUTLIERS_FROM = 100, STEP_AT = 250, GAP_AT = 300, GAP_END = 312, CLIPPED_AT = 350 };

static int16_t sample(int row, test_random_t *random)
{
    double lsb = 60.0 * sin(0.05 * row) + ((row < STEP_AT) ? 0.0 : 90.0) + 0.8 * random_normal(random);
    if (row >= OUTLIERS_FROM && random_uniform(random) < 0.06) {
        lsb += ((random_u32(random) & 1U) != 0U ? 1.0 : -1.0) * pow(10.0, 1.0 + 2.5 * random_uniform(random));
    }
    return (row == CLIPPED_AT) ? INT16_MIN : (row == CLIPPED_AT + 1) ? INT16_MAX : as_sample(lsb);
}

int main(void)
{
    static filter_t f[FILTER_KIND_COUNT];
    test_random_t random;
    random_seed(&random, 2002);
    printf("# x in Q15.16 of every filter at its defaults for 100 Hz; made by `make golden`, held by test_golden\nz");
    FOR_EACH_KIND(kind)
    {
        if (!init_default(&f[kind], (filter_kind_t)kind, 1000)) {
            fprintf(stderr, "golden_vectors: %s refuses its defaults\n", filter_listed_name((filter_kind_t)kind));
            return 1;
        }
        printf(",%s", filter_listed_name((filter_kind_t)kind));
    }
    for (int row = 0; row < ROWS; row++) {
        bool missing = row >= GAP_AT && row < GAP_END;
        int16_t z = sample(row, &random);
        printf(missing ? "\n" : "\n%d", z);
        FOR_EACH_KIND(kind)
        {
            printf(",%" PRId32, missing ? coast_only(&f[kind]) : filter_update(&f[kind], z));
        }
    }
    printf("\n");
    return 0;
}
