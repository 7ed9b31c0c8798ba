/* What the board may send, by docs/protocol.md, and whether the replies are those expected. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "filter_list.h"
#include "fuzz.h"
#include "fuzz_commands.h"
#include "settings/settings_table.h"

_Static_assert(SETTING_PARAMETERS == FUZZ_SETTINGS + FUZZ_VECTORS, "a setting was added: add it to fuzz_protocol.c");

enum { ROW_FLAGS = 0x7FF };

static const char header[] = "t_us,x_lsb,y_lsb,z_lsb,x_mg,y_mg,z_mg,roll_cdeg,pitch_cdeg,flags";

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
    FUZZ_CHECK(strlen(line) < TEXT_LINE_MAX, "a reply of %zu bytes: %s", strlen(line), line);
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
    if (strncmp(line, "# fault ", 8) != 0 && strcmp(line, "# limited: q by r") != 0) {
        snprintf(s->reply[s->count++], REPLY_TEXT, "%.79s", line);
    }
}

static bool begins(const char *line, const char *words)
{
    return strncmp(line, words, strlen(words)) == 0;
}

/* A line that may follow a reply of one line; NULL when none may. */
static void find_optional(const char *first, const char **optional)
{
    *optional = NULL;
    if (begins(first, "# rate ") || begins(first, "# baud ") || begins(first, "# filter ")) {
        *optional = "# every ";
    } else if (begins(first, "# mode csv") || begins(first, "# settings: ")) {
        *optional = header;
    }
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
        find_optional(s->reply[i], &optional);
        i += 1 + e->lines_after[j];
        if (optional == NULL || e->lines_after[j] != 0 || !reply_begins(s, i, optional)) {
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

/* Lines that follow reply line i for certain, by the words alone. The answer to help ends with the list of verbs. */
static unsigned lines_after(const said_t *s, unsigned i)
{
    char name[16];
    const char *first = s->reply[i];
    if (begins(first, "# filter: ")) {
        unsigned last = i;
        while (last + 1 < s->count && !begins(s->reply[last], "# stop, go, ")) {
            last++;
        }
        return last - i;
    }
    if (begins(first, "# state ")) {
        return 6;
    }
    if (sscanf(first, "# filter %15[^: ]: ", name) != 1 || strchr(first, ':') == NULL) {
        return 0;
    }
    return FUZZ_SETTINGS + FUZZ_VECTORS - 1 + filter_parameter_count(filter_listed(filter_find(name)));
}

unsigned count_replies(const said_t *s)
{
    unsigned count = 0;
    for (unsigned i = 0; i < s->count; count++) {
        const char *optional;
        unsigned after = lines_after(s, i);
        find_optional(s->reply[i], &optional);
        i += 1 + after;
        while (after == 0 && optional != NULL && i < s->count && begins(s->reply[i], optional)) {
            i++;
        }
    }
    return count;
}
