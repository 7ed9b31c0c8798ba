/*
 * Recorded accelerometer streams: the CSV reader and the feed that hands rows to the virtual sensor.
 * Used by simrun and by the native build, so that both see the same samples.
 */
#ifndef STREAM_H
#define STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint64_t t_us;         /* unwrapped, from the first row's 0; never steps back */
    uint32_t line;         /* in the file, from 1 */
    int16_t lsb[3];        /* x, y, z in full resolution (256 LSB/g), -4096..4095 */
    int16_t truth_cdeg[2]; /* roll, pitch where the file has them */
    bool missing;          /* flags column with 2 or 16: not a sample */
    bool begins_segment;   /* first row after a repeated header */
} stream_row_t;

typedef struct {
    stream_row_t *rows;
    size_t count;
    bool has_truth;
    double rate_hz;  /* from the median step of t_us, 0 when there is one row */
    char error[256]; /* "FILE:LINE: reason" after a failed load */
} stream_t;

/*
 * Reads a whole CSV stream as in docs/protocol.md: header with t_us and x,y,z or x_lsb,y_lsb,z_lsb, other columns
 * ignored, optional roll_true_cdeg,pitch_true_cdeg and flags; lines beginning with '#' and blank lines skipped; BOM and
 * CRLF accepted. A step back of t_us of more than 2^31 is a wrap; a repeated header starts a new segment (time goes on
 * one period later). Errors (false, stream->error set, nothing leaked): cannot open, empty, missing column, wrong field
 * count, text in a number, time going backwards, value outside -4096..4095.
 */
bool stream_load(stream_t *stream, const char *path);
void stream_free(stream_t *stream);

/* How ticks of the virtual sensor meet rows of the stream. */
typedef enum {
    FEED_ROW_PER_TICK, /* rates agree within 5 %: one row per tick; gaps in t_us are ticks without a sample */
    FEED_IN_FORCE      /* else: the sample in force (newest row not later than the tick) */
} feed_mode_t;

typedef struct {
    const stream_t *stream;
    feed_mode_t mode;
    bool loop;             /* start again at the end */
    size_t next;           /* row of the next tick */
    uint32_t silent_ticks; /* still to pass without a sample before `next` */
    uint64_t origin_us;    /* sensor time of row 0 (FEED_IN_FORCE) */
    bool started;
} feed_t;

/* Chooses the mode for this output data rate; call again when the firmware changes the rate (the position is kept). */
void feed_set_rate(feed_t *feed, const stream_t *stream, double odr_hz, uint64_t now_us);

typedef enum { FEED_SAMPLE, FEED_NOTHING, FEED_END } feed_result_t;

/* One output-data-rate tick at time now_us. FEED_SAMPLE: *row_index is the row. FEED_NOTHING: a gap. FEED_END: over. */
feed_result_t feed_tick(feed_t *feed, uint64_t now_us, size_t *row_index);

#endif
