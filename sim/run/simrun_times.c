/* Taken through simavr's hooks: the firmware carries no code for it. */
#include "simrun_times.h"

#include "sim_interrupts.h"
#include "sim_io.h"
#include "simrun_mcu.h"
#include "simrun_vcd.h"

enum { RETI_CYCLES = 4 /* simavr notifies before it counts them */, REG_GPIOR0 = 0x3E };

typedef struct {
    avr_int_vector_t *vector;
    bool running, pending;
    uint64_t entered, raised;
    uint64_t count, sum, min, max, worst_latency;
} interrupt_t;

static const char *const vector_name[VECTORS] = {
    [1] = "int0",        [6] = "wdt",       [11] = "timer1_compa", [18] = "usart_rx",
    [19] = "usart_udre", [20] = "usart_tx", [22] = "ee_ready",     [24] = "twi"
};

static uint64_t asleep;
static uint64_t interrupted;
static uint64_t entering; /* cycles of interrupt responses */
static unsigned nested;
static interrupt_t interrupts[VECTORS];
static uint64_t streaming_from = NEVER, slept_from, streaming_to = NEVER, slept_to;

/*
 * A pass of the main loop begins where main takes the wake flag back (GPIOR0, hal_sleep.h) and ends where it does so
 * again or sleeps. Counted with and without the interrupts in it.
 */
typedef struct {
    uint64_t cycles;
    double at_ms; /* when that pass began */
} longest_t;

static uint64_t passes;
static uint64_t pass_began = NEVER;
static uint64_t interrupted_at_pass;
static longest_t whole_pass, own_pass;

static void enter(interrupt_t *interrupt)
{
    if (interrupt->pending) {
        uint64_t latency = mcu->cycle + ENTRY_CYCLES - interrupt->raised;
        interrupt->worst_latency = latency > interrupt->worst_latency ? latency : interrupt->worst_latency;
        interrupt->pending = false;
    }
    interrupt->entered = mcu->cycle;
    interrupt->running = true;
    nested++;
    entering += ENTRY_CYCLES;
    mcu->cycle += ENTRY_CYCLES;
}

static void leave(interrupt_t *interrupt)
{
    uint64_t cycles = mcu->cycle + RETI_CYCLES - interrupt->entered;
    interrupt->running = false;
    nested--;
    interrupted += cycles;
    interrupt->count++;
    interrupt->sum += cycles;
    interrupt->max = cycles > interrupt->max ? cycles : interrupt->max;
    if (interrupt->min == 0 || cycles < interrupt->min) {
        interrupt->min = cycles;
    }
}

static void on_running(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    interrupt_t *interrupt = param;
    if (value) {
        enter(interrupt);
    } else if (interrupt->running) {
        leave(interrupt);
    }
    vcd_change(VCD_ISR + (unsigned)(interrupt - interrupts), value != 0);
}

static void on_pending(avr_irq_t *irq, uint32_t value, void *param)
{
    (void)irq;
    interrupt_t *interrupt = param;
    if (value && !interrupt->pending && !interrupt->running && avr_regbit_get(mcu, interrupt->vector->enable)) {
        interrupt->pending = true;
        interrupt->raised = mcu->cycle;
    }
}

static void keep_longest(longest_t *longest, uint64_t cycles)
{
    if (cycles > longest->cycles) {
        longest->cycles = cycles;
        longest->at_ms = (double)pass_began / CYCLES_PER_MS;
    }
}

void times_pass_ends(void)
{
    if (pass_began == NEVER) {
        return;
    }
    uint64_t cycles = mcu->cycle - pass_began;
    keep_longest(&whole_pass, cycles);
    keep_longest(&own_pass, cycles - (interrupted - interrupted_at_pass));
    passes++;
    pass_began = NEVER;
}

static void on_wake_flag(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)param;
    avr->data[address] = value;
    if (value == 0 && nested == 0) {
        times_pass_ends();
        pass_began = avr->cycle;
        interrupted_at_pass = interrupted;
    }
}

