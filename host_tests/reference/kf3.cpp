// A Kalman filter of three states in matrix form, in double; the update in Joseph's form, symmetric by construction.
#include "reference/kf3.h"
#include "reference/linear.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#ifdef __SANITIZE_ADDRESS__
#define KIND __attribute__((noinline))
#else
#define KIND
#endif

namespace
{
using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Vector = Eigen::Vector3d;

constexpr double x_max = 4608.0;

// Each kind of expression once, so that the file compiles in seconds: instantiating Eigen's templates takes the time.
KIND Matrix product(const Matrix &a, const Matrix &b)
{
    return a.lazyProduct(b);
}

KIND Vector product(const Matrix &a, const Vector &v)
{
    return a.lazyProduct(v);
}

KIND Matrix outer(double scale, const Vector &a, const Vector &b)
{
    return scale * a.lazyProduct(b.transpose());
}

KIND Matrix sum(const Matrix &a, const Matrix &b)
{
    return a + b;
}

KIND Matrix transposed(const Matrix &m)
{
    return m.transpose();
}

KIND Matrix magnitudes(const Matrix &m)
{
    return m.cwiseAbs();
}

KIND Matrix matrix(const double *from)
{
    return Eigen::Map<const Matrix>(from);
}

KIND void store(double *to, const Matrix &m)
{
    std::copy(m.data(), m.data() + 9, to);
}

Vector vector(const double *from)
{
    return { from[0], from[1], from[2] };
}

void store(double *to, const Vector &v)
{
    std::copy(v.data(), v.data() + 3, to);
}

const Vector observed(1.0, 0.0, 0.0); // H transposed

// I - K H
Matrix keeping(const reference_kf3_t &f)
{
    return sum(Matrix::Identity(), outer(-1.0, vector(f.gain), observed));
}

Matrix closed_loop(const reference_kf3_t &f)
{
    return product(keeping(f), matrix(f.a));
}

Matrix congruent(const Matrix &a, const Matrix &p) // A P A'
{
    return product(product(a, p), transposed(a));
}

// True when P can be predicted: P11 below 4 R, all else below R.
bool grows(const reference_kf3_t &f)
{
    const double limit = f.r;
    const double others = std::max({ f.p[1], f.p[2], f.p[4], f.p[5], f.p[8] });
    return !f.ends || (f.p[0] < 4.0 * limit && others < limit);
}

void update(reference_kf3_t &f, double z)
{
    f.innovation = z - f.x[0];
    const Vector column = product(matrix(f.p), observed);
    for (int i = 0; i < 3; i++) {
        f.gain[i] = column(i) / (column(0) + f.r);
        f.x[i] += f.gain[i] * f.innovation;
    }
    store(f.p, sum(congruent(keeping(f), matrix(f.p)), outer(f.r, vector(f.gain), vector(f.gain))));
}

// x += period v + half a; v += step a; an increment of a.
void model(reference_kf3_t *f, double period, double half, double step)
{
    const double a[9] = { 1.0, period, half, 0.0, 1.0, step, 0.0, 0.0, 1.0 };
    std::copy(a, a + 9, f->a);
    f->g[2] = 1.0;
}

void settle(reference_kf3_t &f)
{
    for (int k = 0; k < 20000; k++) {
        reference_kf3_step(&f, 0.0);
    }
}
} // namespace

void reference_kf3_coast(reference_kf3_t *f)
{
    if (grows(*f)) {
        store(f->p, sum(congruent(matrix(f->a), matrix(f->p)), outer(f->q, vector(f->g), vector(f->g))));
    } else {
        f->x[2] = 0.0;
    }
    store(f->x, product(matrix(f->a), vector(f->x)));
    if (f->ends && std::abs(f->x[0]) > x_max) {
        f->x[0] = std::copysign(x_max, f->x[0]);
        f->x[1] = f->x[2] = 0.0;
    }
}

