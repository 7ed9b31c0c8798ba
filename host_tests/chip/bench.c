/*
 * Runs on the ATmega328P (simavr): cycles of each filter of its part of the list (BENCH_LIST) beside its float twin,
 * and in the first part (BENCH_THE_REST) of the noise estimate, the angles and the formatting of a row, call included,
 * over streams that look for the longest path. On the UART (1 Mbaud), for campaigns/bench/bench.py:
 *
 *   =NAME REGIME RATE    a section: then 8 hexadecimal digits per call, cycles of ours and of the float one (0: none)
 *   +stack NAME BYTES    deepest stack of a call seen in the section, return address included; another for float_NAME
 *   +rms NAME N          difference of ours to float over the section, 1/1000 LSB or degree, rms
 *
 * Then it sleeps with interrupts off.
 */
#include <avr/pgmspace.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "filter_list.h"
#include "float_filters.h"
#include "noise.h"
#include "tilt.h"
#include "tracker.h"

/* The row as the firmware composes it; what of it is not used the linker drops. */
#include "../../firmware/output/rows.c"

#include "bench_measure.h"
#include "bench_out.h"
#include "bench_streams.h"

enum { SETTLED = 50 };

/* --- what is called: argument and answer are globals (bench_streams.h), so that every call looks the same --- */

static volatile float float_sink;
static volatile float float_source;
static uint32_t r_lsb2_q8;

static void NOINLINE run_nothing(void)
{
    sink = z_lsb;
}

static void NOINLINE run_nothing_float(void)
{
    float_sink = float_source;
}

static void NOINLINE run_empty(void)
{
    __asm__ volatile("");
}

/* A filter of this part: its law, and its yardstick. */
typedef struct {
    const filter_law_t *law;
    void (*lengthen)(filter_config_t *config);
    void (*float_start)(void);
    void (*float_set_noise)(void);
    void (*float_coast)(void);
    void (*float_update)(void);
} subject_t;

static filter_config_t config;
static filter_t state;

/* R stands at another place in each law's parameters. */
static void put_r(const filter_law_t *law)
{
    for (uint8_t i = 0; i < filter_parameter_count(law); i++) {
        if (filter_parameter(law, i) == &filter_parameter_r) {
            config.value[i] = (int32_t)r_lsb2_q8;
        }
    }
}

static void begin(const subject_t *s, uint16_t rate_dhz, bool longer)
{
    config = filter_defaults(s->law, rate_dhz);
    if (longer) {
        s->lengthen(&config);
    }
    put_r(s->law);
    (void)filter_init(&state, s->law, &config);
}

static void NOINLINE set_noise(void)
{
    filter_set_noise(&state, r_lsb2_q8);
}

static void NOINLINE coast(void)
{
    sink = filter_missing(&state);
}

static void NOINLINE update(void)
{
    sink = filter_update(&state, z_lsb);
}

static bool warms_up(void)
{
    return state.collected != FILTER_RUNNING;
}

/* Compiled alone, as by make check: every filter. */
#ifndef BENCH_LIST
#define BENCH_LIST(X) FILTER_LIST(X)
#endif

#define SUBJECT(F)                                                      \
    static void float_start_##F(void)                                   \
    {                                                                   \
        float_##F##_start(&float_##F, &config, (float)sink / 65536.0f); \
    }                                                                   \
    static void float_set_noise_##F(void)                               \
    {                                                                   \
        float_##F##_set_noise(&float_##F, (float)r_lsb2_q8 / 256.0f);   \
    }                                                                   \
    static void NOINLINE float_coast_step_##F(void)                     \
    {                                                                   \
        float_sink = float_##F##_coast(&float_##F);                     \
    }                                                                   \
    static void NOINLINE float_update_step_##F(void)                    \
    {                                                                   \
        float_sink = float_##F##_update(&float_##F, z_lsb);             \
    }
BENCH_LIST(SUBJECT)

#define SUBJECT_FLOAT(F) float_start_##F, float_set_noise_##F, float_coast_step_##F, float_update_step_##F
#define SUBJECT_ROW(F) { &filter_law_##F, lengthen_##F, SUBJECT_FLOAT(F) },
static const subject_t subjects[] = { BENCH_LIST(SUBJECT_ROW) };

#ifdef BENCH_THE_REST
static noise_t noise;
static void NOINLINE update_noise(void)
{
    sink = filter_noise_update(&noise, z_lsb);
}

static tilt_t tilt;
static int32_t a_q8[3];
static void NOINLINE update_angles(void)
{
    tilt_angles(&tilt, a_q8);
}

