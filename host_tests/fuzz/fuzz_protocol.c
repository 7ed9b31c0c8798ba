/* docs/protocol.md once more, for judging: written from the document, sharing nothing with firmware/commands.c. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "filter_any.h"
#include "fuzz.h"
#include "fuzz_commands.h"

enum { LINE_MAX = 32, ROW_FLAGS = 0x7FF };

static const char header[] = "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags";
static const double rates_hz[] = { 12.5, 25, 50, 100, 200, 400, 800 };
static const double ranges_g[] = { 2, 4, 8, 16 };
static const double bauds[] = { 9600, 19200, 38400, 57600, 115200, 250000, 500000, 1000000 };

static bool one_of(double value, const double *list, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (value >= list[i] && value <= list[i]) {
            return true;
        }
    }
    return false;
}

bool settings_legal(const settings_t *s)
{
    return s->filter < FILTER_KIND_COUNT && s->mode <= MODE_PLOT && s->every >= 1 && s->every <= 10000 &&
           one_of(s->rate_dhz / 10.0, rates_hz, 7) && one_of(s->range_g, ranges_g, 4) && one_of(s->baud, bauds, 8);
}

void expected_begin(expected_t *e)
{
    memset(e, 0, sizeof *e);
    e->settings = (settings_t){ .baud = 115200, .rate_dhz = 1000, .every = 1, .range_g = 16, .mode = MODE_CSV };
    e->settings.filter = (uint8_t)filter_any_find("adaptive");
}

static void expect(expected_t *e, const char *reply)
{
    FUZZ_CHECK(e->count < EXPECTED_MAX, "more lines than this target holds");
    snprintf(e->reply[e->count++], REPLY_TEXT, "%s", reply);
}

/* Up to seven digits, in tenths with at most one decimal. */
static bool number(const char *text, bool tenths, double *value)
{
    size_t digits = strspn(text, "0123456789");
    const char *rest = text + digits;
    *value = strtod(text, NULL);
    if (tenths && rest[0] == '.' && digits != 0) {
        size_t decimals = strspn(rest + 1, "0123456789");
        return decimals == 1 && rest[2] == '\0' && digits + decimals <= 7;
    }
    return digits != 0 && digits <= 7 && *rest == '\0';
}

static bool set_rate(settings_t *s, double v)
{
    bool legal = one_of(v, rates_hz, 7);
    s->rate_dhz = legal ? (uint16_t)(v * 10.0) : 0;
    return legal;
}

static bool set_range(settings_t *s, double v)
{
    bool legal = one_of(v, ranges_g, 4);
    s->range_g = legal ? (uint8_t)v : 0;
    return legal;
}

static bool set_every(settings_t *s, double v)
{
    bool legal = v >= 1.0 && v <= 10000.0;
    s->every = legal ? (uint16_t)v : 0;
    return legal;
}

static bool set_baud(settings_t *s, double v)
{
    s->baud = (uint32_t)v;
    return one_of(v, bauds, 8);
}

/* What `NAME VALUE` makes of the settings; false: not legal. */
static bool set(settings_t *s, const char *name, const char *value)
{
    static const struct {
        const char *name;
        bool tenths;
        bool (*set)(settings_t *s, double v);
    } numbers[] = { { "rate", true, set_rate },
                    { "range", false, set_range },
                    { "every", false, set_every },
                    { "baud", false, set_baud } };
    double v = 0.0;
    if (strcmp(name, "filter") == 0) {
        s->filter = (uint8_t)filter_any_find(value);
        return s->filter < FILTER_KIND_COUNT;
    }
    if (strcmp(name, "mode") == 0) {
        s->mode = strcmp(value, "plot") == 0 ? MODE_PLOT : MODE_CSV;
        return s->mode == MODE_PLOT || strcmp(value, "csv") == 0;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (strcmp(name, numbers[i].name) == 0) {
            return number(value, numbers[i].tenths, &v) && numbers[i].set(s, v);
        }
    }
    fuzz_fail(__FILE__, __LINE__, "no setting %s", name);
}

