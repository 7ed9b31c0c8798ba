// Linear filters with constant gains that the synthesised one is compared with. Time is counted in samples.
#ifndef PAPERS_LINEAR_H
#define PAPERS_LINEAR_H

#include "estimators.hpp"

#include <array>
#include <optional>
#include <string>

namespace papers
{
// x = F x + w, cov w = Q, z = x[0] + noise of variance 1.
struct StateSpace {
    int order; // 1..3
    std::array<std::array<double, 3>, 3> f;
    std::array<std::array<double, 3>, 3> q;
};

using Gains = std::array<double, 3>;

StateSpace random_walk(double lambda);        // position alone
StateSpace white_rate(double lambda);         // (position, rate), Q = diag(0, lambda): the shipped kf's
StateSpace white_acceleration(double lambda); // the same with Q = lambda [1/4 1/2; 1/2 1]
StateSpace singer(double lambda, double rho); // acceleration rho a + w, Var w = lambda
StateSpace white_jerk(double lambda);         // (1/2, 1, 1) w: the optimal alpha-beta-gamma filter

// Gains of the Kalman filter in the steady state. Throws std::runtime_error when the Riccati recursion does not settle.
Gains steady_gains(const StateSpace &model);

// Predicts by F, adds gains times innovation; begins with the first sample (or x0) at rest.
Maker with_gains(const StateSpace &model, const Gains &gains, std::optional<double> x0 = {});
Maker steady_kalman(const StateSpace &model, std::optional<double> x0 = {});

// The Kalman filter from the first sample on: P = diag(p0, p0, p0) (variances of samples, by R) about x0.
Maker kalman(const StateSpace &model, double p0, double x0);

// Polynomial filters of fading memory with all poles at theta: order 1, 2.
Maker fading_memory(int order, double theta);

// End point of the polynomial of least squares through the last `length` samples (Savitzky-Golay); fewer at the start.
Maker end_point(int order, int length);

// Sum of the squared impulse response, long after the start.
double stationary_noise_gain(const Maker &maker);

// Error by second difference of the truth, long after the start: 0 for filters of third order.
double stationary_lag(const Maker &maker);
} // namespace papers

#endif
