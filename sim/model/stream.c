/* The whole file is read into memory and cut into lines in place; each line is cut into fields in place. */
#include "stream.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_MAX = 64, LSB_MIN = -4096, LSB_MAX = 4095, CDEG_MAX = 18000, FLAG_COASTED = 2, FLAG_FAULT = 16 };

#define TIME_MAX INT64_C(1000000000000000) /* 31 years in us: unwrapped times stay far from the limit of 64 bits */
#define WRAP_US (INT64_C(1) << 32)
#define WRAP_STEP_US (INT64_C(1) << 31)

enum column { COLUMN_T, COLUMN_X, COLUMN_Y, COLUMN_Z, COLUMN_ROLL, COLUMN_PITCH, COLUMN_FLAGS, COLUMN_COUNT };

static const char *const column_name[COLUMN_COUNT] = { "t_us", "x", "y", "z", "roll_true_cdeg", "pitch_true_cdeg",
                                                       "flags" };

typedef struct {
    stream_t *stream;
    const char *path;
    uint32_t line;
    size_t capacity;
    bool has_header;
    size_t column_count;
    int index[COLUMN_COUNT]; /* field of each column, -1: absent */
    bool segment_begins;
    int64_t wrap_us; /* added to the file's times in this segment */
    int64_t segment_first_us;
    int64_t last_raw_us;
} reader_t;