static float float_a[3];
static float float_roll;
static float float_pitch;
static void NOINLINE update_float_angles(void)
{
    float_angles(&float_roll, &float_pitch, float_a[0], float_a[1], float_a[2]);
}

static row_t row;
static char line[ROW_MAX];
static void NOINLINE update_format_row(void)
{
    char *end = write_csv(line, &row);
    sink = *end;
}
#endif

/* --- the measurement --- */

/* An R anywhere in its legal range, as likely small as large, often one of the ends. */
static void another_noise(void)
{
    uint8_t shift = (uint8_t)(random_bits() >> 27);
    r_lsb2_q8 = shift < 18u ? (uint32_t)1u << shift : 256000ul;
    r_lsb2_q8 = shift == 31u || r_lsb2_q8 < 3u ? 3u : r_lsb2_q8;
}

static void provoke(const subject_t *s, bool with_float)
{
    uint8_t dice = (uint8_t)(random_bits() >> 24);
    if (dice < 40u) {
        another_noise();
        set_noise();
        if (with_float) {
            s->float_set_noise();
        }
    }
    for (uint8_t missing = dice < 128u ? dice & 7u : 0; missing != 0; missing--) {
        coast();
        if (with_float) {
            s->float_coast();
        }
    }
}

static void run_regime(const subject_t *s, const regime_t *regime, uint16_t rate_dhz)
{
    float squares = 0.0f;
    uint16_t compared = 0;
    put_section(filter_name(s->law), regime->name, rate_dhz);
    r_lsb2_q8 = 20ul * 256u;
    begin(s, rate_dhz, regime->longer);
    level_lsb = 0;
    for (sample_number = 0; sample_number < regime->count; sample_number++) {
        bool warming_up = warms_up();
        if (regime->provoke && !warming_up) {
            provoke(s, true);
        }
        regime->sample();
        put_hex((uint16_t)(timed(update) - overhead));
        float ours = (float)sink / 65536.0f;
        if (warming_up) {
            put_hex(0);
            s->float_start();
            continue;
        }
        put_hex((uint16_t)(timed(s->float_update) - float_overhead));
        if (sample_number >= SETTLED) {
            float difference = ours - float_sink;
            squares += difference * difference;
            compared++;
        }
    }
    /* the states are spent on the stack: each call is one sample more */
    for (; stack_calls != 0; stack_calls--) {
        regime->sample();
        watch_stack(update, &deepest);
        watch_stack(s->float_update, &float_deepest);
    }
    end_section(filter_name(s->law), true);
    if (!regime->provoke) {
        float rms = (float)sqrtf(squares / (float)compared) * 1000.0f;
        put_result(PSTR("\n+rms "), PSTR(""), filter_name(s->law), rms < 65535.0f ? (uint16_t)rms : UINT16_MAX);
    }
}

static void run_set_noise(const subject_t *s)
{
    put_text(PSTR("\n="));
    put_text(filter_name(s->law));
    put_text(PSTR("_set_noise anything 1000\n"));
    deepest = 0;
    begin(s, 1000, false);
    for (uint16_t n = 0; n < 500u; n++) {
        another_noise();
        r_lsb2_q8 += n & 1u ? (uint16_t)random_bits() & (uint16_t)(r_lsb2_q8 >> 1) : 0u;
        put_hex((uint16_t)(timed(set_noise) - empty_overhead));
        put_hex(0);
        watch_stack(set_noise, &deepest);
    }
    put_text(PSTR("\n+stack "));
    put_text(filter_name(s->law));
    put_text(PSTR("_set_noise"));
    put_number(deepest);
}

static void run_filter(const subject_t *s)
{
    for (uint8_t r = 0; r < sizeof regimes / sizeof regimes[0]; r++) {
        for (uint8_t i = 0; i < sizeof rates_dhz / sizeof rates_dhz[0]; i++) {
            run_regime(s, &regimes[r], pgm_read_word(&rates_dhz[i]));
        }
    }
    run_set_noise(s);
}

#ifdef BENCH_THE_REST
static void run_noise(void)
{
    static const char name[] PROGMEM = "noise";
    for (uint8_t r = 0; r < sizeof regimes / sizeof regimes[0]; r++) {
        for (uint8_t i = 0; i < sizeof rates_dhz / sizeof rates_dhz[0]; i++) {
            put_section(name, regimes[r].name, pgm_read_word(&rates_dhz[i]));
            filter_noise_init(&noise, pgm_read_word(&rates_dhz[i]), (i & 1u) != 0);
            for (sample_number = 0; sample_number < regimes[r].count; sample_number++) {
                regimes[r].sample();
                put_hex((uint16_t)(timed(update_noise) - overhead));
                put_hex(0);
            }
            for (; stack_calls != 0; stack_calls--) {
                regimes[r].sample();
                watch_stack(update_noise, &deepest);
            }
            end_section(name, false);
        }
    }
}

