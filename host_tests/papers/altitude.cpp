#include "altitude.hpp"
#include "model.hpp"
#include "roll.hpp"

#include <algorithm>
#include <cmath>

namespace papers::altitude
{
namespace
{
constexpr int up = 200; // samples at which the legs begin
constexpr int down = 350;
constexpr int straight = 500;

Interval root(const Interval &square)
{
    return { std::sqrt(square.value), std::sqrt(std::max(0.0, square.low)), std::sqrt(square.high) };
}

double mean(const std::vector<double> &errors, int first, int end)
{
    double sum = 0.0;
    for (int k = first; k < end; k++) {
        sum += errors[static_cast<std::size_t>(k)];
    }
    return sum / (end - first);
}

// Over both straight legs.
double straight_sum(const std::vector<double> &values)
{
    double sum = 0.0;
    for (int k = 0; k < samples; k++) {
        sum += (k < up || k >= straight) ? values[static_cast<std::size_t>(k)] : 0.0;
    }
    return sum;
}

double square_sum(const std::vector<double> &errors, int first, int end)
{
    double sum = 0.0;
    for (int k = first; k < end; k++) {
        sum += errors[static_cast<std::size_t>(k)] * errors[static_cast<std::size_t>(k)];
    }
    return sum;
}
} // namespace

double truth_m(Reading reading, int k)
{
    const auto rise = [&](int from, int to) {
        // half a t^2 of a push from one sample to another: a parabola, then a line
        const double in = period_s * std::clamp(k - from, 0, to - from);
        const double after = period_s * std::max(0, k - to);
        return acceleration_m_s2 * in * (0.5 * in + after);
    };
    const double half = rise(up, down) - rise(down, straight);
    return (reading == Reading::a_t2) ? 2.0 * half : half;
}

double second_difference_m(Reading reading)
{
    return (reading == Reading::a_t2 ? 2.0 : 1.0) * acceleration_m_s2 * period_s * period_s;
}

Exact exact(const Maker &maker, Reading reading, int run_in, double r)
{
    const std::vector<double> gain = roll::noise_gain(maker, run_in + samples).estimate;
    const Estimator estimator = maker();
    std::vector<double> bias;
    std::vector<double> square;
    for (int k = -run_in; k < samples; k++) {
        const double error = truth_m(reading, k) - estimator(truth_m(reading, k));
        if (k >= 0) {
            bias.push_back(error);
            square.push_back(error * error + r * gain[static_cast<std::size_t>(k + run_in)]);
        }
    }
    return { std::sqrt(straight_sum(square) / (up + samples - straight)), std::sqrt(mean(square, 100, up)),
             mean(bias, up, down), mean(bias, down, straight), mean(bias, 300, down) };
}

Result monte_carlo(const Maker &maker, Reading reading, int run_in, int runs, std::uint64_t seed)
{
    std::vector<double> square;
    std::vector<double> stationary;
    std::vector<double> lags[3];
    std::vector<double> one_run;
    for (int run = 0; run < runs; run++) {
        test_random_t random;
        random_seed(&random, run_seed(seed, static_cast<std::uint64_t>(run)));
        const Estimator estimator = maker();
        std::vector<double> errors;
        for (int k = -run_in; k < samples; k++) {
            const double truth = truth_m(reading, k);
            const double error = truth - estimator(truth + sigma_m * random_normal(&random));
            if (k >= 0) {
                errors.push_back(error);
            }
        }
        square.push_back((square_sum(errors, 0, up) + square_sum(errors, straight, samples)) /
                         (up + samples - straight));
        one_run.push_back(std::sqrt(square.back()));
        stationary.push_back(square_sum(errors, 100, up) / 100.0);
        lags[0].push_back(mean(errors, up, down));
        lags[1].push_back(mean(errors, down, straight));
        lags[2].push_back(mean(errors, 300, down));
    }
    double sd = 0.0;
    Result result{};
    (void)mean_of(one_run, result.sigma_one_run);
    result.sigma = root(mean_of(square, sd));
    result.sigma_stationary = root(mean_of(stationary, sd));
    result.lag_up = mean_of(lags[0], sd);
    result.lag_down = mean_of(lags[1], sd);
    result.lag_settled = mean_of(lags[2], sd);
    return result;
}
} // namespace papers::altitude
