/* The lines of each reply, one at a time: composing the longest takes 1.5 ms. Main only. */
#ifndef REPLY_LINES_H
#define REPLY_LINES_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

/* No reply has begun. */
void reply_start(void);

/*
 * Writes the first line of a reply (notice_kind_t), or its next one. Room for TEXT_LINE_MAX has been checked. False:
 * what the line reports is not known yet; nothing is staged.
 */
bool reply_line(uint8_t kind, uint8_t argument);

/* The last line of a reply is out: the next call begins another. */
bool reply_ended(void);

/* The command that asks for a reply (NOTICE_STOPPED to NOTICE_LISTING), as typed. */
flash_text_t reply_command_name(uint8_t kind);

#endif
