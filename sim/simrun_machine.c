/*
 * The ATmega328P: what simavr 1.6 gets wrong is corrected here (no-op sleep, interrupt entry time, frequency) and in
 * simrun_resets.c (resets that drop every timer, level interrupts), and every instruction is checked: program counter,
 * stack pointer, illegal opcodes.
 */
#include <stdlib.h>
#include <string.h>

#include "avr_ioport.h"
#include "sim_avr.h"
#include "sim_core.h"
#include "sim_elf.h"
#include "sim_gdb.h"
#include "simrun.h"

enum {
    FLASH_BYTES = 0x8000,
    CHUNK_CYCLES = 24 /* instructions run without a break between two checks of PC and stack */
};

enum { END_MS = 20, SILENCE_MS = 30, SILENCE_MAX_MS = 2000, STALLED_MS = 20000 };

avr_t *mcu;
twi_peripheral_t twi;

program_size_t machine_size;
static uint32_t boot_start = FLASH_BYTES;
static uint32_t last_pc;
static exit_status_t failure;
static const char *failure_reason;
static uint32_t failure_pc;
static double failure_ms;
static uint32_t random_state;
static bool stopping;
static avr_run_t plain_run; /* simavr replaces it for gdb and for a watchdog reset */
static uint64_t max_cycle = NEVER;
static bool interactive;
static uint32_t chunk_cycles;
uint64_t machine_steps;

double machine_ms(void)
{
    return (double)mcu->cycle / CYCLES_PER_MS;
}

bool machine_in_boot_loader(uint32_t pc)
{
    return pc >= boot_start && pc < FLASH_BYTES;
}

uint32_t machine_random(void)
{
    random_state ^= random_state << 13;
    random_state ^= random_state >> 17;
    random_state ^= random_state << 5;
    return random_state;
}

void machine_fail(exit_status_t status, const char *reason)
{
    if (failure == EXIT_OK) {
        failure = status;
        failure_reason = reason;
        bool plausible = mcu->pc != 0 && mcu->pc < machine_size.flash_bytes;
        failure_pc = plausible ? mcu->pc : last_pc; /* after a wild jump, the place it came from is the most useful */
        failure_ms = machine_ms();
    }
}

/* simavr only logs an illegal opcode and continues; without this its reader of ELF files prints to stdout. */
static void on_log(avr_t *avr, const int level, const char *format, va_list arguments)
{
    char text[256];
    if (avr == NULL || stopping) {
        return;
    }
    vsnprintf(text, sizeof text, format, arguments);
    if (strstr(text, "nvalid Opcode") != NULL || strstr(text, "nvalid opcode") != NULL) {
        machine_fail(EXIT_OPCODE, "illegal opcode");
    } else if (level <= LOG_ERROR && failure == EXIT_OK) {
        fprintf(stderr, "simavr: %s", text);
    }
}

static void no_sleep(avr_t *avr, avr_cycle_count_t cycles)
{
    (void)avr;
    pass_ends();
    stats_slept += cycles + 1; /* simavr adds them to avr->cycle itself */
}

static avr_cycle_count_t on_event(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)when;
    (void)param;
    if (sensor_next() <= avr->cycle) {
        sensor_step();
    }
    if (uart_next() <= avr->cycle) {
        uart_step();
    }
    if (faults_next() <= avr->cycle) {
        faults_step();
    }
    if (eeprom_next() <= avr->cycle) {
        eeprom_step();
    }
    machine_reschedule();
    return 0;
}

