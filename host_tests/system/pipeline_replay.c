/*
 * The sample path alone on the PC: takes the samples (time and readings) out of a run of the firmware or out of a
 * stream, filters them with the same code, and prints the rows anew. On a run without faults, from a cold start on, the
 * two must agree to the last digit.
 *
 *   pipeline_replay CSV FILTER RATE_DHZ RANGE_G SKIP [NAME=VALUE]... > ROWS.csv
 *   pipeline_replay --filters
 *
 * CSV: a stream as in docs/protocol.md, whose rows come at the rate given; its times are counted from its first row.
 * SKIP: data rows before the cold start. NAME is a parameter of the filter as its descriptor names it, VALUE in its
 * unit; R=VALUE multiplies what the noise estimate says. The program is linked with --wrap for choice_begin and
 * filter_noise_r_lsb2_q8, so that the sample path meets these in place of the shipped values and is itself unchanged.
 */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "filter_list.h"
#include "noise.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"
#include "stream.h"

enum { CHANGES_MAX = 16, RATE_TOLERANCE_PERCENT = 5 };

#define R_FACTOR "R"

typedef struct {
    char name[16];
    double value;
} change_t;

static change_t changes[CHANGES_MAX];
static size_t change_count;
static double r_factor = 1.0;

void __wrap_choice_begin(const filter_choice_t *choice, filter_t *f, filter_kind_t kind, uint16_t rate_dhz);
uint32_t __real_filter_noise_r_lsb2_q8(const noise_t *n);
uint32_t __wrap_filter_noise_r_lsb2_q8(const noise_t *n);

static void fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("pipeline_replay: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    exit(2);
}

/* The value in the parameter's own format. */
static int32_t stored(const filter_parameter_t *parameter, double value)
{
    if (parameter->fraction_bits == 0 && value != floor(value)) {
        fail("%s=%g: a whole number was expected", parameter->words, value);
    }
    double scaled = round(ldexp(value, parameter->fraction_bits));
    if (!(scaled >= (parameter->min < 0 ? INT32_MIN : 0) && scaled <= INT32_MAX)) {
        fail("%s=%g does not fit into its field", parameter->words, value);
    }
    return (int32_t)scaled;
}

static void apply(const change_t *change, filter_kind_t kind, filter_config_t *config)
{
    const filter_law_t *law = filter_listed(kind);
    if (strcmp(change->name, R_FACTOR) == 0) {
        return; /* not of the configuration */
    }
    for (uint8_t i = 0; i < filter_parameter_count(law); i++) {
        const filter_parameter_t *parameter = filter_parameter(law, i);
        if (strcmp(parameter->words, change->name) == 0) {
            config->value[i] = stored(parameter, change->value);
            return;
        }
    }
    fail("%s has no parameter %s", filter_name(law), change->name);
}

/* The filter with its changed parameters; false when it refuses them. */
static bool start_changed(filter_t *f, filter_kind_t kind, filter_config_t *config, uint16_t rate_dhz)
{
    *config = filter_defaults(filter_listed(kind), rate_dhz);
    for (size_t i = 0; i < change_count; i++) {
        apply(&changes[i], kind, config);
    }
    return filter_init(f, filter_listed(kind), config) == FILTER_ACCEPTED;
}

void __wrap_choice_begin(const filter_choice_t *choice, filter_t *f, filter_kind_t kind, uint16_t rate_dhz)
{
    (void)choice;
    filter_config_t config;
    (void)start_changed(f, kind, &config, rate_dhz); /* check_configuration has asked */
}

uint32_t __wrap_filter_noise_r_lsb2_q8(const noise_t *n)
{
    double r_lsb2_q8 = round(r_factor * __real_filter_noise_r_lsb2_q8(n));
    return (uint32_t)fmin(fmax(r_lsb2_q8, FILTER_R_MIN_LSB2_Q8), FILTER_R_MAX_LSB2_Q8);
}

static void note_r_factor(double factor)
{
    const double most = (double)FILTER_R_MAX_LSB2_Q8 / FILTER_R_MIN_LSB2_Q8;
    if (!(factor >= 1.0 / most && factor <= most)) {
        fail("R=%g: a factor from %g to %g was expected", factor, 1.0 / most, most);
    }
    r_factor = factor;
}

static void note_change(const char *text)
{
    change_t change;
    int used = 0;
    if (sscanf(text, "%15[A-Za-z]=%lf%n", change.name, &change.value, &used) != 2 || text[used] != '\0') {
        fail("%s: NAME=VALUE was expected", text);
    }
    for (size_t i = 0; i < change_count; i++) {
        if (strcmp(change.name, changes[i].name) == 0) {
            fail("%s: %s stands twice", text, change.name);
        }
    }
    if (strcmp(change.name, "r") == 0) {
        fail("%s: the noise estimate sets r: R=FACTOR", text);
    }
    if (change_count == CHANGES_MAX) {
        fail("more than %d parameters", CHANGES_MAX);
    }
    if (strcmp(change.name, R_FACTOR) == 0) {
        note_r_factor(change.value);
    }
    changes[change_count++] = change;
}

static long number(const char *what, const char *text, long low, long high)
{
    char *end;
    long value = strtol(text, &end, 10);
    if (end == text || *end != '\0' || value < low || value > high) {
        fail("%s %s: a number from %ld to %ld was expected", what, text, low, high);
    }
    return value;
}

