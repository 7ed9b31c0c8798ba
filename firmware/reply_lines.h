/* The lines of each reply, one at a time. The room for a line of TEXT_LINE_MAX has been checked. Main only. */
#ifndef REPLY_LINES_H
#define REPLY_LINES_H

#include <stdint.h>

#include "flash.h"
#include "replies.h"

typedef enum {
    REPLY_GOES_ON, /* a line was written, another follows */
    REPLY_ENDED,   /* the last line was written, or there was none */
    REPLY_WAITS    /* nothing written: what the line tells is not known yet */
} reply_progress_t;

reply_progress_t reply_write_line(reply_kind_t kind, uint8_t argument, uint8_t line);

/* The word that asks for a reply (REPLY_HELP to REPLY_GOING), as it is typed. */
flash_text_t reply_command_name(uint8_t kind);

/* A filter and a legal rate in a reply's argument. */
uint8_t reply_combination(uint8_t filter, uint16_t rate_dhz);

#endif
