// The shipped fixed-point filters: whatever FILTER_LIST holds, with parameters set by their names in the descriptors.
//
// A filter knows time as samples only: q22 = q T^3 / R and P22(0) = (200 LSB/s)^2 T^2 / R. In counts of 0.02 degree
// Table 1 has R = 16 LSB^2, q22 = 0.0009 T^2 / 0.0064 = 8.579e-5 and a rate known to 0.2 degree/s = 10 LSB/s: a
// twentieth of the library's 200 LSB/s. So time is told in units of a twentieth of a second: T = 1 / 809.7 s, q = 20^3
// x 91.09 LSB^2/s^3. Only Start::shipped tells it in seconds, 40.5 Hz and q = 91, as a user would.
#include "filters.hpp"
#include "model.hpp"
#include "scope.hpp"

extern "C" {
#include "filter_list.h"
#include "support/laws.h"
}

#include <cmath>
#include <stdexcept>

namespace papers
{
namespace
{
constexpr double hurry = 20.0;
constexpr double rate_max_deg_s = 3.0;

double table1_value(const std::string &filter, const std::string &parameter, double t_s, const Settings &settings)
{
    const double r_lsb2 = r_deg2 / (lsb_deg * lsb_deg) * settings.r_factor;
    if (parameter == "r") {
        return r_lsb2;
    }
    if (parameter == "q") {
        return q_rate / (lsb_deg * lsb_deg) * period_s * period_s / (t_s * t_s * t_s);
    }
    if (parameter == "ratemax") {
        return rate_max_deg_s / lsb_deg * period_s / t_s;
    }
    if (parameter == "clean") {
        return law_facts(filter_find(filter.c_str())).learns ? 0.5 : clean; // (15) begins with all values alike
    }
    if (parameter == "ratio") {
        return ratio;
    }
    return parameter == "gate" ? settings.gate_sigma : 0.0;
}

filter_t initialised(filter_kind_t kind, const std::string &name, const Settings &settings)
{
    const double speed = (settings.start == Start::shipped) ? 1.0 : hurry;
    const auto rate_dhz = static_cast<std::uint16_t>(std::lround(speed * 10.0 / period_s));
    filter_config_t config = filter_defaults(filter_listed(kind), rate_dhz);
    for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
        const filter_parameter_t parameter = parameter_at(kind, i);
        const double value = table1_value(name, parameter.words, 10.0 / rate_dhz, settings);
        if (value != 0.0) {
            config.value[i] = static_cast<std::int32_t>(std::lround(std::ldexp(value, parameter.fraction_bits)));
        }
    }
    filter_t f;
    if (filter_init(&f, filter_listed(kind), &config) != FILTER_ACCEPTED) {
        throw std::runtime_error(name + ": refuses the parameters of Table 1");
    }
    return f;
}

// Table 1's P in units of R, with T = 1 sample
constexpr double x0_lsb = 2.8 / lsb_deg;
constexpr double rate0_lsb = 0.008 * period_s / lsb_deg;

std::uint32_t fixed(double value, int fraction_bits)
{
    return static_cast<std::uint32_t>(
        std::lround(std::ldexp(std::fmin(value, std::ldexp(1.0, 31 - fraction_bits)), fraction_bits)));
}

// A law holds P in units of its R (lrf: R_L).
void begin_table1(filter_t &f)
{
    const auto x_q16 = static_cast<std::int32_t>(fixed(x0_lsb, 16));
    const auto rate_q16 = static_cast<std::int32_t>(fixed(rate0_lsb, 16));
    const auto per_r = [](double variance_deg2, std::uint32_t r_lsb2_q8) {
        return variance_deg2 / (r_lsb2_q8 / 256.0 * lsb_deg * lsb_deg);
    };
    constexpr double p11_deg2 = 0.7;
    constexpr double p22_deg2 = 0.04 * period_s * period_s;
    if (f.law->start == filter_kalman_start) {
        const std::uint32_t r = f.own.kalman.r_lsb2_q8;
        kalman_from(&f, x_q16, rate_q16, { fixed(per_r(p11_deg2, r), 28), 0, fixed(per_r(p22_deg2, r), 28) });
    } else if (f.law->report == filter_wide_report) {
        const std::uint32_t r = f.own.wide.r_lsb2_q8;
        wide_from(&f, x_q16, rate_q16, { fixed(per_r(p11_deg2, r), 16), 0, fixed(per_r(p22_deg2, r), 28) });
    } else {
        throw std::runtime_error("a filter without a covariance of position and rate cannot start from Table 1");
    }
}

class FixedFilter final : public Filter
{
  public:
    FixedFilter(filter_kind_t kind, const std::string &name, const Settings &settings)
        : initial_(initialised(kind, name, settings))
    {
        if (settings.start == Start::table1) {
            begin_table1(initial_);
        }
        f_ = initial_;
    }
    void restart() override
    {
        f_ = initial_;
    }
    double step(double y_deg) override
    {
        return filter_update(&f_, as_sample(y_deg / lsb_deg)) * (lsb_deg / 65536.0);
    }
    bool refused() const override
    {
        return (f_.flags & FILTER_GATED) != 0;
    }
    double gain() const override
    {
        filter_probe_t probe;
        filter_probe(&f_, &probe);
        return probe.gain_uq16 / 65536.0;
    }

  private:
    filter_t initial_;
    filter_t f_;
};
} // namespace

std::unique_ptr<Filter> detail::make_fixed(const std::string &name, const Settings &settings)
{
    const filter_kind_t kind = filter_find(name.c_str());
    if (kind == FILTER_KIND_COUNT) {
        throw std::runtime_error(name + ": not in FILTER_LIST");
    }
    return std::make_unique<FixedFilter>(kind, name, settings);
}

std::vector<std::string> fixed_names()
{
    std::vector<std::string> result;
    for (std::uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const std::string name = filter_listed_name(static_cast<filter_kind_t>(kind));
        if (of_paper_002(name)) {
            result.push_back(name);
        }
    }
    return result;
}
} // namespace papers
