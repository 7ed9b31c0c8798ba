#include "support/shipped.h"

#include <stdlib.h>
#include <string.h>

#define FOLDER "sim/streams/"

const shipped_t shipped_streams[SHIPPED_STREAMS] = {
    { FOLDER "rest-0.7lsb.csv", 1000, true },       { FOLDER "rest-2lsb.csv", 1000, true },
    { FOLDER "rest-4lsb.csv", 1000, true },         { FOLDER "rest-8lsb.csv", 1000, true },
    { FOLDER "tilt-slow.csv", 1000, true },         { FOLDER "tilt-fast.csv", 1000, false },
    { FOLDER "tilt-400hz.csv", 4000, false },       { FOLDER "through-pitch-90.csv", 1000, false },
    { FOLDER "through-roll-180.csv", 1000, false }, { FOLDER "outliers-15pct.csv", 1000, false },
    { FOLDER "vibration.csv", 1000, false },        { FOLDER "bad-reads.csv", 1000, false },
    { FOLDER "clipping.csv", 1000, false },         { FOLDER "free-fall.csv", 1000, false },
    { FOLDER "sideways-0.5g.csv", 1000, false },    { FOLDER "gaps-jitter.csv", 1000, false },
};

bool stream_cut(stream_t *part, const stream_t *whole, double from_s, double to_s)
{
    memset(part, 0, sizeof *part);
    part->rate_hz = whole->rate_hz;
    part->has_truth = whole->has_truth;
    part->rows = calloc(whole->count + 1, sizeof *part->rows);
    for (size_t i = 0; part->rows != NULL && i < whole->count; i++) {
        double t_s = 1e-6 * (double)whole->rows[i].t_us;
        if (t_s >= from_s && t_s < to_s && !whole->rows[i].missing) {
            part->rows[part->count] = whole->rows[i];
            part->rows[part->count].t_us -= part->count == 0 ? 0 : part->rows[0].t_us;
            part->count++;
        }
    }
    if (part->count < 2) {
        stream_free(part);
        return false;
    }
    part->rows[0].t_us = 0;
    return true;
}
