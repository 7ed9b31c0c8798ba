/* Counts and times of a run, taken through simavr's hooks: the firmware carries no code for it. */
#include <stdlib.h>
#include <string.h>

#include "sim_interrupts.h"
#include "simrun.h"

enum {
    VECTORS = 26,
    ENTRY_CYCLES = 4, /* interrupt response (data sheet "Interrupt Response Time"), which simavr leaves out */
    RAM_START = 0x100,
    RAM_END = 0x8FF,
    FLASH_WORDS = 0x4000,
    LOOK_BACK = 64,
    FLAG_GATED = 1,
    FLAG_COASTED = 2,
    FLAG_FAULT = 16
};

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

uint64_t stats_slept;
uint64_t stats_interrupted;
static unsigned nested;
static interrupt_t interrupts[VECTORS];
static uint64_t streaming_from = NEVER, slept_from, streaming_to = NEVER, slept_to;
static struct {
    uint64_t count, cycles;
} * profile;

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
    mcu->cycle += ENTRY_CYCLES;
}

static void leave(interrupt_t *interrupt)
{
    enum { RETI_CYCLES = 4 }; /* simavr tells before it counts them */
    uint64_t cycles = mcu->cycle + RETI_CYCLES - interrupt->entered;
    interrupt->running = false;
    nested--;
    stats_interrupted += cycles;
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

void stats_start(void)
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
    if (options.profile != NULL) {
        profile = calloc(FLASH_WORDS, sizeof *profile);
        if (profile == NULL) {
            fputs("simrun: out of memory\n", stderr);
            exit(EXIT_INTERNAL);
        }
    }
}

bool stats_in_interrupt(void)
{
    return nested != 0;
}

void stats_reset(void)
{
    nested = 0;
    for (unsigned v = 0; v < VECTORS; v++) {
        interrupts[v].running = false;
        interrupts[v].pending = false;
    }
}

void stats_streaming_begins(void)
{
    streaming_from = mcu->cycle;
    slept_from = stats_slept;
}

void stats_streaming_ends(void)
{
    streaming_to = mcu->cycle;
    slept_to = stats_slept;
}

void stats_profile(uint32_t pc, uint64_t cycles)
{
    uint32_t word = pc / 2 % FLASH_WORDS;
    profile[word].count++;
    profile[word].cycles += cycles;
}

void stats_profile_write(void)
{
    if (profile == NULL) {
        return;
    }
    FILE *file = output_open(options.profile);
    fputs("pc,count,cycles,symbol\n", file);
    for (uint32_t word = 0; word < FLASH_WORDS; word++) {
        if (profile[word].count != 0) {
            fprintf(file, "0x%04x,%llu,%llu,%s\n", (unsigned)word * 2, (unsigned long long)profile[word].count,
                    (unsigned long long)profile[word].cycles, symbols_nearest(word * 2));
        }
    }
    output_close(file, options.profile);
    free(profile);
}

static double load(void)
{
    if (streaming_from == NEVER) {
        return mcu->cycle == 0 ? 0.0 : 1.0 - (double)stats_slept / (double)mcu->cycle;
    }
    uint64_t to = streaming_to != NEVER && streaming_to > streaming_from ? streaming_to : mcu->cycle;
    uint64_t slept = to == streaming_to ? slept_to : stats_slept;
    return to == streaming_from ? 0.0 : 1.0 - (double)(slept - slept_from) / (double)(to - streaming_from);
}

