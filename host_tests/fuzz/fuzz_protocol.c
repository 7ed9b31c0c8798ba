/* docs/protocol.md once more, for judging: written from the document, sharing nothing with commands.c. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "filter_list.h"
#include "fuzz.h"
#include "fuzz_commands.h"

enum { SETTINGS = FUZZ_SETTINGS, LINE_MAX = 40 };

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
    return s->choice.filter < FILTER_KIND_COUNT && s->mode <= MODE_PLOT &&
           (s->i2c == 0 || s->i2c == 32 || s->i2c == 48) && s->every >= 1 && s->every <= 10000 &&
           one_of(s->rate_dhz / 10.0, rates_hz, 7) && one_of(s->range_g, ranges_g, 4) && one_of(s->baud, bauds, 8);
}

static bool calibrations_equal(const calibration_t *a, const calibration_t *b)
{
    return memcmp(a->offset_lsb_q4, b->offset_lsb_q4, 6) == 0 &&
           memcmp(a->scale_lsb_per_g_uq6, b->scale_lsb_per_g_uq6, 6) == 0 && memcmp(a->axes, b->axes, 3) == 0 &&
           memcmp(a->level_q14, b->level_q14, 6) == 0;
}

bool settings_equal(const settings_t *a, const settings_t *b)
{
    for (unsigned i = 0; i < CHOICE_PARAMETERS_MAX; i++) {
        if ((a->choice.own >> i & 1u) && a->choice.parameters[i] != b->choice.parameters[i]) {
            return false;
        }
    }
    return calibrations_equal(&a->calibration, &b->calibration) && a->choice.own == b->choice.own &&
           a->baud == b->baud && a->rate_dhz == b->rate_dhz && a->every == b->every && a->range_g == b->range_g &&
           a->mode == b->mode && a->address == b->address && a->i2c == b->i2c && a->choice.filter == b->choice.filter;
}

static settings_t defaults(void)
{
    settings_t s = { .baud = 115200, .rate_dhz = 1000, .every = 1, .range_g = 16, .mode = MODE_CSV };
    s.choice.filter = 0; /* the first of the list */
    for (int8_t i = 0; i < 3; i++) {
        s.calibration.scale_lsb_per_g_uq6[i] = (i < 2 ? 265 : 256) * 64;
        s.calibration.axes[i] = (int8_t)(i + 1);
    }
    s.calibration.level_q14[2] = 16384;
    return s;
}

void expected_begin(expected_t *e)
{
    memset(e, 0, sizeof *e);
    e->settings = defaults();
    e->sampling = true;
}

static void expect(expected_t *e, const char *reply)
{
    FUZZ_CHECK(e->count < EXPECTED_MAX, "more lines than this target holds");
    snprintf(e->reply[e->count++], REPLY_TEXT, "%s", reply);
}

/*
 * A sign, digits, and where there are fraction bits perhaps a point and one to four digits: below 2^31 without the
 * point in units of the last fraction bit, and taken to the nearest of these.
 */
bool expected_number(const char *text, unsigned fraction_bits, double *value)
{
    double sign = *text == '-' ? -1.0 : 1.0;
    const char *first = text + (*text == '-');
    size_t digits = strspn(first, "0123456789");
    const char *rest = first + digits;
    double one = (double)(1ul << fraction_bits);
    double written = strtod(first, NULL);
    double without_point = written;
    if (rest[0] == '.' && fraction_bits != 0) {
        size_t decimals = strspn(rest + 1, "0123456789");
        if (decimals < 1 || decimals > 4) {
            return false;
        }
        rest += 1 + decimals;
        for (; decimals != 0; decimals--) {
            without_point *= 10.0;
        }
    }
    *value = sign * floor(written * one + 0.5) / one;
    return digits != 0 && *rest == '\0' && floor(without_point + 0.5) <= floor(2147483647.0 / one);
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

/* The value at the index of the word, of three; the last one if it is none of them. */
static bool one_word(const char *value, const char *const words[3], const uint8_t values[3], uint8_t *to)
{
    size_t i = 0;
    while (i < 2 && strcmp(value, words[i]) != 0) {
        i++;
    }
    *to = values[i];
    return strcmp(value, words[i]) == 0;
}

/* What `NAME VALUE` makes of the settings; false: not legal. */
static bool set(settings_t *s, const char *name, const char *value)
{
    static const struct {
        const char *name;
        unsigned fraction_bits;
        bool (*set)(settings_t *s, double v);
    } numbers[] = {
        { "rate", 6, set_rate }, { "range", 0, set_range }, { "every", 0, set_every }, { "baud", 0, set_baud }
    };
    const struct {
        const char *name;
        const char *words[3];
        uint8_t values[3];
        uint8_t *to;
    } words[] = { { "address", { "auto", "53", "1d" }, { 0, 0x53, 0x1D }, &s->address },
                  { "i2c", { "auto", "100", "400" }, { 0, 48, 32 }, &s->i2c },
                  { "mode", { "plot", "csv", "csv" }, { MODE_PLOT, MODE_CSV, MODE_CSV }, &s->mode } };
    double v = 0.0;
    if (strcmp(name, "filter") == 0) {
        uint8_t filter = (uint8_t)filter_find(value);
        if (filter != s->choice.filter) { /* the one in force keeps its parameters */
            s->choice.own = 0;
        }
        s->choice.filter = filter;
        return filter < FILTER_KIND_COUNT;
    }
    if (strcmp(name, "axes") == 0) {
        return expected_axes(s, value);
    }
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strcmp(name, words[i].name) == 0) {
            return one_word(value, words[i].words, words[i].values, words[i].to);
        }
    }
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (strcmp(name, numbers[i].name) == 0) {
            return expected_number(value, numbers[i].fraction_bits, &v) && numbers[i].set(s, v);
        }
    }
    fuzz_fail(__FILE__, __LINE__, "no setting %s", name);
}

