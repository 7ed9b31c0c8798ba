/* The rows as they arrive: counted, what was lost, gaps between good ones, and the judge (simrun_judge.h). */
#ifndef SIMRUN_ROWS_H
#define SIMRUN_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "simrun_judge.h"

void rows_start(uint32_t clock_start_us);
void rows_take(const row_t *row, bool calm); /* calm: no fault is in progress or waits for its good row */
size_t rows_count(void);
void rows_print(FILE *json);
void rows_print_verdict(FILE *json);
void rows_tell(void);         /* stderr: the verdict */
const char *rows_fault(void); /* the first faulty row; NULL if there is none */

#endif
