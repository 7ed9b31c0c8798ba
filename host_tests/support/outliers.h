/*
 * Outliers as the papers assume them, put into a clean stream. PC only.
 *
 * Each axis for itself: a share of 15 % of its readings gets a normal deviate of 20 times the noise added, as in the
 * shipped streams with outliers. The noise is 2 LSB at 100 Hz and has one density (1 LSB at 25 Hz), 1.3 times on z.
 * Alone: each reading is one or not, whatever the one before was. In runs: an outlier ends a run with 1/5, so that runs
 * have a mean length of 5; each reading has its own deviate, or the first one's reading is held through the run.
 */
#ifndef SUPPORT_OUTLIERS_H
#define SUPPORT_OUTLIERS_H

#include "support/faults.h"

#define OUTLIER_SHARE 0.15
#define OUTLIER_RUN 5.0

typedef enum { OUTLIERS_ALONE, OUTLIERS_IN_RUNS, OUTLIERS_HELD, OUTLIERS_COUNT } outliers_t;

const char *outliers_name(outliers_t kind);

/* As faulty_make; clamped at the rails of the range. */
bool outliers_make(faulty_t *faulty, const stream_t *clean, outliers_t kind, uint16_t rate_dhz, uint8_t range_g,
                   uint64_t seed);

#endif
