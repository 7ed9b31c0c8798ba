/* The streams of sim/streams, and folders of recordings beside them, for tests that run over all. PC only. */
#ifndef SUPPORT_SHIPPED_H
#define SUPPORT_SHIPPED_H

#include "stream.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SHIPPED_STREAMS 16U

typedef struct {
    const char *path;
    uint16_t rate_dhz;
    bool calm; /* rest or slow motion without faults: nothing re-acquires */
} shipped_t;
extern const shipped_t shipped_streams[SHIPPED_STREAMS];

/* The rows of from_s..to_s alone, time from 0. False: out of memory, or fewer than two rows. */
bool stream_cut(stream_t *part, const stream_t *whole, double from_s, double to_s);

#endif
