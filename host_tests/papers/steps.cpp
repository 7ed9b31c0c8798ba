// How filters come back: after steps, after bursts, and whether they ever do not.
#include "experiments.hpp"
#include "model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace papers
{
namespace
{
constexpr double never = std::numeric_limits<double>::infinity();
constexpr int in_a_row = 10;

// Settles for a random number of samples, so that a step meets the filter in any phase.
int settling(std::uint64_t seed)
{
    test_random_t random;
    random_seed(&random, seed ^ 0x5555555555555555U);
    return 100 + static_cast<int>(random_below(&random, 100));
}

// Samples from `from` on until the first of ten in a row with an error below back_deg; infinite when not within limit.
double samples_to_return(const Contestant &c, Realisation &realisation, int from, int limit, double back_deg)
{
    c.filter->restart();
    for (int k = 0; k < from; k++) {
        (void)c.filter->step(realisation.at(k).y);
    }
    int good = 0;
    for (int k = from; k < from + limit + in_a_row; k++) {
        const Sample &s = realisation.at(k);
        good = (std::abs(c.filter->step(s.y) - s.truth) < back_deg) ? good + 1 : 0;
        if (good == in_a_row) {
            return k - from - in_a_row + 1; // 0: at once
        }
    }
    return never;
}

void step_rows(const std::string &experiment, double low_sigma, double high_sigma, double outliers,
               const std::vector<Contestant> &all, const Options &options)
{
    constexpr int limit = 600;
    std::vector<std::vector<double>> found(all.size());
    for (int run = 0; run < options.runs; run++) {
        const std::uint64_t seed = run_seed(options.seed + 2, static_cast<std::uint64_t>(run));
        test_random_t random;
        random_seed(&random, ~seed);
        Scenario scenario;
        scenario.outliers = outliers;
        scenario.first_clean = true;
        scenario.step_at = settling(seed);
        scenario.step_sigma = low_sigma + (high_sigma - low_sigma) * random_uniform(&random);
        scenario.step_sigma *= (random_u32(&random) & 1U) != 0U ? 1.0 : -1.0;
        Realisation realisation(scenario, seed);
        for (std::size_t i = 0; i < all.size(); i++) {
            const double back_deg = 4.0 * steady_sigma_deg(plain_name);
            found[i].push_back(samples_to_return(all[i], realisation, scenario.step_at, limit, back_deg));
        }
    }
    for (std::size_t i = 0; i < all.size(); i++) {
        double lost = 0.0;
        for (const double n : found[i]) {
            lost += std::isinf(n);
        }
        row(experiment, all[i], "reacq_median", quantile(found[i], 0.5), options.runs);
        row(experiment, all[i], "reacq_p95", quantile(found[i], 0.95), options.runs);
        row(experiment, all[i], "not_back_in_600", share(lost, options.runs), options.runs);
    }
}

void steps(const std::string &name, double outliers, const Options &options)
{
    const std::array<double, 6> sizes = { 1.0, 5.0, 10.0, 20.0, 50.0, 100.0 };
    const std::vector<Contestant> all = contestants(library_names(), { Start::median });
    for (const double size : sizes) {
        char experiment[40];
        std::snprintf(experiment, sizeof experiment, "%s_%g_sigma", name.c_str(), size);
        step_rows(experiment, size, size, outliers, all, options);
    }
    step_rows(name + "_1..5_sigma", 1.0, 5.0, outliers, all, options);
    step_rows(name + "_5..100_sigma", 5.0, 100.0, outliers, all, options);
}

// Peak of the error from the burst's first sample on, and samples from its end until back.
struct Burst {
    double peak = 0.0;
    double back = never;
};

Burst through_burst(const Contestant &c, Realisation &realisation, int from, int length, double sigma_ss)
{
    Burst result;
    int good = 0;
    c.filter->restart();
    for (int k = 0; k < from + length + 600; k++) {
        const Sample &s = realisation.at(k);
        const double error = std::abs(c.filter->step(s.y) - s.truth) / sigma_ss;
        if (k < from) {
            continue;
        }
        result.peak = std::max(result.peak, error);
        good = (k >= from + length && error < 4.0) ? good + 1 : 0;
        if (good == in_a_row) {
            result.back = k - from - length - in_a_row + 1;
            break;
        }
    }
    return result;
}

void burst_rows(int length, const std::vector<Contestant> &all, const Options &options)
{
    const double sigma_ss = steady_sigma_deg(plain_name);
    std::vector<std::vector<double>> peak(all.size());
    std::vector<std::vector<double>> back(all.size());
    for (int run = 0; run < options.runs; run++) {
        const std::uint64_t seed = run_seed(options.seed + 3, static_cast<std::uint64_t>(run));
        Scenario scenario;
        scenario.outliers = 0.0;
        scenario.burst_at = settling(seed);
        scenario.burst_length = length;
        Realisation realisation(scenario, seed);
        for (std::size_t i = 0; i < all.size(); i++) {
            const Burst burst = through_burst(all[i], realisation, scenario.burst_at, length, sigma_ss);
            peak[i].push_back(burst.peak);
            back[i].push_back(burst.back);
        }
    }
    const std::string experiment = "burst_" + std::to_string(length);
    for (std::size_t i = 0; i < all.size(); i++) {
        row(experiment, all[i], "peak_error_sigma_median", quantile(peak[i], 0.5), options.runs);
        row(experiment, all[i], "peak_error_sigma_p95", quantile(peak[i], 0.95), options.runs);
        row(experiment, all[i], "recovery_p95", quantile(back[i], 0.95), options.runs);
    }
}

// A step of 1..100 sigma in a random phase under 0..30 % outliers; the same trials for every filter.
Scenario lockout_trial(std::uint64_t seed)
{
    test_random_t random;
    random_seed(&random, ~seed);
    Scenario scenario;
    scenario.outliers = 0.3 * random_uniform(&random);
    scenario.step_at = settling(seed);
    scenario.step_sigma = 1.0 + 99.0 * random_uniform(&random);
    scenario.step_sigma *= (random_u32(&random) & 1U) != 0U ? 1.0 : -1.0;
    return scenario;
}

// Those that are in FILTER_LIST and refuse samples, or take them for what they are.
std::vector<std::string> may_lock_out()
{
    std::vector<std::string> result = fixed_names();
    result.erase(std::remove(result.begin(), result.end(), plain_name), result.end());
    return result;
}
} // namespace

void steps_clean(const Options &options)
{
    steps("step_clean", 0.0, options);
}

void steps_with_outliers(const Options &options)
{
    steps("step_15_percent", 0.15, options);
}

void bursts(const Options &options)
{
    const std::vector<Contestant> all = contestants(library_names(), { Start::median });
    burst_rows(10, all, options);
    burst_rows(30, all, options);
}

void lockout(const Options &options)
{
    const int trials = 10 * options.runs;
    const std::vector<Contestant> all = contestants(may_lock_out(), { Start::shipped });
    std::vector<double> lost(all.size());
    std::vector<std::vector<double>> found(all.size());
    for (int trial = 0; trial < trials; trial++) {
        const std::uint64_t seed = run_seed(options.seed + 4, static_cast<std::uint64_t>(trial));
        const Scenario scenario = lockout_trial(seed);
        Realisation realisation(scenario, seed);
        for (std::size_t i = 0; i < all.size(); i++) {
            const double n = samples_to_return(all[i], realisation, scenario.step_at, return_limit(all[i].name),
                                               4.0 * steady_sigma_deg(all[i].name));
            lost[i] += std::isinf(n);
            found[i].push_back(n);
        }
    }
    for (std::size_t i = 0; i < all.size(); i++) {
        row("lockout", all[i], "limit_samples", return_limit(all[i].name), trials);
        row("lockout", all[i], "not_back", lost[i], trials);
        row("lockout", all[i], "samples_p999", quantile(found[i], 0.999), trials);
        row("lockout", all[i], "samples_worst", quantile(found[i], 1.0), trials);
    }
}
} // namespace papers
