#include "filters.hpp"
#include "experiments.hpp"
#include "model.hpp"
#include "reference/robust.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace papers
{
namespace
{
struct Entry {
    const char *name;
    const char *reference; // reference/robust.h
    robust_reading_t reading;
    double gate_sigma;
    int reacquire;
    // of those that are the library's too: samples after a step within which each trial is to be back; 0: not of them
    int returns_within;
    // Table 2: multiplications and additions; 0: not in it
    double products, sums;
};

const Entry entries[] = {
    { "kf", "kf", ROBUST_CORRECTED, 3.0, 0, 1200, 0, 0 },
    { "lrf", "lrf", ROBUST_CORRECTED, 3.0, 0, 800, 47, 38 },
    { "sprf_paper", "sprf", ROBUST_CORRECTED, 2.0, 0, 1200, 53, 36 },
    { "sprf_paper_3sigma", "sprf", ROBUST_CORRECTED, 3.0, 0, 1200, 0, 0 },
    { "sprf", "sprf", ROBUST_CORRECTED, 3.0, 5, 200, 0, 0 },
    { "soft", "soft", ROBUST_CORRECTED, 3.0, 5, 200, 0, 0 },
    { "shrf", "shrf", ROBUST_CORRECTED, 3.0, 0, 1200, 49, 37 },
    { "pbf", "pbf", ROBUST_CORRECTED, 3.0, 0, 800, 84, 41 },
    { "af", "af", ROBUST_CORRECTED, 3.0, 0, 800, 0, 0 },
    { "af_grid", "af_grid", ROBUST_CORRECTED, 3.0, 0, 0, 584, 292 },
    { "clairvoyant", "clairvoyant", ROBUST_CORRECTED, 3.0, 0, 0, 0, 0 },
    { "af_grid_eq15", "af_grid", ROBUST_PRINTED_15, 3.0, 0, 0, 0, 0 },
    { "af_grid_i_by_50", "af_grid", ROBUST_PRINTED_GRID, 3.0, 0, 0, 0, 0 },
    { "pbf_eq21", "pbf", ROBUST_PRINTED_21, 3.0, 0, 0, 0, 0 },
    { "shrf_eq24", "shrf", ROBUST_PRINTED_24, 3.0, 0, 0, 0, 0 },
    { "shrf_eq25", "shrf", ROBUST_PRINTED_25, 3.0, 0, 0, 0, 0 },
    { "pbf_eq26", "pbf", ROBUST_PRINTED_26, 3.0, 0, 0, 0, 0 },
    { "shrf_eq29_cut", "shrf", ROBUST_PRINTED_27, 3.0, 0, 0, 0, 0 },
    { "shrf_eq30", "shrf", ROBUST_PRINTED_30, 3.0, 0, 0, 0, 0 },
    { "sprf_eq33", "sprf", ROBUST_PRINTED_33, 2.0, 0, 0, 0, 0 },
    { "sprf_eq34", "sprf", ROBUST_PRINTED_34, 2.0, 0, 0, 0, 0 },
    { "lrf_eq39", "lrf", ROBUST_PRINTED_39, 3.0, 0, 0, 0, 0 },
};

// The library's rules, in degrees: rate at most 3 degree/s, runs agree within 3 sqrt(2 R) + what that rate moves
constexpr double rate_max_deg_s = 3.0;
constexpr double shipped_rate_variance = 4.0 * 4.0;

// The library has it on the core of kalman.h, not on that of wide.h.
bool kalman_core(const Entry &entry)
{
    const std::string reference = entry.reference;
    return reference == "kf" || reference == "lrf" || entry.reacquire != 0;
}

class DoubleFilter final : public Filter
{
  public:
    DoubleFilter(const Entry &entry, const Settings &settings)
    {
        (void)robust_reference_table1(&initial_, entry.reference);
        initial_.reading = entry.reading;
        initial_.r *= settings.r_factor;
        initial_.gate_sigma = (settings.gate_sigma > 0.0) ? settings.gate_sigma : entry.gate_sigma;
        initial_.reacquire = entry.reacquire;
        if (entry.reacquire != 0) {
            initial_.rate_max = rate_max_deg_s;
            initial_.agree = 3.0 * std::sqrt(2.0 * initial_.r) + rate_max_deg_s * period_s;
            initial_.doubts = true;
        }
        const bool as_published = entry.reference == gated_name && entry.reacquire == 0;
        initial_.median_window = (settings.start != Start::table1 && !as_published) ? 5 : 0;
        if (settings.start == Start::shipped) { // the library limits it, as kalman.h and wide.h say
            const double limit_r = kalman_core(entry) ? 14.0 : 1.0;
            initial_.p22_start = std::min(shipped_rate_variance, limit_r * initial_.r / (period_s * period_s));
        }
        const char *refused = robust_reference_refused(&initial_);
        if (refused != nullptr) {
            throw std::runtime_error(std::string(entry.name) + ": " + refused + " is outside its legal range");
        }
        f_ = initial_;
    }
    void restart() override
    {
        f_ = initial_;
    }
    double step(double y_deg) override
    {
        return robust_reference_step(&f_, y_deg);
    }
    bool refused() const override
    {
        return f_.gated;
    }
    double gain() const override
    {
        return f_.gain[0];
    }
    void tell(bool outlier) override
    {
        f_.outlier = outlier;
    }

  private:
    robust_reference_t initial_{};
    robust_reference_t f_{};
};

std::vector<std::string> names(bool printed)
{
    std::vector<std::string> result;
    for (const Entry &entry : entries) {
        if ((entry.reading != ROBUST_CORRECTED) == printed) {
            result.emplace_back(entry.name);
        }
    }
    return result;
}

const Entry &entry_of(const std::string &name)
{
    const Entry *found = std::find_if(std::begin(entries), std::end(entries),
                                      [&](const Entry &entry) { return name == entry.name; });
    if (found == std::end(entries)) {
        throw std::runtime_error(name + ": no filter of paper 002");
    }
    return *found;
}

double steady_sigma_of(const std::string &name)
{
    robust_reference_t f;
    (void)robust_reference_table1(&f, name.c_str());
    double p[4];
    double gain[2];
    robust_reference_steady(&f, p, gain);
    return std::sqrt(p[0]);
}
} // namespace

std::unique_ptr<Filter> detail::make_double(const std::string &name, const Settings &settings)
{
    for (const Entry &entry : entries) {
        if (name == entry.name) {
            return std::make_unique<DoubleFilter>(entry, settings);
        }
    }
    throw std::runtime_error(name + ": no such reference in host_tests/papers/filters.cpp");
}

void row(const std::string &experiment, const Contestant &c, const std::string &metric, double value, int runs)
{
    row(experiment, c.name, c.arithmetic, metric, value, runs);
}

void row(const std::string &experiment, const Contestant &c, const std::string &metric, const Interval &value, int runs)
{
    row(experiment, c.name, c.arithmetic, metric, value, runs);
}

Contestant contestant(const std::string &name, Arithmetic arithmetic, const Settings &settings)
{
    return { name, arithmetic,
             arithmetic == Arithmetic::fixed ? detail::make_fixed(name, settings)
                                             : detail::make_double(name, settings) };
}

std::vector<std::string> reference_names()
{
    return names(false);
}

std::vector<std::string> printed_names()
{
    return names(true);
}

std::vector<Contestant> contestants(const std::vector<std::string> &chosen, const Settings &settings)
{
    std::vector<Contestant> result;
    const std::vector<std::string> fixed = fixed_names();
    for (const std::string &name : chosen) {
        result.push_back(contestant(name, Arithmetic::in_double, settings));
        if (std::find(fixed.begin(), fixed.end(), name) != fixed.end()) {
            result.push_back(contestant(name, Arithmetic::fixed, settings));
        }
    }
    return result;
}

std::vector<std::string> library_names()
{
    std::vector<std::string> result;
    for (const Entry &entry : entries) {
        if (entry.returns_within != 0) {
            result.emplace_back(entry.name);
        }
    }
    return result;
}

int return_limit(const std::string &name)
{
    return entry_of(name).returns_within;
}

std::vector<PrintedCost> printed_costs()
{
    std::vector<PrintedCost> result;
    for (const Entry &entry : entries) {
        if (entry.products != 0.0) {
            result.push_back({ entry.name, entry.products, entry.sums });
        }
    }
    return result;
}

const std::string plain_name = "kf";
const std::string linear_name = "lrf";
const std::string published_name = "sprf_paper";
const std::string gated_name = "sprf";
const std::string merged_name = "pbf";

double steady_sigma_deg(const std::string &name)
{
    static const double of_plain = steady_sigma_of(plain_name);
    static const double of_linear = steady_sigma_of(linear_name);
    return (name.compare(0, linear_name.size(), linear_name) == 0) ? of_linear : of_plain;
}
} // namespace papers
