/* The clock of missing samples; what a missing sample does to the filters is in pipeline.c. */
#include "path/coast.h"

#include "base/counters.h"
#include "hal_time.h"
#include "machine.h"
#include "path/pipeline.h"
#include "path/silence.h"

#define LONG_STEP_US UINT32_C(100000)

typedef enum {
    STATE_WAITING, /* for the first sample; no row is out yet */
    STATE_RUNNING,
    STATE_COASTING /* the newest row is for a missing sample */
} state_t;

static struct coast {
    uint32_t next_us; /* time of the next sample */
    uint32_t due_us;  /* when it counts as missing */
    uint32_t lost_us; /* COASTING: due_us as it was after the newest sample that came, or for the first row */
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
        c->lost_us = c->due_us;
    }
    pipeline_coast(c->next_us);
    expect(c->next_us + (silence_long() ? LONG_STEP_US : period_us), period_us);
    return true;
}

bool coast_sample(uint32_t t_us, uint32_t period_us)
{
    struct coast *c = here();
    if (c->state != STATE_WAITING && hal_time_reached(pipeline_newest_us(), t_us)) {
        c->lost_us = t_us + period_us + (period_us >> 1);
        count(COUNT_LATE);
        return false;
    }
    if (c->state == STATE_COASTING) { /* t_us is at most two periods before lost_us, or up to 71 minutes late */
        uint32_t periods = (t_us - c->lost_us + 2u * period_us) / period_us;
        if (periods > 1u) {
            count_lost(periods - 1u);
        }
    }
    c->state = STATE_RUNNING;
    expect(t_us + period_us, period_us);
    return true;
}
