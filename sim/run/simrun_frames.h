/* A PC that exchanges frames with the navigation image (--frames). */
#ifndef SIMRUN_FRAMES_H
#define SIMRUN_FRAMES_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Reads the file; exits with EXIT_INPUT and the location on a bad one. NULL: there are no frames. */
void frames_start(const char *path);
bool frames_wanted(void);
bool frames_take(uint8_t byte); /* from the board; true: the end of a record, there may be something to send */
/* False: nothing to send; look again at this cycle, or after the next record if it is NEVER. */
bool frames_next_byte(uint8_t *byte, uint64_t *look_again);
uint64_t frames_over_at(void); /* cycle at which the last frame was answered, NEVER before that */
bool frames_silent(void);      /* the board has owed a reply for too long */
void frames_print(FILE *json);

#endif
