/* The line to the PC: the file of what the firmware sends, its rows, and what is typed. */
#ifndef SIMRUN_UART_H
#define SIMRUN_UART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "simrun_judge.h"

enum { TYPED_MAX = 64 };

typedef struct {
    double at_ms;     /* not before this simulated time */
    const char *text; /* without the line end */
    bool setting;     /* from --rate and the like: it must not be refused */
} typed_line_t;

typedef struct {
    const char *out;
    typed_line_t typed[TYPED_MAX];
    size_t typed_count;
} uart_options_t;

void uart_start(const uart_options_t *wanted, void (*on_row)(const row_t *row)); /* `wanted` must stay valid */
void uart_type_at_once(void); /* from a terminal, which has been opened: it does not wait for the banner */
void uart_finish(void);
void uart_reset(void); /* after a reset of the MCU */
uint64_t uart_next(void);
void uart_step(void);
void uart_flood(bool on);    /* random bytes without a pause, instead of typed lines */
void uart_spoil(bool lost);  /* the next byte received has FE0, or DOR0 */
uint64_t uart_last_tx(void); /* cycle of the last byte sent, 0: none */
void uart_print(FILE *json);

#endif
