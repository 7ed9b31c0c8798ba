// Every filter of paper 002 behind one interface: the double references and the shipped fixed-point code. Angles in
// degrees.
#ifndef PAPERS_FILTERS_H
#define PAPERS_FILTERS_H

#include "report.hpp"

#include <memory>
#include <string>
#include <vector>

namespace papers
{
enum class Start {
    table1, // estimate and P of Table 1 (the narrow fixed-point format: P11 limited to 8 R)
    median, // running median of five samples, the rate as uncertain as in Table 1; as published: Table 1
    shipped // the same as on the chip at 40.5 Hz, where the rate is thought uncertain by 200 LSB/s = 4 degree/s
};

struct Settings {
    Start start = Start::table1;
    double r_factor = 1.0;   // the filter's R by the true one
    double gate_sigma = 0.0; // 0: the filter's own
};

class Filter
{
  public:
    virtual ~Filter() = default;
    // As before the first sample.
    virtual void restart() = 0;
    // One sample; the estimate.
    virtual double step(double y_deg) = 0;
    // The last sample was refused by the gate.
    virtual bool refused() const = 0;
    // Gain of the last step.
    virtual double gain() const = 0;
    // For the clairvoyant, before the step.
    virtual void tell(bool /*outlier*/) {}
};

struct Contestant {
    std::string name;
    Arithmetic arithmetic;
    std::unique_ptr<Filter> filter;
};

// Throws std::runtime_error with one sentence when the name is unknown or the settings are refused.
Contestant contestant(const std::string &name, Arithmetic arithmetic, const Settings &settings);

// Names of the references with the errata applied, and of the readings that the errata refute.
std::vector<std::string> reference_names();
std::vector<std::string> printed_names();

// Names of the filters of FILTER_LIST that are paper 002's.
std::vector<std::string> fixed_names();

// Names of the references that are the library's filters, the published one with the gate of ours as well.
std::vector<std::string> library_names();

// Samples after a step within which each trial of such a filter is to be back.
int return_limit(const std::string &name);

// Table 2.
struct PrintedCost {
    std::string name;
    double products;
    double sums;
};
std::vector<PrintedCost> printed_costs();

// Kalman's filter, which is the standard; with one R for both kinds of samples; with a gate as published; and with
// ours.
extern const std::string plain_name, linear_name, published_name, gated_name;
// The one that the paper compares the simpler ones with.
extern const std::string merged_name;

// The named filters in both arithmetics, the fixed ones as far as they are in FILTER_LIST.
std::vector<Contestant> contestants(const std::vector<std::string> &names, const Settings &settings);

// Standard deviation of the filter's error in the steady state by its own P: "back" means within four of them.
double steady_sigma_deg(const std::string &name);

namespace detail
{
std::unique_ptr<Filter> make_double(const std::string &name, const Settings &settings);
std::unique_ptr<Filter> make_fixed(const std::string &name, const Settings &settings);
} // namespace detail
} // namespace papers

#endif
