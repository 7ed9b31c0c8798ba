// Paper 000, equations (13), (14), (20), (21) and what they should have been: see reference/synthesis.h.
#include "reference/synthesis.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace
{
// A number and its derivative along one direction: the schedules are written once, for values and for tangents.
struct Dual {
    double v = 0.0;
    double d = 0.0;
    Dual(double value = 0.0, double derivative = 0.0) : v(value), d(derivative) {}
};

Dual operator+(Dual a, Dual b)
{
    return { a.v + b.v, a.d + b.d };
}

Dual operator-(Dual a, Dual b)
{
    return { a.v - b.v, a.d - b.d };
}

Dual operator*(Dual a, Dual b)
{
    return { a.v * b.v, a.d * b.v + a.v * b.d };
}

Dual operator/(Dual a, Dual b)
{
    return { a.v / b.v, (a.d - a.v / b.v * b.d) / b.v };
}

Dual within(Dual a, double low, double high)
{
    return (a.v < low) ? Dual(low) : (a.v > high) ? Dual(high) : a;
}

struct Fraction {
    Dual above;
    Dual below;
};

// a1 as above / below, so that 0 / 0 and x / 0 are seen
Fraction a1_of(reference_schedule_kind_t kind, const Dual *p)
{
    switch (kind) {
    case SCHEDULE_SQUARE:
        return { -1.0 * (4.0 * p[0] + 6.0 * p[1] - 8.0 * p[2] + 2.0 * p[3]),
                 2.0 * p[0] + 8.0 * p[1] + 4.0 * p[2] - 8.0 * p[3] + 2.0 * p[4] };
    case SCHEDULE_CORRECTED:
        return { 2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3], p[0] - 4.0 * p[1] + 6.0 * p[2] - 4.0 * p[3] + p[4] };
    case SCHEDULE_UNCORRELATED_OPTIMUM:
        return { 2.0 * p[0] + 2.0 * p[1], p[0] + 4.0 * p[1] + p[2] };
    default: // (21)
        return { -1.0 * (p[0] + 6.0 * p[1] - 8.0 * p[2] + 2.0 * p[3]),
                 8.0 * p[1] + 4.0 * p[2] - 8.0 * p[3] + 2.0 * p[4] };
    }
}

Dual pe_of(reference_schedule_kind_t kind, Dual a, const Dual *p)
{
    const Dual tail = 2.0 * a * (1.0 - 2.0 * a) * p[3] + a * a * p[4];
    const Dual printed = tail - 2.0 * (2.0 - 3.0 * a - 2.0 * a * a) * p[1] + (1.0 - 8.0 * a + 2.0 * a * a) * p[2];
    switch (kind) {
    case SCHEDULE_PRINTED: // (20)
        return (2.0 + a) * p[0] + printed;
    case SCHEDULE_SQUARE:
        return (2.0 + a) * (2.0 + a) * p[0] + printed;
    case SCHEDULE_CORRECTED:
        return (2.0 - a) * (2.0 - a) * p[0] - 2.0 * (2.0 - 5.0 * a + 2.0 * a * a) * p[1] +
               (1.0 - 8.0 * a + 6.0 * a * a) * p[2] + tail;
    default:
        return (2.0 - a) * (2.0 - a) * p[0] + (1.0 - 2.0 * a) * (1.0 - 2.0 * a) * p[1] + a * a * p[2];
    }
}

Eigen::RowVector3d extrapolation(double a1)
{
    return { 2.0 - a1, -(1.0 - 2.0 * a1), -a1 };
}

using Covariance = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
using ConstCovariance = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
} // namespace

void reference_schedule_begin(reference_schedule_t *f, reference_schedule_kind_t kind, double r, const double p[5])
{
    *f = reference_schedule_t{};
    f->kind = kind;
    f->r = r;
    std::copy(p, p + 5, f->p);
    std::fill(f->tangent, f->tangent + 5, std::sqrt(0.2));
}