void reference_kf3_step(reference_kf3_t *f, double z)
{
    reference_kf3_coast(f);
    update(*f, z);
    if (f->ends && *std::max_element(f->p, f->p + 9) >= f->r) {
        std::for_each(f->p, f->p + 9, [](double &element) { element /= 16.0; });
    }
}

void reference_kf3_library(reference_kf3_t *f, double rate_hz, double r, double q, double x0)
{
    const bool fine = rate_hz >= 100.0;
    const double unit = fine ? 1.0 / 16.0 : 1.0;
    const double t = 1.0 / rate_hz;
    const double count = std::pow(2.0, -28);
    const double q33 = std::clamp(q * std::pow(t, 5) / r / (unit * unit), 16.0 * count, fine ? 0.125 : 1.0);
    const double start = std::min(0.5, std::max(40000.0 * t * t / r, q33));
    *f = reference_kf3_t{};
    model(f, 1.0, unit, unit);
    f->g[0] = f->g[1] = unit;
    f->q = q33 * r;
    f->r = r;
    f->ends = true;
    f->x[0] = x0;
    f->p[0] = r;
    f->p[4] = start * r;
    f->p[8] = start / 16.0 * r;
}

void reference_kf3_settled(reference_kf3_t *f, double lambda)
{
    *f = reference_kf3_t{};
    model(f, 1.0, 1.0, 1.0);
    f->g[0] = f->g[1] = 1.0;
    f->q = lambda;
    f->r = 1.0;
    settle(*f);
}

void reference_kf3_textbook(reference_kf3_t *f, double period_s, double r, double q)
{
    const double t = period_s;
    *f = reference_kf3_t{};
    model(f, t, 0.5 * t * t, t);
    f->g[0] = 0.5 * t * t;
    f->g[1] = t;
    f->q = q;
    f->r = r;
    settle(*f);
}

double reference_kf3_noise_gain(const reference_kf3_t *f)
{
    const Matrix m = closed_loop(*f);
    Vector answer = vector(f->gain); // to one sample of 1
    double squares = 0.0;
    for (int n = 0; n < 20000; n++) {
        squares += answer(0) * answer(0);
        answer = product(m, answer);
    }
    return squares;
}

double reference_kf3_radius(const reference_kf3_t *f)
{
    return linear::spectral_radius(closed_loop(*f));
}

// The roots of the characteristic polynomial by the cosine of a third of an angle.
double reference_kf3_least_eigenvalue(const double *p)
{
    const double mean = (p[0] + p[4] + p[8]) / 3.0;
    const double b[3] = { p[0] - mean, p[4] - mean, p[8] - mean };
    const double off = p[1] * p[1] + p[2] * p[2] + p[5] * p[5];
    const double spread = std::sqrt((b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + 2.0 * off) / 6.0);
    if (spread == 0.0) {
        return mean;
    }
    const double determinant = b[0] * (b[1] * b[2] - p[5] * p[5]) - p[1] * (p[1] * b[2] - p[5] * p[2]) +
                               p[2] * (p[1] * p[5] - b[1] * p[2]);
    const double angle = std::acos(std::clamp(determinant / (2.0 * spread * spread * spread), -1.0, 1.0)) / 3.0;
    return mean + 2.0 * spread * std::cos(angle + 2.0 * std::acos(-0.5));
}

void reference_kf3_covariance_error(const reference_kf3_t *f, const double *each, double *total)
{
    const Matrix m = closed_loop(*f);
    Matrix power = Matrix::Identity();
    Matrix all = Matrix::Zero();
    for (int n = 0; n < 5000; n++) {
        all = sum(all, congruent(magnitudes(power), matrix(each)));
        power = product(m, power);
    }
    store(total, all);
}

void reference_kf3_state_error(const reference_kf3_t *f, const double *each, double *total)
{
    const Matrix m = closed_loop(*f);
    Matrix power = Matrix::Identity();
    std::fill(total, total + 3, 0.0);
    for (int n = 0; n < 5000; n++) {
        const Vector part = product(magnitudes(power), vector(each));
        for (int i = 0; i < 3; i++) {
            total[i] += part(i);
        }
        power = product(m, power);
    }
}
