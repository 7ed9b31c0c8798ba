// The adaptive filter in paper 000's experiment: without and with its guard, on clean samples and with bad ones.
#include "experiments_000.hpp"
#include "model.hpp"
#include "roll.hpp"
#include "twins.hpp"

#include <cstdio>

namespace papers::roll
{
namespace
{
constexpr std::array<const char *, 4> turns{ "ramp30", "cos60", "bump30", "sine30" };
constexpr std::array<double, 7> curve_sigma{ 2.0, 2.5, 3.0, 3.5, 4.0, 6.0, 8.0 };

struct Disturbance {
    const char *name;
    Noise noise;
};

std::array<Disturbance, 4> disturbances()
{
    Noise few;
    few.outliers = 0.05;
    Noise many;
    many.outliers = 0.15;
    Noise shifted = few;
    shifted.shift_sigma = 20.0;
    return { { { "clean", Noise{} }, { "5_percent", few }, { "15_percent", many }, { "shift_20_sigma", shifted } } };
}

// guard: in sigmas, 0 for none
Maker guarded(double sigmas)
{
    Shipping shipping;
    shipping.parameters = { { "guard", sigmas } };
    return shipped("adaptive", shipping);
}

std::string named(double sigmas)
{
    char text[40];
    std::snprintf(text, sizeof text, "adaptive(guard=%g)", sigmas);
    return text;
}
} // namespace

void adaptive(const Options &options)
{
    std::vector<double> sigmas(curve_sigma.begin(), curve_sigma.end());
    sigmas.insert(sigmas.begin(), 0.0);
    std::vector<Maker> makers;
    for (const double sigma : sigmas) {
        makers.push_back(guarded(sigma));
    }
    Progress progress(static_cast<double>(turns.size() * disturbances().size()));
    row("adaptive_defaults", "adaptive", Arithmetic::fixed, "guard_sigma", parameter_of("adaptive", "guard", {}), 1);
    for (const char *turn : turns) {
        for (const Disturbance &disturbance : disturbances()) {
            const std::vector<Score> scores = monte_carlo(makers, profile(turn), disturbance.noise, runs_of(options),
                                                          options.seed);
            for (std::size_t i = 0; i < sigmas.size(); i++) {
                for (std::size_t w = 0; w < window_count; w++) {
                    row(std::string("adaptive_") + disturbance.name + "_" + turn, named(sigmas[i]), Arithmetic::fixed,
                        std::string("mse_") + windows[w].name, scores[i].mse_deg2[w], runs_of(options));
                }
            }
            progress.advance();
        }
    }
}
} // namespace papers::roll