bool reference_schedule_step(reference_schedule_t *f)
{
    Dual p[5];
    for (int i = 0; i < 5; i++) {
        p[i] = Dual(f->p[i], f->tangent[i]);
    }
    const Fraction fraction = a1_of(f->kind, p);
    const bool uncorrelated = f->kind == SCHEDULE_UNCORRELATED || f->kind == SCHEDULE_UNCORRELATED_OPTIMUM;
    if (fraction.below.v == 0.0 && !uncorrelated) {
        return false;
    }
    Dual a = (fraction.below.v == 0.0) ? Dual(0.0) : fraction.above / fraction.below;
    if (f->clamped) {
        a = within(a, -0.99, -0.01);
    } else if (uncorrelated) {
        a = within(a, -1.0 / 3.0, 0.0);
    }
    Dual pe = pe_of(f->kind, a, p);
    if (f->clamped) {
        pe = within(pe, 0.0, HUGE_VAL);
    }
    Dual b = pe / (pe + f->r); // (13)
    if (f->clamped) {
        b = within(b, std::max(0.02, -a.v - 0.29), 1.0);
    }
    const Dual estimate = (1.0 - b) * pe; // (14)
    f->a1 = a.v;
    f->pe = pe.v;
    f->b0 = b.v;
    std::copy_backward(f->p, f->p + 4, f->p + 5);
    std::copy_backward(f->tangent, f->tangent + 4, f->tangent + 5);
    f->p[0] = estimate.v;
    f->tangent[0] = estimate.d;
    Eigen::Map<Eigen::Matrix<double, 5, 1>> tangent(f->tangent);
    f->stretch = std::log(tangent.norm());
    tangent.normalize();
    return true;
}

bool reference_printed_region(double a1, double b0)
{
    return b0 > 0.0 && b0 <= 1.0 && a1 > -1.0 && a1 < 0.0 && b0 > -a1 - 0.3;
}

double reference_covariance_pe(const double s[9], double a1)
{
    const Eigen::RowVector3d h = extrapolation(a1);
    return h * ConstCovariance(s) * h.transpose();
}

void reference_covariance_step(double s[9], double a1, double b0, double r)
{
    Covariance covariance(s);
    Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
    f.row(0) = (1.0 - b0) * extrapolation(a1);
    f(1, 0) = f(2, 1) = 1.0;
    covariance = (f * covariance * f.transpose()).eval();
    covariance(0, 0) += b0 * b0 * r;
}

void reference_exact_begin(reference_exact_t *f, double r, double a1_min, double a1_max, const double s[9])
{
    *f = reference_exact_t{};
    f->r = r;
    f->a1_min = a1_min;
    f->a1_max = a1_max;
    std::copy(s, s + 9, f->s);
}

// h = h0 + a1 d: Pe = h S h' is a parabola in a1 with its minimum at -(d S h0') / (d S d').
void reference_exact_step(reference_exact_t *f)
{
    const Covariance s(f->s);
    const Eigen::RowVector3d h0(2.0, -1.0, 0.0);
    const Eigen::RowVector3d d(-1.0, 2.0, -1.0);
    const double curvature = d * s * d.transpose();
    const double slope = d * s * h0.transpose();
    const double wanted = (curvature > 1e-12 * f->r) ? -slope / curvature : 0.0; // three equal errors: any a1 will do
    f->a1 = std::clamp(wanted, f->a1_min, f->a1_max);
    f->pe = reference_covariance_pe(f->s, f->a1);
    f->b0 = f->pe / (f->pe + f->r);
    reference_covariance_step(f->s, f->a1, f->b0, f->r);
}

double reference_closed_noise_gain(double a1, double b0)
{
    const double ac = a1 * (1.0 - b0);
    return (2.0 - b0 - 2.0 * ac * b0 - 2.0 * ac * ac) / ((1.0 + 2.0 * ac) * (4.0 - 3.0 * b0 - 4.0 * ac));
}

// x - x^ = (1 - b0)(x - x_e) - b0 f, and f(n) is not in x_e(n)
double reference_closed_pe(double a1, double b0)
{
    return (reference_closed_noise_gain(a1, b0) - b0 * b0) / ((1.0 - b0) * (1.0 - b0));
}

double reference_closed_lag(double a1, double b0)
{
    return (1.0 - b0) * (1.0 + a1) / b0;
}

// C(1) > 0, C(-1) < 0, |C(0)| < 1, and the last of Schur-Cohn's, 1 - q^2 > |q^2 + 2 q - c (1 + 2 q)| with q = c a1,
// whose one half is (1 + 2 q) b0 > 0.
bool reference_closed_stable(double a1, double b0)
{
    const double c = 1.0 - b0;
    const double q = c * a1;
    return b0 > 0.0 && 4.0 - 3.0 * b0 - 4.0 * q > 0.0 && std::fabs(q) < 1.0 && 1.0 + 2.0 * q > 0.0 &&
           1.0 - 2.0 * q - 2.0 * q * q + c * (1.0 + 2.0 * q) > 0.0;
}

bool reference_closed_stable_region(double a1, double b0)
{
    return b0 > 0.0 && b0 <= 1.0 && 1.0 + 2.0 * a1 * (1.0 - b0) > 0.0;
}
