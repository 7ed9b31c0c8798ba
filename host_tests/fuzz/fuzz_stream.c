/*
 * Any bytes as a recording (sim/model/stream.c). A refusal names file and line; what is accepted is within the
 * documented ranges and says the same when it is written as a stream again and read back; and the feed gives the rows
 * it should.
 */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "feed.h"
#include "fuzz.h"

enum { FEED_TICKS = 300 };

static int memory_file = -1;
static char memory_path[40];

static void write_file(const void *bytes, size_t size)
{
    if (memory_file < 0) {
        memory_file = memfd_create("stream", 0);
        FUZZ_CHECK(memory_file >= 0, "no memory file");
        snprintf(memory_path, sizeof memory_path, "/proc/self/fd/%d", memory_file);
    }
    FUZZ_CHECK(ftruncate(memory_file, 0) == 0 && pwrite(memory_file, bytes, size, 0) == (ssize_t)size, "cannot write");
}

static void check_error(const stream_t *stream, const uint8_t *data, size_t size)
{
    size_t lines = 1;
    for (size_t i = 0; i < size; i++) {
        lines += data[i] == '\n';
    }
    size_t path_length = strlen(memory_path);
    unsigned line = 0;
    int reason_at = 0;
    FUZZ_CHECK(strncmp(stream->error, memory_path, path_length) == 0, "no file named: %s", stream->error);
    FUZZ_CHECK(sscanf(stream->error + path_length, ":%u: %n", &line, &reason_at) == 1 && reason_at != 0,
               "no line named: %s", stream->error);
    FUZZ_CHECK(line >= 1 && line <= lines, "line %u of %zu: %s", line, lines, stream->error);
    FUZZ_CHECK(stream->error[path_length + (size_t)reason_at] != '\0', "no reason: %s", stream->error);
    FUZZ_CHECK(strchr(stream->error, '\n') == NULL, "an error of several lines");
    FUZZ_CHECK(stream->rows == NULL && stream->count == 0, "a refused stream has rows");
}

static void check_rows(const stream_t *stream)
{
    FUZZ_CHECK(stream->count != 0 && stream->error[0] == '\0', "accepted without rows, or with an error");
    FUZZ_CHECK(stream->rows[0].t_us == 0, "the first row is at %llu", (unsigned long long)stream->rows[0].t_us);
    FUZZ_CHECK(stream->rate_hz >= 0.0 && stream->rate_hz <= 1e6, "rate %g", stream->rate_hz);
    for (size_t i = 0; i < stream->count; i++) {
        const stream_row_t *row = &stream->rows[i];
        FUZZ_CHECK(i == 0 || row->t_us >= row[-1].t_us, "row %zu steps back", i);
        for (int axis = 0; axis < 3; axis++) {
            FUZZ_CHECK(row->lsb[axis] >= -4096 && row->lsb[axis] <= 4095, "row %zu has %d LSB", i, row->lsb[axis]);
        }
        FUZZ_CHECK(abs(row->truth_cdeg[0]) <= 18000 && abs(row->truth_cdeg[1]) <= 18000, "truth of row %zu", i);
    }
}

/* As a stream again: each segment counts from its own 0 under a header of its own. */
static char *write_again(const stream_t *stream, size_t *length)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, length);
    FUZZ_CHECK(file != NULL, "out of memory");
    uint64_t segment_us = 0;
    for (size_t i = 0; i < stream->count; i++) {
        const stream_row_t *row = &stream->rows[i];
        if (i == 0 || row->begins_segment) {
            fprintf(file, "t_us,x_lsb,y_lsb,z_lsb,flags%s\n",
                    stream->has_truth ? ",roll_true_cdeg,pitch_true_cdeg" : "");
            segment_us = row->t_us;
        }
        fprintf(file, "%llu,%d,%d,%d,%d", (unsigned long long)(row->t_us - segment_us), row->lsb[0], row->lsb[1],
                row->lsb[2], row->missing ? 2 : 0);
        if (stream->has_truth) {
            fprintf(file, ",%d,%d", row->truth_cdeg[0], row->truth_cdeg[1]);
        }
        fputc('\n', file);
    }
    fclose(file);
    return text;
}

static void check_same(const stream_t *a, const stream_t *b)
{
    FUZZ_CHECK(a->count == b->count && a->has_truth == b->has_truth, "%zu rows, read again %zu", a->count, b->count);
    FUZZ_CHECK(a->rate_hz >= b->rate_hz && a->rate_hz <= b->rate_hz, "%g Hz, read again %g", a->rate_hz, b->rate_hz);
    for (size_t i = 0; i < a->count; i++) {
        const stream_row_t *x = &a->rows[i];
        const stream_row_t *y = &b->rows[i];
        FUZZ_CHECK(x->t_us == y->t_us, "row %zu: %llu us, read again %llu", i, (unsigned long long)x->t_us,
                   (unsigned long long)y->t_us);
        FUZZ_CHECK(memcmp(x->lsb, y->lsb, sizeof x->lsb) == 0, "samples of row %zu", i);
        FUZZ_CHECK(memcmp(x->truth_cdeg, y->truth_cdeg, sizeof x->truth_cdeg) == 0, "truth of row %zu", i);
        FUZZ_CHECK(x->missing == y->missing && x->begins_segment == y->begins_segment, "marks of row %zu", i);
    }
}

/*
 * Row per tick or the row in force: an index of the stream, in order until it begins again, and an end when it does
 * not.
 */
static void check_feed(const stream_t *stream, double odr_hz, bool loop)
{
    feed_t feed = { .stream = stream, .loop = loop };
    feed_set_rate(&feed, stream, odr_hz, 0);
    bool in_order = feed.mode == FEED_ROW_PER_TICK;
    size_t last = stream->count;
    for (unsigned tick = 0; tick < FEED_TICKS; tick++) {
        size_t row = stream->count;
        feed_result_t result = feed_tick(&feed, (uint64_t)((tick + 1.0) * 1e6 / odr_hz), &row);
        if (result == FEED_END) {
            FUZZ_CHECK(!loop, "a loop has no end");
            return;
        }
        if (result != FEED_SAMPLE) {
            continue;
        }
        FUZZ_CHECK(row < stream->count && !stream->rows[row].missing, "tick %u gives row %zu of %zu", tick, row,
                   stream->count);
        FUZZ_CHECK(!in_order || loop || last == stream->count || row > last, "row %zu after %zu", row, last);
        last = row;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double rates_hz[] = { 12.5, 100.0, 800.0 };
    stream_t first;
    write_file(data, size);
    if (!stream_load(&first, memory_path)) {
        check_error(&first, data, size);
        return 0;
    }
    check_rows(&first);
    for (size_t i = 0; i < 3; i++) {
        check_feed(&first, rates_hz[i], false);
        check_feed(&first, rates_hz[i], true);
    }
    check_feed(&first, first.rate_hz > 0.0 ? first.rate_hz : 100.0, false);
    size_t length;
    char *text = write_again(&first, &length);
    write_file(text, length);
    stream_t second;
    FUZZ_CHECK(stream_load(&second, memory_path), "not read again: %s\n%s", second.error, text);
    check_same(&first, &second);
    free(text);
    stream_free(&first);
    stream_free(&second);
    return 0;
}