static void expect_setting(expected_t *e, const char *name, const char *value)
{
    char reply[REPLY_TEXT];
    settings_t after = e->settings;
    if (value != NULL && !set(&after, name, value)) {
        snprintf(reply, sizeof reply, "# refused 4: %.8s is one of ", name);
        expect(e, reply);
        return;
    }
    e->baud_changed = e->baud_changed || (value != NULL && strcmp(name, "baud") == 0);
    e->settings = after;
    snprintf(reply, sizeof reply, "# %.8s ", name);
    expect(e, reply);
}

static void expect_lines(expected_t *e, const char *first, unsigned lines)
{
    expect(e, first);
    e->lines_after[e->count - 1] = lines - 1;
}

/* A saved baud rate may be another than the one in force. */
static void take_settings(expected_t *e, settings_t taken)
{
    e->baud_changed = true;
    e->settings = taken;
}

static bool expect_measuring(expected_t *e, const char *line)
{
    static const char *const names[] = { "selftest", "noise", "odr", "tare", "cal", "cal6" };
    size_t length = strcspn(line, " ");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strlen(names[i]) == length && strncmp(line, names[i], length) == 0) {
            e->measures = true;
        }
    }
    return e->measures;
}

static bool expect_verb(expected_t *e, const char *line)
{
    unsigned parameters = filter_parameter_count(filter_listed((filter_kind_t)e->settings.choice.filter));
    if (strcmp(line, "help") == 0 || strcmp(line, "?") == 0) {
        expect_lines(e, "# filter: ", SETTINGS + FUZZ_VECTORS + parameters + 1);
    } else if (strcmp(line, "version") == 0) {
        expect(e, "# tilt-uno ");
    } else if (strcmp(line, "status") == 0) {
        expect_lines(e, "# state ", 7);
    } else if (strcmp(line, "settings") == 0) {
        expect_lines(e, "# filter ", SETTINGS + FUZZ_VECTORS + parameters);
    } else if (strcmp(line, "stop") == 0) {
        e->sampling = false;
        expect(e, "# stopped");
    } else if (strcmp(line, "go") == 0) {
        e->sampling = true;
        expect(e, "# going");
    } else if (strcmp(line, "save") == 0) {
        e->has_saved = true;
        e->saved = e->settings;
        expect(e, "# saved");
    } else if (strcmp(line, "load") == 0) {
        take_settings(e, e->has_saved ? e->saved : defaults());
        expect(e, e->has_saved ? "# settings: as saved" : "# settings: defaults, none saved");
    } else if (strcmp(line, "defaults") == 0) {
        take_settings(e, defaults());
        expect(e, "# settings: defaults");
    } else {
        return false;
    }
    return true;
}

/* A line without leading and trailing blanks, in lower case. */
static void expect_line(expected_t *e, char *line)
{
    static const char *const names[SETTINGS] = { "filter", "rate",    "range", "every", "baud",
                                                 "mode",   "address", "i2c",   "axes" };
    if (expect_measuring(e, line) || expect_verb(e, line)) {
        return;
    }
    char *value = strchr(line, ' ');
    if (value != NULL) {
        *value++ = '\0';
        value += strspn(value, " ");
    }
    for (size_t i = 0; i < SETTINGS; i++) {
        if (strcmp(line, names[i]) == 0) {
            expect_setting(e, names[i], value);
            return;
        }
    }
    char reply[REPLY_TEXT];
    if (expected_vector(&e->settings, line, value, reply) || expected_parameter(&e->settings, line, value, reply)) {
        expect(e, reply);
        return;
    }
    expect(e, "# refused 1: unknown command (type help)");
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
        expect(e, "# refused 2: line too long");
    } else if (e->garbage) {
        expect(e, "# refused 3: illegal characters");
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