static void expect_setting(expected_t *e, const char *name, const char *value)
{
    char reply[REPLY_TEXT];
    settings_t after = e->settings;
    if (value != NULL && !set(&after, name, value)) {
        snprintf(reply, sizeof reply, "# refused: %.8s is one of ", name);
        expect(e, reply);
        return;
    }
    e->baud_changed = e->baud_changed || (value != NULL && strcmp(name, "baud") == 0);
    e->settings = after;
    snprintf(reply, sizeof reply, "# %.8s ", name);
    expect(e, reply);
}

/* A line without leading and trailing blanks, in lower case. */
static void expect_line(expected_t *e, char *line)
{
    static const char *const names[] = { "filter", "rate", "range", "every", "baud", "mode" };
    static const char *const verbs[][2] = {
        { "help", "# filter: " }, { "status", "# state " }, { "stop", "# stopped" }, { "go", "# going" }
    };
    for (size_t i = 0; i < 4; i++) {
        if (strcmp(line, verbs[i][0]) == 0) {
            expect(e, verbs[i][1]);
            return;
        }
    }
    char *value = strchr(line, ' ');
    if (value != NULL) {
        *value++ = '\0';
        value += strspn(value, " ");
    }
    for (size_t i = 0; i < 6; i++) {
        if (strcmp(line, names[i]) == 0) {
            expect_setting(e, names[i], value);
            return;
        }
    }
    expect(e, "# unknown command (type help)");
}

static void end_line(expected_t *e)
{
    bool too_long = e->length > LINE_MAX;
    e->line_ends++;
    while (e->length != 0 && e->line[e->length - 1] == ' ') {
        e->length--;
    }
    e->line[e->length] = '\0';
    if (too_long) {
        expect(e, "# refused: line too long");
    } else if (e->garbage) {
        expect(e, "# refused: characters that no command has");
    } else if (e->length != 0) {
        expect_line(e, e->line);
    }
    e->length = 0;
    e->garbage = false;
}

void expected_byte(expected_t *e, uint8_t byte)
{
    if (byte == '\r' || byte == '\n') {
        end_line(e);
    } else if (byte < 0x20 || byte > 0x7E) {
        e->garbage = true;
    } else if (e->length != 0 || byte != ' ') {
        FUZZ_CHECK(e->length < LINE_TYPED_MAX - 1, "a longer line than this target holds");
        e->line[e->length++] = (char)(byte >= 'A' && byte <= 'Z' ? byte + 32 : byte);
    }
}

/* Columns written as printf would, in their ranges, time going on. */
static bool csv_row(said_t *s, const char *line)
{
    unsigned t_us;
    unsigned flags;
    int v[8];
    if (sscanf(line, "%u,%d,%d,%d,%d,%d,%d,%d,%d,%u", &t_us, &v[0], &v[1], &v[2], &v[3], &v[4], &v[5], &v[6], &v[7],
               &flags) != 10) {
        return false;
    }
    char again[128];
    snprintf(again, sizeof again, "%u,%d,%d,%d,%d,%d,%d,%d,%d,%u", t_us, v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7],
             flags);
    FUZZ_CHECK(strcmp(again, line) == 0 && strlen(line) <= 66, "a row not as printf writes it: %s", line);
    for (int i = 0; i < 3; i++) {
        FUZZ_CHECK(v[i] >= -4096 && v[i] <= 4095 && abs(v[3 + i]) <= 18000, "a value outside its range: %s", line);
    }
    FUZZ_CHECK(v[6] >= -17999 && v[6] <= 18000 && abs(v[7]) <= 9000, "an angle outside its range: %s", line);
    FUZZ_CHECK((flags & ~(unsigned)ROW_FLAGS) == 0, "flags: %s", line);
    FUZZ_CHECK(!s->has_row || (int32_t)(t_us - s->row_us) > 0, "time stands or goes back: %s after %u", line,
               (unsigned)s->row_us);
    s->has_row = true;
    s->row_us = t_us;
    return true;
}

/* `label` and a number with two decimals up to `limit`; returns what follows, NULL when it is not so. */
static const char *degrees(const char *at, const char *label, double limit)
{
    if (at == NULL || strncmp(at, label, strlen(label)) != 0) {
        return NULL;
    }
    at += strlen(label);
    const char *digits = at + (*at == '-');
    size_t whole = strspn(digits, "0123456789");
    if (whole < 1 || whole > 3 || digits[whole] != '.' || strspn(digits + whole + 1, "0123456789") != 2) {
        return NULL;
    }
    double value = strtod(at, NULL);
    return value >= -limit && value <= limit ? digits + whole + 3 : NULL;
}

