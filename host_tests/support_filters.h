/*
 * What the generic tests of lib/filters share, on the PC and on the chip (no double, no 64-bit numbers): random
 * numbers, configurations from the descriptors, and the facts about single filters that no descriptor tells.
 */
#ifndef SUPPORT_FILTERS_H
#define SUPPORT_FILTERS_H

#include "filter_any.h"
#include "fx.h"
#include "support_random.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Rates that every configuration's first field may take. */
#define CONFIG_RATE_MIN_DHZ 50U
#define CONFIG_RATE_MAX_DHZ 40000U

/* How often a test repeats something: fully on the PC, less on the chip, where a second of the simulator is 2 s. */
#ifdef __AVR__
#define ON_PC_OR_CHIP(pc, chip) (chip)
#else
#define ON_PC_OR_CHIP(pc, chip) (pc)
#endif

/* From this kind on the first that the program links: on the chip not all are (mk/chip_tests.mk). */
uint8_t linked_kind(uint8_t kind);

/* One of the linked kinds for any number, all of them by turns. */
uint8_t any_kind(uint32_t number);

/* The kinds of the list that are linked. */
#define FOR_EACH_KIND(kind) \
    for (uint8_t kind = linked_kind(0); kind < (uint8_t)FILTER_KIND_COUNT; kind = linked_kind((uint8_t)(kind + 1U)))

/* xorshift32 (Marsaglia); the state must not be 0. */
uint32_t random32(uint32_t *state);

/* 0 <= result < end. */
uint32_t random32_below(uint32_t *state, uint32_t end);

/* Parameters of a filter, copied out of program memory. */
uint8_t parameter_count(filter_kind_t kind);
filter_parameter_t parameter_at(filter_kind_t kind, uint8_t index);

/* The low bytes of a value into the parameter's field, and back with the sign that its range tells. */
void parameter_set(filter_any_config_t *config, const filter_parameter_t *parameter, uint32_t value);
uint32_t parameter_get(const filter_any_config_t *config, const filter_parameter_t *parameter);

/* Within the range of the descriptor. */
bool parameter_legal(const filter_parameter_t *parameter, uint32_t value);

/* First field of every configuration. */
void config_set_rate(filter_any_config_t *config, uint16_t rate_dhz);

/* Every parameter anywhere in its range, the ends and the neighbourhood of the lower end preferred. */
void random_config(uint32_t *random, filter_kind_t kind, filter_any_config_t *config);

/*
 * A filter begun with a random legal configuration. Draws again when init refuses and the filter may do so with every
 * parameter in range; *refused counts these. False: refused although no such condition exists, or always.
 */
bool init_random(filter_any_t *f, filter_kind_t kind, uint32_t *random, uint32_t *refused);

/* True when F_init may refuse a configuration whose parameters are each in range. */
bool has_joint_condition(filter_kind_t kind);

/* NULL, or the name of what is outside the bounds that filter.h and the filter's own header promise after a call. */
const char *broken_bound(const filter_any_t *f, const filter_probe_t *probe, int32_t x_lsb_q16);

/* Largest difference between the answers to a sequence and to its mirror image, Q16. */
int32_t mirror_tolerance_lsb_q16(filter_kind_t kind);

/* True when the filter starts with the running median of filter.h; else with the first sample ("as published"). */
bool starts_with_median(filter_kind_t kind);
#define FOR_EACH_KIND_WITH_MEDIAN(kind) FOR_EACH_KIND(kind) if (starts_with_median((filter_kind_t)(kind)))

/* True when a sample flagged FILTER_GATED is not used at all; else it may count with a small gain. */
bool gated_means_unused(filter_kind_t kind);

/*
 * Samples after which a filter that coasted is back, with default parameters at 100 Hz: see the derivation at its
 * definition.
 */
uint16_t recovery_samples(filter_kind_t kind);

#endif