static uint64_t earliest(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

void machine_reschedule(void)
{
    uint64_t at = earliest(earliest(sensor_next(), uart_next()), earliest(faults_next(), eeprom_next()));
    at = earliest(earliest(at, max_cycle), mcu->cycle + CYCLES_PER_MS); /* the end of the run is checked every ms */
    avr_cycle_timer_register(mcu, at > mcu->cycle ? at - mcu->cycle : 1, on_event, NULL);
}

static void on_bus_byte(void *owner, uint32_t transfer, uint32_t byte)
{
    (void)owner;
    faults_on_byte(transfer, byte);
}

static void after_bus_byte(void *owner)
{
    (void)owner;
    sensor_check_rate();
    faults_after_byte();
}

static void refuse(const char *path, const char *reason) __attribute__((noreturn));
static void refuse(const char *path, const char *reason)
{
    fprintf(stderr, "simrun: %s: %s\n", path, reason);
    exit(EXIT_INPUT);
}

/* Starts in the boot loader as after the reset that an UNO gets when its port is opened. */
static void load_boot_loader(void)
{
    if (options.blank) {
        memset(mcu->flash, 0xFF, FLASH_BYTES);
    }
    boot_start = bootloader_load();
    mcu->codeend = FLASH_BYTES;
    mcu->reset_pc = boot_start;
    mcu->pc = boot_start;
    avr_regbit_clear(mcu, mcu->reset_flags.porf);
    avr_regbit_set(mcu, mcu->reset_flags.extrf);
}

static void load_program(void)
{
    elf_firmware_t program;
    memset(&program, 0, sizeof program);
    symbols_load(options.fw, &machine_size);
    if (elf_read_firmware(options.fw, &program) != 0) {
        refuse(options.fw, "not a firmware that simavr can load");
    }
    if (machine_size.flash_bytes > FLASH_BYTES) {
        refuse(options.fw, "larger than the flash");
    }
    mcu = avr_make_mcu_by_name("atmega328p");
    if (mcu == NULL || avr_init(mcu) != 0) {
        refuse("libsimavr", "no ATmega328P in it");
    }
    snprintf(program.mmcu, sizeof program.mmcu, "atmega328p");
    program.frequency = CYCLES_PER_MS * 1000u;
    mcu->frequency = program.frequency;
    avr_load_firmware(mcu, &program);
    mcu->codeend = program.flashsize;
    mcu->log = LOG_WARNING;
    free(program.flash);
}

static bool instructions_are_watched(void)
{
    return faults_watch_pc || span_wanted || race_wanted || stats_profiling;
}

void machine_start(void)
{
    random_state = options.seed * 2654435769u; /* a small seed gives small numbers at first, below every probability */
    interactive = options.pty || options.gdb_port != 0;
    signals_start();
    avr_global_logger_set(on_log);
    load_program();
    max_cycle = options.max_ms > 0.0 ? (uint64_t)(options.max_ms * CYCLES_PER_MS) : NEVER;
    stack_paint();
    if (options.bootloader != NULL) {
        load_boot_loader();
    }
    if (options.strap) {
        avr_ioport_external_t ground = { .name = 'D', .mask = 1u << PIN_STRAP, .value = 0 };
        avr_ioctl(mcu, AVR_IOCTL_IOPORT_SET_EXTERNAL('D'), &ground);
    }
    plain_run = mcu->run;
    if (options.gdb_port != 0) {
        mcu->gdb_port = (int)options.gdb_port;
        mcu->state = cpu_Stopped;
        avr_gdb_init(mcu);
        fprintf(stderr, "simrun: waiting for avr-gdb: target remote :%u\n", options.gdb_port);
    }
    mcu->sleep = no_sleep;
    twi.sensor = &sensor;
    twi.before_byte = on_bus_byte;
    twi.after_byte = after_bus_byte;
    vcd_start();
    sensor_start();
    if (!twi_attach(&twi, mcu)) {
        refuse("libsimavr", "no two-wire interface in it");
    }
    uart_start();
    eeprom_start();
    verdict_start();
    stats_start();
    faults_start();
    span_start();
    pass_start();
    race_start();
    chunk_cycles = instructions_are_watched() ? 0 : CHUNK_CYCLES;
    rules_start();
    resets_start();
}

/* When the work was done: the stream or the frames are over; NEVER before that. */
static uint64_t done_at(void)
{
    uint64_t now = mcu->cycle;
    if (options.frames != NULL) {
        if (frames_silent()) {
            machine_fail(EXIT_STALLED, "the board has not answered a frame for 2 s");
        }
        return frames_over_at();
    }
    uint64_t over = sensor_over_at();
    if (over == NEVER && max_cycle == NEVER && !interactive &&
        now >= sensor_last_tick() + (uint64_t)STALLED_MS * CYCLES_PER_MS) {
        machine_fail(EXIT_STALLED, "the firmware has not used the sensor for 20 s (see --max-ms)");
    }
    return over;
}

static bool ended(void)
{
    uint64_t now = mcu->cycle;
    uint64_t over = done_at();
    if (failure != EXIT_OK || now >= max_cycle || signals_asked_to_end()) {
        return true;
    }
    if (over == NEVER || now < over + (uint64_t)END_MS * CYCLES_PER_MS) {
        return false;
    }
    return now >= uart_last_tx() + (uint64_t)SILENCE_MS * CYCLES_PER_MS ||
           now >= over + (uint64_t)SILENCE_MAX_MS * CYCLES_PER_MS;
}

static void watch_state(int state)
{
    bool in_program = mcu->pc < machine_size.flash_bytes || machine_in_boot_loader(mcu->pc);
    if (state == cpu_Crashed) {
        machine_fail(EXIT_CRASH, "crash: jump out of the flash or access beyond the RAM");
    } else if (state == cpu_Done) {
        machine_fail(EXIT_STOPPED, "the firmware sleeps with interrupts off");
    } else if (!in_program) {
        machine_fail(EXIT_CRASH, "crash: ran into erased flash");
    }
}

static uint64_t next_timer(void)
{
    const avr_cycle_timer_slot_t *first = mcu->cycle_timers.timer;
    return first == NULL ? NEVER : first->when;
}

unsigned machine_opcode_at(uint32_t pc)
{
    return mcu->flash[pc] | (unsigned)mcu->flash[pc + 1] << 8;
}

/*
 * simavr serves what was pending at SEI one instruction later than the processor does. In a loop of SEI, SLEEP, CLI it
 * never would: a SLEEP that finds something pending falls through.
 */
static void serve_interrupts(void)
{
    enum { OPCODE_CLI = 0x94F8 };
    if (mcu->interrupt_state == 0) {
        return;
    }
    avr_service_interrupts(mcu);
    if (mcu->interrupt_state > 0 && machine_opcode_at(last_pc) == OPCODE_SLEEP &&
        machine_opcode_at(mcu->pc) == OPCODE_CLI) {
        avr_service_interrupts(mcu);
    }
}

/*
 * A few instructions, as avr_run does them, but without checking every timer after each: four times as fast, same
 * cycles (a newly set timer makes simavr end the chunk in time). True if more than the PC may have changed.
 */
static bool step(uint64_t chunk)
{
    bool plain = mcu->state == cpu_Running && mcu->run == plain_run;
    if (!plain) {
        avr_run(mcu);
        return true;
    }
    uint64_t first = next_timer();
    uint64_t left = first > mcu->cycle ? first - mcu->cycle : 0;
    mcu->run_cycle_count = left < chunk ? left : chunk;
    mcu->pc = avr_run_one(mcu);
    rules_on_step(last_pc);
    if (next_timer() > mcu->cycle && mcu->interrupt_state == 0 && mcu->state == cpu_Running) {
        return false;
    }
    if (mcu->state == cpu_Running) {
        avr_cycle_timer_process(mcu);
        serve_interrupts();
        if (next_timer() <= mcu->cycle) { /* the entry took time: simavr drops a compare it sees 9 cycles late */
            avr_cycle_timer_process(mcu);
        }
    }
    return true;
}

static void watch_everything(int state)
{
    resets_watch(last_pc);
    watch_state(state);
}

/* Calls the options that need to see each instruction beforehand. */
static void look_ahead(void)
{
    bool awake = mcu->state == cpu_Running;
    if (race_wanted && race_on_step(awake && mcu->run == plain_run)) {
        watch_everything(mcu->state);
    }
    if (faults_watch_pc && awake) {
        faults_on_pc(mcu->pc);
    }
    if (span_wanted && awake) {
        span_on_pc(mcu->pc);
    }
}

static void run(void)
{
    bool stack_low = false;
    do {
        if (chunk_cycles == 0) {
            look_ahead();
        }
        bool running = mcu->state == cpu_Running;
        uint64_t began = stats_own_cycles();
        last_pc = mcu->pc;
        machine_steps++;
        bool eventful = step(stack_low ? 0 : chunk_cycles);
        stack_low = stack_watch(machine_size.end_of_ram);
        if (stats_profiling && running) {
            stats_profile(last_pc, stats_own_cycles() - began);
        }
        if (eventful || mcu->pc >= machine_size.flash_bytes) {
            watch_everything(mcu->state);
        }
        if (eventful && ended()) {
            break;
        }
    } while (failure == EXIT_OK);
}

exit_status_t machine_run(const char **reason)
{
    static char text[512];
    run();
    stopping = true;
    if (signals_asked_to_end() && !interactive) {
        machine_fail(EXIT_INTERNAL, "ended by a signal");
    }
    if (failure == EXIT_OK && resets_count() != options.expect_resets) {
        failure = EXIT_RESETS;
        snprintf(text, sizeof text, "%u resets of the MCU, %u expected (--expect-resets)", (unsigned)resets_count(),
                 options.expect_resets);
    } else if (failure == EXIT_OK && verdict_reason() != NULL) {
        failure = EXIT_WRONG;
        snprintf(text, sizeof text, "%s", verdict_reason());
    } else if (failure != EXIT_OK) {
        snprintf(text, sizeof text, "%s, at %.3f ms, PC 0x%04x (%s)", failure_reason, failure_ms, (unsigned)failure_pc,
                 symbols_nearest(failure_pc));
    }
    *reason = text;
    return failure;
}
