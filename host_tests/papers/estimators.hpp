// Filters of one measured number as plain callables: what papers 000 and 001 compare. Each experiment takes any.
#ifndef PAPERS_ESTIMATORS_H
#define PAPERS_ESTIMATORS_H

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace papers
{
// One measurement in, one estimate out, both in the experiment's unit (degrees, metres).
using Estimator = std::function<double(double z)>;

// Gives an estimator as it is before its first sample.
using Maker = std::function<Estimator()>;

// The synthesised filter (7) with constant gains, its past estimates equal to x0, or to the first sample.
Maker synthesised(double a1, double b0, std::optional<double> x0 = {});

// How a shipped filter is fed and set.
struct Shipping {
    double rate_hz = 10.0;
    double lsb_per_unit = 16.0;  // counts per degree or metre: what rounding costs is 1 / 12 of a count squared
    double zero = 0.0;           // the measurement that is count 0
    double r = 0.6;              // variance of the measurement in units squared, for the filter's r
    bool reset_at_first = false; // begun by F_reset with the first sample, not by the median of five
    std::map<std::string, double> parameters = {}; // further ones by the descriptor's names and units (LSB)
};

// A filter of FILTER_LIST by name. Throws std::runtime_error with one sentence for what the list or the filter refuses.
Maker shipped(const std::string &name, const Shipping &shipping);

// Names of FILTER_LIST, in its order.
std::vector<std::string> shipped_names();
bool is_shipped(const std::string &name);

// Largest variance that the shipped filters take, in LSB squared: more is told to them as this.
double largest_r_lsb2();
} // namespace papers

#endif
