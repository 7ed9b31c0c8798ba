/* simavr is made to sleep before each instruction outside a handler. */
#include "simrun_starve.h"

#include "simrun_mcu.h"
#include "simrun_times.h"

static avr_run_t run_before;

/* Nothing may come between SEI and SLEEP: it is allowed to sleep, and starves once it is woken. */
static bool falls_asleep(const avr_t *avr)
{
    return mcu_opcode_at(avr->pc) == OPCODE_SLEEP;
}

/*
 * What is pending already would not end a sleep of simavr before its next timer. No instruction of main comes between
 * two handlers. True: a handler runs.
 */
static bool serves_pending(avr_t *avr)
{
    uint64_t began = avr->cycle;
    while (avr->interrupt_state != 0 && avr->sreg[S_I] && !times_in_interrupt()) {
        avr_service_interrupts(avr);
    }
    if (avr->cycle != began) {
        avr_cycle_timer_process(avr); /* the entry took time */
    }
    return times_in_interrupt();
}

static void run_handlers_only(avr_t *avr)
{
    if (avr->state == cpu_Running && !times_in_interrupt() && avr->sreg[S_I] && !falls_asleep(avr)) {
        if (serves_pending(avr)) {
            return;
        }
        avr->state = cpu_Sleeping;
    }
    run_before(avr);
    if (avr->state == cpu_Sleeping && !avr->sreg[S_I]) {
        avr->state = cpu_Running; /* for simavr an interrupt that was pending before the sleep does not end it */
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
