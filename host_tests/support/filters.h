/*
 * What the generic tests of lib/filters share, on the PC and on the chip (no double, no 64-bit numbers): random
 * numbers, configurations from the descriptors, and the facts about single laws that no descriptor has.
 */
#ifndef SUPPORT_FILTERS_H
#define SUPPORT_FILTERS_H

#include "filter_list.h"
#include "fx.h"
#include "support/random.h"
#include "tracker.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How often a test repeats something: fully on the PC, less on the chip, where a second of the simulator is 2 s. */
#ifdef __AVR__
#define ON_PC_OR_CHIP(pc, chip) (chip)
#else
#define ON_PC_OR_CHIP(pc, chip) (pc)
#endif

/* From this kind on the first that the program links: on the chip not all are (host_tests/chip/chip_tests.mk). */
uint8_t linked_kind(uint8_t kind);

/* One of the linked kinds for any number, all of them by turns. */
uint8_t any_kind(uint32_t number);

/* The kinds of the list that are linked. */
#define FOR_EACH_KIND(kind) \
    for (uint8_t kind = linked_kind(0); kind < (uint8_t)FILTER_KIND_COUNT; kind = linked_kind((uint8_t)(kind + 1U)))

/* The bare prediction of a filter that runs: what filter_missing does without its damping and its hold. */
static inline int32_t coast_only(filter_t *f)
{
    f->broken = true;
    f->flags = FILTER_COASTED;
    LAW_OF(f, step)(f, 0, STEP_MISSING);
    filter_tracker_nothing(f);
    return f->x_lsb_q16;
}

/* xorshift32 (Marsaglia); the state must not be 0. */
uint32_t random32(uint32_t *state);

/* 0 <= result < end. */
uint32_t random32_below(uint32_t *state, uint32_t end);

/* The kind whose law a filter follows. */
filter_kind_t kind_of(const filter_t *f);

/* Parameters of a filter, copied out of program memory. */
uint8_t parameter_count(filter_kind_t kind);
filter_parameter_t parameter_at(filter_kind_t kind, uint8_t index);
const char *parameter_name(filter_kind_t kind, uint8_t index); /* until the next one is asked for */

/* Within the range of the descriptor, or off. */
bool parameter_legal(const filter_parameter_t *parameter, int32_t value);

/* A filter with the law's defaults at an output data rate; false: refused. */
bool init_default(filter_t *f, filter_kind_t kind, uint16_t rate_dhz);

/* Every parameter anywhere in its range, the ends and the neighbourhood of the lower end preferred. */
void random_config(uint32_t *random, filter_kind_t kind, filter_config_t *config);

/*
 * A filter with a random legal configuration. Draws again when init refuses and the filter may do so with every
 * parameter in range; *refused counts these. False: refused although no such condition exists, or always.
 */
bool init_random(filter_t *f, filter_kind_t kind, uint32_t *random, uint32_t *refused);

/* Whatever was called before: the estimate as the probe reports it. */
int32_t estimate_of(const filter_t *f);

/* NULL, or the name of what is outside the bounds that filter.h and the law's own file promise after a call. */
const char *broken_bound(const filter_t *f, const filter_probe_t *probe, int32_t x_lsb_q16);

#ifndef __AVR__
/* How it is judged that a filter did not diverge: see support/envelope.h. */
typedef enum {
    ENVELOPE_LINEAR,     /* band */
    ENVELOPE_FIXED_GAIN, /* band, where no sample is missing */
    ENVELOPE_MIXTURE,    /* band, which holds its rate from one gain to the other */
    ENVELOPE_REACQUIRES, /* hull and run */
    ENVELOPE_STANDS,     /* hull and run, of few samples */
    ENVELOPE_WAITS,      /* wait */
    ENVELOPE_NONE
} envelope_rule_t;

typedef struct {
    double gain_sum;       /* of the band */
    double variance_ratio; /* of the R that its gain is made for to R */
    double forgets;        /* W in time constants; 0: forgets_samples */
    unsigned forgets_samples;
    envelope_rule_t rule;
    double (*noise_gain)(const filter_t *f); /* sum h^2 of its steady state; NULL: a Kalman filter of two states */
    double (*time_constant_samples)(uint16_t rate_dhz, double r_lsb2); /* NULL: likewise */
} envelope_facts_t;
#endif

/* The largest ratemax: up to 217 Hz above the bound of a rate, 4608 LSB a sample. */
enum { RATE_UNLIMITED_LSB_S = 1000000 };

/* What no descriptor has of a law: support_law_NAME.c has them. */
typedef struct {
    int32_t mirror_lsb_q16;    /* largest difference between the answers to a sequence and to its mirror image */
    uint16_t recovery_samples; /* after which a filter that predicted is back, with default parameters at 100 Hz */
    bool joint_condition;      /* init may refuse a configuration whose parameters are each in range */
    bool gated_means_unused;   /* a sample flagged FILTER_GATED is not used at all; else it may count a little */
    bool starts_with_median;   /* with the running median of filter.h; else with the first sample ("as published") */
    bool restarts;             /* restarts on samples that stay away */
    bool learns;               /* its noise, or the share of outliers: a restart keeps that */
    bool rate_is_a_difference; /* of two estimates: at rest 314 and 589 degrees a second at 800 Hz */
    bool switches;             /* FILTER_SWITCHED may be set */
    bool published_only;       /* to compare with its paper: no tool recommends it */
    bool locks_out;            /* as published: after outliers in runs it may not come back to a motion */
    bool loses_motion;         /* or may be off it while they last */
    bool stays_away;           /* not back within 400 samples after a jump of thousands of LSB */
    bool synthesised;          /* its rate is a step between two estimates: up to twice their bound */
#ifndef __AVR__
    envelope_facts_t envelope;
#endif
} law_facts_t;
law_facts_t law_facts(filter_kind_t kind);

/* Of each law, in its support_law_NAME.c: the facts; NULL, or what of its own state is outside its bounds. */
#define LAW_SUPPORT(F)               \
    law_facts_t law_facts_##F(void); \
    const char *broken_##F(const filter_t *f);
FILTER_LIST(LAW_SUPPORT)
#undef LAW_SUPPORT

#define FOR_EACH_KIND_WITH_MEDIAN(kind) FOR_EACH_KIND(kind) if (law_facts((filter_kind_t)(kind)).starts_with_median)

#endif
