// products000: what a sample costs the synthesised filters, counted on the shipped code. A line for each set of taps:
// the most products of a sample behind the start, the most of the start's, shifts that round, divisions; gaps among the
// samples.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "counting.hpp"
#include "synth.h"
#include "synth_opt.h"
#include "synth_plus.h"

counting::Tally counting::tally{};

namespace
{
int sample(int k)
{
    return static_cast<int>(std::lround(160.0 + 40.0 * std::sin(0.01 * k) + 20.0 * std::sin(2.7 * k)));
}

// Of the filter's updates and coasts.
template <class F, class C, class Init, class Update, class Coast>
int most(const char *what, const C &config, Init init, Update update, Coast coast)
{
    F f;
    if (!init(&f, &config)) {
        std::fprintf(stderr, "products000: %s refuses its configuration\n", what);
        return 2;
    }
    counting::Tally start{};
    counting::Tally steady{};
    for (int k = 0; k < 1000; k++) {
        counting::tally = {};
        if (k % 50 == 49) {
            (void)coast(&f);
        } else {
            (void)update(&f, sample(k));
        }
        counting::Tally &worst = (k < 100) ? start : steady;
        worst.products = std::max(worst.products, counting::tally.products);
        worst.shifts = std::max(worst.shifts, counting::tally.shifts);
        worst.divisions = std::max(worst.divisions, counting::tally.divisions);
    }
    std::printf("%s\t%ld\t%ld\t%ld\t%ld\n", what, steady.products, start.products, steady.shifts,
                std::max(start.divisions, steady.divisions));
    return 0;
}

int of_synth(const char *what, int a1_q16)
{
    synth_config_t config;
    synth_defaults(&config, 1000);
    config.a1_q16 = a1_q16;
    return most<synth_t>(what, config, synth_init, synth_update, synth_coast);
}

int of_synth_opt(const char *what, int variant_u)
{
    synth_opt_config_t config;
    synth_opt_defaults(&config, 1000);
    config.variant_u = variant_u;
    return most<synth_opt_t>(what, config, synth_opt_init, synth_opt_update, synth_opt_coast);
}

// Three taps: those of the steady Kalman filter of white jerk with lambda 5e-4; with rho = 0 any that are stable.
int of_synth_plus(const char *what, int k, bool third_tap)
{
    synth_plus_config_t config;
    synth_plus_defaults(&config, 1000);
    if (third_tap) {
        config.b0_uq16 = 28266;
        config.b1_q16 = (k != 0) ? -48055 : -20000;
        config.b2_q16 = (k != 0) ? 20895 : 5000;
    }
    config.k = k;
    return most<synth_plus_t>(what, config, synth_plus_init, synth_plus_update, synth_plus_coast);
}
} // namespace

int main()
{
    int status = of_synth("synth, a1 = 0", 0);
    status |= of_synth("synth, a1 < 0", -19661);
    status |= of_synth("synth, a1 > 0", 19661);
    status |= of_synth_opt("synth_opt, exact", 0);
    status |= of_synth_opt("synth_opt, U", 1);
    status |= of_synth_plus("synth_plus, alpha-beta", 0, false);
    status |= of_synth_plus("synth_plus, three taps", 0, true);
    status |= of_synth_plus("synth_plus, three taps, rho 127/128", 7, true);
    status |= of_synth_plus("synth_plus, three taps, rho 1", 8, true);
    return status;
}
