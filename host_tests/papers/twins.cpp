#include "twins.hpp"
#include "linear.hpp"

extern "C" {
#include "filter_list.h"
#include "kalman.h"
#include "support/filters.h"
}

#include <cmath>
#include <stdexcept>

namespace papers
{
namespace
{
// Drive of a model whose process noise has the power density q, by R and per sample: q T^n / R, with `factor` times the
// R told; limited as kalman.h and kf3.c limit it.
double drive(const std::string &name, const Shipping &shipping, int power, double factor, double limit)
{
    const double r_lsb2 = factor * parameter_of(name, "r", shipping);
    return std::fmin(limit, parameter_of(name, "q", shipping) / (std::pow(shipping.rate_hz, power) * r_lsb2));
}
const double rate_drive_max = std::ldexp(static_cast<double>(KALMAN_Q22_MAX_UQ26), -26);
constexpr double acceleration_drive_max = 1.0;

// (8) of lrf: one R for both kinds of samples.
double pooled(const Shipping &shipping)
{
    const double ratio = parameter_of("lrf", "ratio", shipping);
    const double clean = parameter_of("lrf", "clean", shipping);
    return clean + (1.0 - clean) * ratio * ratio;
}

// kf3.c: a walks, v += a, x += v, so a step of a is in all three at once.
StateSpace white_jerk_as_shipped(double lambda)
{
    return { 3,
             { { { 1, 1, 1 }, { 0, 1, 1 }, { 0, 0, 1 } } },
             { { { lambda, lambda, lambda }, { lambda, lambda, lambda }, { lambda, lambda, lambda } } } };
}

// synth_plus with a1 = 0 and b2 = 0 is alpha-beta: alpha = b0, beta = b0 + b1.
Maker alpha_beta_of_taps(const Shipping &shipping)
{
    const double b0 = parameter_of("synth_plus", "b0", shipping);
    if (parameter_of("synth_plus", "k", shipping) != 0.0 || parameter_of("synth_plus", "b2", shipping) != 0.0) {
        throw std::runtime_error("synth_plus: its twin here is alpha-beta, k = 0 and b2 = 0");
    }
    return with_gains(white_rate(0.0), { b0, b0 + parameter_of("synth_plus", "b1", shipping), 0.0 });
}
} // namespace

double parameter_of(const std::string &name, const std::string &parameter, const Shipping &shipping)
{
    const auto given = shipping.parameters.find(parameter);
    if (given != shipping.parameters.end()) {
        return given->second;
    }
    if (parameter == "r") {
        return shipping.r * shipping.lsb_per_unit * shipping.lsb_per_unit;
    }
    const filter_kind_t kind = filter_find(name.c_str());
    if (kind == FILTER_KIND_COUNT) {
        throw std::runtime_error(name + ": not in FILTER_LIST");
    }
    filter_config_t config = filter_defaults(filter_listed(kind),
                                             static_cast<std::uint16_t>(std::lround(10.0 * shipping.rate_hz)));
    for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
        const filter_parameter_t entry = parameter_at(kind, i);
        if (parameter == entry.words) {
            return std::ldexp(static_cast<double>(config.value[i]), -entry.fraction_bits);
        }
    }
    throw std::runtime_error(name + ": has no parameter " + parameter);
}

std::optional<Maker> linear_twin(const std::string &name, const Shipping &shipping)
{
    if (name == "kf") {
        return steady_kalman(white_rate(drive(name, shipping, 3, 1.0, rate_drive_max)));
    }
    if (name == "lrf") {
        return steady_kalman(white_rate(drive(name, shipping, 3, pooled(shipping), rate_drive_max)));
    }
    if (name == "kf3") {
        return steady_kalman(white_jerk_as_shipped(drive(name, shipping, 5, 1.0, acceleration_drive_max)));
    }
    if (name == "synth") {
        return synthesised(parameter_of(name, "a1", shipping), parameter_of(name, "b0", shipping));
    }
    if (name == "synth_opt") {
        return synthesised(0.0, 2.0 / 3.0); // the limit of the exact covariance's schedule
    }
    if (name == "synth_plus") {
        return alpha_beta_of_taps(shipping);
    }
    return {};
}

double rounded_variance(double r, const Shipping &shipping)
{
    return r + 1.0 / (12.0 * shipping.lsb_per_unit * shipping.lsb_per_unit);
}
} // namespace papers
