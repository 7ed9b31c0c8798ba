/*
 * The shipped filters and the firmware's sample path as a library for the PC: what `tilt replay`, `compare` and `tune`
 * call (tools/tilt/native.py has the same structures for ctypes). Not for the chip; one caller at a time, because the
 * sample path has its state in static variables.
 */
#ifndef LIBTILT_H
#define LIBTILT_H

#include <stdbool.h>
#include <stdint.h>

/* A recording: count rows, unwrapped times from 0, readings x y z one after the other, median step (0: one row). */
typedef struct {
    int64_t count;
    const int64_t *t_us;
    const int16_t *lsb;
    const uint8_t *missing;
    int64_t step_us;
} libtilt_stream_t;

/* A row as the firmware sends it (docs/protocol.md), at the time that it has in the recording. */
typedef struct {
    int64_t t_us;
    int32_t source; /* row of the recording, -1: a prediction */
    int16_t lsb[3];
    int16_t mg[3];
    int16_t roll_cdeg;
    int16_t pitch_cdeg;
    uint16_t flags;
    uint16_t unused;
} libtilt_row_t;

/* A parameter of a filter, as filter_parameter_t has it, and its value at some rate. Values are as stored. */
typedef struct {
    char name[16];
    char unit[8];
    int64_t min, max, value;
    int32_t fraction_bits;
    int32_t zero_means_off;
} libtilt_parameter_t;

/* One sample of one axis behind a filter: filter_probe_t, and R in force when it came. */
typedef struct {
    int32_t x_lsb_q16;
    int32_t rate_lsb_q16;
    int32_t innovation_lsb_q16;
    uint32_t p_lsb2_q8;
    uint32_t gate_lsb2_q8;
    uint32_t r_lsb2_q8;
    uint16_t gain_uq16;
    uint8_t flags;  /* of filter.h */
    uint8_t judged; /* 1: a sample came and the filter predicted it; 0: missing, clipped, or the filter was starting */
} libtilt_probe_t;

#pragma GCC visibility push(default) /* all else stays inside the library */

/* Kinds are 0 .. libtilt_filters() - 1, in the order of filter_list.h. */
int libtilt_filters(void);
const char *libtilt_filter_name(int kind);
int libtilt_filter_cycles(int kind);          /* worst case on the chip */
bool libtilt_filter_published_only(int kind); /* to compare with its paper: no tool recommends it */

/* False: the filter has no parameter with this number. */
bool libtilt_parameter(int kind, int index, uint16_t rate_dhz, libtilt_parameter_t *out);

/* 1: the virtual sensor takes a row a tick at this rate; 0: it samples what is in force (docs/protocol.md, Streams). */
int libtilt_row_per_tick(const libtilt_stream_t *in, uint16_t rate_dhz);

/*
 * The recording through the firmware's sample path from a cold start, as simrun plays it to the board without faults
 * of bus and wiring; the filter has its defaults but for values[i], as typed, of parameter i where changed[i] is not 0.
 * Returns the number of rows, -1 where room (in rows) is not enough, -2 without memory, -3 where the firmware refuses
 * the values.
 */
int64_t libtilt_replay(const libtilt_stream_t *in, int kind, uint16_t rate_dhz, uint8_t range_g, const int64_t *values,
                       const uint8_t *changed, libtilt_row_t *out, int64_t room);

/*
 * One axis through one filter: count samples, state 0 missing, 1 there, 2 at the rail. The filter has its defaults but
 * for values[i] of parameter i where changed[i] is not 0. r_lsb2_q8: R throughout; 0: as the firmware estimates it.
 * Returns 0, or filter_init's answer, where the filter refuses its parameters.
 */
int libtilt_axis(int kind, uint16_t rate_dhz, const int64_t *values, const uint8_t *changed, uint32_t r_lsb2_q8,
                 bool noisy_axis, const int16_t *z_lsb, const uint8_t *state, int64_t count, libtilt_probe_t *out);

#pragma GCC visibility pop

#endif
