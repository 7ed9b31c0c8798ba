#include "statistics.hpp"
#include "model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace papers
{
namespace
{
constexpr int resamplings = 1000;
}

double quantile(std::vector<double> values, double q)
{
    std::sort(values.begin(), values.end());
    const double at = q * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    const double part = at - static_cast<double>(below);
    if (part == 0.0 || values[below] == values[above]) {
        return values[below]; // infinities do not mix
    }
    return values[below] + part * (values[above] - values[below]);
}

double total(const std::vector<double> &values)
{
    return std::accumulate(values.begin(), values.end(), 0.0);
}

std::vector<Interval> bootstrap_ratios(const std::vector<const std::vector<double> *> &numerators,
                                       const std::vector<const std::vector<double> *> &denominators, std::uint64_t seed)
{
    const std::size_t n = numerators.front()->size();
    std::vector<std::vector<double>> ratios(numerators.size());
    std::vector<std::uint32_t> drawn(n);
    test_random_t random;
    random_seed(&random, run_seed(seed, 0));
    for (int b = 0; b < resamplings; b++) {
        std::generate(drawn.begin(), drawn.end(), [&] { return random_below(&random, static_cast<std::uint32_t>(n)); });
        for (std::size_t i = 0; i < numerators.size(); i++) {
            double a = 0.0;
            double d = 0.0;
            for (const std::uint32_t run : drawn) {
                a += (*numerators[i])[run];
                d += (*denominators[i])[run];
            }
            ratios[i].push_back(a / d);
        }
    }
    std::vector<Interval> result;
    for (std::size_t i = 0; i < numerators.size(); i++) {
        result.push_back({ total(*numerators[i]) / total(*denominators[i]), quantile(ratios[i], 0.025),
                           quantile(ratios[i], 0.975) });
    }
    return result;
}
} // namespace papers

extern "C" {
// Of each column the sum of the one by the sum of the other, and the percentiles of resampled runs: columns x 3.
void contest_ratios(int columns, int runs, const double *above, const double *below, std::uint64_t seed, double *ratios)
{
    std::vector<std::vector<double>> over;
    std::vector<std::vector<double>> under;
    for (int i = 0; i < columns; i++) {
        over.emplace_back(above + i * runs, above + (i + 1) * runs);
        under.emplace_back(below + i * runs, below + (i + 1) * runs);
    }
    std::vector<const std::vector<double> *> numerators;
    std::vector<const std::vector<double> *> denominators;
    for (std::size_t i = 0; i < over.size(); i++) {
        numerators.push_back(&over[i]);
        denominators.push_back(&under[i]);
    }
    for (const papers::Interval &ratio : papers::bootstrap_ratios(numerators, denominators, seed)) {
        *ratios++ = ratio.value;
        *ratios++ = ratio.low;
        *ratios++ = ratio.high;
    }
}
}
