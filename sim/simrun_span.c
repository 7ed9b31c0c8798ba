/*
 * Cycles from one function's entry to another's (--span): what main spends in between, without interrupts, and how deep
 * its stack goes, one line per passage.
 */
#include <stdlib.h>
#include <string.h>

#include "simrun.h"

enum { REG_SPL = 0x5D };

bool span_wanted;
static FILE *file;
static const char *path;
static uint32_t from_pc;
static uint32_t to_pc;
static bool inside;
static uint64_t began;
static uint64_t interrupted_before;
static uint16_t sp_at_start;
static uint16_t lowest_sp;

static uint16_t stack_pointer(void)
{
    uint16_t sp;
    memcpy(&sp, mcu->data + REG_SPL, sizeof sp); /* little endian, like the PC */
    return sp;
}

static uint32_t find(const char *name)
{
    uint32_t pc;
    if (!symbols_find(name, &pc)) {
        fprintf(stderr, "simrun: --span: the firmware has no function %s\n", name);
        exit(EXIT_INPUT);
    }
    return pc;
}

void span_start(void)
{
    static char names[256];
    if (options.span == NULL) {
        return;
    }
    snprintf(names, sizeof names, "%s", options.span);
    char *to = strchr(names, ':');
    char *file_name = to == NULL ? NULL : strchr(to + 1, ':');
    if (file_name == NULL) {
        fprintf(stderr, "simrun: --span wants FROM:TO:CSV, not '%s'\n", options.span);
        exit(EXIT_INPUT);
    }
    *to++ = '\0';
    *file_name++ = '\0';
    from_pc = find(names);
    to_pc = find(to);
    path = file_name;
    file = output_open(path);
    fputs("at_us,cycles,stack_bytes\n", file);
    span_wanted = true;
}

void span_on_pc(uint32_t pc)
{
    if (stats_in_interrupt()) {
        return;
    }
    uint16_t sp = stack_pointer();
    if (pc == from_pc) {
        inside = true;
        began = mcu->cycle;
        interrupted_before = stats_interrupted;
        sp_at_start = sp;
        lowest_sp = sp;
    } else if (inside && pc == to_pc) {
        inside = false;
        uint64_t cycles = mcu->cycle - began - (stats_interrupted - interrupted_before);
        fprintf(file, "%.1f,%llu,%u\n", (double)began / CYCLES_PER_US, (unsigned long long)cycles,
                (unsigned)(sp_at_start - lowest_sp));
    } else if (inside && sp < lowest_sp) {
        lowest_sp = sp;
    }
}

/* A passage cut off by a reset does not count. */
void span_reset(void)
{
    inside = false;
}

void span_finish(void)
{
    output_close(file, path);
}
