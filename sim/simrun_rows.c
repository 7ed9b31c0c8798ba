/*
 * Rows counted as they arrive, and what was lost between the sensor and them. The sensor's samples are kept for a
 * limited time (SERVED_KEPT), so that a day fits in memory: each row is looked up when it arrives.
 */
#include <string.h>

#include "simrun.h"

enum { LOOK_BACK = 64, FLAG_GATED = 1, FLAG_COASTED = 2, FLAG_FAULT = 16 };
enum { STEP_UNIT_US = 64 };
#define STEPS 524288ul /* up to 33.5 s between two rows */

/* Samples from that of the first row to that of the last row of one class, and rows of that class. */
typedef struct {
    size_t rows, samples;
} class_t;

static size_t row_count, gated, coasted, faulty;
static row_t first, last;
static size_t first_number; /* number of the first row's sample, in the whole run */
static uint64_t first_cycle;
static class_t measured; /* rows that are not predictions */
static uint32_t first_resets;
static uint32_t steps[STEPS];

/* Number of samples latched up to that cycle. */
static size_t served_until(uint64_t cycle)
{
    size_t count;
    const served_t *served = sensor_served_lately(&count);
    size_t newer = 0;
    while (newer < count && served[count - 1 - newer].cycle > cycle) {
        newer++;
    }
    return sensor_served_count() - newer;
}

/* The newest sample that the first row can show, at the time it was sent. */
static void find_first(const row_t *row)
{
    size_t count;
    const served_t *served = sensor_served_lately(&count);
    size_t older = sensor_served_count() - count;
    first = *row;
    if (count == 0) {
        return;
    }
    size_t i = count;
    while (i > 1 && i + LOOK_BACK > count && memcmp(served[i - 1].lsb, row->lsb, sizeof row->lsb) != 0) {
        i--;
    }
    bool found = memcmp(served[i - 1].lsb, row->lsb, sizeof row->lsb) == 0;
    i = found ? i : count;
    first_number = older + i;
    first_cycle = served[i - 1].cycle;
}

/* The rows' own time stamps measure the distance; a lost remainder shorter than one row is not detected. */
static void extend(class_t *rows, const row_t *row)
{
    uint64_t span_us = row->t_us - first.t_us;
    uint64_t until = first_cycle + (uint64_t)(((double)span_us + sensor_period_us() / 2.0) * CYCLES_PER_US);
    size_t number = served_until(until);
    rows->rows++;
    rows->samples = number > first_number ? number - first_number : 0;
}

static uint32_t resets_so_far(void)
{
    return resets_count() + resets_boot_count();
}

void rows_take(const row_t *row)
{
    if (row_count == 0) {
        stats_streaming_begins();
        find_first(row);
        first_resets = resets_so_far();
    } else {
        uint32_t step = (row->t_us - last.t_us + STEP_UNIT_US / 2) / STEP_UNIT_US;
        steps[step < STEPS ? step : STEPS - 1]++;
    }
    last = *row;
    row_count++;
    gated += (row->flags & FLAG_GATED) != 0;
    coasted += (row->flags & FLAG_COASTED) != 0;
    faulty += (row->flags & FLAG_FAULT) != 0;
    if ((row->flags & (FLAG_COASTED | FLAG_FAULT)) == 0) {
        extend(&measured, row);
    }
}

size_t rows_count(void)
{
    return row_count;
}

/* Median time between rows in samples of the last rate in force: the `every` in force. */
static unsigned every_seen(void)
{
    double period_us = sensor_period_us();
    if (row_count < 2 || period_us <= 0.0) {
        return 1;
    }
    size_t below = 0;
    uint32_t step = 0;
    while (below + steps[step] <= (row_count - 2) / 2) {
        below += steps[step++];
    }
    double every = (double)step * STEP_UNIT_US / period_us + 0.5;
    return every < 1.0 ? 1 : (unsigned)every;
}

/*
 * If only every Nth sample has a row, it is unknown whether those between two rows arrived or were coasted; and a reset
 * restarts the clock of the rows.
 */
static bool lost_is_known(unsigned every)
{
    return every == 1 && resets_so_far() == first_resets;
}

/* Samples served from that of the first row to that of the last one that is not a prediction, less those rows. */
static size_t lost(void)
{
    size_t shown = measured.rows < 2 ? measured.samples : measured.rows - 1;
    return measured.samples > shown ? measured.samples - shown : 0;
}

void rows_print(FILE *json)
{
    unsigned every = every_seen();
    fprintf(json, "  \"rows\": %zu,\n  \"every\": %u,\n", row_count, every);
    if (lost_is_known(every)) {
        fprintf(json, "  \"lost\": %zu,\n", lost());
    } else {
        fputs("  \"lost\": null,\n", json);
    }
    fprintf(json, "  \"gated\": %zu,\n  \"coasted\": %zu,\n  \"fault_rows\": %zu,\n", gated, coasted, faulty);
}
