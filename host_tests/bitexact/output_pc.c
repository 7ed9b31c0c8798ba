#include "output.h"

#include <stdio.h>

void output_start(void) {}

void output_char(char c)
{
    putchar(c);
}

void output_end(void)
{
    fflush(stdout);
}
