#include "estimators.hpp"

extern "C" {
#include "filter_list.h"
#include "support/filters.h"
}

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace papers
{
namespace
{
filter_t initialised(const std::string &name, const Shipping &shipping)
{
    const filter_kind_t kind = filter_find(name.c_str());
    if (kind == FILTER_KIND_COUNT) {
        throw std::runtime_error(name + ": not in FILTER_LIST");
    }
    std::map<std::string, double> wanted = shipping.parameters;
    wanted.emplace("r", std::min(shipping.r * shipping.lsb_per_unit * shipping.lsb_per_unit, largest_r_lsb2()));
    filter_config_t config = filter_defaults(filter_listed(kind),
                                             static_cast<std::uint16_t>(std::lround(10.0 * shipping.rate_hz)));
    for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
        const filter_parameter_t parameter = parameter_at(kind, i);
        const auto found = wanted.find(parameter.words);
        if (found != wanted.end()) {
            config.value[i] = static_cast<std::int32_t>(
                std::llround(std::ldexp(found->second, parameter.fraction_bits)));
            wanted.erase(found);
        }
    }
    wanted.erase("r"); // a filter without one does not ask
    if (!wanted.empty()) {
        throw std::runtime_error(name + ": has no parameter " + wanted.begin()->first);
    }
    filter_t f;
    if (filter_init(&f, filter_listed(kind), &config) != FILTER_ACCEPTED) {
        throw std::runtime_error(name + ": refuses these parameters");
    }
    filter_set_noise(
        &f, static_cast<std::uint32_t>(std::lround(
                256.0 * std::min(shipping.r * shipping.lsb_per_unit * shipping.lsb_per_unit, largest_r_lsb2()))));
    return f;
}

class Shipped
{
  public:
    Shipped(const filter_t &begun, const Shipping &shipping)
        : f_(begun), counts_(shipping.lsb_per_unit), zero_(shipping.zero), reset_(shipping.reset_at_first)
    {
    }
    double operator()(double z)
    {
        const std::int16_t z_lsb = as_sample((z - zero_) * counts_);
        if (reset_) {
            filter_reset(&f_, z_lsb);
            reset_ = false;
        }
        return filter_update(&f_, z_lsb) / (65536.0 * counts_) + zero_;
    }

  private:
    filter_t f_;
    double counts_;
    double zero_;
    bool reset_;
};
} // namespace

Maker synthesised(double a1, double b0, std::optional<double> x0)
{
    return [a1, b0, x0] {
        std::array<double, 3> x{}; // newest first
        x.fill(x0.value_or(0.0));
        return [a1, b0, x, begun = x0.has_value()](double z) mutable {
            if (!begun) {
                x.fill(z);
                begun = true;
            }
            const double expected = (2.0 - a1) * x[0] - (1.0 - 2.0 * a1) * x[1] - a1 * x[2];
            x = { expected + b0 * (z - expected), x[0], x[1] };
            return x[0];
        };
    };
}

Maker shipped(const std::string &name, const Shipping &shipping)
{
    const filter_t begun = initialised(name, shipping);
    return [begun, shipping] { return Shipped(begun, shipping); };
}

std::vector<std::string> shipped_names()
{
    std::vector<std::string> result;
    for (std::uint8_t kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        result.emplace_back(filter_listed_name(static_cast<filter_kind_t>(kind)));
    }
    return result;
}

bool is_shipped(const std::string &name)
{
    return filter_find(name.c_str()) != FILTER_KIND_COUNT;
}

double largest_r_lsb2()
{
    return FILTER_R_MAX_LSB2_Q8 / 256.0;
}
} // namespace papers