/* Why values that are in their ranges are refused. */
static const char *refused_together(void)
{
    for (size_t i = 0; i < change_count; i++) {
        double samples = changes[i].value;
        bool legal = samples == 0.0 || samples == 3.0 || samples == 5.0 || samples == 9.0;
        if (strcmp(changes[i].name, "reacquire") == 0 && !legal) {
            return "reacquire: 3, 5, 9 or 0";
        }
    }
    return "values that do not go together";
}

/* The sample path takes what its filter's init says for granted, so it is asked here. */
static void check_configuration(filter_kind_t kind, uint16_t rate_dhz)
{
    filter_config_t config;
    filter_t filter;
    if (!start_changed(&filter, kind, &config, rate_dhz)) {
        const filter_law_t *law = filter_listed(kind);
        filter_answer_t answer = filter_judge(law, &config);
        fail("%s refuses its configuration: %s", filter_name(law),
             answer >= FILTER_REFUSED_FIRST ? filter_parameter(law, (uint8_t)(answer - FILTER_REFUSED_FIRST))->words
                                            : refused_together());
    }
}

static void print_row(void)
{
    row_t row;
    pipeline_finish();
    pipeline_row(&row);
    pipeline_row_done();
    printf("%u,%d,%d,%d,%d,%d,%d,%d,%d,%u\n", (unsigned)row.t_us, row.lsb[0], row.lsb[1], row.lsb[2], row.mg[0],
           row.mg[1], row.mg[2], row.roll_cdeg, row.pitch_cdeg, row.flags);
}

/* A row for each sample, and for each that is missing before it while the filters predict. */
static void filter_and_print(const adxl345_sample_t *sample, uint32_t period_us)
{
    while (coast_due(sample->t_us) && coast_over(period_us, true)) {
        print_row();
    }
    if (coast_sample(sample->t_us, period_us)) {
        pipeline_sample(sample);
        print_row();
    }
}

/* Missing rows are no samples: the sample path finds the gap by the next one's time. */
static void replay(const char *path, uint16_t rate_dhz, size_t skip)
{
    stream_t stream;
    if (!stream_load(&stream, path)) {
        fail("%s", stream.error);
    }
    if (skip >= stream.count) {
        fail("%s: no row to filter: %zu rows, %zu to skip", path, stream.count, skip);
    }
    double rate_hz = rate_dhz / 10.0;
    if (stream.rate_hz > 0.0 && fabs(stream.rate_hz - rate_hz) > rate_hz * RATE_TOLERANCE_PERCENT / 100.0) {
        fail("%s: its rows come at %.1f Hz, which is not within %d %% of %.1f Hz", path, stream.rate_hz,
             RATE_TOLERANCE_PERCENT, rate_hz);
    }
    for (size_t i = skip; i < stream.count; i++) {
        const stream_row_t *row = &stream.rows[i];
        if (!row->missing) {
            adxl345_sample_t sample = { .t_us = (uint32_t)row->t_us, .lsb = { row->lsb[0], row->lsb[1], row->lsb[2] } };
            filter_and_print(&sample, 10000000ul / rate_dhz);
        }
    }
    stream_free(&stream);
}

static bool is_range(long range_g)
{
    return range_g == 2 || range_g == 4 || range_g == 8 || range_g == 16;
}

/* Of the firmware: 12.5 Hz times a power of two, to 800 Hz. */
static bool is_rate(long rate_dhz)
{
    long power = rate_dhz / 125;
    return rate_dhz % 125 == 0 && power >= 1 && power <= 64 && (power & (power - 1)) == 0;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--filters") == 0) {
        for (unsigned kind = 0; kind < FILTER_KIND_COUNT; kind++) {
            puts(filter_listed_name((filter_kind_t)kind));
        }
        return 0;
    }
    if (argc < 6) {
        fprintf(stderr, "usage: pipeline_replay CSV FILTER RATE_DHZ RANGE_G SKIP [NAME=VALUE]... | --filters\n");
        return 2;
    }
    filter_kind_t kind = filter_find(argv[2]);
    if (kind == FILTER_KIND_COUNT) {
        fail("no filter %s", argv[2]);
    }
    uint16_t rate_dhz = (uint16_t)number("rate in 0.1 Hz", argv[3], FILTER_RATE_MIN_DHZ, FILTER_RATE_MAX_DHZ);
    if (!is_rate(rate_dhz)) {
        fail("rate in 0.1 Hz %s: 125, 250, 500, 1000, 2000, 4000 or 8000 was expected", argv[3]);
    }
    uint8_t range_g = (uint8_t)number("range in g", argv[4], 2, 16);
    if (!is_range(range_g)) {
        fail("range in g %s: 2, 4, 8 or 16 was expected", argv[4]);
    }
    for (int i = 6; i < argc; i++) {
        note_change(argv[i]);
    }
    check_configuration(kind, rate_dhz);
    coast_wait(0);
    pipeline_reset();
    settings_defaults();
    pipeline_calibrate(&settings()->calibration);
    settings_take_filter((uint8_t)kind);
    pipeline_forget();
    pipeline_change(&settings()->choice, rate_dhz, range_g);
    pipeline_finish();
    replay(argv[1], rate_dhz, (size_t)number("rows to skip", argv[5], 0, 1000000000));
    return 0;
}
