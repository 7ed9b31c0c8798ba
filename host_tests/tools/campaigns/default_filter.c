/*
 * Runs every filter over the streams that make default asks for (campaigns/pages/default_filter.py makes the table).
 *
 *   default_filter [NAME...] < JOBS > ROWS.csv         NAME: only these contenders
 *
 * A job is a line: KEY PATH RATE_DHZ RANGE_G DIVIDE FROM_S TO_S truth|smooth SEEDS OUTLIER_SEEDS. The part FROM_S..TO_S
 * of a stream, DIVIDE rows averaged to one (support/smooth.h), goes at RATE_DHZ through every filter with its defaults
 * and every peer: once as it is, SEEDS times with each kind of fault, OUTLIER_SEEDS times with each kind of outliers.
 * `truth`: the reference is gravity at the attitude of the truth columns, else the clean stream smoothed both ways.
 *
 * A row: KEY,RATE_DHZ,FAULT,SEED,CONTENDER, then number of values and sums of squared differences from each reference,
 * over all samples, then over those within half a second after a bad read. The first second is never counted.
 * Status 2: a job cannot be read, one sentence says which.
 */
#include "support/outliers.h"
#include "support/shipped.h"
#include "support/smooth.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef PEER_FUSION /* make comparison, where its library is there */
#include "tools/comparison/fusion_pc.h"
#else
#include "tools/comparison/fusion_none.h"
#endif
#include "tools/comparison/runner.h"

/* References: truth, or smoothed at these cuts, the first of which decides; behind them the own run without faults. */
static const double cut_hz[] = { 5.0, 2.5, 10.0 };
enum { SMOOTHED = sizeof cut_hz / sizeof cut_hz[0], OWN = SMOOTHED, REFERENCES };

static const double bad_for_s = 0.5;

typedef struct {
    char key[64], path[512], reference[8];
    unsigned rate_dhz, range_g, divide, seeds, outlier_seeds;
    double from_s, to_s;
} job_t;

typedef struct {
    job_t job;
    divided_t divided;
    double *reference[SMOOTHED][3]; /* by row of the divided stream */
    double *own[ALL][3];            /* what each makes of it */
} bench_t;

typedef struct {
    size_t count;
    double square[REFERENCES];
} sums_t;

/* --- references --- */

static double true_lsb(const stream_row_t *row, int axis)
{
    double roll = row->truth_cdeg[0] * 1.74532925199432958e-4;
    double pitch = row->truth_cdeg[1] * 1.74532925199432958e-4;
    if (axis == 0) {
        return -lsb_per_g[axis] * sin(pitch);
    }
    return lsb_per_g[axis] * cos(pitch) * (axis == 1 ? sin(roll) : cos(roll));
}

/* Every row's reference, then that of the groups. */
static bool one_reference(bench_t *bench, const stream_t *whole, size_t which, int axis)
{
    double *every = malloc(whole->count * sizeof *every);
    double *mean = malloc(bench->divided.stream.count * sizeof *mean);
    bench->reference[which][axis] = mean;
    if (every == NULL || mean == NULL) {
        free(every);
        return false;
    }
    bool truth = strcmp(bench->job.reference, "truth") == 0;
    for (size_t i = 0; i < whole->count; i++) {
        every[i] = truth ? true_lsb(&whole->rows[i], axis) : whole->rows[i].lsb[axis];
    }
    bool good = truth || smooth_both_ways(every, whole->count, whole->rate_hz, cut_hz[which]);
    for (size_t i = 0; good && i < bench->divided.stream.count; i++) {
        mean[i] = divided_mean(&bench->divided, i, every);
    }
    free(every);
    return good;
}

static bool references(bench_t *bench, const stream_t *whole)
{
    bool good = true;
    for (size_t which = 0; which < SMOOTHED; which++) {
        for (int axis = 0; axis < 3; axis++) {
            good = good && one_reference(bench, whole, which, axis);
        }
    }
    return good;
}

/* --- runs --- */

static char *const *only; /* names of the contenders that are asked for; NULL: all */

static bool wanted(size_t contender)
{
    for (char *const *name = only; name != NULL && *name != NULL; name++) {
        if (strcmp(*name, runner_name(contender)) == 0) {
            return true;
        }
    }
    return only == NULL || *only == NULL;
}

