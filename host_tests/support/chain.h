/*
 * One axis of the firmware's sample path (pipeline.c: noise estimate, coasting over gaps, clipping, filter) as
 * a value, so that many can run. A test holds it to be pipeline.c bit for bit. PC only.
 */
#ifndef SUPPORT_CHAIN_H
#define SUPPORT_CHAIN_H

#include "filter_list.h"
#include "noise.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Running median of the last `window` samples, the newest among them: a reference of the tests, not in the library. */
#define MEDIAN_WINDOW_MAX 9U

typedef struct {
    int16_t seen_lsb[MEDIAN_WINDOW_MAX]; /* newest first */
    uint8_t window;
    uint8_t filled;
} median_t;

/* NULL, or why the window is refused: even windows have no middle sample, 1 and more than 9 are none. */
const char *median_init(median_t *m, unsigned window);

/* Median of the samples so far, at most `window`; of an even number of first samples the upper one of the middle. */
int16_t median_update(median_t *m, int16_t z_lsb);

typedef struct {
    filter_t filter;
    noise_t noise;
    median_t median; /* window 0: the filter gets the samples as they are */
    uint64_t last_us;
    uint32_t period_us;
    uint32_t coasts; /* predictions before the last sample that was used */
    uint16_t rate_dhz;
    uint32_t away; /* after a hold: 1, and 1 more for each sample away from what was held */
    int32_t x_lsb_q16;
    int16_t rail_high_lsb;
    bool has_sample;
    bool clipped; /* the last sample */
    bool waits;   /* the last sample was not for the filter: away from what was held */
    bool begun;   /* the filter began anew with it */
} chain_t;

/* A cold start with the filter's defaults; axis 2 is the noisier z. False: the rate is illegal. */
bool chain_begin(chain_t *chain, filter_kind_t kind, uint16_t rate_dhz, uint8_t range_g, int axis);

/* One sample in, the estimate out. */
int32_t chain_sample(chain_t *chain, uint64_t t_us, int16_t lsb);

/* R in force, LSB^2. */
double chain_r_lsb2(const chain_t *chain);

#endif
