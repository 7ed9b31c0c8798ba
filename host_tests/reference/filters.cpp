// Kalman's equations in matrix form and the re-acquisition rule on raw samples, in double.
#include "reference/filters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace
{
using Matrix = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
using Vector = Eigen::Vector2d;

Matrix transition(const reference_filter_t &f)
{
    Matrix transition_matrix;
    transition_matrix << 1.0, f.period_s, 0.0, 1.0;
    return transition_matrix;
}

const Eigen::RowVector2d H(1.0, 0.0);

void limit_rate(reference_filter_t &f)
{
    if (f.rate_max > 0.0) {
        f.x[1] = std::clamp(f.x[1], -f.rate_max, f.rate_max);
    }
}

// Kalman's update with the given variance of the innovation.
void update(reference_filter_t &f, double s)
{
    Eigen::Map<Vector> x(f.x);
    Eigen::Map<Matrix> p(f.p);
    const Vector k = p * H.transpose() / s;
    x += k * f.innovation;
    p = ((Matrix::Identity() - k * H) * p).eval();
    f.gain[0] = k(0);
    f.gain[1] = k(1);
    limit_rate(f);
}

// From the sixth sample refused in a row on the rate is not believed; a soft gate makes a new one of each.
void forget_rate(reference_filter_t &f)
{
    f.refused = (f.run == 0) ? 1 : f.refused + 1;
    if (f.reacquire != 0 && f.soft2 == 0.0 && f.refused > 5) {
        f.x[1] = 0.0;
    }
    if (f.doubts && f.p[0] >= f.r) {
        f.x[1] *= 0.5;
    }
}

// Rule CR: L refused raw samples in a row, each within `agree` of the one before, restart the filter on their slope.
void refuse(reference_filter_t &f, double z)
{
    f.gated = true;
    f.gain[0] = f.gain[1] = 0.0;
    forget_rate(f);
    if (f.run > 0 && std::abs(z - f.previous) <= f.agree) {
        f.run++;
    } else {
        f.run = 1;
        f.first = z;
    }
    if (f.reacquire == 0 || f.run < f.reacquire) {
        return;
    }
    const double span = (f.run - 1) * f.period_s;
    f.x[0] = z;
    f.x[1] = (z - f.first) / span;
    limit_rate(f);
    Eigen::Map<Matrix> p(f.p);
    p << f.r, f.r / span, f.r / span, 2.0 * f.r / (span * span) + f.q[3];
    f.run = 0;
    f.reacquired = true;
    f.gated = false;
}
} // namespace

void reference_coast(reference_filter_t *f)
{
    Eigen::Map<Vector> x(f->x);
    Eigen::Map<Matrix> p(f->p);
    const Eigen::Map<const Matrix> q(f->q);
    const Matrix a = transition(*f);
    x = (a * x).eval();
    p = (a * p * a.transpose() + q).eval();
}

void reference_step(reference_filter_t *f, double z)
{
    reference_coast(f);
    Eigen::Map<Vector> x(f->x);
    Eigen::Map<Matrix> p(f->p);
    f->gated = f->reacquired = false;
    f->innovation = z - H * x;
    const double r2 = f->innovation * f->innovation;
    const double s = H * p * H.transpose() + f->r;
    const bool outlying = f->gate2 > 0.0 && r2 > f->gate2 * s && r2 > f->soft2 * s;
    if (outlying) {
        refuse(*f, z);
    } else {
        f->run = 0;
    }
    if (!f->reacquired && (!outlying || f->soft2 > 0.0)) {
        const double s_gain = H * p * H.transpose() + f->r_gain;
        update(*f, f->soft2 > 0.0 ? std::max(s_gain, r2 / f->soft2) : s_gain);
    }
    f->previous = z;
}

double reference_lyapunov(const reference_filter_t *f, double r_true)
{
    const Matrix a = transition(*f);
    const Eigen::Map<const Matrix> q(f->q);
    const Vector k(f->gain[0], f->gain[1]);
    const Matrix keep = Matrix::Identity() - k * H;
    // E = M E M' + C with M = keep a: solved as a linear system, vec(E) = (I - M (x) M)^-1 vec(C)
    const Matrix m = keep * a;
    const Matrix c = keep * q * keep.transpose() + k * r_true * k.transpose();
    Eigen::Matrix4d system = Eigen::Matrix4d::Identity();
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            system(i, j) -= m(i / 2, j / 2) * m(i % 2, j % 2);
        }
    }
    const Eigen::Vector4d right(c(0, 0), c(0, 1), c(1, 0), c(1, 1));
    return system.partialPivLu().solve(right)(0);
}

reference_filter_t reference_table_1(double factor)
{
    reference_filter_t f{};
    f.period_s = 0.0247;
    f.r = 0.0064;
    f.r_gain = factor * 0.0064;
    f.q[3] = 0.0009;
    f.x[0] = 2.8;
    f.x[1] = 0.008;
    f.p[0] = 0.7;
    f.p[3] = 0.04;
    return f;
}

void reference_settle(reference_filter_t *f)
{
    for (int k = 0; k < 5000; k++) {
        reference_step(f, 0.0);
    }
}

void reference_library(reference_filter_t *f, double rate_hz, double r, double q, double gate_sigma, int reacquire,
                       double rate_max, double x0)
{
    const double t = 1.0 / rate_hz;
    const double q22 = std::clamp(q * t * t * t / r, 4.0 / 67108864.0, 14.0);
    const double start = std::clamp(40000.0 * t * t / r, q22, 14.0);
    *f = reference_filter_t{};
    f->period_s = t;
    f->r = f->r_gain = r;
    f->q[3] = q22 * r / (t * t);
    f->gate2 = gate_sigma * gate_sigma;
    f->reacquire = reacquire;
    f->agree = 3.0 * std::sqrt(2.0 * r) + rate_max * t;
    f->doubts = reacquire != 0;
    f->rate_max = rate_max;
    f->x[0] = x0;
    f->p[0] = r;
    f->p[3] = start * r / (t * t);
}
