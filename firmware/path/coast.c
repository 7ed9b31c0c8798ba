/* The clock of missing samples; what a missing sample does to the filters is in pipeline.c. */
#include "path/coast.h"

#include "base/counters.h"
#include "hal_time.h"
#include "machine.h"
#include "path/pipeline.h"
#include "path/silence.h"

#define LONG_STEP_US UINT32_C(100000)

/* So much of an outage is counted before it is over, because times wrap after 71 minutes; a part of a sample is not. */
#define LONG_OUTAGE_US (UINT32_C(1) << 30)

typedef enum {
    STATE_WAITING, /* for the first sample; no row is out yet */
    STATE_RUNNING,
    STATE_COASTING /* the newest row is for a missing sample */
} state_t;

static struct coast {
    uint32_t next_us; /* time of the next sample */
    uint32_t due_us;  /* when it counts as missing */
    uint32_t from_us; /* COASTING: half a period after the newest sample that came or is counted */
    uint8_t state;    /* state_t */
} coast;

/* With its address in a register, each access takes half the code. */
static inline struct coast *here(void)
{
    struct coast *c = &coast;
    MACHINE_POINTER(c);
    return c;
}

static void expect(uint32_t t_us, uint32_t period_us)
{
    struct coast *c = here();
    c->next_us = t_us;
    c->due_us = t_us + (period_us >> 1);
}

void coast_wait(uint32_t now_us)
{
    coast.state = STATE_WAITING;
    expect(now_us + LONG_STEP_US, 0);
}

bool coast_due(uint32_t t_us)
{
    return hal_time_reached(t_us, coast.due_us);
}

uint32_t coast_due_us(void)
{
    return coast.due_us;
}

bool coast_over(uint32_t period_us, bool sample)
{
    struct coast *c = here();
    if (sample && (c->state == STATE_WAITING || silence_holds())) {
        return false;
    }
    if (c->state != STATE_COASTING) {
        c->state = STATE_COASTING;
        c->from_us = c->next_us - (period_us >> 1);
    }
    if ((uint8_t)((c->due_us - c->from_us) >> 24) == LONG_OUTAGE_US >> 24) { /* met: 2^24 us are many steps */
        c->from_us += LONG_OUTAGE_US;
        count_lost(LONG_OUTAGE_US / period_us);
    }
    pipeline_coast(c->next_us);
    expect(c->next_us + (silence_long() ? LONG_STEP_US : period_us), period_us);
    return true;
}

/* Counts what is missing before a sample that has come; none if it is older than what is counted. */
static void count_missing(struct coast *c, uint32_t t_us, uint32_t period_us)
{
    int32_t since_us = (int32_t)(t_us - c->from_us);
    if (since_us > 0) {
        count_lost((uint32_t)since_us / period_us);
        c->from_us = t_us + (period_us >> 1);
    }
}

bool coast_sample(uint32_t t_us, uint32_t period_us)
{
    struct coast *c = here();
    if (c->state == STATE_COASTING) {
        count_missing(c, t_us, period_us);
    }
    if (c->state != STATE_WAITING && hal_time_reached(pipeline_newest_us(), t_us)) {
        count(COUNT_LATE);
        return false;
    }
    c->state = STATE_RUNNING;
    expect(t_us + period_us, period_us);
    return true;
}
