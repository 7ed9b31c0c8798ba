/*
 * Measures the filters on the real recordings, for make recordings (campaigns/pages/recordings.py makes the tables).
 *
 *   recordings > ROWS.csv   progress on stderr; a row's first field says what it is: stream, filter, tails, rest, fault
 *
 * Status 1: an estimate left its bounds; 2: the recordings cannot be read; 3: they are not there.
 */
#include "support/recordings.h"
#include "support/faults.h"
#include "support/shipped.h"
#include "support/survey.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char axis_name[] = "xyz";
static const double forever_s = 1e9;
static size_t broken;
static size_t judged;

static void print_counts(const char *what, const char *name, filter_kind_t kind, int axis, const axis_counts_t *c)
{
    printf("%s,%s,%s,%c,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%.3f,%zu,%zu,%.1f,%zu,%.1f\n", what, name,
           filter_listed_name(kind), axis_name[axis], c->samples, c->gated, c->reacquired, c->saturated,
           c->longest_gated, c->bounds_broken, c->envelope_judged, c->envelope_broken, c->envelope_worst,
           c->hull_judged, c->hull_broken, c->hull_left_lsb, c->outside, c->outside_worst_lsb);
    broken += c->bounds_broken + c->hull_broken + c->envelope_broken;
    judged += c->envelope_judged;
}

/* Every filter on one axis; false: one refuses the rate. */
static bool every_filter(const char *what, const char *name, const stream_t *stream, const survey_t *survey, int axis)
{
    for (filter_kind_t kind = (filter_kind_t)0; kind < FILTER_KIND_COUNT; kind++) {
        axis_counts_t counts;
        if (!survey_axis(stream, survey, kind, axis, &counts)) {
            fprintf(stderr, "recordings: %s: %s refuses %.1f Hz\n", name, filter_listed_name(kind),
                    survey->rate_dhz / 10.0);
            return false;
        }
        print_counts(what, name, kind, axis, &counts);
    }
    return true;
}

static bool one_recording(const recording_t *r)
{
    stream_t stream;
    if (!stream_load(&stream, r->path)) {
        fprintf(stderr, "recordings: %s\n", stream.error);
        return false;
    }
    row_counts_t rows = survey_rows(&stream, r->range_g);
    printf("stream,%s,%.1f,%u,%.1f,%zu,%zu,%zu,%zu,%zu\n", r->name, r->rate_dhz / 10.0, r->range_g, stream.rate_hz,
           rows.rows, rows.clipped, rows.duplicates, rows.zeros, rows.ones);
    survey_t survey = { r->rate_dhz, r->range_g, 0.0, forever_s };
    bool good = true;
    for (int axis = 0; good && axis < 3; axis++) {
        good = every_filter("filter", r->name, &stream, &survey, axis);
    }
    stream_free(&stream);
    return good;
}

static bool one_rest(const recordings_t *recordings, const rest_t *rest)
{
    const recording_t *r = recordings_find(recordings, rest->name);
    stream_t stream;
    if (r == NULL || !stream_load(&stream, r->path)) {
        fprintf(stderr, "recordings: %s: %s\n", rest->name, r == NULL ? "not in the index" : stream.error);
        return false;
    }
    survey_t survey = { r->rate_dhz, r->range_g, rest->from_s, rest->to_s };
    char key[64];
    snprintf(key, sizeof key, "%s,%g", rest->name, rest->from_s);
    bool good = true;
    for (int axis = 0; good && axis < 3; axis++) {
        tails_t tails = survey_tails(&stream, rest->from_s, rest->to_s, axis);
        printf("tails,%s,%g,%c,%zu,%.2f,%.5f,%.5f\n", rest->name, rest->from_s, axis_name[axis], tails.samples,
               tails.sd_lsb, tails.beyond3, tails.beyond5);
        good = every_filter("rest", key, &stream, &survey, axis);
    }
    stream_free(&stream);
    return good;
}

/* --- faults put into clean recordings --- */

enum { SEEDS = 20 };

/* Whole recordings without faults of their own, from a slow turn to walking. */
#define MOVING 5U
static const rest_t moving[MOVING] = { { "sis-lie-slow", 0, 1e9 },
                                       { "sis-roll90", 0, 1e9 },
                                       { "sis-walk", 0, 1e9 },
                                       { "freeimu-orient-a", 0, 1e9 },
                                       { "gy85-tilt-92hz", 0, 1e9 } };

