/*
 * The judge of the rows: what the firmware printed against what the virtual sensor latched. It knows neither variables
 * nor counters of the firmware, only the model's record, the rows as they were sent and the moment at which Timer1
 * began to count. Plain C without simavr, so that a test can feed it handmade rows.
 *
 * A row whose flags do not disown it (none of JUDGE_DISOWNED) is right if its readings are a triplet that the model
 * latched at most two sample periods before the row's time stamp, at most three after it, and before the row was sent,
 * and that no right row has shown yet: a row of a sample that was delivered twice is reported as such. It is stale if
 * the model latched that triplet, but longer before; otherwise it is wrong.
 */
#ifndef SIMRUN_JUDGE_H
#define SIMRUN_JUDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* gated 1, coasted 2, fault 16, stuck 32, integrity 64: the row itself marks its readings as not a sample */
#define JUDGE_DISOWNED 0x73u

typedef struct {
    uint64_t cycle; /* at which the sensor latched it */
    int16_t lsb[3];
    bool shown; /* by a right row */
} served_t;

typedef struct {
    uint32_t t_us;
    unsigned flags;
    int16_t lsb[3];
    uint64_t sent; /* cycle of its line end */
} row_t;

typedef enum {
    JUDGE_RIGHT,
    JUDGE_DISOWNED_ROW,
    JUDGE_UNTIMED,
    JUDGE_STALE,
    JUDGE_TWICE,
    JUDGE_WRONG,
    JUDGE_VERDICTS
} judge_verdict_t;

typedef struct {
    uint32_t cycles_per_us; /* set by the caller, as is the next */
    uint32_t start_us;      /* reading of the firmware's clock when Timer1 begins to count */
    bool has_clock;
    uint64_t clock_cycle;
    uint32_t rows; /* since the clock began */
    uint32_t last_us;
    uint32_t rows_seen; /* of the whole run */
    uint32_t count[JUDGE_VERDICTS];
    uint32_t steps_back; /* rows stamped before their predecessor */
    bool any_fault;      /* the following fields are valid */
    bool first_steps_back;
    judge_verdict_t first_verdict;
    uint32_t first_number; /* of the row, from 1 */
    row_t first;
} judge_t;

/* The firmware's clock restarts at this cycle. A row before the first restart is untimed, and not judged. */
void judge_clock_begins(judge_t *judge, uint64_t cycle);

/* Judges the next row. `served`: the samples latched recently, oldest first; period_us: of the rate in force. */
judge_verdict_t judge_row(judge_t *judge, const row_t *row, served_t *served, size_t served_count, double period_us);

/* Judged rows, right ones included. */
uint32_t judge_judged(const judge_t *judge);

/* One sentence with the verdicts and the first faulty row; the text is valid until the next call. */
const char *judge_summary(const judge_t *judge);

#endif
