// Paper 001: sigma on straight legs and the lag under acceleration, beside 0.37 m / 0.9 m of the synthesised filter,
// 0.3 m / 1.4 m and 0.45 m / 0 of the Kalman filters of first and second order.
#include "altitude.hpp"
#include "experiments_001.hpp"
#include "linear.hpp"
#include "twins.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

namespace papers::altitude
{
namespace
{
constexpr double kf1_lag_m = 1.4; // published, solved for
constexpr double kf1_sigma_m = 0.3;
constexpr double kf2_sigma_m = 0.45;
constexpr int settle = 200; // samples of run-in for the filters on the chip: 20 s

int runs_of(const Options &options)
{
    return std::max(1, options.runs / 5);
}

const char *name_of(Reading reading)
{
    return reading == Reading::a_t2 ? "altitude_a_t2" : "altitude_half_a_t2";
}

void rows(Reading reading, const std::string &name, Arithmetic arithmetic, const Result &r, int runs)
{
    const std::string experiment = name_of(reading);
    row(experiment, name, arithmetic, "sigma", r.sigma, runs);
    row(experiment, name, arithmetic, "sigma_one_run_sd", r.sigma_one_run, runs);
    row(experiment, name, arithmetic, "sigma_stationary", r.sigma_stationary, runs);
    row(experiment, name, arithmetic, "lag_20_35", r.lag_up, runs);
    row(experiment, name, arithmetic, "lag_35_50", r.lag_down, runs);
    row(experiment, name, arithmetic, "lag_settled", r.lag_settled, runs);
}

void exact_rows(Reading reading, const std::string &name, Arithmetic arithmetic, const Exact &e)
{
    const std::string experiment = name_of(reading);
    row(experiment, name, arithmetic, "exact_sigma", e.sigma, 1);
    row(experiment, name, arithmetic, "exact_sigma_stationary", e.sigma_stationary, 1);
    row(experiment, name, arithmetic, "exact_lag_20_35", e.lag_up, 1);
    row(experiment, name, arithmetic, "exact_lag_35_50", e.lag_down, 1);
    row(experiment, name, arithmetic, "exact_lag_settled", e.lag_settled, 1);
}

// The example of paper 001 to the letter: x_e(n) of x_e(n - 1) .. (n - 3). The measurement never enters x_e.
Maker extrapolation_fed_back(double a1, double b0)
{
    return [a1, b0] {
        return [a1, b0, e = std::array<double, 3>{}](double z) mutable {
            const double expected = (2.0 - a1) * e[0] - (1.0 - 2.0 * a1) * e[1] - a1 * e[2];
            e = { expected, e[0], e[1] };
            return expected + b0 * (z - expected);
        };
    };
}

// The lambda at which a quantity that falls with lambda (or rises) takes a value, by halving on a logarithmic scale.
double solved(const std::function<double(double)> &of, double wanted, bool rises)
{
    double low = -6.0;
    double high = 6.0;
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        ((of(std::pow(10.0, middle)) < wanted) == rises ? low : high) = middle;
    }
    return std::pow(10.0, 0.5 * (low + high));
}

struct Entry {
    std::string name;
    Maker maker;
};

// q of the process noise in the paper's units: lambda R / T^4, an acceleration squared
void kalman_rows(const std::string &name, const StateSpace &model, double lambda)
{
    const Gains gains = steady_gains(model);
    const std::array<const char *, 3> metrics{ "alpha", "beta", "gamma" };
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.order); i++) {
        row("altitude_kalman", name, Arithmetic::in_double, metrics[i], gains[i], 1);
    }
    row("altitude_kalman", name, Arithmetic::in_double, "q", lambda * sigma_m * sigma_m / std::pow(period_s, 4.0), 1);
}

