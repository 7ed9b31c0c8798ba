/* Serial commands, one per line: NAME VALUE sets, NAME shows, verbs have no value. Main only. */
#ifndef COMMANDS_H
#define COMMANDS_H

#include <stdbool.h>
#include <stdint.h>

#define COMMANDS_LINE_MAX 40u

void commands_start(void);

/*
 * Takes received bytes while the pass has time, at least one; runs at most one complete line, and only if there is room
 * for its reply. True: it has run one. Do not call while a save is running or the baud rate is to change: the bytes
 * wait in the receive ring.
 */
bool commands_pass(void);

#endif
