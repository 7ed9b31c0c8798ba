/*
 * Consistency re-acquisition: refused samples that agree among themselves are no outliers but where the signal is now.
 *
 * L refused raw samples in a row, each within `agree` of the sample before it, restart the filter at the last of them,
 * on the slope from the first to the last. An accepted sample ends the run; a missing one makes the slope unknown.
 * Shared by the filters on the core of two_state.h that gate; internal to the library: filters wrap it.
 */
#ifndef REACQUIRE_H
#define REACQUIRE_H

#include "two_state.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Legal lengths of a run: 3, 5 and 9, whose slope is a shift; 0: never. */
#define REACQUIRE_SAMPLES_DEFAULT 5U
#define REACQUIRE_SAMPLES_MIN 3U
#define REACQUIRE_SAMPLES_MAX 9U

/* Legal range of the rate's limit, LSB/s: with R it says how far two raw samples of one run may lie apart. */
#define REACQUIRE_RATE_MAX_MIN_LSB_S 10U
#define REACQUIRE_RATE_MAX_MAX_LSB_S 1000000U
#define REACQUIRE_RATE_MAX_DEFAULT_LSB_S 800U

typedef struct {
    int16_t previous_lsb; /* last raw sample; what every sample needs comes first: an AVR reaches 63 bytes simply */
    uint8_t run;          /* refused samples in the run */
    bool broken;          /* a sample was missing within the run */
    uint8_t steps;        /* L - 1, a power of two; 0: off */
    int16_t first_lsb;    /* of the run */
    uint16_t agree_lsb;   /* raw samples of one run differ by at most this */
} reacquire_t;

/* True when the length of a run is one that a slope can be fitted over without a division. */
bool reacquire_steps_legal(uint16_t samples);

/* True when the length of a run and the limit of the rate are legal. */
FX_ONCE bool reacquire_legal(uint16_t samples, uint32_t rate_max_lsb_s);

/* No run yet; L legal. */
FX_ONCE void reacquire_init(reacquire_t *a, uint16_t samples);

/* Agreement 3 sqrt(2 R) + rate_max with the core's R and limit of the rate, < 135 + 4609 LSB. 700 cycles. */
FX_ONCE void reacquire_set_noise(reacquire_t *a, const two_state_t *s);

/* No run, and z0 was the sample before. */
void reacquire_reset(reacquire_t *a, int16_t z0_lsb);

/*
 * Before a sample that tells no position: what was refused so far does not help it to restart the filter. A run goes on
 * as one of a single sample, so that the time since the last accepted one is not forgotten.
 */
FX_ONCE void reacquire_hold(reacquire_t *a);

/*
 * A refused sample, predicted over by the core: counted when it agrees with the one before, else the first of a new
 * run. The last of a run restarts the core (flags: FILTER_REACQUIRED alone): true. The caller notes every raw sample in
 * previous_lsb afterwards, sets run to 0 on accepted ones and broken on missing ones.
 */
FX_ONCE bool reacquire_refused(reacquire_t *a, two_state_t *s, int16_t z_lsb);

#ifdef __cplusplus
}
#endif
#endif
