/* Prints the notices, one line at a time, when there is room for it and a data row: no row is displaced. Main only. */
#ifndef SPEAKER_H
#define SPEAKER_H

#include <stdbool.h>

/* Prints at most one line, if there is room for it and a data row; false: there is nothing to do, or it waits. */
bool speaker_pass(void);

#endif