static bool begin(runner_t *runner, const job_t *job, size_t contender, int axis)
{
    return runner_begin(runner, contender, (uint16_t)job->rate_dhz, (uint8_t)job->range_g, axis);
}

static bool own_run(bench_t *bench, size_t contender, int axis)
{
    const stream_t *clean = &bench->divided.stream;
    runner_t runner;
    double *own_lsb = malloc(clean->count * sizeof *own_lsb);
    bench->own[contender][axis] = own_lsb;
    if (own_lsb == NULL || !begin(&runner, &bench->job, contender, axis)) {
        return false;
    }
    for (size_t i = 0; i < clean->count; i++) {
        own_lsb[i] = runner_lsb(&runner, &clean->rows[i], axis);
    }
    return true;
}

static bool own_runs(bench_t *bench)
{
    bool good = true;
    for (size_t contender = 0; contender < ALL; contender++) {
        for (int axis = 0; axis < 3; axis++) {
            good = good && (!wanted(contender) || own_run(bench, contender, axis));
        }
    }
    return good;
}

static void add(sums_t *sums, const bench_t *bench, size_t source, int axis, double x_lsb, double own_lsb)
{
    sums->count++;
    for (size_t which = 0; which < SMOOTHED; which++) {
        double e = x_lsb - bench->reference[which][axis][source];
        sums->square[which] += e * e;
    }
    sums->square[OWN] += (x_lsb - own_lsb) * (x_lsb - own_lsb);
}

static void one_axis(const bench_t *bench, const faulty_t *faulty, size_t contender, int axis, sums_t sums[2])
{
    const stream_t *clean = &bench->divided.stream;
    runner_t runner;
    (void)begin(&runner, &bench->job, contender, axis); /* own_run did it before, so it cannot be refused here */
    double bad_until_s = -1.0;
    for (size_t i = 0; i < faulty->stream.count; i++) {
        const stream_row_t *row = &faulty->stream.rows[i];
        const stream_row_t *good = &clean->rows[faulty->source[i]];
        double t_s = 1e-6 * (double)row->t_us;
        double x_lsb = runner_lsb(&runner, row, axis);
        double own_lsb = bench->own[contender][axis][faulty->source[i]];
        if (memcmp(row->lsb, good->lsb, sizeof row->lsb) != 0) {
            bad_until_s = t_s + bad_for_s;
        }
        if (t_s < 1.0) {
            continue;
        }
        add(&sums[0], bench, faulty->source[i], axis, x_lsb, own_lsb);
        if (t_s < bad_until_s) {
            add(&sums[1], bench, faulty->source[i], axis, x_lsb, own_lsb);
        }
    }
}

static void print_row(const bench_t *bench, const char *fault, unsigned seed, size_t contender, const sums_t sums[2])
{
    printf("%s,%u,%s,%u,%s", bench->job.key, bench->job.rate_dhz, fault, seed, runner_name(contender));
    for (int part = 0; part < 2; part++) {
        printf(",%zu", sums[part].count);
        for (size_t which = 0; which < REFERENCES; which++) {
            printf(",%.6g", sums[part].square[which]);
        }
    }
    printf("\n");
}

static void one_run(const bench_t *bench, const faulty_t *faulty, const char *fault, unsigned seed)
{
    for (size_t contender = 0; contender < ALL; contender++) {
        sums_t sums[2] = { { 0 }, { 0 } };
        if (!wanted(contender)) {
            continue;
        }
        for (int axis = 0; axis < 3; axis++) {
            one_axis(bench, faulty, contender, axis, sums);
        }
        print_row(bench, fault, seed, contender, sums);
    }
}

/* A run without faults: each row its own source. */
static bool clean_run(const bench_t *bench)
{
    const stream_t *clean = &bench->divided.stream;
    faulty_t same = { .stream = *clean, .source = malloc(clean->count * sizeof *same.source) };
    for (size_t i = 0; same.source != NULL && i < clean->count; i++) {
        same.source[i] = i;
    }
    if (same.source != NULL) {
        one_run(bench, &same, "none", 0);
    }
    free(same.source);
    return same.source != NULL;
}

/* A seed that puts no fault in is told with no rows: it is the run without faults. */
static bool run_and_free(const bench_t *bench, faulty_t *faulty, bool made, const char *fault, unsigned seed)
{
    if (made && faulty->faulty > 0) {
        one_run(bench, faulty, fault, seed);
    }
    if (made) {
        faulty_free(faulty);
    }
    return made;
}

