/*
 * What the filters do on real recordings, and on the shipped streams by the same rules: within their documented bounds,
 * no further from the raw samples than the rules of support/envelope.h allow, hardly anything refused at rest.
 */
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "support/recordings.h"
#include "support/shipped.h"
#include "support/survey.h"
#include "support/test.h"

#include <stdio.h>

/* notes of the recordings: with R = 1.5 x variance a gate of 3 sigma refuses 0.0 to 1.6 % of healthy samples at rest */
#define REST_GATED_MAX 0.016
#define SETTLED_S 2.0

static recordings_t recordings;
static char text[200];

static const char *about(const char *name, int kind, int axis, const char *what)
{
    snprintf(text, sizeof text, "%s: %s %c: %s", name, filter_listed_name((filter_kind_t)kind), "xyz"[axis], what);
    return text;
}

static int16_t row_mg(const chain_t *chain)
{
    int32_t x_lsb_q8 = (chain->x_lsb_q16 + 128) >> 8;
    return (int16_t)((x_lsb_q8 * 1000 + 32768) >> 16);
}

static void filter_sample(const adxl345_sample_t *sample, uint32_t period_us)
{
    while (coast_due(sample->t_us) && coast_over(period_us, true)) {
        pipeline_finish();
        pipeline_row_done();
    }
    TEST_ASSERT_TRUE(coast_sample(sample->t_us, period_us));
    pipeline_sample(sample);
    pipeline_finish();
}

static void compare_with_pipeline(const stream_t *stream, uint8_t kind, uint16_t rate_dhz, uint8_t range_g)
{
    chain_t chain[3];
    coast_wait(0);
    pipeline_reset();
    settings_defaults();
    calibration_plain(&settings()->calibration, CALIBRATION_SCALE_2V5_UQ6, CALIBRATION_SCALE_2V5_UQ6); /* as row_mg */
    pipeline_calibrate(&settings()->calibration);
    settings_take_filter(kind);
    pipeline_forget();
    pipeline_change(&settings()->choice, rate_dhz, range_g);
    pipeline_finish();
    for (int axis = 0; axis < 3; axis++) {
        TEST_ASSERT_TRUE(chain_begin(&chain[axis], (filter_kind_t)kind, rate_dhz, range_g, axis));
    }
    for (size_t i = 0; i < stream->count; i++) {
        const stream_row_t *in = &stream->rows[i];
        adxl345_sample_t sample = { .t_us = (uint32_t)in->t_us, .lsb = { in->lsb[0], in->lsb[1], in->lsb[2] } };
        row_t row;
        uint16_t flags = 0;
        filter_sample(&sample, chain[0].period_us);
        pipeline_row(&row);
        pipeline_row_done();
        for (int axis = 0; axis < 3; axis++) {
            (void)chain_sample(&chain[axis], in->t_us, in->lsb[axis]);
            uint8_t refused = chain[axis].clipped ? 0 : FILTER_GATED;
            uint8_t own = chain[axis].waits ? refused : chain[axis].filter.flags;
            flags |= (own & FILTER_GATED) != 0U ? ROW_GATED : 0U;
            flags |= (own & FILTER_REACQUIRED) != 0U || chain[axis].begun ? ROW_REACQUIRED : 0U;
            flags |= chain[axis].clipped ? ROW_CLIPPED : 0U;
            TEST_ASSERT_EQUAL_INT16_MESSAGE(row.mg[axis], row_mg(&chain[axis]), about("pipeline", kind, axis, "mg"));
        }
        TEST_ASSERT_EQUAL_HEX16(row.flags & (ROW_GATED | ROW_REACQUIRED | ROW_CLIPPED), flags);
    }
}

TEST(the_chain_is_the_pipeline)
{
    static const char *const names[] = { "gaps-jitter", "clipping", "bad-reads", "outliers-15pct" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        stream_t stream;
        char path[64];
        snprintf(path, sizeof path, "sim/streams/%s.csv", names[i]);
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, path), stream.error);
        for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
            compare_with_pipeline(&stream, kind, 1000, 16);
        }
        stream_free(&stream);
    }
}

static size_t check_stream(const char *name, const stream_t *stream, uint16_t rate_dhz, uint8_t range_g)
{
    size_t judged = 0;
    survey_t survey = { rate_dhz, range_g, 0.0, 1e9 };
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (int axis = 0; axis < 3; axis++) {
            axis_counts_t c;
            TEST_ASSERT_TRUE_MESSAGE(survey_axis(stream, &survey, (filter_kind_t)kind, axis, &c), name);
            TEST_ASSERT_EQUAL_size_t_MESSAGE(0, c.bounds_broken,
                                             about(name, kind, axis, "outside its documented bounds"));
            TEST_ASSERT_EQUAL_size_t_MESSAGE(0, c.envelope_broken,
                                             about(name, kind, axis, "breaks the rule of its kind"));
            TEST_ASSERT_EQUAL_size_t_MESSAGE(0, c.hull_broken,
                                             about(name, kind, axis, "too far from samples that agree"));
            judged += c.envelope_judged + c.hull_judged;
        }
    }
    return judged;
}