void times_start(void)
{
    for (int i = 0; i < mcu->interrupts.vector_count; i++) {
        avr_int_vector_t *vector = mcu->interrupts.vector[i];
        if (vector->vector == 0 || vector->vector >= VECTORS) {
            continue;
        }
        interrupt_t *interrupt = &interrupts[vector->vector];
        interrupt->vector = vector;
        avr_irq_register_notify(&vector->irq[AVR_INT_IRQ_RUNNING], on_running, interrupt);
        avr_irq_register_notify(&vector->irq[AVR_INT_IRQ_PENDING], on_pending, interrupt);
    }
    avr_register_io_write(mcu, REG_GPIOR0, on_wake_flag, NULL);
}

void times_sleep(uint64_t cycles)
{
    asleep += cycles;
}

uint64_t times_interrupted(void)
{
    return interrupted;
}

uint64_t times_own_cycles(void)
{
    return mcu->cycle - asleep - entering;
}

bool times_in_interrupt(void)
{
    return nested != 0;
}

void times_reset(void)
{
    nested = 0;
    pass_began = NEVER; /* a pass cut off by a reset does not count */
    for (unsigned v = 0; v < VECTORS; v++) {
        interrupts[v].running = false;
        interrupts[v].pending = false;
    }
}

void times_streaming_begins(void)
{
    streaming_from = mcu->cycle;
    slept_from = asleep;
}

void times_streaming_ends(void)
{
    streaming_to = mcu->cycle;
    slept_to = asleep;
}

double times_load(void)
{
    if (streaming_from == NEVER) {
        return mcu->cycle == 0 ? 0.0 : 1.0 - (double)asleep / (double)mcu->cycle;
    }
    uint64_t to = streaming_to != NEVER && streaming_to > streaming_from ? streaming_to : mcu->cycle;
    uint64_t slept = to == streaming_to ? slept_to : asleep;
    return to == streaming_from ? 0.0 : 1.0 - (double)(slept - slept_from) / (double)(to - streaming_from);
}

const char *times_vector_name(unsigned vector)
{
    static char number[16];
    if (vector < VECTORS && vector_name[vector] != NULL) {
        return vector_name[vector];
    }
    snprintf(number, sizeof number, "vector%u", vector);
    return number;
}

static void print_passes(FILE *json)
{
    fprintf(json, "  \"passes\": %llu,\n  \"pass_max_cycles\": %llu,\n  \"pass_max_at_ms\": %.3f,\n",
            (unsigned long long)passes, (unsigned long long)whole_pass.cycles, whole_pass.at_ms);
    fprintf(json, "  \"pass_own_max_cycles\": %llu,\n  \"pass_own_max_at_ms\": %.3f,\n",
            (unsigned long long)own_pass.cycles, own_pass.at_ms);
}

void times_print(FILE *json)
{
    uint64_t worst = 0;
    for (unsigned v = 1; v < VECTORS; v++) {
        const interrupt_t *interrupt = &interrupts[v];
        if (interrupt->count == 0) {
            continue;
        }
        const char *name = times_vector_name(v);
        fprintf(json, "  \"isr_%s_n\": %llu,\n  \"isr_%s_min\": %llu,\n", name, (unsigned long long)interrupt->count,
                name, (unsigned long long)interrupt->min);
        fprintf(json, "  \"isr_%s_mean\": %.2f,\n  \"isr_%s_max\": %llu,\n", name,
                (double)interrupt->sum / (double)interrupt->count, name, (unsigned long long)interrupt->max);
        fprintf(json, "  \"isr_%s_worst_latency\": %llu,\n", name, (unsigned long long)interrupt->worst_latency);
        worst = interrupt->worst_latency > worst ? interrupt->worst_latency : worst;
    }
    fprintf(json, "  \"worst_latency_cycles\": %llu,\n", (unsigned long long)worst);
    print_passes(json);
}