/* |a| of any size up to the bound of the estimates, each axis by itself, often with few leading bits. */
static int32_t any_acceleration(void)
{
    uint8_t bits = (uint8_t)(11u + (uint8_t)(random_bits() >> 24) % 10u);
    int32_t a = (int32_t)(random_bits() >> (32u - bits));
    return (random_bits() & 0x80000000ul) ? -a : a;
}

/* About 1 g, as a board lies. */
static int32_t resting(uint8_t axis)
{
    return (int32_t)uniform(14) * 4 + (axis == 2 ? 50000 : 0);
}

static void run_angles(const char *regime, bool at_rest, uint16_t count)
{
    static const char name[] PROGMEM = "angles";
    float squares = 0.0f;
    put_section(name, regime, 0);
    for (uint16_t n = 0; n < count; n++) {
        for (uint8_t axis = 0; axis < 3; axis++) {
            a_q8[axis] = at_rest ? resting(axis) : any_acceleration();
            float_a[axis] = (float)a_q8[axis] / 256.0f;
        }
        put_hex((uint16_t)(timed(update_angles) - empty_overhead));
        put_hex((uint16_t)(timed(update_float_angles) - empty_overhead));
        float pitch = (float)tilt.pitch_cdeg / 100.0f - float_pitch;
        squares += pitch * pitch;
        float roll = (float)tilt.roll_cdeg / 100.0f - float_roll;
        squares += tilt.roll_undefined || roll > 180.0f ? 0.0f : roll * roll;
        if (stack_calls != 0) {
            stack_calls--;
            watch_stack(update_angles, &deepest);
            watch_stack(update_float_angles, &float_deepest);
        }
    }
    end_section(name, true);
    put_result(PSTR("\n+rms "), PSTR(""), name, (uint16_t)((float)sqrtf(squares / (2.0f * (float)count)) * 1000.0f));
}

/* Nines are what a subtraction of powers of ten takes longest over. */
static int16_t nines(int16_t limit)
{
    static const int16_t slow[] PROGMEM = { 9, 99, 999, 1999, 3999, 8999, 9999, 17999 };
    int16_t value;
    do {
        value = (int16_t)pgm_read_word(&slow[(uint8_t)random_bits() & 7u]);
    } while (value > limit);
    return (int16_t)(0 - value);
}

static void run_format_row(const char *regime, bool widest, uint16_t count)
{
    static const char name[] PROGMEM = "format_row";
    put_section(name, regime, 0);
    for (uint16_t n = 0; n < count; n++) {
        row.t_us = widest ? 3999999999ul : random_bits();
        for (uint8_t axis = 0; axis < 3; axis++) {
            row.lsb[axis] = widest ? nines(4096) : uniform(10);
            row.mg[axis] = widest ? nines(18000) : uniform(12);
        }
        row.roll_cdeg = widest ? nines(18000) : uniform(15);
        row.pitch_cdeg = widest ? nines(9000) : uniform(13);
        row.flags = widest ? 7999 : 1;
        put_hex((uint16_t)(timed(update_format_row) - empty_overhead));
        put_hex(0);
        if (stack_calls != 0) {
            stack_calls--;
            watch_stack(update_format_row, &deepest);
        }
    }
    end_section(name, false);
}

static void run_the_rest(void)
{
    run_noise();
    run_angles(PSTR("typical"), true, 1000);
    run_angles(PSTR("anything"), false, 4500);
    run_format_row(PSTR("typical"), false, 1000);
    run_format_row(PSTR("widest"), true, 4500);
}
#else
static void run_the_rest(void) {}
#endif

int main(void)
{
    begin_measuring();
    overhead = timed(run_nothing);
    float_overhead = timed(run_nothing_float);
    empty_overhead = timed(run_empty);
    own_depth = (uint8_t)(stack_of(run_nothing) - 2u); /* of the empty step; two are the return address into it */
    for (uint8_t i = 0; i < sizeof subjects / sizeof subjects[0]; i++) {
        run_filter(&subjects[i]);
    }
    run_the_rest();
    end_measuring();
    for (;;) {
    }
}
