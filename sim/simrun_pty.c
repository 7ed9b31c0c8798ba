/* A pseudo terminal in place of the USB serial port, in real time: for a terminal program, a plotter or avrdude. */
#define _GNU_SOURCE /* posix_openpt, cfmakeraw */

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "simrun.h"

static int master = -1;
static int slave = -1; /* kept open, or the master reads errors until somebody opens it */
static struct timespec began;

void pty_open(void)
{
    master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    const char *name = master < 0 || grantpt(master) != 0 || unlockpt(master) != 0 ? NULL : ptsname(master);
    slave = name == NULL ? -1 : open(name, O_RDWR | O_NOCTTY);
    struct termios settings;
    if (slave < 0 || tcgetattr(slave, &settings) != 0) {
        perror("simrun: pseudo terminal");
        exit(EXIT_INTERNAL);
    }
    cfmakeraw(&settings);
    tcsetattr(slave, TCSANOW, &settings);
    fprintf(stderr, "simrun: UART on %s\n", name);
    clock_gettime(CLOCK_MONOTONIC, &began);
}

/* What nobody reads is lost, as on a board without a PC. */
void pty_send(uint8_t byte)
{
    ssize_t sent = write(master, &byte, 1);
    if (sent < 0 && errno != EAGAIN) {
        perror("simrun: pseudo terminal");
    }
}

bool pty_receive(uint8_t *byte)
{
    return read(master, byte, 1) == 1;
}

void pty_pace(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    double real_ms = (double)(now.tv_sec - began.tv_sec) * 1e3 + (double)(now.tv_nsec - began.tv_nsec) * 1e-6;
    double ahead_ms = machine_ms() - real_ms;
    if (ahead_ms > 1.0) {
        struct timespec pause = { .tv_sec = (time_t)(ahead_ms / 1e3) };
        pause.tv_nsec = (long)((ahead_ms - (double)pause.tv_sec * 1e3) * 1e6);
        nanosleep(&pause, NULL);
    }
}
