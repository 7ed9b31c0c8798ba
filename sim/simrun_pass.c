/*
 * Duration of the main loop's passes: a pass begins where main takes the wake flag back (GPIOR0, hal_sleep.h) and ends
 * where it does so again or sleeps. Counted with and without the interrupts in it.
 */
#include "sim_io.h"
#include "simrun.h"

enum { REG_GPIOR0 = 0x3E };

typedef struct {
    uint64_t cycles;
    double at_ms; /* when that pass began */
} longest_t;

static uint64_t count;
static uint64_t began = NEVER;
static uint64_t interrupted_before;
static longest_t whole, own;

static void keep_longest(longest_t *longest, uint64_t cycles)
{
    if (cycles > longest->cycles) {
        longest->cycles = cycles;
        longest->at_ms = (double)began / CYCLES_PER_MS;
    }
}

void pass_ends(void)
{
    if (began == NEVER) {
        return;
    }
    uint64_t cycles = mcu->cycle - began;
    keep_longest(&whole, cycles);
    keep_longest(&own, cycles - (stats_interrupted - interrupted_before));
    count++;
    began = NEVER;
}

static void on_wake_flag(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)param;
    avr->data[address] = value;
    if (value == 0 && !stats_in_interrupt()) {
        pass_ends();
        began = avr->cycle;
        interrupted_before = stats_interrupted;
    }
}

void pass_start(void)
{
    avr_register_io_write(mcu, REG_GPIOR0, on_wake_flag, NULL);
}

/* A pass cut off by a reset does not count. */
void pass_reset(void)
{
    began = NEVER;
}

void pass_print(FILE *json)
{
    fprintf(json, "  \"passes\": %llu,\n  \"pass_max_cycles\": %llu,\n  \"pass_max_at_ms\": %.3f,\n",
            (unsigned long long)count, (unsigned long long)whole.cycles, whole.at_ms);
    fprintf(json, "  \"pass_own_max_cycles\": %llu,\n  \"pass_own_max_at_ms\": %.3f,\n", (unsigned long long)own.cycles,
            own.at_ms);
}
