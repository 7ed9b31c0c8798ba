/* Data rows: decimation, both output modes, dropping whole rows when the line is full. Main only. */
#ifndef ROWS_H
#define ROWS_H

#include <stdbool.h>
#include <stdint.h>

/* Column names of the csv mode, without the end of line, in program memory. */
const char *rows_header(void);

/* Counters to zero, no rows yet. */
void rows_start(void);

/* Rows may go out (false while the banner and the header are not through). */
void rows_enable(bool enabled);

/* A sample has been filtered: its row if it is the one in `every`. */
void rows_sample(void);

/* A row without a sample, now. */
void rows_held(uint32_t now_us);

/* Rows written and rows dropped for lack of room, saturating. */
uint32_t rows_written(void);
uint16_t rows_dropped(void);

#endif
