// synth_plus and what it contains, as linear systems (Eigen).
#include "reference/synth_plus.h"
#include "reference/linear.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace
{
using State = Eigen::Matrix<double, 5, 5>; // x1, x2, x3, u1, u2

struct System {
    State f;
    Eigen::Matrix<double, 5, 1> g;
};

Eigen::Matrix<double, 1, 5> extrapolation(const reference_taps_t &t)
{
    return { 2.0 - t.a1, -(1.0 - 2.0 * t.a1), -t.a1, t.b1, t.b2 };
}

System closed_loop(const reference_taps_t &t)
{
    System s = { State::Zero(), Eigen::Matrix<double, 5, 1>::Zero() };
    s.f.row(0) = (1.0 - t.b0) * extrapolation(t);
    s.f(1, 0) = s.f(2, 1) = s.f(4, 3) = 1.0;
    s.f.row(3) = -extrapolation(t);
    s.g(0) = t.b0;
    s.g(3) = 1.0;
    return s;
}

template <int n> Eigen::Matrix<double, n, 1> steady_gains(const Eigen::Matrix<double, n, n> &f, double noise)
{
    Eigen::Matrix<double, n, n> p = Eigen::Matrix<double, n, n>::Identity();
    Eigen::Matrix<double, n, 1> k = p.col(0);
    for (int i = 0; i < 20000; i++) {
        p = (f * p * f.transpose()).eval();
        p(n - 1, n - 1) += noise;
        k = p.col(0) / (p(0, 0) + 1.0);
        p = (p - k * p.row(0)).eval();
        p = (0.5 * (p + p.transpose())).eval();
    }
    return k;
}

Eigen::Matrix3d singer(double rho)
{
    return (Eigen::Matrix3d() << 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, rho).finished();
}
} // namespace

double reference_plus_step(reference_plus_t *f, const reference_taps_t *taps, double z)
{
    Eigen::Matrix<double, 5, 1> state;
    state << f->x[0], f->x[1], f->x[2], f->u[0], f->u[1];
    const double expected = extrapolation(*taps) * state;
    const double u = z - expected;
    std::rotate(f->x, f->x + 2, f->x + 3);
    f->x[0] = expected + taps->b0 * u;
    f->u[1] = f->u[0];
    f->u[0] = u;
    return f->x[0];
}

double reference_plus_radius(const reference_taps_t *taps)
{
    return linear::spectral_radius(closed_loop(*taps).f);
}

double reference_plus_noise_gain(const reference_taps_t *taps)
{
    const System s = closed_loop(*taps);
    return linear::lyapunov(s.f, s.g * s.g.transpose())(0, 0);
}

double reference_plus_rounding_lsb(const reference_taps_t *taps, int n)
{
    const System s = closed_loop(*taps);
    Eigen::Matrix<double, 5, 1> of_product = Eigen::Matrix<double, 5, 1>::Unit(0);
    Eigen::Matrix<double, 5, 1> of_extrapolation = of_product * (1.0 - taps->b0);
    of_extrapolation(3) = -1.0;
    double sum = 0.0;
    for (int i = 0; i < 20000; i++) {
        sum += std::abs(of_product(0)) + n * std::abs(of_extrapolation(0));
        of_product = (s.f * of_product).eval();
        of_extrapolation = (s.f * of_extrapolation).eval();
    }
    return sum / 131072.0;
}

double reference_alpha_beta_step(double state[2], double alpha, double beta, double z)
{
    const double expected = state[0] + state[1];
    state[0] = expected + alpha * (z - expected);
    state[1] += beta * (z - expected);
    return state[0];
}

void reference_singer_gains(double rho, double lambda, double k[3])
{
    Eigen::Map<Eigen::Vector3d> gains(k);
    gains = steady_gains<3>(singer(rho), lambda);
}

double reference_singer_step(double state[3], double rho, const double k[3], double z)
{
    Eigen::Map<Eigen::Vector3d> x(state);
    x = (singer(rho) * x).eval();
    x += Eigen::Map<const Eigen::Vector3d>(k) * (z - x(0));
    return x(0);
}

reference_taps_t reference_singer_taps(double rho, const double k[3])
{
    return { -rho, k[0], k[1] - (1.0 + rho) * k[0], rho * (k[0] - k[1]) + k[2] };
}

double reference_singer_error(double rho, const double k[3], double true_rho, double true_lambda)
{
    // truth and filter together; the error of the position is a difference of two states
    using Both = Eigen::Matrix<double, 6, 6>;
    const Eigen::Map<const Eigen::Vector3d> gain(k);
    const Eigen::Matrix3d model = singer(rho);
    const Eigen::Matrix3d truth = singer(true_rho);
    // in errors e = truth - filter and the true acceleration, which alone of the truth is stationary
    const Eigen::Matrix3d kept = Eigen::Matrix3d::Identity() - gain * Eigen::RowVector3d::Unit(0);
    Both f = Both::Zero();
    Both q = Both::Zero();
    f.topLeftCorner<3, 3>() = kept * model;
    f.block<3, 1>(0, 5) = kept * (truth - model).col(2);
    f(5, 5) = true_rho;
    const Eigen::Vector3d noise = kept.col(2);
    q.topLeftCorner<3, 3>() = noise * noise.transpose() * true_lambda + gain * gain.transpose();
    q.block<3, 1>(0, 5) = noise * true_lambda;
    q.block<1, 3>(5, 0) = noise.transpose() * true_lambda;
    q(5, 5) = true_lambda;
    return linear::lyapunov(f, q)(0, 0);
}

void reference_white_gains(double drive, double k[2])
{
    Eigen::Map<Eigen::Vector2d> gains(k);
    gains = steady_gains<2>((Eigen::Matrix2d() << 1.0, 1.0, 0.0, 1.0).finished(), drive);
}

double reference_line_end(const double *z, int n)
{
    return linear::line_end(Eigen::Map<const Eigen::VectorXd>(z, n))(0);
}
