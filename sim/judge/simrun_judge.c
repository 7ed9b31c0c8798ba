/* Times are relative to the moment at which a row was sent, so that the wrap of its stamp needs no counting. */
#include "simrun_judge.h"

#include <stdio.h>
#include <string.h>

enum { LOOK_BACK = 4096 /* samples: an older triplet that happens to be equal is no excuse */ };

static const char *const verdict_words[JUDGE_VERDICTS] = {
    [JUDGE_STALE] = "stale: the sensor latched these readings, but more than two sample periods before the stamp",
    [JUDGE_TWICE] = "twice: another row has shown this sample already",
    [JUDGE_WRONG] = "wrong: the sensor latched no such readings by that time",
};

void judge_clock_begins(judge_t *judge, uint64_t cycle)
{
    judge->has_clock = true;
    judge->clock_cycle = cycle;
    judge->rows = 0;
}

/* Cycle of the row's stamp: less than 35 minutes before or after it was sent. May be negative. */
static int64_t stamped_at(const judge_t *judge, const row_t *row)
{
    uint64_t sent_us = (row->sent - judge->clock_cycle) / judge->cycles_per_us;
    int32_t age_us = (int32_t)((uint32_t)sent_us + judge->start_us - row->t_us);
    return (int64_t)row->sent - (int64_t)age_us * judge->cycles_per_us;
}

/*
 * Equal samples near the stamp: the oldest that no row has shown becomes this row's own. If there is none, the newest
 * equal sample that is not too new decides. A sample is newer than its stamp says if the stamp was computed back from
 * the 33 samples that a full FIFO holds, with a period that has become 5 % shorter since: up to 33 x 0.05 + 0.5
 * periods.
 */
static judge_verdict_t compare(const row_t *row, int64_t at, int64_t near, served_t *served, size_t count)
{
    int64_t early = near + near / 2;
    size_t oldest = count > LOOK_BACK ? count - LOOK_BACK : 0;
    served_t *own = NULL;
    judge_verdict_t verdict = JUDGE_WRONG;
    for (size_t i = count; i > oldest; i--) {
        served_t *sample = &served[i - 1];
        int64_t age = at - (int64_t)sample->cycle;
        if (sample->cycle > row->sent || age < -early || memcmp(sample->lsb, row->lsb, sizeof row->lsb) != 0) {
            continue;
        }
        if (age > near) {
            verdict = verdict == JUDGE_WRONG ? JUDGE_STALE : verdict;
            break;
        }
        own = sample->shown ? own : sample;
        verdict = JUDGE_TWICE;
    }
    if (own == NULL) {
        return verdict;
    }
    own->shown = true;
    return JUDGE_RIGHT;
}

static bool steps_back(judge_t *judge, const row_t *row)
{
    bool back = judge->has_clock && judge->rows != 0 && (int32_t)(row->t_us - judge->last_us) < 0;
    judge->last_us = row->t_us;
    judge->rows++;
    judge->steps_back += back;
    return back;
}

judge_verdict_t judge_row(judge_t *judge, const row_t *row, served_t *served, size_t served_count, double period_us)
{
    judge_verdict_t verdict = JUDGE_DISOWNED_ROW;
    if ((row->flags & JUDGE_DISOWNED) == 0) {
        int64_t near = (int64_t)(2.0 * period_us * judge->cycles_per_us);
        verdict = judge->has_clock ? compare(row, stamped_at(judge, row), near, served, served_count) : JUDGE_UNTIMED;
    }
    bool back = steps_back(judge, row);
    judge->count[verdict]++;
    judge->rows_seen++;
    bool at_fault = back || verdict >= JUDGE_STALE;
    if (at_fault && !judge->any_fault) {
        judge->any_fault = true;
        judge->first = *row;
        judge->first_number = judge->rows_seen;
        judge->first_verdict = verdict;
        judge->first_steps_back = back;
    }
    return verdict;
}

uint32_t judge_judged(const judge_t *judge)
{
    return judge->count[JUDGE_RIGHT] + judge->count[JUDGE_STALE] + judge->count[JUDGE_TWICE] +
           judge->count[JUDGE_WRONG];
}

const char *judge_summary(const judge_t *judge)
{
    static char text[384];
    int length = snprintf(text, sizeof text, "%u rows judged: %u wrong, %u stale, %u twice; %u steps back in time",
                          (unsigned)judge_judged(judge), (unsigned)judge->count[JUDGE_WRONG],
                          (unsigned)judge->count[JUDGE_STALE], (unsigned)judge->count[JUDGE_TWICE],
                          (unsigned)judge->steps_back);
    if (judge->any_fault && length > 0) {
        const row_t *row = &judge->first;
        bool bad = judge->first_verdict >= JUDGE_STALE;
        snprintf(text + length, sizeof text - (size_t)length,
                 "; first row %u: t_us %u, readings %d,%d,%d, flags %u, %s", (unsigned)judge->first_number,
                 (unsigned)row->t_us, row->lsb[0], row->lsb[1], row->lsb[2], row->flags,
                 bad ? verdict_words[judge->first_verdict] : "stamped before the row ahead of it");
    }
    return text;
}