static bool fail(reader_t *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool fail(reader_t *r, const char *format, ...)
{
    char reason[160];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    size_t keep = strlen(r->path) > 70 ? strlen(r->path) - 70 : 0; /* the end of a long path is more useful */
    snprintf(r->stream->error, sizeof r->stream->error, "%s:%u: %s", r->path + keep, (unsigned)r->line, reason);
    return false;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static char *trim(char *text)
{
    while (is_blank(*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length != 0 && is_blank(text[length - 1])) {
        length--;
    }
    text[length] = '\0';
    return text;
}

/* Splits at commas; returns the number of fields, COLUMNS_MAX + 1 if there are more than COLUMNS_MAX. */
static size_t split(char *line, char *field[COLUMNS_MAX])
{
    size_t count = 0;
    char *at = line;
    while (at != NULL) {
        if (count == COLUMNS_MAX) {
            return COLUMNS_MAX + 1;
        }
        char *comma = strchr(at, ',');
        if (comma != NULL) {
            *comma = '\0';
        }
        field[count++] = trim(at);
        at = comma == NULL ? NULL : comma + 1;
    }
    return count;
}

static bool parse_integer(const char *text, int64_t *value)
{
    char *end;
    errno = 0;
    long long parsed = strtoll(text, &end, 10);
    *value = parsed;
    return *text != '\0' && *end == '\0' && errno == 0;
}

/* x and x_lsb are the same column; the first one wins if a file has both. */
static int column_of(const char *name)
{
    for (int c = 0; c < COLUMN_COUNT; c++) {
        if (strcmp(name, column_name[c]) == 0) {
            return c;
        }
    }
    if (strlen(name) == 5 && strcmp(name + 1, "_lsb") == 0 && name[0] >= 'x' && name[0] <= 'z') {
        return COLUMN_X + (name[0] - 'x');
    }
    return -1;
}

static bool looks_like_header(const char *line)
{
    return strncmp(line, "t_us,", 5) == 0 || strstr(line, ",t_us") != NULL;
}

static bool read_header(reader_t *r, char *line)
{
    char *field[COLUMNS_MAX];
    r->column_count = split(line, field);
    if (r->column_count > COLUMNS_MAX) {
        return fail(r, "more than %d columns", COLUMNS_MAX);
    }
    for (int c = 0; c < COLUMN_COUNT; c++) {
        r->index[c] = -1;
    }
    for (size_t i = 0; i < r->column_count; i++) {
        int c = column_of(field[i]);
        if (c >= 0 && r->index[c] < 0) {
            r->index[c] = (int)i;
        }
    }
    for (int c = COLUMN_T; c <= COLUMN_Z; c++) {
        if (r->index[c] < 0) {
            return fail(r, "missing column %s%s", column_name[c],
                        r->has_header ? ""
                                      : " (a header with t_us and x,y,z or x_lsb,y_lsb,z_lsb comes first): "
                                        "tilt import FILE converts other recordings");
        }
    }
    r->has_header = true;
    bool truth = r->index[COLUMN_ROLL] >= 0 && r->index[COLUMN_PITCH] >= 0;
    if (r->stream->count != 0 && truth != r->stream->has_truth) {
        return fail(r, "the truth columns come or go in the middle of the file");
    }
    r->stream->has_truth = truth;
    r->segment_begins = true;
    r->wrap_us = 0;
    return true;
}

static bool bounded(reader_t *r, char *field[], int column, int64_t low, int64_t high, int64_t *value)
{
    const char *text = field[r->index[column]];
    if (!parse_integer(text, value)) {
        return fail(r, "%s is not a whole number: '%.40s'%s", column_name[column], text,
                    strchr(text, '.') == NULL ? "" : ": tilt import FILE converts other units");
    }
    if (*value < low || *value > high) {
        return fail(r, "%s is outside %lld..%lld: %lld", column_name[column], (long long)low, (long long)high,
                    (long long)*value);
    }
    return true;
}

/* Undoes the wrap of a 32-bit microsecond counter and counts from the segment's first row. */
static bool unwrap(reader_t *r, int64_t raw_us, uint64_t *t_us)
{
    if (r->segment_begins) {
        r->segment_first_us = raw_us;
        r->last_raw_us = raw_us;
        r->segment_begins = false;
    }
    if (raw_us < r->last_raw_us) {
        int64_t back = r->last_raw_us - raw_us;
        if (back <= WRAP_STEP_US || r->last_raw_us >= WRAP_US) {
            return fail(r, "time goes backwards: %lld after %lld", (long long)raw_us, (long long)r->last_raw_us);
        }
        r->wrap_us += WRAP_US;
    }
    r->last_raw_us = raw_us;
    *t_us = (uint64_t)(raw_us + r->wrap_us - r->segment_first_us);
    return true;
}

static bool append(reader_t *r, const stream_row_t *row)
{
    stream_t *stream = r->stream;
    if (stream->count == r->capacity) {
        size_t capacity = r->capacity == 0 ? 1024 : 2 * r->capacity;
        stream_row_t *grown = realloc(stream->rows, capacity * sizeof *grown);
        if (grown == NULL) {
            return fail(r, "out of memory");
        }
        stream->rows = grown;
        r->capacity = capacity;
    }
    stream->rows[stream->count++] = *row;
    return true;
}

static bool read_row(reader_t *r, char *line)
{
    char *field[COLUMNS_MAX];
    size_t count = split(line, field);
    if (count != r->column_count) {
        return fail(r, "%zu%s fields where the header has %zu", count, count > COLUMNS_MAX ? " or more" : "",
                    r->column_count);
    }
    stream_row_t row = { .line = r->line, .begins_segment = r->segment_begins };
    int64_t value;
    if (!bounded(r, field, COLUMN_T, 0, TIME_MAX, &value) || !unwrap(r, value, &row.t_us)) {
        return false;
    }
    for (int axis = 0; axis < 3; axis++) {
        if (!bounded(r, field, COLUMN_X + axis, LSB_MIN, LSB_MAX, &value)) {
            return false;
        }
        row.lsb[axis] = (int16_t)value;
    }
    for (int i = 0; i < 2 && r->stream->has_truth; i++) {
        if (!bounded(r, field, COLUMN_ROLL + i, -CDEG_MAX, CDEG_MAX, &value)) {
            return false;
        }
        row.truth_cdeg[i] = (int16_t)value;
    }
    if (r->index[COLUMN_FLAGS] >= 0) {
        if (!bounded(r, field, COLUMN_FLAGS, 0, UINT16_MAX, &value)) {
            return false;
        }
        row.missing = (value & (FLAG_COASTED | FLAG_FAULT)) != 0;
    }
    return append(r, &row);
}

static bool read_line(reader_t *r, char *line)
{
    line = trim(line);
    if (*line == '\0' || *line == '#') {
        return true;
    }
    if (!r->has_header || looks_like_header(line)) {
        return read_header(r, line);
    }
    return read_row(r, line);
}

static bool read_lines(reader_t *r, char *text, size_t length)
{
    char *end = text + length;
    char *at = text;
    if (length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) {
        at += 3;
    }
    while (at < end) {
        r->line++;
        char *newline = memchr(at, '\n', (size_t)(end - at));
        char *line_end = newline == NULL ? end : newline;
        if (memchr(at, '\0', (size_t)(line_end - at)) != NULL) {
            return fail(r, "a NUL byte: no text, or UTF-16, which tilt import FILE converts");
        }
        *line_end = '\0';
        if (!read_line(r, at)) {
            return false;
        }
        at = line_end + 1;
    }
    if (length == 0 || !r->has_header) {
        r->line = r->line == 0 ? 1 : r->line;
        return fail(r, length == 0 ? "the file is empty" : "no header");
    }
    return r->stream->count != 0 || fail(r, "no rows after the header");
}

static int compare_steps(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a;
    uint64_t y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Median step inside the segments, us; 0 if there is none. */
static bool median_step(reader_t *r, uint64_t *step_us)
{
    const stream_t *stream = r->stream;
    *step_us = 0;
    uint64_t *steps = malloc(stream->count * sizeof *steps);
    if (steps == NULL) {
        return fail(r, "out of memory");
    }
    size_t count = 0;
    for (size_t i = 1; i < stream->count; i++) {
        if (!stream->rows[i].begins_segment) {
            steps[count++] = stream->rows[i].t_us - stream->rows[i - 1].t_us;
        }
    }
    if (count != 0) {
        qsort(steps, count, sizeof *steps, compare_steps);
        *step_us = steps[count / 2];
    }
    free(steps);
    return true;
}

/* Each segment begins one period after the last row of the previous one. */
static bool join_segments(reader_t *r)
{
    stream_t *stream = r->stream;
    uint64_t step_us;
    if (!median_step(r, &step_us)) {
        return false;
    }
    stream->rate_hz = step_us == 0 ? 0.0 : 1e6 / (double)step_us;
    uint64_t offset = 0;
    for (size_t i = 1; i < stream->count; i++) {
        if (stream->rows[i].begins_segment) {
            offset = stream->rows[i - 1].t_us + step_us;
        }
        stream->rows[i].t_us += offset;
    }
    return true;
}

/* NULL after fail(). */
static char *read_whole(reader_t *r, FILE *file, size_t *length)
{
    bool seekable = fseek(file, 0, SEEK_END) == 0;
    long end = seekable ? ftell(file) : -1;
    if (end < 0 || fseek(file, 0, SEEK_SET) != 0) {
        (void)fail(r, "cannot read: %s", strerror(errno));
        return NULL;
    }
    char *text = malloc((size_t)end + 1);
    *length = text == NULL ? 0 : fread(text, 1, (size_t)end, file);
    if (text == NULL || *length != (size_t)end) {
        (void)fail(r, ferror(file) ? "cannot be read: is it a file?" : "out of memory");
        free(text);
        return NULL;
    }
    return text;
}

bool stream_load(stream_t *stream, const char *path)
{
    memset(stream, 0, sizeof *stream);
    reader_t reader = { .stream = stream, .path = path };
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return fail(&reader, "cannot open: %s", strerror(errno));
    }
    size_t length;
    char *text = read_whole(&reader, file, &length);
    fclose(file);
    bool good = text != NULL && read_lines(&reader, text, length) && join_segments(&reader);
    free(text);
    if (!good) {
        stream_free(stream);
    }
    return good;
}

void stream_free(stream_t *stream)
{
    free(stream->rows);
    stream->rows = NULL;
    stream->count = 0;
}
