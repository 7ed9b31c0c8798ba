/* What main spends from one entry to the other, without interrupts, and how deep its stack goes: a line per passage. */
#include "simrun_span.h"

#include <string.h>

#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_symbols.h"
#include "simrun_times.h"

static FILE *file;
static const char *path;
static uint32_t from_pc;
static uint32_t to_pc;
static bool inside;
static uint64_t began;
static uint64_t interrupted_before;
static uint16_t sp_at_start;
static uint16_t lowest_sp;

static uint32_t find(const char *name)
{
    uint32_t pc;
    if (!symbols_find(name, &pc)) {
        output_refuse("--span: the firmware has no function %s", name);
    }
    return pc;
}

bool span_start(const char *wanted)
{
    static char names[256];
    if (wanted == NULL) {
        return false;
    }
    snprintf(names, sizeof names, "%s", wanted);
    char *to = strchr(names, ':');
    char *file_name = to == NULL ? NULL : strchr(to + 1, ':');
    if (file_name == NULL) {
        output_refuse("--span wants FROM:TO:CSV, not '%s'", wanted);
    }
    *to++ = '\0';
    *file_name++ = '\0';
    from_pc = find(names);
    to_pc = find(to);
    path = file_name;
    file = output_open(path);
    fputs("at_us,cycles,stack_bytes\n", file);
    return true;
}

void span_on_pc(uint32_t pc)
{
    if (file == NULL || times_in_interrupt()) {
        return;
    }
    uint16_t sp = mcu_stack_pointer();
    if (pc == from_pc) {
        inside = true;
        began = mcu->cycle;
        interrupted_before = times_interrupted();
        sp_at_start = sp;
        lowest_sp = sp;
    } else if (inside && pc == to_pc) {
        inside = false;
        uint64_t cycles = mcu->cycle - began - (times_interrupted() - interrupted_before);
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
