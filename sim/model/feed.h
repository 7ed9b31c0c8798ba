/*
 * A stream as the virtual sensor measures it, at any output data rate: which row each tick uses, and the noise on a row
 * that several ticks use. Shared by the simulator, the firmware on the PC and tilt replay.
 */
#ifndef FEED_H
#define FEED_H

#include "stream.h"

/* How ticks of the virtual sensor map to rows of the stream. */
typedef enum {
    FEED_ROW_PER_TICK, /* rates agree within 5 %: one row per tick; gaps in t_us are ticks without a sample */
    FEED_IN_FORCE      /* otherwise: the sample in force (newest row not later than the tick) */
} feed_mode_t;

typedef struct {
    const stream_t *stream;
    feed_mode_t mode;
    bool loop;             /* restart at the end */
    size_t next;           /* row of the next tick */
    uint32_t silent_ticks; /* ticks without a sample left before `next` */
    uint64_t origin_us;    /* sensor time of row 0 (FEED_IN_FORCE) */
    uint32_t repeats;      /* earlier ticks that found the same row in force */
    bool started;
} feed_t;

/* Chooses the mode for this output data rate; call again when the firmware changes the rate (the position is kept). */
void feed_set_rate(feed_t *feed, const stream_t *stream, double odr_hz, uint64_t now_us);

typedef enum { FEED_SAMPLE, FEED_NOTHING, FEED_END } feed_result_t;

/*
 * One output-data-rate tick at time now_us. FEED_SAMPLE: *row_index is the row. FEED_NOTHING: a gap. FEED_END: the
 * stream is over.
 */
feed_result_t feed_tick(feed_t *feed, uint64_t now_us, size_t *row_index);

/*
 * The readings of the row that the last tick used. A row in force for several ticks, because the sensor runs faster
 * than the stream, differs by one LSB on one axis from tick to tick, like a sensor's noise: equal readings would look
 * like a stuck sensor (fault 10). Readings with a meaning of their own are not changed: an axis that the stream has not
 * changed for ten rows, a reading at the rail of a range, and -1, -1, -1, which is a sensor without power.
 */
void feed_vary(const feed_t *feed, int16_t lsb[3]);

#endif
