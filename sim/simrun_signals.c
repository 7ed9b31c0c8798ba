/* A run that is ended by a signal keeps its files and prints its summary. */
#include <signal.h>

#include "simrun.h"

static volatile sig_atomic_t asked_to_end;

static void on_signal(int number)
{
    (void)number;
    asked_to_end = 1;
}

void signals_start(void)
{
    (void)signal(SIGINT, on_signal);
    (void)signal(SIGTERM, on_signal);
}

bool signals_asked_to_end(void)
{
    return asked_to_end != 0;
}
