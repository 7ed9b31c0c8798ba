/*
 * What simavr 1.6 gets wrong is corrected here (no-op sleep, interrupts pending at SEI), in simrun_times.c (interrupt
 * entry time), simrun_mcu.c (frequency, level interrupts) and simrun_resets.c (resets that drop every timer), and
 * every instruction is checked: program counter, stack pointer, illegal opcodes.
 */
#include "simrun_machine.h"

#include "sim_avr.h"
#include "sim_core.h"
#include "sim_gdb.h"
#include "simrun_events.h"
#include "simrun_failure.h"
#include "simrun_faults.h"
#include "simrun_frames.h"
#include "simrun_mcu.h"
#include "simrun_profile.h"
#include "simrun_race.h"
#include "simrun_resets.h"
#include "simrun_rules.h"
#include "simrun_sensor.h"
#include "simrun_span.h"
#include "simrun_stack.h"
#include "simrun_times.h"
#include "simrun_uart.h"

enum { CHUNK_CYCLES = 24 /* instructions run without a break between two checks of PC and stack */ };

enum { END_MS = 20, SILENCE_MS = 30, SILENCE_MAX_MS = 2000, STALLED_MS = 20000 };

static machine_options_t options;
static avr_run_t plain_run; /* simavr replaces it for gdb and for a watchdog reset */
static uint64_t max_cycle = NEVER;
static uint32_t last_pc;
static uint64_t steps;

static void no_sleep(avr_t *avr, avr_cycle_count_t cycles)
{
    (void)avr;
    times_pass_ends();
    times_sleep(cycles + 1); /* simavr adds them to avr->cycle itself */
}

void machine_prepare(const machine_options_t *wanted)
{
    options = *wanted;
    failure_start(&last_pc);
}

void machine_start(void)
{
    max_cycle = options.max_ms > 0.0 ? (uint64_t)(options.max_ms * CYCLES_PER_MS) : NEVER;
    events_end_at(max_cycle);
    plain_run = mcu->run;
    if (options.gdb_port != 0) {
        mcu->gdb_port = (int)options.gdb_port;
        mcu->state = cpu_Stopped;
        avr_gdb_init(mcu);
        fprintf(stderr, "simrun: waiting for avr-gdb: target remote :%u\n", options.gdb_port);
    }
    mcu->sleep = no_sleep;
}

uint64_t machine_steps(void)
{
    return steps;
}

/* When the work was done: the stream or the frames are over; NEVER before that. */
static uint64_t done_at(void)
{
    uint64_t now = mcu->cycle;
    if (frames_wanted()) {
        if (frames_silent()) {
            failure_set(EXIT_STALLED, "the board has not answered a frame for 2 s");
        }
        return frames_over_at();
    }
    uint64_t over = sensor_over_at();
    if (over == NEVER && max_cycle == NEVER && !options.interactive &&
        now >= sensor_last_tick() + (uint64_t)STALLED_MS * CYCLES_PER_MS) {
        failure_set(EXIT_STALLED, "the firmware has not used the sensor for 20 s (see --max-ms)");
    }
    return over;
}

static bool ended(void)
{
    uint64_t now = mcu->cycle;
    uint64_t over = done_at();
    if (failure_status() != EXIT_OK || now >= max_cycle || failure_asked_to_end()) {
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
    bool in_program = mcu->pc < mcu_program.flash_bytes || mcu_in_boot_loader(mcu->pc);
    if (state == cpu_Crashed) {
        failure_set(EXIT_CRASH, "crash: jump out of the flash or access beyond the RAM");
    } else if (state == cpu_Done) {
        failure_set(EXIT_STOPPED, "the firmware sleeps with interrupts off");
    } else if (!in_program) {
        failure_set(EXIT_CRASH, "crash: ran into erased flash");
    }
}

static uint64_t next_timer(void)
{
    const avr_cycle_timer_slot_t *first = mcu->cycle_timers.timer;
    return first == NULL ? NEVER : first->when;
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
    if (mcu->interrupt_state > 0 && mcu_opcode_at(last_pc) == OPCODE_SLEEP && mcu_opcode_at(mcu->pc) == OPCODE_CLI) {
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
    if (race_on_step(awake && mcu->run == plain_run)) {
        watch_everything(mcu->state);
    }
    if (awake) {
        faults_on_pc(mcu->pc);
        span_on_pc(mcu->pc);
    }
}

/* A profile wants chunks that end where the program may go elsewhere. */
static uint64_t chunk_at(uint32_t pc)
{
    return profile_wanted() ? profile_straight_cycles(pc, CHUNK_CYCLES) : CHUNK_CYCLES;
}

/* True: more than the PC may have changed. */
static bool measured_step(uint64_t chunk)
{
    bool running = mcu->state == cpu_Running;
    uint64_t began = times_own_cycles();
    last_pc = mcu->pc;
    steps++;
    bool eventful = step(chunk);
    if (running && profile_wanted()) {
        profile_on_step(last_pc, times_own_cycles() - began);
    }
    return eventful;
}

void machine_run(bool each)
{
    bool stack_low = false;
    do {
        if (each) {
            look_ahead();
        }
        bool eventful = measured_step(each || stack_low ? 0 : chunk_at(mcu->pc));
        stack_low = stack_watch(mcu_program.end_of_ram);
        if (eventful || mcu->pc >= mcu_program.flash_bytes) {
            watch_everything(mcu->state);
        }
        if (eventful && ended()) {
            break;
        }
    } while (failure_status() == EXIT_OK);
}
