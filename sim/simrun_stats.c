/* Counts and times of a run, taken through simavr's hooks: the firmware carries no code for it. */
#include <stdlib.h>
#include <string.h>

#include "sim_interrupts.h"
#include "simrun.h"

enum {
    VECTORS = 26,
    VECTOR_BYTES = 4,
    ENTRY_CYCLES = 4, /* interrupt response (data sheet "Interrupt Response Time"), which simavr omits */
    RAM_START = 0x100,
    RAM_END = 0x8FF,
    FLASH_WORDS = 0x4000
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
bool stats_profiling;
static uint64_t entering; /* cycles of interrupt responses */
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
    entering += ENTRY_CYCLES;
    mcu->cycle += ENTRY_CYCLES;
}

static void leave(interrupt_t *interrupt)
{
    enum { RETI_CYCLES = 4 }; /* simavr notifies before it counts them */
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
    stats_profiling = options.profile != NULL || options.calls != NULL;
    if (options.profile != NULL) {
        profile = calloc(FLASH_WORDS, sizeof *profile);
        if (profile == NULL) {
            fputs("simrun: out of memory\n", stderr);
            exit(EXIT_INTERNAL);
        }
    }
}

uint64_t stats_own_cycles(void)
{
    return mcu->cycle - stats_slept - entering;
}

bool stats_in_interrupt(void)
{
    return nested != 0;
}

void stats_reset(void)
{
    nested = 0;
    calls_reset();
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

/* The response to an interrupt is charged to the vector, not to the instruction, or the sleep, after which it came. */
void stats_profile(uint32_t pc, uint64_t cycles)
{
    bool interrupt = pc != 0 && pc / VECTOR_BYTES < VECTORS;
    cycles += interrupt ? ENTRY_CYCLES : 0u;
    if (profile != NULL) {
        uint32_t word = pc / 2 % FLASH_WORDS;
        profile[word].count++;
        profile[word].cycles += cycles;
    }
    if (options.calls != NULL) {
        calls_on_step(pc, cycles, interrupt);
    }
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

const char *stats_vector_name(unsigned vector)
{
    static char number[16];
    if (vector < VECTORS && vector_name[vector] != NULL) {
        return vector_name[vector];
    }
    snprintf(number, sizeof number, "vector%u", vector);
    return number;
}

static void write_interrupts(FILE *file)
{
    uint64_t worst = 0;
    for (unsigned v = 1; v < VECTORS; v++) {
        const interrupt_t *interrupt = &interrupts[v];
        if (interrupt->count == 0) {
            continue;
        }
        const char *name = stats_vector_name(v);
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
    fprintf(file, "  \"samples_served\": %zu,\n  \"sensor_overruns\": %u,\n", sensor_served_count(),
            (unsigned)sensor.overruns);
    sensor_print(file);
    fprintf(file, "  \"samples_altered\": %u,\n", (unsigned)alter_count());
    frames_print(file);
    rows_print(file);
    flow_print(file);
    eeprom_print(file);
    rules_print(file);
    fprintf(file, "  \"uart_baud\": %.0f,\n", 1e6 * CYCLES_PER_US * 10.0 / (double)uart_frame_cycles());
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
    fprintf(file, "  \"simulator_steps\": %llu,\n", (unsigned long long)machine_steps);
    unsigned ram = machine_size.end_of_ram - RAM_START;
    fprintf(file, "  \"flash_bytes\": %u,\n  \"ram_static_bytes\": %u,\n", (unsigned)machine_size.flash_bytes, ram);
    fprintf(file, "  \"stack_high_water_bytes\": %u,\n  \"ram_used_bytes\": %u,\n", (unsigned)stack_high_water(),
            ram + (unsigned)stack_high_water());
    faults_print(file);
    verdict_print(file);
    fprintf(file, "  \"boot_resets\": %u,\n  \"resets\": %u\n}\n", (unsigned)resets_boot_count(),
            (unsigned)resets_count());
    output_close(file, options.stats);
}

void stats_summary(void)
{
    fprintf(stderr, "simrun: %.1f ms, %zu samples served, %zu rows, load %.2f %%, stack %u of %u bytes, %u resets\n",
            machine_ms(), sensor_served_count(), rows_count(), 100.0 * load(), (unsigned)stack_high_water(),
            (unsigned)(RAM_END + 1 - machine_size.end_of_ram), (unsigned)resets_count());
}
