#include "simrun_failure.h"

#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "sim_avr.h"
#include "simrun_mcu.h"
#include "simrun_symbols.h"

static exit_status_t failure;
static const char *failure_reason;
static uint32_t failure_pc;
static double failure_ms;
static const uint32_t *last_step;
static bool over;
static volatile sig_atomic_t asked_to_end;

void failure_set(exit_status_t status, const char *reason)
{
    if (failure == EXIT_OK) {
        failure = status;
        failure_reason = reason;
        bool plausible = mcu->pc != 0 && mcu->pc < mcu_program.flash_bytes;
        failure_pc = plausible ? mcu->pc : *last_step; /* after a wild jump it is the most useful */
        failure_ms = mcu_ms();
    }
}

/* simavr only logs an illegal opcode and continues; without this its reader of ELF files prints to stdout. */
static void on_log(avr_t *avr, const int level, const char *format, va_list arguments)
{
    char text[256];
    if (avr == NULL || over) {
        return;
    }
    vsnprintf(text, sizeof text, format, arguments);
    if (strstr(text, "nvalid Opcode") != NULL || strstr(text, "nvalid opcode") != NULL) {
        failure_set(EXIT_OPCODE, "illegal opcode");
    } else if (level <= LOG_ERROR && failure == EXIT_OK) {
        fprintf(stderr, "simavr: %s", text);
    }
}

static void on_signal(int number)
{
    (void)number;
    asked_to_end = 1;
}

bool failure_asked_to_end(void)
{
    return asked_to_end != 0;
}

void failure_start(const uint32_t *last_pc)
{
    (void)signal(SIGINT, on_signal);
    (void)signal(SIGTERM, on_signal);
    last_step = last_pc;
    avr_global_logger_set(on_log);
}

exit_status_t failure_status(void)
{
    return failure;
}

exit_status_t failure_end(const char **reason)
{
    static char text[512];
    over = true;
    if (failure != EXIT_OK) {
        snprintf(text, sizeof text, "%s, at %.3f ms, PC 0x%04x (%s)", failure_reason, failure_ms, (unsigned)failure_pc,
                 symbols_nearest(failure_pc));
    }
    *reason = text;
    return failure;
}
