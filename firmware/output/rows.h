/* Data rows: decimation, both output modes, dropping of whole rows when the line is full. Main only. */
#ifndef ROWS_H
#define ROWS_H

#include <stdbool.h>
#include <stdint.h>

/* Whether rows go out from now on: not until the banner and the header are out. */
void rows_enable(bool enabled);

/*
 * A sample has been filtered, or is missing: writes its row if it is the one in `every`. plot: in the plotters' format,
 * not csv.
 */
void rows_sample(uint16_t every, bool plot);

/*
 * Holds back the csv rows of the samples of the next 2 s, so that a person can read the reply: they are counted, not
 * sent; the next row that is sent has ROW_DROPPED.
 */
void rows_hold(void);

/* A line was typed: ends the hold, or restarts it if the line asks for more to read. */
void rows_typed(bool more_to_read);

#endif
