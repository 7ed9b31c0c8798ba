/*
 * For a terminal program, a plotter or avrdude. Simulated time follows real time and never runs ahead of it. If the PC
 * has no processor time for the simulator, or the reader none for the terminal's data, simulated time waits. So the
 * result does not depend on the load of the PC. A boot loader with an empty flash (--blank) exits if nothing arrives
 * for some simulated time, whereas avrdude counts real time: after the opening, simulated time runs ahead until the
 * boot loader listens, and waits there for avrdude.
 */
#define _GNU_SOURCE /* posix_openpt */

#include "simrun_pty.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "simrun_failure.h"
#include "simrun_mcu.h"
#include "simrun_resets.h"

enum {
    READER_LOOK_MS = 50,
    DEBT_MS = 20,           /* a larger debt of real time is written off: boot loaders count time */
    BOOT_QUIET_MS = 500,    /* simulated time: Optiboot listens after 375 ms, and exits if nothing arrives for 1 s */
    BOOT_PATIENCE_MS = 5000 /* real time: avrdude sends its first byte after 0.6 s */
};

/* An opening with --blank: until the boot loader listens, while bytes arrive, and once it has exited. */
typedef enum { BOOT_OVER, BOOT_STARTS, BOOT_TALKS } boot_t;

static int master = -1;
static bool waits_for_opening; /* --blank */
static double reader_patience_s;
static boot_t boot;
static uint64_t boot_quiet_at; /* cycle from which on simulated time waits for a byte */
static bool opened;            /* a program holds the other end */
static bool ever_opened;
static struct timespec began;
static double forgiven_ms; /* real time during which simulated time waited, less what it was allowed to run ahead */

/* Raw bytes, no echo; other settings made at the other end are kept. */
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

void pty_open(bool blank, double patience_s)
{
    waits_for_opening = blank;
    reader_patience_s = patience_s;
    master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    const char *name = master < 0 || grantpt(master) != 0 || unlockpt(master) != 0 ? NULL : ptsname(master);
    int slave = name == NULL ? -1 : open(name, O_RDWR | O_NOCTTY);
    if (slave < 0 || close(slave) != 0) { /* once it has been opened and closed, the master reports each opening */
        perror("simrun: pseudo terminal");
        exit(EXIT_INTERNAL);
    }
    fprintf(stderr, "simrun: UART on %s\n", name);
    clock_gettime(CLOCK_MONOTONIC, &began);
}

bool pty_is_open(void)
{
    return master >= 0;
}

static double real_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)(now.tv_sec - began.tv_sec) * 1e3 + (double)(now.tv_nsec - began.tv_nsec) * 1e-6;
}

static void boot_enter(boot_t state)
{
    boot = state;
    boot_quiet_at = mcu->cycle + (uint64_t)BOOT_QUIET_MS * CYCLES_PER_MS;
}

/* The settings of a terminal are lost with its last user, so each new one gets it raw. */
static void look_for_user(void)
{
    struct pollfd end = { .fd = master, .events = POLLIN };
    bool now = poll(&end, 1, 0) >= 0 && (end.revents & POLLHUP) == 0;
    if (now && !opened) {
        if (!make_raw(master)) {
            perror("simrun: pseudo terminal");
        }
        resets_port_opened();
        boot_enter(waits_for_opening ? BOOT_STARTS : BOOT_OVER);
    } else if (!now) {
        boot = BOOT_OVER; /* no program is left to wait for, or to run ahead for */
    }
    opened = now;
    ever_opened = ever_opened || now;
}

/* Waits a short time for `event` at the other end. False: it has been closed, or the run is to end. */
static bool wait_for(short event, bool *came)
{
    struct pollfd end = { .fd = master, .events = event };
    bool looked = poll(&end, 1, READER_LOOK_MS) >= 0 || errno == EINTR; /* a signal is not a hang-up */
    bool well = looked && (end.revents & POLLHUP) == 0 && !failure_asked_to_end();
    *came = well && (end.revents & event) != 0;
    return well;
}

/* False: the other end has been closed, the run is to end, or the program there does not read. */
static bool wait_for_reader(double until_ms)
{
    bool reads;
    if (!wait_for(POLLOUT, &reads)) {
        return false;
    }
    if (!reads && real_ms() >= until_ms) {
        static char reason[128];
        snprintf(reason, sizeof reason,
                 "a program holds the pseudo terminal but has read nothing for %g s (see --patience)",
                 reader_patience_s);
        failure_set(EXIT_READER, reason);
        return false;
    }
    return true;
}

/* If the other end is closed the byte is lost, as on a board without a PC. */
void pty_send(uint8_t byte)
{
    double until_ms = 0.0;
    while (opened && write(master, &byte, 1) < 0) {
        if (errno == EAGAIN) {
            until_ms = until_ms > 0.0 ? until_ms : real_ms() + reader_patience_s * 1e3;
            if (!wait_for_reader(until_ms)) {
                break;
            }
        } else if (errno != EINTR) {
            if (errno != EIO) {
                perror("simrun: pseudo terminal");
            }
            break;
        }
    }
}

/* Without a connection a boot loader would soon exit into an empty flash. */
static void wait_for_first_user(void)
{
    struct timespec pause = { .tv_nsec = READER_LOOK_MS * 1000000L };
    while (!ever_opened && !failure_asked_to_end()) {
        nanosleep(&pause, NULL);
        look_for_user();
    }
}

/* Simulated time stops until a byte arrives, unless the boot loader has exited or no bytes are sent. */
static void wait_for_byte(void)
{
    double until_ms = real_ms() + BOOT_PATIENCE_MS;
    bool came = false;
    while (mcu_in_boot_loader(mcu->pc) && !came && wait_for(POLLIN, &came) && real_ms() < until_ms) {
    }
    if (!came) {
        boot_enter(BOOT_OVER);
    }
}

bool pty_receive(uint8_t *byte)
{
    look_for_user();
    if (waits_for_opening) {
        wait_for_first_user();
    }
    if (!opened || (boot == BOOT_STARTS && mcu->cycle < boot_quiet_at)) {
        return false;
    }
    if (boot != BOOT_OVER && mcu->cycle >= boot_quiet_at) {
        wait_for_byte();
    }
    bool any = read(master, byte, 1) == 1;
    if (any && boot != BOOT_OVER) {
        boot_enter(BOOT_TALKS);
    }
    return any;
}

void pty_pace(void)
{
    double ahead_ms = mcu_ms() + forgiven_ms - real_ms();
    if (boot == BOOT_STARTS) { /* avrdude has begun to count: run as fast as the PC can */
        forgiven_ms -= ahead_ms;
        return;
    }
    if (ahead_ms < -DEBT_MS) {
        forgiven_ms -= ahead_ms + DEBT_MS;
    }
    if (ahead_ms > 1.0) {
        struct timespec pause = { .tv_sec = (time_t)(ahead_ms / 1e3) };
        pause.tv_nsec = (long)((ahead_ms - (double)pause.tv_sec * 1e3) * 1e6);
        nanosleep(&pause, NULL);
    }
}
