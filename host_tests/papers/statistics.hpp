// Quantiles and 95 % confidence intervals.
#ifndef PAPERS_STATISTICS_H
#define PAPERS_STATISTICS_H

#include <cstdint>
#include <vector>

namespace papers
{
struct Interval {
    double value;
    double low;
    double high;
};

// The q-th quantile (linear between order statistics); infinite members sort last. Not of nothing.
double quantile(std::vector<double> values, double q);

double total(const std::vector<double> &values);

// Sum of a over sum of b with the percentiles of 1,000 resamplings of the runs (the same for a and b): for several b at
// once.
std::vector<Interval> bootstrap_ratios(const std::vector<const std::vector<double> *> &numerators,
                                       const std::vector<const std::vector<double> *> &denominators,
                                       std::uint64_t seed);
} // namespace papers

#endif
