/*
 * The protocol as its document has it, apart from the firmware: what a typed line must be answered with, what may be
 * sent.
 */
#ifndef FUZZ_COMMANDS_H
#define FUZZ_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/settings.h"

/* Settings with a name of their own, without the parameters of the filter. */
enum { FUZZ_SETTINGS = 9, FUZZ_VECTORS = 3 };

enum { EXPECTED_MAX = 256, REPLIES_MAX = 1024, REPLY_TEXT = 80, LINE_TYPED_MAX = 512 };

/* What was typed, as the replies it must get. */
typedef struct {
    settings_t settings, saved;
    bool has_saved;
    bool measures; /* a command that answers when the board has lain still */
    bool sampling;
    bool baud_changed;
    unsigned line_ends; /* blank lines are not answered, unless a byte was lost in one */
    unsigned count;
    char reply[EXPECTED_MAX][REPLY_TEXT]; /* how the first line begins */
    unsigned lines_after[EXPECTED_MAX];   /* that follow it for certain */
    char line[LINE_TYPED_MAX];
    unsigned length;
    bool garbage;
} expected_t;

void expected_begin(expected_t *e);
void expected_byte(expected_t *e, uint8_t byte);

/* The number that a text is for the board; false: none. */
bool expected_number(const char *text, unsigned fraction_bits, double *value);

/*
 * `offset 1 2 3`, or `gate` and `gate 3`, with the settings that it leaves and how the reply begins; false when the
 * filter has no such parameter.
 */
bool expected_vector(settings_t *s, const char *name, const char *value, char reply[REPLY_TEXT]);

/* `axes VALUE`; false: not legal. */
bool expected_axes(settings_t *s, const char *value);

bool expected_parameter(settings_t *s, const char *name, const char *value, char reply[REPLY_TEXT]);

/* What was sent. */
typedef struct {
    bool faults_expected;
    unsigned banner_lines;
    unsigned count;
    char reply[REPLIES_MAX][REPLY_TEXT]; /* lines that begin with '#', and headers */
    bool has_row;
    uint32_t row_us;
} said_t;

/* Checks a line against the grammar; true when it is no row. */
bool said_line(said_t *s, const char *line);
void said_reply(said_t *s, const char *line);

/* All replies are those expected, in order. */
void check_replies(const said_t *s, const expected_t *e);

/* Replies, each counted once whatever its number of lines. */
unsigned count_replies(const said_t *s);

bool settings_legal(const settings_t *s);

/* All that can be typed. */
bool settings_equal(const settings_t *a, const settings_t *b);

#endif