static struct {
    score_t score[SEEDS][CONTENDERS];
    size_t faulty, rows;
} pool[FAULT_COUNT];

static bool one_fault(const study_t *study, fault_t fault)
{
    for (unsigned seed = 0; seed < SEEDS; seed++) {
        faulty_t faulty;
        if (!faulty_make(&faulty, study->clean, fault, study->rate_dhz, study->range_g, seed + 1U)) {
            return false;
        }
        pool[fault].faulty += faulty.faulty;
        pool[fault].rows += faulty.stream.count;
        for (size_t contender = 0; contender < CONTENDERS; contender++) {
            study_score(study, &faulty, contender, &pool[fault].score[seed][contender]);
        }
        faulty_free(&faulty);
    }
    return true;
}

static bool add_to_pool(const recordings_t *recordings, const rest_t *part)
{
    const recording_t *r = recordings_find(recordings, part->name);
    stream_t whole;
    stream_t stream;
    study_t study = { .clean = NULL };
    if (r == NULL || !stream_load(&whole, r->path)) {
        fprintf(stderr, "recordings: %s: %s\n", part->name, r == NULL ? "not in the index" : whole.error);
        return false;
    }
    bool good = stream_cut(&stream, &whole, part->from_s, part->to_s);
    good = good && study_begin(&study, &stream, r->rate_dhz, r->range_g);
    for (fault_t fault = (fault_t)0; good && fault < FAULT_COUNT; fault++) {
        good = one_fault(&study, fault);
    }
    study_end(&study);
    stream_free(&stream);
    stream_free(&whole);
    return good;
}

/* Mean and worst over the seeds. */
static void print_contender(const char *name, fault_t fault, size_t contender)
{
    double sum[3] = { 0.0 };
    double worst[2] = { 0.0 };
    for (unsigned seed = 0; seed < SEEDS; seed++) {
        const score_t *score = &pool[fault].score[seed][contender];
        double value[3] = { rms(score->own, score->count), rms(score->plain, score->count),
                            rms(score->predicted, score->count) };
        for (int i = 0; i < 3; i++) {
            sum[i] += value[i] / SEEDS;
        }
        worst[0] = fmax(worst[0], value[0]);
        worst[1] = fmax(worst[1], value[1]);
    }
    printf("fault,%s,%s,%s,%.6f,%.3f,%.3f,%.3f,%.3f,%.3f\n", name, fault_name(fault), contender_name(contender),
           (double)pool[fault].faulty / (double)pool[fault].rows, sum[0], worst[0], sum[1], worst[1], sum[2]);
}

static bool faults_in(const recordings_t *recordings, const char *name, const rest_t *parts, size_t count)
{
    memset(pool, 0, sizeof pool);
    for (size_t i = 0; i < count; i++) {
        fprintf(stderr, "\rrecordings: faults, %s: %zu of %zu  ", name, i + 1, count);
        if (!add_to_pool(recordings, &parts[i])) {
            return false;
        }
    }
    for (fault_t fault = (fault_t)0; fault < FAULT_COUNT; fault++) {
        for (size_t contender = 0; contender < CONTENDERS; contender++) {
            print_contender(name, fault, contender);
        }
    }
    return true;
}

static bool survey_all(const recordings_t *recordings)
{
    for (size_t i = 0; i < recordings->count; i++) {
        fprintf(stderr, "\rrecordings: stream %zu of %zu  ", i + 1, recordings->count);
        if (!one_recording(&recordings->list[i])) {
            return false;
        }
    }
    for (size_t i = 0; i < RESTS; i++) {
        if (!one_rest(recordings, &recording_rests[i])) {
            return false;
        }
    }
    return true;
}

int main(void)
{
    static recordings_t recordings;
    if (!recordings_there()) {
        fprintf(stderr, "recordings: %s/open/index.csv is not there (RECORDINGS=folder)\n", recordings_folder());
        return 3;
    }
    if (!recordings_load(&recordings)) {
        fprintf(stderr, "recordings: %s\n", recordings.error);
        return 2;
    }
    bool good = survey_all(&recordings) && faults_in(&recordings, "at rest", recording_rests, RESTS) &&
                faults_in(&recordings, "moving", moving, MOVING);
    fprintf(stderr, "\n");
    if (good && judged == 0) {
        fprintf(stderr, "recordings: no estimate was judged\n");
        good = false;
    }
    if (!good) {
        return 2;
    }
    return broken == 0 ? 0 : 1;
}
