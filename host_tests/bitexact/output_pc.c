#include "output.h"

#include <stdio.h>

#include "hal_time.h"

uint32_t hal_host_cpu_hz = 16000000; /* settings.c asks for the processor's clock */

void output_start(void) {}

void output_char(char c)
{
    putchar(c);
}

void output_end(void)
{
    fflush(stdout);
}
