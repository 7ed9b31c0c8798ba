/*
 * What a law has for the generic tests, beside its descriptor: support_law_NAME.c has its bounds (broken_NAME: NULL, or
 * what of the state is outside them) and its facts (law_facts_NAME), and here is what such files share.
 *
 * Symmetry: the laws compute magnitudes and round them alike for both signs: exact, unless a law says otherwise.
 *
 * Motion that stops at the start of a gap of n <= 200 samples at 2 LSB per sample: the filter comes back E = 2 n LSB
 * and 2 LSB per sample wrong. From there the error e obeys e' = (I - K H) A e and V = e^T P^-1 e falls by the largest
 * eigenvalue of P'^-1 (I - K H) A P A^T (I - K H)^T at each update, because P' exceeds that product by the noise
 * terms; so |e_x| <= sqrt(P11 V). The number of samples after which that is below 1/4 LSB, and how it follows, stands
 * with each law.
 *
 * The envelope (support/envelope.h): sum |h| and W.
 */
#ifndef SUPPORT_LAW_FACTS_H
#define SUPPORT_LAW_FACTS_H

#include "support/filters.h"

#define X_MAX_Q16 ((uint32_t)FILTER_X_MAX_LSB << 16)

#ifdef __AVR__
#define ENVELOPE(...) /* on the PC only: double */
#else
#define TWO_STATE_SUM 1.434
#define THREE_STATE_SUM 1.828
#define MIXTURE_SUM (1.434 + 1.945)
#define LINEAR_FORGETS 10.0
#define PAPER_TIME_CONSTANT 14.7
#define ENVELOPE(sum, ratio, time_constants, samples, ...) \
    .envelope = { .gain_sum = (sum),                       \
                  .variance_ratio = (ratio),               \
                  .forgets = (time_constants),             \
                  .forgets_samples = (samples),            \
                  .rule = __VA_ARGS__ }, /* and what it has of its own behind it */
#endif

/* What most are. */
#define USUAL .starts_with_median = true
#define REFUSES .gated_means_unused = true
#define SETTLES_IN(samples) .recovery_samples = (samples)

/* R of a law within the legal range, of which the upper end may be a law's own. */
bool r_broken(uint32_t r_lsb2_q8, uint32_t max_lsb2_q8);

bool running(const filter_t *f);

/* Flags of a gate, which a law without one never sets. */
bool gate_shows(const filter_t *f);

/* Families of laws: kalman.h; its runs of refused samples; wide.h; mixture.h; synth.h. */
const char *broken_core(const filter_t *f, uint32_t r_max_lsb2_q8);
const char *broken_run(const filter_t *f);
const char *broken_wide(const filter_t *f);
const char *broken_mixture(const filter_t *f);
const char *broken_estimates(const filter_t *f);

#endif
