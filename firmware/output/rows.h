/* Data rows: decimation, both output modes, dropping whole rows when the line is full. Main only. */
#ifndef ROWS_H
#define ROWS_H

#include <stdbool.h>
#include <stdint.h>

/* No rows yet. */
void rows_start(void);

/* Rows may go out (false while the banner and the header are not through). */
void rows_enable(bool enabled);

/*
 * A sample has been filtered, or is missing: its row if it is the one in `every`. plot: in the form for the plotters,
 * not csv.
 */
void rows_sample(uint16_t every, bool plot);

/*
 * Csv rows of the samples of the next 2 s are held, so that a person can read what was said: counted, not sent; the
 * next one that is sent has ROW_DROPPED.
 */
void rows_hold(void);

/* A line was typed: they are not held any longer, unless it asks for more to be read: then as long again. */
void rows_typed(bool more_to_read);

/* Its row, whatever `every` says. */
void rows_at_once(bool plot);

#endif
