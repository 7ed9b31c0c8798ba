/*
 * A stream as the virtual sensor measures it, at any output data rate: which row each tick takes, and what noise makes
 * of a row that several ticks take. The same for the simulator, the firmware on the PC and tilt replay.
 */
#ifndef FEED_H
#define FEED_H

#include "stream.h"

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
    uint32_t repeats;      /* ticks that found the same row in force, before this one */
    bool started;
} feed_t;

/* Chooses the mode for this output data rate; call again when the firmware changes the rate (the position is kept). */
void feed_set_rate(feed_t *feed, const stream_t *stream, double odr_hz, uint64_t now_us);

typedef enum { FEED_SAMPLE, FEED_NOTHING, FEED_END } feed_result_t;

/* One output-data-rate tick at time now_us. FEED_SAMPLE: *row_index is the row. FEED_NOTHING: a gap. FEED_END: over. */
feed_result_t feed_tick(feed_t *feed, uint64_t now_us, size_t *row_index);

/*
 * The readings of the row that the last tick took. A row that is in force for several ticks, because the sensor runs
 * faster than the stream, differs by one LSB on one axis from tick to tick, as a sensor's noise would have it: equal
 * readings would look like a sensor that hangs (fault 10). Not what has a meaning of its own: an axis that the stream
 * has not changed for ten rows, a reading at the rail of a range, and -1, -1, -1, which is a sensor without power.
 */
void feed_vary(const feed_t *feed, int16_t lsb[3]);

#endif
