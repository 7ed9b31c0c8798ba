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

static void run_handlers_only(avr_t *avr)
{
    if (avr->state == cpu_Running && !times_in_interrupt() && avr->sreg[S_I] && !falls_asleep(avr)) {
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
