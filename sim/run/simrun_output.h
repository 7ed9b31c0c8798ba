/* How simrun ends, and files that it writes. */
#ifndef SIMRUN_OUTPUT_H
#define SIMRUN_OUTPUT_H

#include <stdio.h>

typedef enum {
    EXIT_OK = 0,
    EXIT_INTERNAL = 1, /* simrun itself failed: memory, writing a file; or a signal ended it */
    EXIT_INPUT = 2,    /* usage, or a file that cannot be read or is wrong */
    EXIT_CRASH = 3,    /* jump out of the program, access beyond RAM */
    EXIT_OPCODE = 4,   /* illegal opcode */
    EXIT_STACK = 5,    /* stack pointer at or below _end */
    EXIT_UART = 6,     /* a byte written to a UART that was not ready: lost on hardware */
    EXIT_RESETS = 7,   /* number of resets is not --expect-resets */
    EXIT_STOPPED = 8,  /* the firmware slept with interrupts off */
    EXIT_STALLED = 9,  /* no --max-ms, and the sensor was not used for 20 s: the stream would never end */
    EXIT_WRONG = 10,   /* --judge, and a row is wrong, stale or stamped before its predecessor */
    EXIT_RULE = 11,    /* a rule of the data sheet is broken that simavr does not check */
    EXIT_READER = 12   /* --pty, and the program at the other end does not read */
} exit_status_t;

/* Prints "simrun: " and the reason, and exits with EXIT_INPUT. */
void output_refuse(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));

FILE *output_open(const char *path); /* exits with EXIT_INPUT and the reason */
/* Exits with EXIT_INTERNAL if anything written to it was lost; does nothing for NULL. */
void output_close(FILE *file, const char *path);

#endif
