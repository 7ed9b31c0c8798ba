/*
 * Says the notices, one line at a time, when the line has room beside a data row: they never push a row out. Main only.
 */
#ifndef SPEAKER_H
#define SPEAKER_H

#include <stdbool.h>

/* No line of a notice is out yet. */
void speaker_start(void);

/* At most one line, if there is room for it and a data row; false: there is nothing to do, or it waits. */
bool speaker_pass(void);

#endif