static bool faulty_runs(const bench_t *bench, fault_t kind)
{
    const job_t *job = &bench->job;
    bool good = true;
    for (unsigned seed = 1; good && seed <= job->seeds; seed++) {
        faulty_t faulty;
        good = faulty_make(&faulty, &bench->divided.stream, kind, (uint16_t)job->rate_dhz, (uint8_t)job->range_g, seed);
        good = run_and_free(bench, &faulty, good, fault_name(kind), seed);
    }
    return good;
}

static bool outlier_runs(const bench_t *bench, outliers_t kind)
{
    const job_t *job = &bench->job;
    bool good = true;
    for (unsigned seed = 1; good && seed <= job->outlier_seeds; seed++) {
        faulty_t faulty;
        good = outliers_make(&faulty, &bench->divided.stream, kind, (uint16_t)job->rate_dhz, (uint8_t)job->range_g,
                             seed);
        good = run_and_free(bench, &faulty, good, outliers_name(kind), seed);
    }
    return good;
}

static bool all_runs(const bench_t *bench)
{
    static const fault_t kinds[] = { FAULT_BAD_1E5, FAULT_BAD_1E3, FAULT_CONTENTION };
    bool good = clean_run(bench);
    for (size_t kind = 0; kind < sizeof kinds / sizeof kinds[0]; kind++) {
        good = good && faulty_runs(bench, kinds[kind]);
    }
    for (outliers_t kind = (outliers_t)0; kind < OUTLIERS_COUNT; kind++) {
        good = good && outlier_runs(bench, kind);
    }
    return good;
}

/* --- jobs --- */

static const char *run_job(bench_t *bench, const stream_t *whole)
{
    const job_t *job = &bench->job;
    if (strcmp(job->reference, "truth") == 0 && !whole->has_truth) {
        return "it has no truth columns";
    }
    if (!stream_divide(&bench->divided, whole, job->divide)) {
        return "fewer than two rows at this rate";
    }
    if (!references(bench, whole)) {
        return "too short to be smoothed";
    }
    if (!own_runs(bench)) {
        return "a filter refuses this rate";
    }
    return all_runs(bench) ? NULL : "out of memory";
}

static bool one_job(const job_t *job)
{
    bench_t bench = { .job = *job };
    stream_t file;
    if (!stream_load(&file, job->path)) {
        fprintf(stderr, "default_filter: %s\n", file.error);
        return false;
    }
    stream_t whole;
    const char *reason = "fewer than two rows in this part";
    if (stream_cut(&whole, &file, job->from_s, job->to_s)) {
        reason = run_job(&bench, &whole);
        stream_free(&whole);
    }
    for (size_t i = 0; i < SMOOTHED * 3U; i++) {
        free(bench.reference[i / 3U][i % 3U]);
    }
    for (size_t i = 0; i < ALL * 3U; i++) {
        free(bench.own[i / 3U][i % 3U]);
    }
    divided_free(&bench.divided);
    stream_free(&file);
    if (reason != NULL) {
        fprintf(stderr, "default_filter: %s at %g Hz: %s\n", job->key, job->rate_dhz / 10.0, reason);
    }
    return reason == NULL;
}

static bool read_job(job_t *job, const char *line)
{
    int fields = sscanf(line, "%63s %511s %u %u %u %lf %lf %7s %u %u", job->key, job->path, &job->rate_dhz,
                        &job->range_g, &job->divide, &job->from_s, &job->to_s, job->reference, &job->seeds,
                        &job->outlier_seeds);
    bool range = job->range_g == 2 || job->range_g == 4 || job->range_g == 8 || job->range_g == 16;
    return fields == 10 && range && job->divide >= 1 && job->rate_dhz >= 50 && job->rate_dhz <= 40000;
}

int main(int argc, char **argv)
{
    only = argv + (argc > 0 ? 1 : 0);
    char line[1024];
    while (fgets(line, sizeof line, stdin) != NULL) {
        job_t job = { .range_g = 0 };
        if (!read_job(&job, line)) {
            fprintf(stderr, "default_filter: not a job: %s", line);
            return 2;
        }
        if (!one_job(&job)) {
            return 2;
        }
    }
    return 0;
}
