// The reference table of paper 000's experiment: seven profiles, six pairs of gains, exactly, in double and on the
// chip's integers.
#include "experiments_000.hpp"
#include "roll.hpp"

#include <algorithm>
#include <cstdio>

namespace papers::roll
{
namespace
{
struct Gains {
    double a1;
    double b0;
};
constexpr std::array<Gains, 6> gains{
    { { -0.3, 0.1 }, { 0.0, 0.1 }, { 0.0, 0.3 }, { -0.1, 0.3 }, { -0.3, 0.5 }, { 0.0, 2.0 / 3.0 } }
};

std::string name_of(const Gains &g)
{
    char text[60];
    std::snprintf(text, sizeof text, "synth(%g:%.3g)", g.a1, g.b0);
    return text;
}

Maker fixed(const Gains &g)
{
    Shipping shipping;
    shipping.reset_at_first = true;
    shipping.parameters = { { "a1", g.a1 }, { "b0", g.b0 } };
    return shipped("synth", shipping);
}

void rows(const std::string &experiment, const std::string &name, Arithmetic arithmetic, const Score &score, int runs)
{
    for (std::size_t w = 0; w < window_count; w++) {
        row(experiment, name, arithmetic, std::string("mse_") + windows[w].name, score.mse_deg2[w], runs);
    }
}
} // namespace

int runs_of(const Options &options)
{
    return std::max(1, options.runs * 2 / 5);
}

void reference_table(const Options &options)
{
    const int runs = std::max(4000, runs_of(options)); // its bands of 3 % are for these
    std::vector<Maker> makers;
    for (const Gains &g : gains) {
        makers.push_back(synthesised(g.a1, g.b0));
        makers.push_back(fixed(g));
    }
    Progress progress(static_cast<double>(profiles().size()));
    for (const Profile &turn : profiles()) {
        const std::string experiment = std::string("roll_") + turn.name;
        const std::vector<Score> scores = monte_carlo(makers, turn, Noise{}, runs, options.seed);
        for (std::size_t i = 0; i < gains.size(); i++) {
            const Exact value = exact(makers[2 * i], turn);
            for (std::size_t w = 0; w < window_count; w++) {
                row(experiment, name_of(gains[i]), Arithmetic::in_double, std::string("exact_mse_") + windows[w].name,
                    value.mse_deg2[w], 1);
            }
            row(experiment, name_of(gains[i]), Arithmetic::in_double, "exact_peak_bias", value.peak_deg, 1);
            rows(experiment, name_of(gains[i]), Arithmetic::in_double, scores[2 * i], runs);
            rows(experiment, name_of(gains[i]), Arithmetic::fixed, scores[2 * i + 1], runs);
        }
        progress.advance();
    }
}
} // namespace papers::roll
