/*
 * A main loop that gets no time, as if what it calls never came back, while interrupts go on: simavr is made to sleep
 * before each instruction outside of a handler.
 */
#include "simrun.h"

static avr_run_t run_before;

/* Between SEI and SLEEP nothing comes: it falls asleep, and starves when it is woken. */
static bool falls_asleep(const avr_t *avr)
{
    return machine_opcode_at(avr->pc) == OPCODE_SLEEP;
}

static void run_handlers_only(avr_t *avr)
{
    if (avr->state == cpu_Running && !stats_in_interrupt() && avr->sreg[S_I] && !falls_asleep(avr)) {
        avr->state = cpu_Sleeping;
    }
    run_before(avr);
    if (avr->state == cpu_Sleeping && !avr->sreg[S_I]) {
        avr->state = cpu_Running; /* an interrupt that was pending before the sleep does not end it for simavr */
    }
}

void starve(bool on)
{
    if (on && mcu->run != run_handlers_only) {
        run_before = mcu->run;
        mcu->run = run_handlers_only;
    } else if (!on && mcu->run == run_handlers_only) {
        mcu->run = run_before;
        mcu->state = mcu->state == cpu_Sleeping ? cpu_Running : mcu->state;
    }
}