static int compare_steps(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a;
    uint32_t y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Median time from row to row in samples of the last rate in force: the `every` that was in force. */
static unsigned every_seen(void)
{
    size_t count = uart_row_count();
    double period_us = sensor_period_us();
    uint32_t *steps = count < 2 || period_us <= 0.0 ? NULL : malloc((count - 1) * sizeof *steps);
    if (steps == NULL) {
        return 1;
    }
    for (size_t i = 1; i < count; i++) {
        steps[i - 1] = uart_row(i)->t_us - uart_row(i - 1)->t_us;
    }
    qsort(steps, count - 1, sizeof *steps, compare_steps);
    double median_us = steps[(count - 1) / 2];
    free(steps);
    double every = median_us / period_us + 0.5;
    return every < 1.0 ? 1 : (unsigned)every;
}

/* Index of the newest sample that the row can show, at the time it was sent. */
static size_t served_of(const row_t *row)
{
    size_t count = sensor_served_count();
    while (count > 0 && sensor_served(count - 1)->cycle > row->sent) {
        count--;
    }
    for (size_t i = count; i > 0 && i + LOOK_BACK > count; i--) {
        if (memcmp(sensor_served(i - 1)->lsb, row->lsb, sizeof row->lsb) == 0) {
            return i - 1;
        }
    }
    return count == 0 ? 0 : count - 1;
}

/*
 * Samples served from that of the first row to that of the last one that is no prediction, less those the rows stand
 * for. The rows' own time stamps measure the distance; a lost remainder shorter than one row is not seen. Only for a
 * run at one rate without resets or faults: the file of --served is the judge.
 */
static unsigned lost(unsigned every)
{
    size_t rows = 0;
    size_t last = 0;
    for (size_t i = 0; i < uart_row_count(); i++) {
        if (every > 1 || (uart_row(i)->flags & (FLAG_COASTED | FLAG_FAULT)) == 0) {
            rows++;
            last = i;
        }
    }
    if (rows < 2) {
        return 0;
    }
    size_t first_served = served_of(uart_row(0));
    uint64_t span_us = uart_row(last)->t_us - uart_row(0)->t_us;
    uint64_t until = sensor_served(first_served)->cycle +
                     (uint64_t)(((double)span_us + sensor_period_us() / 2.0) * CYCLES_PER_US);
    size_t served = 0;
    for (size_t i = first_served + 1; i < sensor_served_count() && sensor_served(i)->cycle <= until; i++) {
        served++;
    }
    size_t shown = (rows - 1) * every;
    return served > shown ? (unsigned)(served - shown) : 0;
}

static unsigned rows_with(unsigned flags)
{
    unsigned count = 0;
    for (size_t i = 0; i < uart_row_count(); i++) {
        count += (uart_row(i)->flags & flags) != 0;
    }
    return count;
}

static void write_interrupts(FILE *file)
{
    uint64_t worst = 0;
    for (unsigned v = 1; v < VECTORS; v++) {
        const interrupt_t *interrupt = &interrupts[v];
        if (interrupt->count == 0) {
            continue;
        }
        char number[16];
        snprintf(number, sizeof number, "vector%u", v);
        const char *name = vector_name[v] != NULL ? vector_name[v] : number;
        fprintf(file, "  \"isr_%s_n\": %llu,\n  \"isr_%s_min\": %llu,\n", name, (unsigned long long)interrupt->count,
                name, (unsigned long long)interrupt->min);
        fprintf(file, "  \"isr_%s_mean\": %.2f,\n  \"isr_%s_max\": %llu,\n", name,
                (double)interrupt->sum / (double)interrupt->count, name, (unsigned long long)interrupt->max);
        fprintf(file, "  \"isr_%s_worst_latency\": %llu,\n", name, (unsigned long long)interrupt->worst_latency);
        worst = interrupt->worst_latency > worst ? interrupt->worst_latency : worst;
    }
    fprintf(file, "  \"worst_latency_cycles\": %llu,\n", (unsigned long long)worst);
}

static void write_samples(FILE *file)
{
    unsigned every = every_seen();
    fprintf(file, "  \"samples_served\": %zu,\n  \"sensor_overruns\": %u,\n", sensor_served_count(),
            (unsigned)sensor.overruns);
    fprintf(file, "  \"samples_altered\": %u,\n", (unsigned)alter_count());
    fprintf(file, "  \"rows\": %zu,\n  \"every\": %u,\n  \"lost\": %u,\n", uart_row_count(), every, lost(every));
    fprintf(file, "  \"gated\": %u,\n  \"coasted\": %u,\n  \"fault_rows\": %u,\n", rows_with(FLAG_GATED),
            rows_with(FLAG_COASTED), rows_with(FLAG_FAULT));
    fprintf(file, "  \"uart_bytes\": %llu,\n  \"uart_rx_overruns\": %u,\n", (unsigned long long)uart_bytes(),
            (unsigned)uart_rx_overruns());
    fprintf(file, "  \"i2c_transfers\": %u,\n  \"i2c_bytes\": %llu,\n", (unsigned)twi.transfer,
            (unsigned long long)twi.bytes);
    fprintf(file, "  \"i2c_hand_clocks_max\": %u,\n  \"i2c_hand_stops\": %u,\n  \"i2c_driven_high\": %s,\n",
            (unsigned)twi.hand_clocks_max, (unsigned)twi.hand_stops, twi.driven_high ? "true" : "false");
    fprintf(file, "  \"i2c_load\": %.5f,\n", mcu->cycle == 0 ? 0.0 : (double)twi.busy_cycles / (double)mcu->cycle);
}

void stats_write(exit_status_t status)
{
    if (options.stats == NULL) {
        return;
    }
    FILE *file = output_open(options.stats);
    fprintf(file, "{\n  \"exit_status\": %d,\n  \"sim_ms\": %.3f,\n", (int)status, machine_ms());
    if (options.filter != NULL) {
        fprintf(file, "  \"filter\": \"%s\",\n", options.filter);
    }
    write_samples(file);
    fprintf(file, "  \"cpu_load\": %.5f,\n", load());
    write_interrupts(file);
    pass_print(file);
    unsigned ram = machine_size.end_of_ram - RAM_START;
    fprintf(file, "  \"flash_bytes\": %u,\n  \"ram_static_bytes\": %u,\n", (unsigned)machine_size.flash_bytes, ram);
    fprintf(file, "  \"stack_high_water_bytes\": %u,\n  \"ram_used_bytes\": %u,\n", (unsigned)stack_high_water(),
            ram + (unsigned)stack_high_water());
    faults_print(file);
    verdict_print(file);
    fprintf(file, "  \"boot_resets\": %u,\n  \"resets\": %u\n}\n", (unsigned)machine_boot_resets(),
            (unsigned)machine_resets());
    output_close(file, options.stats);
}

void stats_summary(void)
{
    fprintf(stderr, "simrun: %.1f ms, %zu samples served, %zu rows, load %.2f %%, stack %u of %u bytes, %u resets\n",
            machine_ms(), sensor_served_count(), uart_row_count(), 100.0 * load(), (unsigned)stack_high_water(),
            (unsigned)(RAM_END + 1 - machine_size.end_of_ram), (unsigned)machine_resets());
}
