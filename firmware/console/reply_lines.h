/* The lines of each reply, one at a time: composing the longest takes 1.5 ms. Main only. */
#ifndef REPLY_LINES_H
#define REPLY_LINES_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

typedef enum {
    REPLY_WAITS,   /* what the line reports is not known yet; nothing is staged */
    REPLY_GOES_ON, /* the line is out, another follows */
    REPLY_ENDED    /* the last line is out */
} reply_progress_t;

/* Writes the first line of a reply (notice_kind_t), or its next one. Room for TEXT_LINE_MAX has been checked. */
reply_progress_t reply_line(uint8_t kind, uint8_t argument, bool first);

/* The command that asks for a reply (NOTICE_STOPPED to NOTICE_LISTING), as typed. */
flash_text_t reply_command_name(uint8_t kind);

#endif
