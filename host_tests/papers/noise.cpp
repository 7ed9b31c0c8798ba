// The noise that lib/filters identifies from samples (noise.c), on paper 000's roll.
#include "reference/noise.h"
#include "experiments_000.hpp"
#include "model.hpp"
#include "roll.hpp"

extern "C" {
#include "noise.h"
}

#include <cmath>

namespace papers::roll
{
namespace
{
constexpr double lsb_per_degree = 16.0;
constexpr double after_s = 10.0;

// One case, from the floor, which is hundreds of times too small here.
struct Case {
    const char *name;
    const char *turn; // none: at rest
    std::uint16_t rate_hz;
    double bad; // share of samples that are 20 degrees off
};
constexpr std::array<Case, 6> cases{ { { "rest_10_hz", nullptr, 10, 0.0 },
                                       { "cos60_10_hz", "cos60", 10, 0.0 },
                                       { "sine30_10_hz", "sine30", 10, 0.0 },
                                       { "rest_10_hz_1_percent_of_20_deg", nullptr, 10, 0.01 },
                                       { "rest_100_hz", nullptr, 100, 0.0 },
                                       { "rest_100_hz_1_percent_of_20_deg", nullptr, 100, 0.01 } } };

double variance_lsb2()
{
    return r_deg2 * lsb_per_degree * lsb_per_degree + 1.0 / 12.0;
}

std::vector<double> truth_lsb(const Case &what)
{
    std::vector<double> truth;
    for (int k = 0; k <= static_cast<int>(after_s) * what.rate_hz; k++) {
        truth.push_back((what.turn == nullptr) ? 0.0 : lsb_per_degree * profile(what.turn).truth_deg(k));
    }
    return truth;
}

// R in force at the end of one run, by 1.5 times the variance.
double identified_ratio(const Case &what, const std::vector<double> &truth, std::uint64_t seed)
{
    test_random_t random;
    random_seed(&random, seed);
    noise_t n;
    filter_noise_init(&n, static_cast<std::uint16_t>(10 * what.rate_hz), false);
    for (const double lsb : truth) {
        const double noise = std::sqrt(r_deg2) * random_normal(&random);
        const double off = random_uniform(&random) < what.bad ? 20.0 : 0.0;
        (void)filter_noise_update(&n, as_sample(lsb + (noise + off) * lsb_per_degree));
    }
    return filter_noise_r_lsb2_q8(&n) / (256.0 * 1.5 * variance_lsb2());
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

void case_rows(const Case &what, const Options &options)
{
    const std::vector<double> truth = truth_lsb(what);
    std::vector<double> ratios;
    for (int run = 0; run < runs_of(options); run++) {
        ratios.push_back(identified_ratio(what, truth, run_seed(options.seed, static_cast<std::uint64_t>(run))));
    }
    double sd = 0.0;
    const Interval mean = mean_of(ratios, sd);
    const reference_noise_t of = { truth.data(), static_cast<int>(truth.size()),
                                   static_cast<std::uint16_t>(10 * what.rate_hz), variance_lsb2(), what.bad };
    const reference_noise_estimate_t e = reference_noise_estimate(&of);
    // R in force is anywhere within an eighth of the estimate: by 1 / 192 above it on average, of a variance of 1 / 192
    const double expected = e.estimate * (1.0 + 1.0 / 192.0);
    // terms of a relative deviation of 1.2, correlated with their neighbours: a sample serves in six
    const double most = std::sqrt(6.0 * 1.2 * 1.2 * e.weight / (2.0 * (1.0 - e.again)) + 1.0 / 192.0);
    const std::string experiment = std::string("noise_") + what.name;
    row(experiment, "noise(x)", Arithmetic::fixed, "exact_r_by_true", expected, 1);
    row(experiment, "noise(x)", Arithmetic::fixed, "exact_r_one_run_sd", most, 1);
    row(experiment, "noise(x)", Arithmetic::fixed, "r_by_true", mean, runs_of(options));
    row(experiment, "noise(x)", Arithmetic::fixed, "r_one_run_sd", relative_deviation(ratios, mean, sd),
        runs_of(options));
}
} // namespace

void noise(const Options &options)
{
    Progress progress(static_cast<double>(cases.size()));
    for (const Case &what : cases) {
        case_rows(what, options);
        progress.advance();
    }
}
} // namespace papers::roll
