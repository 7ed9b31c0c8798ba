/* What each filter of the list promises besides the bounds of its state: symmetry, recovery, what its flags mean. */
#include "support_filters.h"

typedef struct {
    int32_t mirror_lsb_q16;  /* mirror_tolerance_lsb_q16 */
    uint16_t recovery;       /* recovery_samples */
    bool joint;              /* has_joint_condition */
    bool gated_means_unused; /* the functions of the same name */
    bool starts_with_median;
} promise_t;

/*
 * Symmetry: the cores, synth and auto compute magnitudes and round them alike for both signs: exact. synth_plus rounds
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
 */
#define PROMISE_kf 0, 43, false, true, true
#define PROMISE_sprf 0, 43, true, true, true
#define PROMISE_soft 0, 43, true, false, true
#define PROMISE_lrf 0, 114, false, true, true
#define PROMISE_synth 0, 40, true, true, true
#define PROMISE_synth_plus 4096, 40, true, true, true
#define PROMISE_synth_opt 0, 14, false, true, true
#define PROMISE_sprf_paper 0, 443, false, true, false
#define PROMISE_shrf 0, 150, false, false, true
#define PROMISE_pbf 0, 150, false, false, true
#define PROMISE_af 0, 150, false, false, true
#define PROMISE_kf3 0, 90, false, true, true
#define PROMISE_adaptive 0, 90, false, false, true
#define PROMISE_auto 0, 10, false, true, true

/* A filter without a promise does not compile. */
static promise_t promise_of(filter_kind_t kind)
{
    switch (kind) {
#define PROMISE(F)        \
    case FILTER_KIND_##F: \
        return (promise_t){ PROMISE_##F };
        FILTER_LIST(PROMISE)
#undef PROMISE
    case FILTER_KIND_COUNT:
        break;
    }
    return (promise_t){ 0 };
}

int32_t mirror_tolerance_lsb_q16(filter_kind_t kind)
{
    return promise_of(kind).mirror_lsb_q16;
}

uint16_t recovery_samples(filter_kind_t kind)
{
    return promise_of(kind).recovery;
}

bool has_joint_condition(filter_kind_t kind)
{
    return promise_of(kind).joint;
}

bool gated_means_unused(filter_kind_t kind)
{
    return promise_of(kind).gated_means_unused;
}

bool starts_with_median(filter_kind_t kind)
{
    return promise_of(kind).starts_with_median;
}
