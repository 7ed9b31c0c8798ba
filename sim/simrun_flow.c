/*
 * Whether good rows keep coming. A row is good if its flags do not disown it (simrun_judge.h) and no axis at the rail
 * was left out of it. It shows a sample if nothing but the filter's gate or the rail is against it (flags 1 and 8).
 * Records the longest times without a row that shows a sample: of the whole run, and of its quiet parts, in which every
 * fault so far is over and has had its good row.
 */
#include "simrun.h"

#define FLAG_GATED 1u
#define FLAG_CLIPPED 8u

typedef struct {
    uint64_t cycles, from;
} gap_t;

static uint64_t last_good = NEVER, last_shown = NEVER;
static gap_t longest, longest_calm;

static void keep_longest(gap_t *gap, uint64_t from, uint64_t to)
{
    if (to - from > gap->cycles) {
        *gap = (gap_t){ .cycles = to - from, .from = from };
    }
}

/*
 * No fault is in progress or waits for its good row. Then none has begun since the previous row either, because it
 * would wait for a row that shows what was latched after it.
 */
void flow_on_row(const row_t *row)
{
    unsigned against = row->flags & JUDGE_DISOWNED;
    if (against == 0 && (row->flags & FLAG_CLIPPED) == 0) {
        last_good = row->sent;
    }
    if ((against & ~FLAG_GATED) != 0) {
        return;
    }
    if (last_shown != NEVER) {
        keep_longest(&longest, last_shown, row->sent);
        if (faults_over()) {
            keep_longest(&longest_calm, last_shown, row->sent);
        }
    }
    last_shown = row->sent;
}

static void print_gap(FILE *json, const char *name, const gap_t *gap)
{
    fprintf(json, "  \"%s_ms\": %.3f,\n  \"%s_from_ms\": %.3f,\n", name, (double)gap->cycles / CYCLES_PER_MS, name,
            (double)gap->from / CYCLES_PER_MS);
}

void flow_print(FILE *json)
{
    if (last_good == NEVER) {
        fputs("  \"rows_last_good_ms\": null,\n", json);
    } else {
        fprintf(json, "  \"rows_last_good_ms\": %.3f,\n", (double)last_good / CYCLES_PER_MS);
    }
    print_gap(json, "rows_gap", &longest);
    print_gap(json, "rows_calm_gap", &longest_calm);
}
