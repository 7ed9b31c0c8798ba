/*
 * One endless sequence of calls (all that change a state) over all filters, the same on the PC and on the chip:
 * first every corner of every configuration with the extreme inputs, then random configurations with random ones. Each
 * call's answer, flags and probe go into a running CRC-32 and the bounds of the state are looked at.
 */
#ifndef FILTER_SEQUENCE_H
#define FILTER_SEQUENCE_H

#include "support/filters.h"

typedef struct {
    uint32_t random;
    uint32_t crc;       /* over all calls so far; crc32_value() of it is what to compare */
    uint32_t updates;   /* calls of filter_update so far */
    uint32_t refused;   /* configurations drawn in vain */
    uint32_t episode;   /* configurations begun */
    uint32_t corner;    /* next corner of this kind's configurations */
    uint32_t level;     /* of the input, low 16 bits */
    uint16_t calls;     /* of the episode so far */
    uint16_t calls_end; /* of the episode */
    uint16_t slope;     /* of the input */
    uint8_t signal;     /* which input */
    uint8_t noise_bits; /* of the input */
    uint8_t coasts;     /* missing samples of 256 calls in random episodes */
    uint8_t kind;       /* in force */
    bool extremes;      /* corners are not through */
    filter_t filter;
} filter_sequence_t;

void sequence_start(filter_sequence_t *s);

/* On until so many updates are done. NULL, or the name of the bound that a call has broken (s tells where). */
const char *sequence_run(filter_sequence_t *s, uint32_t updates);

#endif
