// The synthesised filter as a linear system: x(n) = F x(n-1) + b0 e1 z(n), F the companion matrix of equation (7).
#include "reference/synth.h"
#include "reference/linear.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace
{
Eigen::RowVector3d extrapolation(double a1)
{
    return { 2.0 - a1, -(1.0 - 2.0 * a1), -a1 };
}

Eigen::Matrix3d closed_loop(double a1, double b0)
{
    Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
    f.row(0) = (1.0 - b0) * extrapolation(a1);
    f(1, 0) = f(2, 1) = 1.0;
    return f;
}

double line_gain(int n)
{
    return (4.0 * n - 2.0) / (n * (n + 1.0));
}
} // namespace

void reference_synth_at(reference_synth_t *f, double a1, double b0, double x0)
{
    *f = reference_synth_t{};
    f->a1 = a1;
    f->b0 = b0;
    std::fill(f->x, f->x + 3, x0);
    f->samples = 1;
}

void reference_synth_least_squares(reference_synth_t *f, double a1, double b0)
{
    *f = reference_synth_t{};
    f->a1 = a1;
    f->b0 = b0;
    f->least_squares_until = 1;
    while (line_gain(f->least_squares_until + 1) > b0) {
        f->least_squares_until++;
    }
}

double reference_synth_step(reference_synth_t *f, double z)
{
    Eigen::Map<Eigen::Vector3d> x(f->x);
    f->samples++;
    if (f->least_squares_until != 0 && f->samples == 1) {
        x.setConstant(z);
    }
    const bool start = f->samples <= f->least_squares_until;
    f->gain = start ? line_gain(f->samples) : f->b0;
    f->extrapolated = extrapolation(start ? 0.0 : f->a1) * x;
    const double estimate = f->extrapolated + f->gain * (z - f->extrapolated);
    x = Eigen::Vector3d(estimate, x(0), x(1));
    return estimate;
}

void reference_synth_median(reference_synth_t *f, double a1, double b0, const double *five)
{
    reference_synth_least_squares(f, a1, b0);
    double sorted[5];
    std::copy(five, five + 5, sorted);
    std::sort(sorted, sorted + 5);
    std::fill(f->x, f->x + 3, sorted[2]);
    f->samples = 5;
}

double reference_synth_radius(double a1, double b0)
{
    return linear::spectral_radius(closed_loop(a1, b0));
}

double reference_synth_noise_gain(double a1, double b0)
{
    const Eigen::Matrix3d f = closed_loop(a1, b0);
    const Eigen::Matrix3d noise = Eigen::Vector3d::Unit(0) * Eigen::RowVector3d::Unit(0) * (b0 * b0);
    return linear::lyapunov(f, noise)(0, 0);
}

double reference_synth_error_sum(double a1, double b0)
{
    const Eigen::Matrix3d f = closed_loop(a1, b0);
    Eigen::Vector3d error(1.0, 0.0, 0.0);
    double sum = 0.0;
    for (int k = 0; k < 20000 && error.norm() > 1e-12; k++) {
        sum += std::abs(error(0));
        error = (f * error).eval();
    }
    return sum;
}
