/* Data rows: decimation, both output modes, dropping whole rows when the line is full. Main only. */
#ifndef ROWS_H
#define ROWS_H

#include <stdbool.h>
#include <stdint.h>

/* No rows yet. */
void rows_start(void);

/* Rows may go out (false while the banner and the header are not through). */
void rows_enable(bool enabled);

/* A sample has been filtered: its row if it is the one in `every`. */
void rows_sample(void);

/* A row without a sample, now. */
void rows_held(uint32_t now_us);

#endif
