// products000: what a sample costs the synthesised filters, counted on the shipped code. A line for each set of taps:
// the most products of a sample behind the start, the most of the start's, shifts that round, divisions; gaps among the
// samples; then products and shifts as the equations have them.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "counting.hpp"
#include "synth.h"

counting::Tally counting::tally{};

namespace
{
int sample(int k)
{
    return static_cast<int>(std::lround(160.0 + 40.0 * std::sin(0.01 * k) + 20.0 * std::sin(2.7 * k)));
}

// No sample: what filter_missing does beside its damping.
void predict(filter_t &f)
{
    f.broken = true;
    LAW_OF(&f, step)(&f, 0, STEP_MISSING);
    filter_tracker_nothing(&f);
}

// By hand from the equations: b0 u; a1 times the curvature; b1 u and b2 u. rho is no product but a shift.
struct Equations {
    int products, shifts;
};

// Of the filter's updates and predictions.
int most(const char *what, const filter_law_t *law, const filter_config_t &config, Equations by_hand)
{
    filter_t f;
    if (filter_init(&f, law, &config) != FILTER_ACCEPTED) {
        std::fprintf(stderr, "products000: %s refuses its configuration\n", what);
        return 2;
    }
    counting::Tally start{};
    counting::Tally steady{};
    for (int k = 0; k < 1000; k++) {
        counting::tally = {};
        if (k % 50 == 49) {
            predict(f);
        } else {
            (void)filter_update(&f, sample(k));
        }
        counting::Tally &worst = (k < 100) ? start : steady;
        worst.products = std::max(worst.products, counting::tally.products);
        worst.shifts = std::max(worst.shifts, counting::tally.shifts);
        worst.divisions = std::max(worst.divisions, counting::tally.divisions);
    }
    std::printf("%s\t%ld\t%ld\t%ld\t%ld\t%d\t%d\n", what, steady.products, start.products, steady.shifts,
                std::max(start.divisions, steady.divisions), by_hand.products, by_hand.shifts);
    return 0;
}

int of_synth(const char *what, int a1_q16, Equations by_hand)
{
    filter_config_t config = filter_defaults(&filter_law_synth, 1000);
    config.value[SYNTH_A1_Q16] = a1_q16;
    return most(what, &filter_law_synth, config, by_hand);
}

int of_synth_opt(const char *what, int variant_u, Equations by_hand)
{
    filter_config_t config = filter_defaults(&filter_law_synth_opt, 1000);
    config.value[SYNTH_OPT_VARIANT_U] = variant_u;
    return most(what, &filter_law_synth_opt, config, by_hand);
}

// Three taps: those of the steady Kalman filter of white jerk with lambda 5e-4; with rho = 0 any that are stable.
int of_synth_plus(const char *what, int k, bool third_tap, Equations by_hand)
{
    filter_config_t config = filter_defaults(&filter_law_synth_plus, 1000);
    if (third_tap) {
        config.value[SYNTH_PLUS_B0_UQ16] = 28266;
        config.value[SYNTH_PLUS_B1_Q16] = (k != 0) ? -48055 : -20000;
        config.value[SYNTH_PLUS_B2_Q16] = (k != 0) ? 20895 : 5000;
    }
    config.value[SYNTH_PLUS_K] = k;
    return most(what, &filter_law_synth_plus, config, by_hand);
}
} // namespace

int main()
{
    int status = of_synth("synth, a1 = 0", 0, { 1, 0 });
    status |= of_synth("synth, a1 < 0", -19661, { 2, 0 });
    status |= of_synth("synth, a1 > 0", 19661, { 2, 0 });
    status |= of_synth_opt("synth_opt, exact", 0, { 1, 0 });
    status |= of_synth_opt("synth_opt, U", 1, { 2, 0 });
    status |= of_synth_plus("synth_plus, alpha-beta", 0, false, { 2, 0 });
    status |= of_synth_plus("synth_plus, three taps", 0, true, { 3, 0 });
    status |= of_synth_plus("synth_plus, three taps, rho 127/128", 7, true, { 3, 1 });
    status |= of_synth_plus("synth_plus, three taps, rho 1", 8, true, { 3, 1 });
    return status;
}
