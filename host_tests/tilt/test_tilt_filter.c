/* The facade lib/tilt/src/tilt_filter.h: the firmware's sample path bit for bit, other sensors, bad input. */
#include "filter_list.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/filters.h"
#include "support/path.h"
#include "support/random.h"
#include "support/shipped.h"
#include "support/test.h"
#include "tilt_filter.h"

#include <stdio.h>

/* Flags that are not of the sample path: of the driver and the bus, of the rows, of the supervisor of `auto`. */
#define OF_THE_BOARD (ROW_FAULT | ROW_STUCK | ROW_INTEGRITY | ROW_DROPPED | ROW_LEFT_OUT)

static tilt_filter_t tilt;
static char text[400];
static uint8_t first_rows;

_Static_assert((int)TILT_GATED == (int)ROW_GATED && (int)TILT_COASTED == (int)ROW_COASTED &&
                   (int)TILT_REACQUIRED == (int)ROW_REACQUIRED && (int)TILT_CLIPPED == (int)ROW_CLIPPED &&
                   (int)TILT_WARMING_UP == (int)ROW_WARMING_UP && (int)TILT_NOT_GRAVITY == (int)ROW_NOT_GRAVITY &&
                   (int)TILT_ROLL_UNDEFINED == (int)ROW_ROLL_UNDEFINED && (int)TILT_SWITCHED == (int)ROW_SWITCHED,
               "the facade's flags are the protocol's");

/* --- equal to the firmware --- */

static void begin_both(uint8_t kind, uint16_t rate_dhz)
{
    path_start(kind, rate_dhz, 16, 0);
    TEST_ASSERT_TRUE(tilt_filter_begin_with(&tilt, rate_dhz / 10U, filter_listed((filter_kind_t)kind)));
    first_rows = law_facts((filter_kind_t)kind).starts_with_median ? 0 : FILTER_WARM_UP_SAMPLES;
}

/* The firmware flags its first rows as warming up whatever the law; one starts on the first sample, as published. */
static uint16_t compared_flags(void)
{
    if (first_rows == 0) {
        return (uint16_t)~OF_THE_BOARD;
    }
    first_rows--;
    return (uint16_t) ~(OF_THE_BOARD | ROW_WARMING_UP);
}

static void compare_row(void)
{
    row_t row;
    pipeline_finish();
    pipeline_row(&row);
    pipeline_row_done();
    TEST_ASSERT_EQUAL_INT16_MESSAGE(row.roll_cdeg, tilt.angles.roll_cdeg, text);
    TEST_ASSERT_EQUAL_INT16_MESSAGE(row.pitch_cdeg, tilt.angles.pitch_cdeg, text);
    uint16_t compared = compared_flags();
    TEST_ASSERT_EQUAL_HEX16_MESSAGE(row.flags & compared, tilt.flags & compared, text);
    for (int axis = 0; axis < 3; axis++) {
        TEST_ASSERT_EQUAL_INT16_MESSAGE(row.mg[axis], (int16_t)((tilt.a_q8[axis] * 1000 + 32768) >> 16), text);
    }
}

/*
 * Before a sample that ends a long gap the firmware writes no row while its filters hold. A sketch goes on saying that
 * samples are missing, which changes nothing then.
 */
static void fill_gap(uint32_t t_us, uint32_t period_us, bool any_sample)
{
    while (coast_due(t_us)) {
        bool row = coast_over(period_us, true);
        if (any_sample) {
            tilt_filter_missing(&tilt);
        }
        if (!row) {
            return;
        }
        compare_row();
    }
}

static void one_sample(const stream_row_t *in, uint32_t period_us, bool any_sample)
{
    adxl345_sample_t sample = { .t_us = (uint32_t)in->t_us, .lsb = { in->lsb[0], in->lsb[1], in->lsb[2] } };
    fill_gap(sample.t_us, period_us, any_sample);
    if (coast_sample(sample.t_us, period_us)) {
        pipeline_sample(&sample);
        tilt_filter_update(&tilt, in->lsb[0], in->lsb[1], in->lsb[2]);
        compare_row();
    }
}

/* lost: the share of samples that begin a gap, of 1 to 40 samples. */
static void compare_stream(const stream_t *stream, uint8_t kind, uint16_t rate_dhz, double lost)
{
    test_random_t random;
    uint32_t gap = 0;
    random_seed(&random, 1U + kind);
    begin_both(kind, rate_dhz);
    for (size_t i = 0; i < stream->count; i++) {
        if (gap == 0 && random_uniform(&random) < lost) {
            gap = 1U + random_below(&random, random_below(&random, 40) + 1U);
        }
        if (gap != 0) {
            gap--;
            continue;
        }
        snprintf(text, sizeof text, "%s, %s, row %zu, lost %g", filter_listed_name((filter_kind_t)kind), stream->error,
                 i, lost);
        one_sample(&stream->rows[i], 10000000U / rate_dhz, i != 0);
    }
}

static void compare_file(const char *path, uint16_t rate_dhz)
{
    static const double lost[] = { 0.0, 0.02, 0.2 };
    stream_t stream;
    TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, path), stream.error);
    snprintf(stream.error, sizeof stream.error, "%s", path); /* for the messages */
    for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        for (size_t i = 0; i < sizeof lost / sizeof lost[0]; i++) {
            compare_stream(&stream, kind, rate_dhz, lost[i]);
        }
    }
    stream_free(&stream);
}

TEST(test_angles_and_flags_are_the_firmwares)
{
    for (size_t i = 0; i < SHIPPED_STREAMS; i++) {
        compare_file(shipped_streams[i].path, shipped_streams[i].rate_dhz);
    }
    compare_file("sim/streams/steps.csv", 1000);
    compare_file("sim/streams/steps-outliers.csv", 1000);
}
