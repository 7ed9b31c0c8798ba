/* Cycles and stack of one call, and the lines that tell them, for bench.c only. */
#ifndef BENCH_MEASURE_H
#define BENCH_MEASURE_H

#include <avr/io.h>
#include <avr/pgmspace.h>
#include <stdbool.h>
#include <stdint.h>

#include "bench_out.h"

enum { PAINT = 0xA5, PAINTED = 160, STACK_CALLS = 100 };

static uint16_t overhead;
static uint16_t float_overhead;
static uint16_t empty_overhead;
static uint8_t stack_calls;
static uint16_t deepest;
static uint16_t float_deepest;
static uint8_t own_depth;

/* Bytes of stack that a call takes, the return address included: what no longer shows the paint below SP. */
static uint16_t NOINLINE stack_of(void (*call)(void))
{
    uint8_t *top = (uint8_t *)SP;
    for (uint8_t i = 0; i < PAINTED; i++) {
        *(volatile uint8_t *)(top - i) = PAINT;
    }
    call();
    uint8_t used = PAINTED;
    while (used != 0 && *(volatile uint8_t *)(top - (used - 1u)) == PAINT) {
        used--;
    }
    return used;
}

static void watch_stack(void (*call)(void), uint16_t *most)
{
    uint16_t used = (uint16_t)(stack_of(call) - own_depth);
    *most = used > *most ? used : *most;
}

static void put_section(const char *name, const char *regime, uint16_t rate_dhz)
{
    put_text(PSTR("\n="));
    put_text(name);
    put(' ');
    put_text(regime);
    put_number(rate_dhz);
    put('\n');
    deepest = 0;
    float_deepest = 0;
    stack_calls = STACK_CALLS;
    random_state = 2463534242ul +
                   rate_dhz; /* of the section alone: another filter in the list changes no other number */
}

static void put_result(const char *kind, const char *prefix, const char *name, uint16_t value)
{
    put_text(kind);
    put_text(prefix);
    put_text(name);
    put_number(value);
}

static void end_section(const char *name, bool has_float)
{
    put_result(PSTR("\n+stack "), PSTR(""), name, deepest);
    if (has_float) {
        put_result(PSTR("\n+stack "), PSTR("float_"), name, float_deepest);
    }
}

#endif
