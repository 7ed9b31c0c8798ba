/*
 * Those that simavr does itself (watchdog, gdb), those requested by a fault or an opened port, and how many there were.
 */
#include "simrun_resets.h"

#include <stddef.h>

#include "simrun_mcu.h"
#include "simrun_stack.h"

/* r0..r31; from here to RAM_START are the I/O registers, which a reset sets itself */
enum { REGISTERS_END = 32 };

static void (*core_reset)(avr_t *);
static void (*set_up_parts)(bool power_lost);
static bool port_resets;
static bool reset_happened, reset_wanted, port_opened;
static reset_t wanted_kind;
static uint32_t resets, boot_resets;

uint32_t resets_count(void)
{
    return resets;
}

uint32_t resets_boot_count(void)
{
    return boot_resets;
}

/* Only records it: after this call simavr still resets its own parts and drops all timers. */
static void on_reset(avr_t *avr)
{
    if (core_reset != NULL) {
        core_reset(avr);
    }
    reset_happened = true;
}

/* What a reset of the MCU leaves to simrun. */
static void set_up_again(bool power_lost)
{
    mcu_poll_no_levels();
    mcu_forget_strap();
    set_up_parts(power_lost);
}

static void power_cycle(void)
{
    (void)stack_high_water();
    for (unsigned i = 0; i <= RAM_END; i++) {
        if (i < REGISTERS_END || i >= RAM_START) {
            mcu->data[i] = (uint8_t)mcu_random();
        }
    }
    stack_paint_is();
}

static void do_wanted_reset(void)
{
    bool power = wanted_kind == RESET_POWER_ON;
    bool counted = !port_opened;
    reset_wanted = false;
    port_opened = false;
    if (power) {
        power_cycle();
    }
    avr_reset(mcu);
    const avr_regbit_t cause[] = { [RESET_EXTERNAL] = mcu->reset_flags.extrf,
                                   [RESET_POWER_ON] = mcu->reset_flags.porf,
                                   [RESET_BROWN_OUT] = mcu->reset_flags.borf };
    avr_regbit_set(mcu, cause[wanted_kind]);
    set_up_again(power);
    resets += counted ? 1u : 0u;
    reset_happened = false;
}

void resets_want(reset_t kind)
{
    reset_wanted = true;
    wanted_kind = kind;
}

bool resets_wanted(void)
{
    return reset_wanted;
}

void resets_port_opened(void)
{
    if (port_resets) {
        port_opened = !reset_wanted;
        resets_want(RESET_EXTERNAL);
    }
}

static void own_reset_came(uint32_t last_pc)
{
    reset_happened = false;
    set_up_again(false);
    if (mcu_in_boot_loader(last_pc)) {
        boot_resets++;
    } else {
        resets++;
    }
}

void resets_start(bool boot_loader, void (*set_up)(bool power_lost))
{
    port_resets = boot_loader;
    set_up_parts = set_up;
    core_reset = mcu->reset;
    mcu->reset = on_reset;
    set_up_again(false);
}

void resets_watch(uint32_t last_pc)
{
    if (reset_happened) {
        own_reset_came(last_pc);
    }
    if (reset_wanted) {
        do_wanted_reset();
    }
}
