// Steady twins in double of the shipped filters that are linear: from their stored parameters and their model's Riccati
// equation, not from the fixed-point code. What fixed point passes of the noise is held to them.
#ifndef PAPERS_TWINS_H
#define PAPERS_TWINS_H

#include "estimators.hpp"

#include <optional>
#include <string>

namespace papers
{
// None for a filter whose gain depends on its data. Begins with the first sample, not by the median of five.
std::optional<Maker> linear_twin(const std::string &name, const Shipping &shipping);

// A parameter as a shipped filter has it: given, or its default at this rate. Throws std::runtime_error for unknown
// names.
double parameter_of(const std::string &name, const std::string &parameter, const Shipping &shipping);

// Variance of what a shipped filter is given when the measurement's is r: rounding to counts adds 1 / 12 of a count
// squared.
double rounded_variance(double r, const Shipping &shipping);
} // namespace papers

#endif
