/* Serial commands: one line each, NAME VALUE sets, NAME shows, verbs stand alone. Main only. */
#ifndef COMMANDS_H
#define COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#define COMMANDS_LINE_MAX 40u

void commands_start(void);

/*
 * Takes received bytes while the pass has time, one at least; runs at most one complete line, and only while there is
 * room for its reply. True: it has run one. Not to be called while a save runs or the baud rate is to change: the bytes
 * wait in the receive ring.
 */
bool commands_pass(void);

#endif
