/*
 * The lines of each reply, one at a time, each in as many passes as it takes: the longest is composed in 1.5 ms. Main
 * only.
 */
#ifndef REPLY_LINES_H
#define REPLY_LINES_H

#include <stdbool.h>
#include <stdint.h>

#include "flash.h"
#include "replies.h"

typedef enum {
    REPLY_SPEAKS,  /* the line is not complete: nobody else may write */
    REPLY_GOES_ON, /* it is out, another follows */
    REPLY_ENDED    /* the last one is out */
} reply_progress_t;

/* Room for a line of TEXT_LINE_MAX has been checked. False: what the line tells is not known yet, nothing is staged. */
bool reply_begin_line(reply_kind_t kind, uint8_t argument, uint8_t line);

/* A byte of the line or more, as long as the pass has time. */
reply_progress_t reply_speak(void);

/* The word that asks for a reply (REPLY_HELP to REPLY_GOING), as it is typed. */
flash_text_t reply_command_name(uint8_t kind);

/* A filter and a legal rate in a reply's argument. */
uint8_t reply_combination(uint8_t filter, uint16_t rate_dhz);

#endif
