/* The one table of facts about the laws of the list that no descriptor tells: a row each. */
#include "support_filters.h"

/*
 * Symmetry: the laws, synth and auto compute magnitudes and round them alike for both signs: exact. synth_plus rounds
 * what rho takes off half up, so that a mirrored step may differ by 2^-16 LSB, and later estimates by the sum of the
 * response to that: 2^-4 LSB allows a sum of 4096.
 *
 * Motion that stops at the start of a gap of n <= 200 samples at 2 LSB per sample: the filter comes back E = 2 n LSB
 * and 2 LSB per sample wrong. From there the error e obeys e' = (I - K H) A e and V = e^T P^-1 e falls by the largest
 * eigenvalue of P'^-1 (I - K H) A P A^T (I - K H)^T at each update, because P' exceeds that product by the noise
 * terms; so |e_x| <= sqrt(P11 V). With q T^3 / R = 1/300 (defaults at 100 Hz) and P grown over the gap up to the
 * core's limit of 2, this is below 1/4 LSB after 43 samples for the worst n. sprf takes that path when the first
 * innovation is within its gate, else its five agreeing samples restart it without error. synth at (0, 0.3) obeys e =
 * 0.7 (2 e1 - e2) from 2 n and 2 n - 2 LSB: |e| <= 400.1 x 0.83666^k, and below 1/4 LSB from k = 40 on for every n <=
 * 200. synth_opt in the limit, e = (2 e1 - e2) / 3, likewise after 14 (poles at 0.57735), and synth_plus with its
 * alpha-beta of 0.289 and 0.0487 after 40 (0.843), both recursions run in double over every n. lrf is kf with q T^3 /
 * R_L = 1/300/60.85 and R_L = 182.6 LSB^2: 114 by the same bound. soft takes kf's path within its soft gate and is
 * restarted beyond its gate, as sprf; in between it updates with a larger R, by which V falls as well (the recursion
 * in double is back after 16).
 *
 * Where samples are refused V falls too, because P grows meanwhile: n samples after the motion's end, refused or
 * coasted, it is at most 16 / (q T^3 n) LSB^-2 (4 LSB^2 e and P of n steps of the model), 1600 / n here. sprf_paper
 * takes all from V = 4 on, n = 400, and 43 more. shrf takes a sample surely when b t / 2 <= ln(0.85 / 0.15) +
 * ln(S_N / S) / 2: with t <= V and b = 399 / (P11 + 400), P11 = n^3 / 900, from n = 100 on; pbf and af use every sample
 * and are faster: 100 + 43, rounded up.
 *
 * kf3 comes back as far wrong, and its error obeys the recursion of its P: computed in double for each n, with P held
 * where its range ends, the slowest is below 1/4 LSB from sample 90 on. auto: its
 * three members with gates, restarts and scores in double, for each n: 10 at most (n = 5).
 *
 * Joint conditions: reacquire of sprf and soft, of 3..9 only 3, 5 and 9, whose slope is a shift; the stability regions
 * of synth (a1 and b0) and of synth_plus (its four coefficients).
 *
 * The envelope (support_envelope.h): sum |h| and W. synth: poles at 0.83666, e^-10 after 56 samples; synth_opt: at
 * 0.57735; synth_plus: kf's gains at the least R, fixed.
 */
#ifdef __AVR__
#define ENVELOPE(...) /* on the PC only: double */
#else
#define TWO_STATE_SUM 1.434
#define SYNTH_SUM 2.277
#define THREE_STATE_SUM 1.828
#define SYNTH_OPT_SUM 1.446
#define MIXTURE_SUM (1.434 + 1.945)
#define LINEAR_FORGETS 10.0
#define PAPER_TIME_CONSTANT 14.7
#define ENVELOPE(...) .envelope = { __VA_ARGS__ },
#endif

/* What most are. */
#define USUAL .starts_with_median = true
#define REFUSES .gated_means_unused = true
#define SETTLES_IN(samples) .recovery_samples = (samples)

#define FACTS_kf                                                \
    ENVELOPE(TWO_STATE_SUM, 1.0, LINEAR_FORGETS, 0, ENVELOPE_LINEAR) \
    USUAL, REFUSES, SETTLES_IN(43)
#define FACTS_lrf                                                 \
    ENVELOPE(TWO_STATE_SUM, 60.85, LINEAR_FORGETS, 0, ENVELOPE_LINEAR) \
    USUAL, REFUSES, SETTLES_IN(114)
#define FACTS_sprf                                                      \
    ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_STANDS) \
    USUAL, REFUSES, SETTLES_IN(43), .joint_condition = true, .restarts = true
#define FACTS_soft                                                          \
    ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_REACQUIRES) \
    USUAL, SETTLES_IN(43), .joint_condition = true, .restarts = true
#define FACTS_sprf_paper                                              \
    ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_NONE) \
    REFUSES, SETTLES_IN(443), .restarts = true
#define FACTS_shrf                                                      \
    ENVELOPE(0.0, 1.0, 1200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_WAITS) \
    USUAL, SETTLES_IN(150)
#define FACTS_pbf                                                                \
    ENVELOPE(MIXTURE_SUM, 1.0, 800.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_MIXTURE) \
    USUAL, SETTLES_IN(150)
#define FACTS_af                                                                 \
    ENVELOPE(MIXTURE_SUM, 1.0, 800.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_MIXTURE) \
    USUAL, SETTLES_IN(150), .learns = true
#define FACTS_synth                                        \
    ENVELOPE(SYNTH_SUM, 1.0, 0.0, 56, ENVELOPE_FIXED_GAIN) \
    USUAL, REFUSES, SETTLES_IN(40), .joint_condition = true, .rate_is_a_difference = true, .synthesised = true
#define FACTS_synth_opt                                        \
    ENVELOPE(SYNTH_OPT_SUM, 1.0, 0.0, 19, ENVELOPE_FIXED_GAIN) \
    USUAL, REFUSES, SETTLES_IN(14), .rate_is_a_difference = true, .synthesised = true
#define FACTS_synth_plus                                                 \
    ENVELOPE(TWO_STATE_SUM, 1.0, LINEAR_FORGETS, 0, ENVELOPE_FIXED_GAIN) \
    USUAL, REFUSES, SETTLES_IN(40), .joint_condition = true, .mirror_lsb_q16 = 4096, .synthesised = true
#define FACTS_kf3                                                          \
    ENVELOPE(THREE_STATE_SUM, 1.0, LINEAR_FORGETS, 0, ENVELOPE_FIXED_GAIN) \
    USUAL, REFUSES, SETTLES_IN(90)
#define FACTS_adaptive                                                \
    ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_NONE) \
    USUAL, SETTLES_IN(90), .restarts = true, .learns = true
#define FACTS_auto                                                    \
    ENVELOPE(0.0, 1.0, 200.0 / PAPER_TIME_CONSTANT, 0, ENVELOPE_NONE) \
    USUAL, REFUSES, SETTLES_IN(10), .restarts = true, .switches = true

/* A law without its row does not compile. */
law_facts_t law_facts(filter_kind_t kind)
{
    switch (kind) {
#define ROW(F)            \
    case FILTER_KIND_##F: \
        return (law_facts_t){ FACTS_##F };
        FILTER_LIST(ROW)
#undef ROW
    case FILTER_KIND_COUNT:
        break;
    }
    return (law_facts_t){ 0 };
}
