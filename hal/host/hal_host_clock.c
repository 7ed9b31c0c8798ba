/* The host's virtual clock: steps from event to event of the board's parts, which it gets in a table. */
#include "hal_host_private.h"
#include "hal_sleep.h"
#include "hal_time.h"

/* A pass of main takes time too; otherwise a main loop that asks for another pass would stop the clock. */
enum { PASS_CYCLES = 320 };

static uint64_t now; /* cycles since power-on */
static hal_host_config_t config;
static hal_host_faults_t faults;
static const host_part_t *parts;
static size_t parts_count;
static bool wake_wanted;
static bool stopped;

void host_clock_begin(const hal_host_config_t *wanted, const host_part_t *board, size_t count)
{
    config = *wanted;
    parts = board;
    parts_count = count;
    now = 0;
}

const hal_host_config_t *host_config(void)
{
    return &config;
}

hal_host_faults_t *hal_host_faults(void)
{
    return &faults;
}

void host_clock_reset(void)
{
    wake_wanted = false;
    stopped = false;
}

void host_clock_spend(uint64_t cycles)
{
    now += cycles;
}

void host_clock_stop(void)
{
    stopped = true;
}

uint64_t hal_host_now(void)
{
    return now;
}

double hal_host_now_ms(void)
{
    return (double)now / (1000.0 * HOST_CYCLES_PER_US);
}

uint32_t hal_time_us(void)
{
    return (uint32_t)(config.time_start_us + now / HOST_CYCLES_PER_US);
}

uint16_t hal_time_count_isr(void)
{
    return (uint16_t)hal_time_us();
}

void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count)
{
    uint32_t now_us = hal_time_us();
    *t_us = now_us - (uint16_t)(now_us - count);
}

uint8_t hal_time_lap(void)
{
    static uint8_t lap;
    lap = (uint8_t)(lap + faults.lap_step);
    return lap;
}

void hal_wake(void)
{
    wake_wanted = true;
}

static void run_due_events(void)
{
    for (size_t i = 0; i < parts_count; i++) {
        if (parts[i].next == NULL || parts[i].next() <= now) {
            parts[i].step();
        }
    }
}

static uint64_t next_event(void)
{
    uint64_t earliest = HOST_NEVER;
    for (size_t i = 0; i < parts_count; i++) {
        uint64_t at = parts[i].next != NULL ? parts[i].next() : HOST_NEVER;
        earliest = at < earliest ? at : earliest;
    }
    return earliest;
}

static void go_to(uint64_t at)
{
    now = at > now ? at : now;
    run_due_events();
}

void hal_sleep_until_wake(void)
{
    uint64_t pass_end = now + PASS_CYCLES;
    while (next_event() <= pass_end) {
        go_to(next_event());
    }
    now = pass_end;
    while (!wake_wanted) {
        go_to(next_event());
        if (stopped) {
            return;
        }
    }
    wake_wanted = false;
}
