/*
 * All RAM above _end is painted before the start; bytes that no longer hold the paint were used. The stack has run into
 * the variables if the byte that a push with SP = _end + 1 writes has changed, or SP stays at or below _end.
 */
#include "simrun_stack.h"

#include <string.h>

#include "simrun_failure.h"
#include "simrun_mcu.h"

enum {
    PAINT = 0xA5,
    NEAR = 64,        /* bytes: a generous bound for the movement of the stack in one chunk of instructions */
    SETTLED_STEPS = 4 /* SPH, SREG and SPL are written one after the other (avr-gcc's prologue) */
};

static uint8_t paint[RAM_END + 1];
static bool paint_holds = true;
static uint16_t lowest_seen = RAM_END;
static uint16_t high_water; /* bytes, from paint, before the last power cycle */
static uint16_t last_sp = RAM_END;
static unsigned low_steps;

void stack_paint(void)
{
    memset(mcu->data + RAM_START, PAINT, RAM_END + 1 - RAM_START);
    stack_paint_is();
}

void stack_paint_is(void)
{
    memcpy(paint, mcu->data, sizeof paint);
    last_sp = RAM_END;
}

/*
 * The first byte above the variables has changed. Far from the stack that is not a push: the firmware is painting its
 * own stack.
 */
static void guard_changed(uint16_t sp, uint32_t end_of_ram)
{
    if (sp > end_of_ram + NEAR) {
        paint_holds = false;
    } else {
        failure_set(EXIT_STACK, "the stack has run into the variables");
    }
}

bool stack_watch(uint32_t end_of_ram)
{
    uint16_t sp = mcu_stack_pointer();
    if (paint_holds && mcu->data[end_of_ram + 1] != paint[end_of_ram + 1]) {
        guard_changed(sp, end_of_ram);
    }
    if (sp <= end_of_ram) {
        low_steps++;
        if (low_steps >= SETTLED_STEPS) {
            failure_set(EXIT_STACK, "the stack has run into the variables");
        }
        return true;
    }
    low_steps = 0;
    if (sp < lowest_seen && sp + NEAR > last_sp) {
        lowest_seen = sp;
    }
    last_sp = sp;
    return false;
}

uint16_t stack_high_water(void)
{
    uint16_t used = (uint16_t)(RAM_END - lowest_seen);
    if (paint_holds) {
        uint32_t address = mcu_program.end_of_ram;
        while (address <= RAM_END && mcu->data[address] == paint[address]) {
            address++;
        }
        uint16_t painted_over = (uint16_t)(RAM_END + 1 - address);
        used = painted_over > used ? painted_over : used;
    }
    high_water = used > high_water ? used : high_water;
    return high_water;
}
