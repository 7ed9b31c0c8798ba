/*
 * Faults as they were measured on real boards, put into a clean stream, and what they do to the filters. PC only.
 *
 * Bad reads are single ones of five forms, each as likely: 0,0,0; -1,-1,-1; one axis 0; a garbled triplet (bytes in
 * wrong places, as 1794,3,12); one axis doubled. Contention (two sensors at one address) doubles the axis that holds
 * most of gravity in 20 % of the reads, in runs of 1..9 as often as recorded. Duplicates: polled 1.64 times as fast as
 * the sensor delivers, so 39 % of the reads repeat the one before. Clipping: bursts of vibration, a fifth of the time,
 * beyond the rails of the 2 g range. Jitter: a timer of the sensor's nominal period that is late or early by a tenth
 * (standard deviation), one read in a hundred 1.5 to 3 periods after the one before: repeats and losses.
 */
#ifndef SUPPORT_FAULTS_H
#define SUPPORT_FAULTS_H

#include "stream.h"
#include "support/chain.h"

typedef enum {
    FAULT_BAD_1E5,
    FAULT_BAD_1E4,
    FAULT_BAD_1E3,
    FAULT_CONTENTION,
    FAULT_DUPLICATES,
    FAULT_CLIPPING,
    FAULT_JITTER,
    FAULT_COUNT
} fault_t;

const char *fault_name(fault_t fault);

/* A stream with faults; source[i] is the clean row that row i shows or should show. */
typedef struct {
    stream_t stream;
    size_t *source;
    uint8_t range_g;
    size_t faulty; /* rows that are not as in the clean stream, or repeat */
} faulty_t;

/* Room for twice the rows of the clean stream, none in it yet. False: out of memory. */
bool faulty_begin(faulty_t *faulty, const stream_t *clean, uint8_t range_g);

/* False: out of memory. The clean stream has no missing rows. */
bool faulty_make(faulty_t *faulty, const stream_t *clean, fault_t fault, uint16_t rate_dhz, uint8_t range_g,
                 uint64_t seed);
void faulty_free(faulty_t *faulty);

/* The filters of the list, and behind them a median of five before kf (R from the samples before the median). */
#define CONTENDERS ((size_t)FILTER_KIND_COUNT + 1U)
#define MEDIAN_PLAIN ((size_t)FILTER_KIND_COUNT)
const char *contender_name(size_t contender);

/* A cold start, as chain_begin. */
bool contender_begin(chain_t *chain, size_t contender, uint16_t rate_dhz, uint8_t range_g, int axis);

/* A clean stream and what each contender makes of it. */
typedef struct {
    const stream_t *clean;
    uint16_t rate_dhz;
    uint8_t range_g;
    int32_t *x_lsb_q16[CONTENDERS][3];
    size_t reacquired; /* by sprf, on all axes: 0 where the stream is calm */
} study_t;

bool study_begin(study_t *study, const stream_t *clean, uint16_t rate_dhz, uint8_t range_g);
void study_end(study_t *study);

/*
 * Squared differences of the output from the contender's own without faults and from kf's without faults, summed. For
 * kf, lrf and synth `predicted` is what theory says of the first: a read wrong by A leaves A^2 sum h^2. For kf
 * `allowed` is what a filter may leave that does not follow it, see the test of the faults.
 */
typedef struct {
    double own, plain;
    double predicted;
    double allowed;
    size_t count;
} score_t;

/* Adds what the fault does to a contender. */
void study_score(const study_t *study, const faulty_t *faulty, size_t contender, score_t *score);

double rms(double sum, size_t count);

#endif
