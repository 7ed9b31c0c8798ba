/*
 * A pseudo terminal in place of the USB serial port: for a terminal program, a plotter or avrdude. Simulated time keeps
 * to real time and never runs ahead of it: where the PC has no processor for the simulator, or the reader none for what
 * is in the terminal, simulated time waits. So what happens does not depend on how busy the PC is.
 */
#define _GNU_SOURCE /* posix_openpt */

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "simrun.h"

enum {
    READER_LOOK_MS = 50,
    DEBT_MS = 20
}; /* a debt of real time beyond that is not made up: boot loaders count time */

static int master = -1;
static bool opened; /* somebody holds the other end */
static bool ever_opened;
static struct timespec began;
static double forgiven_ms; /* of real time, in which simulated time waited */

/* Bytes as they are, no echo; what else the one at the other end has set stays. */
static bool make_raw(int terminal)
{
    struct termios settings;
    if (tcgetattr(terminal, &settings) != 0) {
        return false;
    }
    settings.c_iflag &= ~(tcflag_t)(IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON);
    settings.c_oflag &= ~(tcflag_t)OPOST;
    settings.c_lflag &= ~(tcflag_t)(ECHO | ECHONL | ICANON | ISIG | IEXTEN);
    return tcsetattr(terminal, TCSANOW, &settings) == 0;
}

void pty_open(void)
{
    master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    const char *name = master < 0 || grantpt(master) != 0 || unlockpt(master) != 0 ? NULL : ptsname(master);
    int slave = name == NULL ? -1 : open(name, O_RDWR | O_NOCTTY);
    if (slave < 0 || close(slave) != 0) { /* closed once, the master tells when it is opened */
        perror("simrun: pseudo terminal");
        exit(EXIT_INTERNAL);
    }
    fprintf(stderr, "simrun: UART on %s\n", name);
    clock_gettime(CLOCK_MONOTONIC, &began);
}

/* The settings of a terminal go with its last user, so each new one gets it raw. */
static void look_for_user(void)
{
    struct pollfd end = { .fd = master, .events = POLLIN };
    bool now = poll(&end, 1, 0) >= 0 && (end.revents & POLLHUP) == 0;
    if (now && !opened) {
        if (!make_raw(master)) {
            perror("simrun: pseudo terminal");
        }
        resets_port_opened();
    }
    opened = now;
    ever_opened = ever_opened || now;
}

/* False: nobody holds the other end any more, or the run is to end. */
static bool wait_for_reader(void)
{
    struct pollfd end = { .fd = master, .events = POLLOUT };
    return poll(&end, 1, READER_LOOK_MS) >= 0 && (end.revents & POLLHUP) == 0 && !machine_asked_to_end();
}

/* Without anybody at the other end it is lost, as on a board without a PC. */
void pty_send(uint8_t byte)
{
    while (opened && write(master, &byte, 1) < 0) {
        if (errno == EINTR || (errno == EAGAIN && wait_for_reader())) {
            continue;
        }
        if (errno != EAGAIN && errno != EIO) {
            perror("simrun: pseudo terminal");
        }
        break;
    }
}

/* A boot loader that nobody talks to would soon leave for a flash that is empty. */
static void wait_for_first_user(void)
{
    struct timespec pause = { .tv_nsec = READER_LOOK_MS * 1000000L };
    while (!ever_opened && !machine_asked_to_end()) {
        nanosleep(&pause, NULL);
        look_for_user();
    }
}

bool pty_receive(uint8_t *byte)
{
    look_for_user();
    if (options.blank) {
        wait_for_first_user();
    }
    return opened && read(master, byte, 1) == 1;
}

void pty_pace(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    double real_ms = (double)(now.tv_sec - began.tv_sec) * 1e3 + (double)(now.tv_nsec - began.tv_nsec) * 1e-6;
    double ahead_ms = machine_ms() + forgiven_ms - real_ms;
    if (ahead_ms < -DEBT_MS) {
        forgiven_ms -= ahead_ms + DEBT_MS;
    }
    if (ahead_ms > 1.0) {
        struct timespec pause = { .tv_sec = (time_t)(ahead_ms / 1e3) };
        pause.tv_nsec = (long)((ahead_ms - (double)pause.tv_sec * 1e3) * 1e6);
        nanosleep(&pause, NULL);
    }
}
