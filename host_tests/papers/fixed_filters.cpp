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
#include "filter_any.h"
#include "support_filters.h"
#include "two_state_wide.h"
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
        return filter == "af" ? 0.5 : clean; // af learns it: (15) begins with all values alike
    }
    if (parameter == "ratio") {
        return ratio;
    }
    return parameter == "gate" ? settings.gate_sigma : 0.0;
}

filter_any_t initialised(filter_kind_t kind, const std::string &name, const Settings &settings)
{
    const double speed = (settings.start == Start::shipped) ? 1.0 : hurry;
    const auto rate_dhz = static_cast<std::uint16_t>(std::lround(speed * 10.0 / period_s));
    filter_any_config_t config;
    filter_any_defaults(kind, &config, rate_dhz);
    for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
        const filter_parameter_t parameter = parameter_at(kind, i);
        const double value = table1_value(name, parameter.name, 10.0 / rate_dhz, settings);
        if (value != 0.0) {
            parameter_set(&config, &parameter,
                          static_cast<std::uint32_t>(std::lround(std::ldexp(value, parameter.fraction_bits))));
        }
    }
    filter_any_t f;
    if (!filter_any_init(&f, kind, &config)) {
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

void begin(two_state_t &core, double p11, double p22)
{
    two_state_begin(&core, static_cast<std::int32_t>(fixed(x0_lsb, 16)),
                    static_cast<std::int32_t>(fixed(rate0_lsb, 16)), fixed(p11, 28), 0, fixed(p22, 28));
}

void begin(two_state_wide_t &core, double p11, double p22)
{
    two_state_wide_begin(&core, static_cast<std::int32_t>(fixed(x0_lsb, 16)),
                         static_cast<std::int32_t>(fixed(rate0_lsb, 16)), fixed(p11, 16), 0, fixed(p22, 28));
}

// A state with a core that can be begun; one without is another paper's. A core holds P in units of its R (lrf: R_L).
template <class State> auto begin_state(State &state, int) -> decltype(begin(state.core, 0.0, 0.0))
{
    const double r_core_deg2 = state.core.r_lsb2_q8 / 256.0 * lsb_deg * lsb_deg;
    begin(state.core, 0.7 / r_core_deg2, 0.04 * period_s * period_s / r_core_deg2);
}

template <class State> void begin_state(State &, long)
{
    throw std::runtime_error("a filter without a core cannot start from Table 1");
}

void begin_table1(filter_any_t &f)
{
    switch (f.kind) {
#define BEGIN(F)                        \
    case FILTER_KIND_##F:               \
        begin_state(f.state.of_##F, 0); \
        break;
        FILTER_LIST(BEGIN)
#undef BEGIN
    default:
        break;
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
        return filter_any_update(&f_, as_sample(y_deg / lsb_deg)) * (lsb_deg / 65536.0);
    }
    bool refused() const override
    {
        return (filter_any_flags(&f_) & FILTER_GATED) != 0;
    }
    double gain() const override
    {
        filter_probe_t probe;
        filter_any_probe(&f_, &probe);
        return probe.gain_uq16 / 65536.0;
    }

  private:
    filter_any_t initial_;
    filter_any_t f_;
};
} // namespace

std::unique_ptr<Filter> detail::make_fixed(const std::string &name, const Settings &settings)
{
    const filter_kind_t kind = filter_any_find(name.c_str());
    if (kind == FILTER_KIND_COUNT) {
        throw std::runtime_error(name + ": not in FILTER_LIST");
    }
    return std::make_unique<FixedFilter>(kind, name, settings);
}

std::vector<std::string> fixed_names()
{
    std::vector<std::string> result;
    for (std::uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        const std::string name = filter_any_name(static_cast<filter_kind_t>(kind));
        if (of_paper_002(name)) {
            result.push_back(name);
        }
    }
    return result;
}
} // namespace papers
