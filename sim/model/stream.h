/* Recorded accelerometer streams: the CSV reader. Used by simrun and by the native build: both see the same samples. */
#ifndef STREAM_H
#define STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint64_t t_us;         /* unwrapped, first row at 0; never steps back */
    uint32_t line;         /* in the file, from 1 */
    int16_t lsb[3];        /* x, y, z in full resolution (256 LSB/g), -4096..4095 */
    int16_t truth_cdeg[2]; /* roll, pitch if the file has them */
    bool missing;          /* flags column with 2 or 16: not a sample */
    bool begins_segment;   /* first row after a repeated header */
} stream_row_t;

typedef struct {
    stream_row_t *rows;
    size_t count;
    bool has_truth;
    double rate_hz;  /* from the median step of t_us, 0 if there is only one row */
    char error[256]; /* "FILE:LINE: reason" after a failed load */
} stream_t;

/*
 * Reads a whole CSV stream as in docs/protocol.md: header with t_us and x,y,z or x_lsb,y_lsb,z_lsb, other columns
 * ignored, optional roll_true_cdeg,pitch_true_cdeg and flags; lines beginning with '#' and blank lines skipped; BOM and
 * CRLF accepted. A step back of t_us of more than 2^31 is a wrap; a repeated header starts a new segment (time
 * continues one period later). Errors (false, stream->error set, nothing leaked): cannot open, empty, missing column,
 * wrong field count, text in a number, time going backwards, value outside -4096..4095.
 */
bool stream_load(stream_t *stream, const char *path);
void stream_free(stream_t *stream);

#endif
