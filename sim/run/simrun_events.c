#include "simrun_events.h"

#include <stddef.h>

#include "sim_cycle_timers.h"
#include "simrun_mcu.h"

enum { PARTS_MAX = 4 };

static struct {
    uint64_t (*next)(void);
    void (*step)(void);
} parts[PARTS_MAX];
static size_t part_count;
static uint64_t end_at = NEVER;

void events_add(uint64_t (*next)(void), void (*step)(void))
{
    parts[part_count].next = next;
    parts[part_count].step = step;
    part_count++;
}

void events_end_at(uint64_t cycle)
{
    end_at = cycle;
}

static avr_cycle_count_t on_event(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)when;
    (void)param;
    for (size_t i = 0; i < part_count; i++) {
        if (parts[i].next() <= avr->cycle) {
            parts[i].step();
        }
    }
    events_reschedule();
    return 0;
}

static uint64_t earliest(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

void events_reschedule(void)
{
    uint64_t at = earliest(end_at, mcu->cycle + CYCLES_PER_MS);
    for (size_t i = 0; i < part_count; i++) {
        at = earliest(at, parts[i].next());
    }
    avr_cycle_timer_register(mcu, at > mcu->cycle ? at - mcu->cycle : 1, on_event, NULL);
}