static bool plot_row(const char *line)
{
    const char *at = degrees(line, "roll_raw:", 180.0);
    at = degrees(at, ",roll:", 180.0);
    at = degrees(at, ",pitch_raw:", 90.0);
    at = degrees(at, ",pitch:", 90.0);
    return at != NULL && (strcmp(at, ",gated:0") == 0 || strcmp(at, ",gated:1") == 0);
}

bool said_line(said_t *s, const char *line)
{
    if (csv_row(s, line) || plot_row(line)) {
        return false;
    }
    if (*line == '\0') {
        FUZZ_CHECK(s->banner_lines == 0, "an empty line after the banner's first");
        return false;
    }
    FUZZ_CHECK(strcmp(line, header) == 0 || strncmp(line, "# ", 2) == 0, "neither row nor reply: '%s'", line);
    FUZZ_CHECK(strlen(line) < 120, "a reply of %zu bytes: %s", strlen(line), line);
    for (const char *c = line; *c != '\0'; c++) {
        FUZZ_CHECK(*c >= ' ' && *c <= '~', "byte 0x%02X in a reply", (unsigned)(uint8_t)*c);
    }
    FUZZ_CHECK(s->faults_expected || strncmp(line, "# fault ", 8) != 0, "a fault is told: %s", line);
    s->banner_lines++;
    return true;
}

void said_reply(said_t *s, const char *line)
{
    FUZZ_CHECK(s->count < REPLIES_MAX, "more replies than this target holds");
    if (strncmp(line, "# fault ", 8) != 0) {
        snprintf(s->reply[s->count++], REPLY_TEXT, "%.79s", line);
    }
}

static bool begins(const char *line, const char *words)
{
    return strncmp(line, words, strlen(words)) == 0;
}

/* Lines of a reply after its first: those that must follow, and whether one more may. */
static unsigned lines_after(const char *first, const char **optional)
{
    *optional = NULL;
    if (begins(first, "# rate ") || begins(first, "# baud ") || begins(first, "# filter ")) {
        *optional = "# every ";
    } else if (begins(first, "# mode csv")) {
        *optional = header;
    }
    return begins(first, "# filter: ") ? 6 : (begins(first, "# state ") ? 6 : 0);
}

/* Whether reply line i, if there is one, begins so. */
static bool reply_begins(const said_t *s, unsigned i, const char *words)
{
    return i < s->count && begins(s->reply[i], words);
}

/*
 * From reply line i and expectation j on. A second line of `rate`, `baud` and `filter` comes only where line or time
 * force another decimation, and looks like the reply to `every`: both readings are tried, the longer first.
 */
static bool matches(const said_t *s, unsigned i, const expected_t *e, unsigned j)
{
    for (; j < e->count; j++) {
        const char *optional;
        if (!reply_begins(s, i, e->reply[j])) {
            return false;
        }
        i += 1 + lines_after(s->reply[i], &optional);
        if (optional == NULL || !reply_begins(s, i, optional)) {
            continue;
        }
        bool as_own_reply = j + 1 < e->count && begins(s->reply[i], e->reply[j + 1]);
        if (!as_own_reply) {
            i++;
        } else if (matches(s, i + 1, e, j + 1)) {
            return true;
        }
    }
    return i == s->count;
}

void check_replies(const said_t *s, const expected_t *e)
{
    if (matches(s, 0, e, 0)) {
        return;
    }
    for (unsigned j = 0; j < e->count; j++) {
        fprintf(stderr, "expected: %s\n", e->reply[j]);
    }
    for (unsigned i = 0; i < s->count; i++) {
        fprintf(stderr, "got: %s\n", s->reply[i]);
    }
    fuzz_fail(__FILE__, __LINE__, "replies are not those expected");
}

unsigned count_replies(const said_t *s)
{
    unsigned count = 0;
    for (unsigned i = 0; i < s->count; count++) {
        const char *optional;
        i += 1 + lines_after(s->reply[i], &optional);
        while (optional != NULL && i < s->count && begins(s->reply[i], optional)) {
            i++;
        }
    }
    return count;
}
