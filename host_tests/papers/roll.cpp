#include "roll.hpp"
#include "model.hpp"
#include "support/roll_shapes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace papers::roll
{
namespace
{
double minimum_jerk(double s)
{
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

double triangle(double s)
{
    return 1.0 - std::fabs(2.0 * s - 1.0);
}

// half of it at 7 s and half at 9 s
double steps(double s)
{
    return (s >= 0.25 ? 0.5 : 0.0) + (s >= 0.75 ? 0.5 : 0.0);
}
} // namespace

// k is counted from the turn's beginning as a whole number, so that no rounding moves a step
double Profile::truth_deg(int k) const
{
    const int begin = static_cast<int>(std::lround(begin_s / period_s));
    const int length = static_cast<int>(std::lround(turn_s / period_s));
    const int in = std::clamp(k - begin, 0, length);
    return (in == 0) ? 0.0 : amplitude_deg * shape(static_cast<double>(in) / length);
}

const std::array<Profile, 7> &profiles()
{
    static const std::array<Profile, 7> all{ { { "ramp30", 30.0, roll_ramp },
                                               { "cos60", 60.0, roll_cosine },
                                               { "minjerk60", 60.0, minimum_jerk },
                                               { "bump30", 30.0, roll_bump },
                                               { "sine30", 30.0, roll_sine },
                                               { "triangle30", 30.0, triangle },
                                               { "steps30", 30.0, steps } } };
    return all;
}

const Profile &profile(const std::string &name)
{
    const auto found = std::find_if(profiles().begin(), profiles().end(),
                                    [&](const Profile &p) { return name == p.name; });
    if (found == profiles().end()) {
        throw std::runtime_error(name + ": no such profile of roll");
    }
    return *found;
}

NoiseGain noise_gain(const Maker &maker, int count)
{
    NoiseGain result;
    const auto n = static_cast<std::size_t>(count);
    result.estimate.assign(n, 0.0);
    result.residual.assign(n, 0.0);
    for (int from = 0; from < count; from++) {
        const Estimator estimator = maker();
        for (int k = 0; k < count; k++) {
            const double impulse = (k == from) ? 1.0 : 0.0;
            const double h = estimator(impulse);
            result.estimate[static_cast<std::size_t>(k)] += h * h;
            result.residual[static_cast<std::size_t>(k)] += (impulse - h) * (impulse - h);
        }
    }
    return result;
}

std::vector<double> bias_deg(const Maker &maker, const std::vector<double> &truth_deg)
{
    const Estimator estimator = maker();
    std::vector<double> result;
    std::transform(truth_deg.begin(), truth_deg.end(), std::back_inserter(result),
                   [&](double truth) { return estimator(truth) - truth; });
    return result;
}

PerWindow mean_over_windows(const std::vector<double> &values)
{
    PerWindow result{};
    for (std::size_t w = 0; w < window_count; w++) {
        const auto first = values.begin() + windows[w].first;
        const auto end = values.begin() + windows[w].last + 1;
        result[w] = total(std::vector<double>(first, end)) / static_cast<double>(end - first);
    }
    return result;
}

Exact exact(const Maker &maker, const Profile &profile, double r)
{
    std::vector<double> truth;
    for (int k = 0; k < samples; k++) {
        truth.push_back(profile.truth_deg(k));
    }
    std::vector<double> bias2 = bias_deg(maker, truth);
    Exact result{};
    for (double &b : bias2) {
        result.peak_deg = std::max(result.peak_deg, std::fabs(b));
        b *= b;
    }
    result.bias2_deg2 = mean_over_windows(bias2);
    const PerWindow variance = mean_over_windows(noise_gain(maker, samples).estimate);
    for (std::size_t w = 0; w < window_count; w++) {
        result.mse_deg2[w] = result.bias2_deg2[w] + r * variance[w];
    }
    return result;
}

std::vector<double> measured_deg(const Profile &profile, const Noise &noise, std::uint64_t seed, int run)
{
    test_random_t random;
    random_seed(&random, run_seed(seed, static_cast<std::uint64_t>(run)));
    const double sigma = std::sqrt(noise.r);
    std::vector<double> result;
    for (int k = 0; k < samples; k++) {
        // both are drawn always: the noise of clean samples does not depend on the outliers
        double f = sigma * random_normal(&random);
        const double draw = random_uniform(&random);
        if (draw < noise.outliers && noise.shift_sigma != 0.0) {
            f += (draw < 0.5 * noise.outliers ? -1.0 : 1.0) * noise.shift_sigma * sigma;
        } else if (draw < noise.outliers) {
            f *= noise.ratio;
        }
        result.push_back(profile.truth_deg(k) + f);
    }
    return result;
}

std::vector<Score> monte_carlo(const std::vector<Maker> &makers, const Profile &profile, const Noise &noise, int runs,
                               std::uint64_t seed)
{
    std::vector<std::array<std::vector<double>, window_count>> squares(makers.size());
    for (int run = 0; run < runs; run++) {
        const std::vector<double> measured = measured_deg(profile, noise, seed, run);
        for (std::size_t i = 0; i < makers.size(); i++) {
            const Estimator estimator = makers[i]();
            std::vector<double> error2;
            for (int k = 0; k < samples; k++) {
                const double error = estimator(measured[static_cast<std::size_t>(k)]) - profile.truth_deg(k);
                error2.push_back(error * error);
            }
            const PerWindow means = mean_over_windows(error2);
            for (std::size_t w = 0; w < window_count; w++) {
                squares[i][w].push_back(means[w]);
            }
        }
    }
    std::vector<Score> result(makers.size());
    for (std::size_t i = 0; i < makers.size(); i++) {
        for (std::size_t w = 0; w < window_count; w++) {
            result[i].mse_deg2[w] = mean_of(squares[i][w], result[i].one_run_sd_deg2[w]);
        }
    }
    return result;
}
} // namespace papers::roll