TEST(no_filter_diverges_on_the_shipped_streams)
{
    for (size_t i = 0; i < SHIPPED_STREAMS; i++) {
        const shipped_t *shipped = &shipped_streams[i];
        stream_t stream;
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, shipped->path), stream.error);
        size_t judged = check_stream(shipped->path, &stream, shipped->rate_dhz, 16);
        TEST_ASSERT_GREATER_THAN_size_t_MESSAGE(stream.count, judged, shipped->path);
        stream_free(&stream);
    }
}

static void load_recordings(void)
{
    if (!recordings_there()) {
        TEST_IGNORE_MESSAGE("no ../shared/streams (RECORDINGS=folder)");
    }
    TEST_ASSERT_TRUE_MESSAGE(recordings_load(&recordings), recordings.error);
    TEST_ASSERT_GREATER_THAN_size_t(0, recordings.count);
}

/* Shares in the index have four places. */
TEST(recordings_are_as_their_index_says)
{
    load_recordings();
    for (size_t i = 0; i < recordings.count; i++) {
        const recording_t *r = &recordings.list[i];
        stream_t stream;
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, r->path), stream.error);
        row_counts_t counts = survey_rows(&stream, r->range_g);
        double rows = (double)counts.rows;
        TEST_ASSERT_EQUAL_size_t_MESSAGE(r->rows, counts.rows, r->name);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.6e-4, r->clipped, (double)counts.clipped / rows, r->name);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.6e-4 + 1.0 / rows, r->duplicates, (double)counts.duplicates / rows,
                                          r->name);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(r->zeros, counts.zeros, r->name);
        TEST_ASSERT_EQUAL_size_t_MESSAGE(r->ones, counts.ones, r->name);
        TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(0.01 * r->step_us, r->step_us, 1e6 / stream.rate_hz, r->name);
        stream_free(&stream);
    }
}

TEST(no_filter_diverges_on_the_recordings)
{
    load_recordings();
    for (size_t i = 0; i < recordings.count; i++) {
        const recording_t *r = &recordings.list[i];
        stream_t stream;
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, r->path), stream.error);
        size_t judged = check_stream(r->name, &stream, r->rate_dhz, r->range_g);
        TEST_ASSERT_GREATER_THAN_size_t_MESSAGE(0, judged, r->name);
        stream_free(&stream);
    }
}

/* False gates and re-acquisitions of a filter that gates at 3 sigma or where an outlier is likelier. */
static void check_rest(const char *name, const stream_t *rest, uint16_t rate_dhz, uint8_t range_g)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        for (int axis = 0; axis < 3; axis++) {
            survey_t survey = { rate_dhz, range_g, 0.0, 1e9 };
            axis_counts_t c;
            TEST_ASSERT_TRUE(survey_axis(rest, &survey, (filter_kind_t)kind, axis, &c));
            if (law_facts((filter_kind_t)kind).envelope.rule == ENVELOPE_NONE) {
                continue;
            }
            size_t limit = (size_t)(REST_GATED_MAX * (double)c.samples);
            TEST_ASSERT_LESS_OR_EQUAL_size_t_MESSAGE(limit, c.gated, about(name, kind, axis, "refused at rest"));
            TEST_ASSERT_TRUE_MESSAGE(c.reacquired == 0 || c.last_reacquired_s < SETTLED_S,
                                     about(name, kind, axis, "re-acquired at rest"));
        }
    }
}

TEST(shipped_rests_are_hardly_gated)
{
    for (size_t i = 0; i < 4; i++) {
        stream_t stream;
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, shipped_streams[i].path), stream.error);
        check_rest(shipped_streams[i].path, &stream, shipped_streams[i].rate_dhz, 16);
        stream_free(&stream);
    }
}

TEST(recorded_rests_are_hardly_gated)
{
    load_recordings();
    for (size_t i = 0; i < RESTS; i++) {
        const rest_t *rest = &recording_rests[i];
        const recording_t *r = recordings_find(&recordings, rest->name);
        stream_t stream;
        stream_t part;
        TEST_ASSERT_NOT_NULL_MESSAGE(r, rest->name);
        TEST_ASSERT_TRUE_MESSAGE(stream_load(&stream, r->path), stream.error);
        TEST_ASSERT_TRUE_MESSAGE(stream_cut(&part, &stream, rest->from_s, rest->to_s), rest->name);
        TEST_ASSERT_GREATER_THAN_size_t_MESSAGE(200, part.count, rest->name);
        check_rest(rest->name, &part, r->rate_dhz, r->range_g);
        stream_free(&part);
        stream_free(&stream);
    }
}

int main(void)
{
    printf("recordings in %s\n", recordings_folder());
    return test_all();
}
