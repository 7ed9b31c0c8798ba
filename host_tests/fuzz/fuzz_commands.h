/*
 * The protocol as its document has it, apart from the firmware: what a typed line must be answered with, what may be
 * sent.
 */
#ifndef FUZZ_COMMANDS_H
#define FUZZ_COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#include "settings.h"

enum { EXPECTED_MAX = 256, REPLIES_MAX = 1024, REPLY_TEXT = 80, LINE_TYPED_MAX = 512 };

/* What was typed, as the replies it must get. */
typedef struct {
    settings_t settings;
    bool baud_changed;
    unsigned line_ends; /* blank lines are not answered, unless a byte was lost in one */
    unsigned count;
    char reply[EXPECTED_MAX][REPLY_TEXT]; /* how the first line begins */
    char line[LINE_TYPED_MAX];
    unsigned length;
    bool garbage;
} expected_t;

void expected_begin(expected_t *e);
void expected_byte(expected_t *e, uint8_t byte);

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

#endif
