// The adaptive filter in paper 000's experiment: without and with its guard, on clean samples and with bad ones.
#include "experiments_000.hpp"
#include "model.hpp"
#include "roll.hpp"
#include "twins.hpp"

extern "C" {
#include "adaptive.h"
}

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

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

// One case of the noise that adaptive identifies, from the default R, which is hundreds of times too small here.
struct Identified {
    const char *name;
    const char *turn; // none: at rest
    double rate_hz;
    double outlier_deg; // added to one sample in a hundred
};
constexpr double identified_after_s = 10.0;
constexpr std::array<Identified, 5> identified{ { { "rest_10_hz", nullptr, 10.0, 0.0 },
                                                  { "cos60_10_hz", "cos60", 10.0, 0.0 },
                                                  { "sine30_10_hz", "sine30", 10.0, 0.0 },
                                                  { "rest_10_hz_1_percent_of_20_deg", nullptr, 10.0, 20.0 },
                                                  { "rest_100_hz", nullptr, 100.0, 0.0 } } };

// Identified R by the true one after 10 s of one run.
double identified_ratio(const Identified &what, const filter_config_t &config, std::uint64_t seed)
{
    constexpr double lsb_per_degree = 16.0;
    test_random_t random;
    random_seed(&random, seed);
    filter_t f;
    if (filter_init(&f, &filter_law_adaptive, &config) != FILTER_ACCEPTED) {
        throw std::runtime_error("adaptive: refuses its defaults");
    }
    const int count = static_cast<int>(std::lround(identified_after_s * what.rate_hz));
    for (int k = 0; k <= count; k++) {
        const double noise = std::sqrt(r_deg2) * random_normal(&random);
        const double bad = random_uniform(&random) < 0.01 ? what.outlier_deg : 0.0;
        const double truth = (what.turn == nullptr) ? 0.0 : profile(what.turn).truth_deg(k);
        (void)filter_update(&f, as_sample((truth + noise + bad) * lsb_per_degree));
    }
    return adaptive_r_lsb2_q8(&f) / (256.0 * r_deg2 * lsb_per_degree * lsb_per_degree);
}

// Standard deviation by the mean, with the 95 % interval that the fourth moment gives it.
Interval relative_deviation(const std::vector<double> &values, const Interval &mean, double sd)
{
    double fourth = 0.0;
    for (const double value : values) {
        fourth += std::pow(value - mean.value, 4.0) / static_cast<double>(values.size());
    }
    const double spread = fourth - std::pow(sd, 4.0); // of a squared deviation
    const double error = std::sqrt(std::fmax(0.0, spread) / static_cast<double>(values.size())) / (2.0 * sd);
    return { sd / mean.value, (sd - 1.959964 * error) / mean.value, (sd + 1.959964 * error) / mean.value };
}

void identified_rows(const Identified &what, const Options &options)
{
    filter_config_t config = filter_defaults(&filter_law_adaptive,
                                             static_cast<std::uint16_t>(std::lround(10.0 * what.rate_hz)));
    std::vector<double> ratios;
    for (int run = 0; run < runs_of(options); run++) {
        ratios.push_back(identified_ratio(what, config, run_seed(options.seed, static_cast<std::uint64_t>(run))));
    }
    double sd = 0.0;
    const Interval mean = mean_of(ratios, sd);
    const std::string experiment = std::string("adaptive_r_") + what.name;
    row(experiment, "adaptive", Arithmetic::fixed, "r_by_true", mean, runs_of(options));
    row(experiment, "adaptive", Arithmetic::fixed, "r_one_run_sd", relative_deviation(ratios, mean, sd),
        runs_of(options));
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
    Progress progress(static_cast<double>(turns.size() * disturbances().size() + identified.size()));
    row("adaptive_defaults", "adaptive", Arithmetic::fixed, "guard_sigma", parameter_of("adaptive", "guard", {}), 1);
    for (const Identified &what : identified) {
        identified_rows(what, options);
        progress.advance();
    }
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
