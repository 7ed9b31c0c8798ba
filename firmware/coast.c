/* The clock of missing samples; what a missing sample does to the filters is in pipeline.c. */
#include "coast.h"

#include "counters.h"
#include "hal_time.h"
#include "pipeline.h"

#define LONG_STEP_US UINT32_C(100000)

static struct {
    uint32_t next_us;    /* time of the sample that comes next */
    uint32_t counted_us; /* a period after the newest one that has come */
    bool waiting;        /* for the first sample */
} coast;

void coast_wait(uint32_t now_us)
{
    coast.waiting = true;
    coast.next_us = now_us + LONG_STEP_US;
}

bool coast_too_late(uint32_t t_us)
{
    bool late = !coast.waiting && hal_time_reached(pipeline_newest_us(), t_us);
    if (late) {
        count(COUNT_LATE);
    }
    return late;
}

uint32_t coast_due_us(uint32_t period_us)
{
    return coast.next_us + (period_us >> 1);
}

/* Those that did not come before a sample; once for each, however long it waits. */
static void count_missing_before(uint32_t t_us, uint32_t period_us)
{
    uint32_t behind_us = t_us + (period_us >> 1) - coast.counted_us;
    if (!coast.waiting && hal_time_reached(behind_us, period_us)) {
        count_lost(behind_us / period_us);
    }
    if (coast.waiting || hal_time_reached(t_us + period_us, coast.counted_us)) { /* not one that is too late */
        coast.counted_us = t_us + period_us;
    }
}

bool coast_over(uint32_t t_us, uint32_t period_us, bool sample)
{
    if (sample) {
        count_missing_before(t_us, period_us);
    }
    bool skip = sample && (coast.waiting || pipeline_holds());
    if (skip || !hal_time_reached(t_us, coast_due_us(period_us))) {
        return false;
    }
    pipeline_coast(coast.next_us);
    if (pipeline_long_silent()) {
        coast.next_us += LONG_STEP_US;
    } else {
        coast.next_us += period_us;
    }
    return true;
}

void coast_end(uint32_t t_us, uint32_t period_us)
{
    coast.waiting = false;
    coast.next_us = t_us + period_us;
}
