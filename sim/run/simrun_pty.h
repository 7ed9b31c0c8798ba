/* A pseudo terminal in place of the USB serial port (--pty). */
#ifndef SIMRUN_PTY_H
#define SIMRUN_PTY_H

#include <stdbool.h>
#include <stdint.h>

/* blank: nothing runs before the first opening. patience_s: a program that reads nothing for so long ends the run. */
void pty_open(bool blank, double patience_s);
bool pty_is_open(void);
void pty_send(uint8_t byte);
bool pty_receive(uint8_t *byte);
void pty_pace(void); /* sleep until real time has caught up; if it is far ahead, do not try to catch up with it */

#endif
