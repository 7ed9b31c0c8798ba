/* The sensor's samples are kept for a limited time (SERVED_KEPT): each row is looked up when it arrives. */
#include "simrun_rows.h"

#include <string.h>

#include "sim_io.h"
#include "simrun_mcu.h"
#include "simrun_resets.h"
#include "simrun_sensor.h"
#include "simrun_times.h"

enum { LOOK_BACK = 64, FLAG_GATED = 1, FLAG_COASTED = 2, FLAG_CLIPPED = 8, FLAG_FAULT = 16 };
enum { REG_TCCR1B = 0x81, CLOCK_SELECT = 0x07 };
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

static bool shows(const row_t *row, const served_t *sample)
{
    return memcmp(sample->lsb, row->lsb, sizeof row->lsb) == 0;
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
    bool found = shows(row, &served[i - 1]);
    while (!found && i > 1 && i + LOOK_BACK > count) {
        i--;
        found = shows(row, &served[i - 1]);
    }
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

static void count_row(const row_t *row)
{
    if (row_count == 0) {
        times_streaming_begins();
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

/*
 * Whether good rows keep coming. A row is good if its flags do not disown it (simrun_judge.h) and no axis at the rail
 * was left out of it. It shows a sample if nothing but the filter's gate or the rail is against it (flags 1 and 8).
 * Records the longest times without a row that shows a sample: of the whole run, and of its quiet parts, in which every
 * fault so far is over and has had its good row.
 */
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

/* If it is calm, no fault has begun since the previous row either: it would wait for a row of what came after it. */
static void measure_gaps(const row_t *row, bool calm)
{
    unsigned against = row->flags & JUDGE_DISOWNED;
    if (against == 0 && (row->flags & FLAG_CLIPPED) == 0) {
        last_good = row->sent;
    }
    if ((against & ~(unsigned)FLAG_GATED) != 0) {
        return;
    }
    if (last_shown != NEVER) {
        keep_longest(&longest, last_shown, row->sent);
        if (calm) {
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

static void print_gaps(FILE *json)
{
    if (last_good == NEVER) {
        fputs("  \"rows_last_good_ms\": null,\n", json);
    } else {
        fprintf(json, "  \"rows_last_good_ms\": %.3f,\n", (double)last_good / CYCLES_PER_MS);
    }
    print_gap(json, "rows_gap", &longest);
    print_gap(json, "rows_calm_gap", &longest_calm);
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
    print_gaps(json);
}

/* The judge: the firmware's clock starts with Timer1. */
static judge_t judge;

static void on_timer(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)address;
    (void)param;
    if ((value & CLOCK_SELECT) != 0) {
        judge_clock_begins(&judge, avr->cycle);
    }
}

void rows_start(uint32_t clock_start_us)
{
    judge = (judge_t){ .cycles_per_us = CYCLES_PER_US, .start_us = clock_start_us };
    avr_register_io_write(mcu, REG_TCCR1B, on_timer, NULL);
}

void rows_print_verdict(FILE *json)
{
    fprintf(json, "  \"rows_judged\": %u,\n  \"rows_wrong\": %u,\n  \"rows_stale\": %u,\n",
            (unsigned)judge_judged(&judge), (unsigned)judge.count[JUDGE_WRONG], (unsigned)judge.count[JUDGE_STALE]);
    fprintf(json, "  \"rows_twice\": %u,\n  \"t_us_steps_back\": %u,\n", (unsigned)judge.count[JUDGE_TWICE],
            (unsigned)judge.steps_back);
}

void rows_tell(void)
{
    if (judge.rows_seen != 0) {
        fprintf(stderr, "simrun: %s\n", judge_summary(&judge));
    }
}

const char *rows_fault(void)
{
    return judge.any_fault ? judge_summary(&judge) : NULL;
}

void rows_take(const row_t *row, bool calm)
{
    size_t count;
    served_t *served = sensor_served_lately(&count);
    count_row(row);
    measure_gaps(row, calm);
    (void)judge_row(&judge, row, served, count, sensor_true_period_us());
}