std::vector<Entry> entries_of(Reading reading)
{
    const double lag_samples = kf1_lag_m / second_difference_m(reading);
    const auto noise_of = [](const StateSpace &model) { return stationary_noise_gain(steady_kalman(model)); };
    const double by_lag = solved([](double l) { return stationary_lag(steady_kalman(white_acceleration(l))); },
                                 lag_samples, false);
    const double by_sigma = solved([&](double l) { return noise_of(white_acceleration(l)); },
                                   std::pow(kf1_sigma_m / sigma_m, 2.0), true);
    const double second = solved([&](double l) { return noise_of(white_jerk(l)); },
                                 std::pow(kf2_sigma_m / sigma_m, 2.0), true);
    const std::string suffix = (reading == Reading::a_t2) ? "_a_t2" : "_half_a_t2";
    kalman_rows("kf1_by_lag" + suffix, white_acceleration(by_lag), by_lag);
    if (reading == Reading::a_t2) {
        kalman_rows("kf1_by_sigma", white_acceleration(by_sigma), by_sigma);
        kalman_rows("kf2_by_sigma", white_jerk(second), second);
    }
    return { { "synth(-0.3:0.1)", synthesised(-0.3, 0.1, 0.0) },
             { "synth(0:0.1)", synthesised(0.0, 0.1, 0.0) },
             { "synth_as_printed(-0.3:0.1)", extrapolation_fed_back(-0.3, 0.1) },
             { "kf1_by_lag", steady_kalman(white_acceleration(by_lag), 0.0) },
             { "kf1_by_sigma", steady_kalman(white_acceleration(by_sigma), 0.0) },
             { "kf2_by_sigma", steady_kalman(white_jerk(second), 0.0) } };
}

// Altitude less estimate when there is no noise.
std::vector<double> noise_free_m(const Maker &maker, Reading reading)
{
    const Estimator estimator = maker();
    std::vector<double> errors;
    for (int k = 0; k < samples; k++) {
        errors.push_back(truth_m(reading, k) - estimator(truth_m(reading, k)));
    }
    return errors;
}

double peak_of(const std::vector<double> &errors)
{
    double peak = 0.0;
    for (const double error : errors) {
        peak = std::fmax(peak, std::fabs(error));
    }
    return peak;
}

// Counts per metre such that the range fits into 13 bits about its middle.
Shipping shipping_of(Reading reading)
{
    const double range = truth_m(reading, samples - 1);
    Shipping shipping;
    shipping.lsb_per_unit = (reading == Reading::a_t2) ? 3.5 : 7.0;
    shipping.zero = 0.5 * range;
    shipping.r = sigma_m * sigma_m;
    return shipping;
}
} // namespace

void readings(const Options &options)
{
    Progress progress(2.0);
    for (const Reading reading : { Reading::half_a_t2, Reading::a_t2 }) {
        for (const Entry &entry : entries_of(reading)) {
            rows(reading, entry.name, Arithmetic::in_double,
                 monte_carlo(entry.maker, reading, 0, runs_of(options), options.seed), runs_of(options));
            exact_rows(reading, entry.name, Arithmetic::in_double, exact(entry.maker, reading, 0, sigma_m * sigma_m));
            const std::vector<double> errors = noise_free_m(entry.maker, reading);
            row(name_of(reading), entry.name, Arithmetic::in_double, "peak_bias", peak_of(errors), 1);
            row(name_of(reading), entry.name, Arithmetic::in_double, "lag_noise_free", errors[349], 1);
        }
        progress.advance();
    }
}

void shipped_filters(const Options &options)
{
    const std::vector<std::string> names = shipped_names();
    Progress progress(2.0 * static_cast<double>(names.size() + 2));
    for (const Reading reading : { Reading::half_a_t2, Reading::a_t2 }) {
        const auto one = [&](const std::string &title, const std::string &name,
                             const std::map<std::string, double> &parameters) {
            Shipping shipping = shipping_of(reading);
            shipping.parameters = parameters;
            rows(reading, title, Arithmetic::fixed,
                 monte_carlo(shipped(name, shipping), reading, settle, runs_of(options), options.seed),
                 runs_of(options));
            const std::optional<Maker> twin = linear_twin(name, shipping);
            if (twin) {
                exact_rows(reading, title, Arithmetic::fixed,
                           exact(*twin, reading, settle, rounded_variance(sigma_m * sigma_m, shipping)));
            }
            progress.advance();
        };
        one("synth(-0.3:0.1)", "synth", { { "a1", -0.3 }, { "b0", 0.1 } });
        one("synth(0:0.1)", "synth", { { "a1", 0.0 }, { "b0", 0.1 } });
        for (const std::string &name : names) {
            one(name, name, {});
        }
    }
}
} // namespace papers::altitude
