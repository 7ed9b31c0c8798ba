// Paper 003's filter in Eigen, as its equations read.
#include "reference_nav.h"

#include <Eigen/Dense>
#include <cmath>

namespace
{
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Square3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr int mu = 0;
constexpr int dv = 3;
constexpr int dr = 6;
constexpr int dc = 9;

Matrix matrix_of(const reference_nav_t &f)
{
    return Eigen::Map<const Rows>(f.matrix, f.states, f.states);
}

void keep(reference_nav_t &f, const Matrix &m)
{
    Eigen::Map<Rows>(f.matrix, f.states, f.states) = m;
}

Matrix covariance_of(const reference_nav_t &f)
{
    const Matrix m = matrix_of(f);
    return (f.form == REFERENCE_NAV_ROOT) ? Matrix(m * m.transpose()) : m;
}

// C of (3.4): [a x]
Square3 cross(const double a[3])
{
    Square3 c;
    c << 0.0, -a[2], a[1], a[2], 0.0, -a[0], -a[1], a[0], 0.0;
    return c;
}

Matrix phi_of(const reference_nav_t &f, double h, const double force[3], const double dcm[9])
{
    Matrix phi = Matrix::Identity(f.states, f.states);
    const Square3 c = cross(force);
    phi.block<3, 3>(dv, mu) = c * h;
    phi.block<3, 3>(dr, mu) = c * (0.5 * h * h);
    phi.block<3, 3>(dr, dv) = Square3::Identity() * h;
    if ((f.printed & PRINTED_PHI) != 0) {
        phi.block<3, 3>(dr, dr).setZero(); // (3.5)
    }
    if (f.states > dc) {
        const Square3 a = Eigen::Map<const Square3>(dcm);
        phi.block<3, 3>(mu, dc) = a * h;
        phi.block<3, 3>(dv, dc) = c * a * (0.5 * h * h);
    }
    return phi;
}

// The square upper triangle of the QR factors of a tall matrix.
Matrix triangle(const Matrix &tall)
{
    const Eigen::HouseholderQR<Matrix> qr(tall);
    return qr.matrixQR().topRows(tall.cols()).triangularView<Eigen::Upper>();
}

struct Epoch {
    Matrix h;
    Vector y;
};

Epoch epoch_of(const reference_nav_t &f, bool field, bool gps, bool down, const double y[4])
{
    Matrix h = Matrix::Zero(9, f.states);
    Vector sigma(9);
    int rows = 0;
    const Square3 tau = Eigen::Map<const Square3>(f.tau);
    if (field) {
        h.block<2, 3>(0, mu) = tau.bottomRows<2>(); // (3.35) in place of turning the covariance by (3.36)
        sigma.segment<2>(0).setConstant(y[0]);
        rows = 2;
    }
    if (gps) {
        h.block<3, 3>(rows, dv).setIdentity();
        h.block<3, 3>(rows + 3, ((f.printed & PRINTED_ROWS) != 0) ? dv : dr).setIdentity(); // (3.32)
        sigma.segment<3>(rows).setConstant(y[1]);
        sigma.segment<3>(rows + 3).setConstant(y[2]);
        rows += 6;
    }
    if (down) {
        h(rows, dr + 2) = 1.0;
        sigma(rows) = y[3];
        rows += 1;
    }
    return { h.topRows(rows), sigma.head(rows) };
}

// (3.20)-(3.23) and (3.19)
Matrix gain_by_root(reference_nav_t &f, const Epoch &e)
{
    const Matrix m = matrix_of(f);
    const int n = f.states;
    Matrix nt(n + e.h.rows(), n);
    nt.topRows(n).setIdentity();
    nt.bottomRows(e.h.rows()) = e.y.cwiseInverse().asDiagonal() * (e.h * m);
    const Matrix p = m * triangle(nt).inverse();
    keep(f, p);
    return p * p.transpose() * e.h.transpose() * e.y.cwiseAbs2().cwiseInverse().asDiagonal();
}

// (3.9), (3.11); or Joseph's form
Matrix gain_by_covariance(reference_nav_t &f, const Epoch &e)
{
    const Matrix p = matrix_of(f);
    const Matrix r = e.y.cwiseAbs2().asDiagonal();
    const Matrix s = e.h * p * e.h.transpose() + r;
    const Matrix k = p * e.h.transpose() * s.inverse();
    if (f.form == REFERENCE_NAV_CONVENTIONAL) {
        keep(f, p - k * s * k.transpose());
    } else {
        const Matrix left = Matrix::Identity(f.states, f.states) - k * e.h;
        keep(f, left * p * left.transpose() + k * r * k.transpose());
    }
    return k;
}

// Where the paper's state i stands in nav/lib.
int ours(int i)
{
    return (i < dv) ? i + 6 : ((i >= dr && i < dc) ? i - 6 : i);
}
} // namespace

void reference_nav_tau(double tau[9], const double mag[3], bool printed)
{
    const Eigen::Map<const Eigen::Vector3d> m(mag);
    const double p = m.norm();
    const Eigen::Vector2d rest = m.tail<2>();
    Eigen::Map<Square3> t(tau);
    t(0, 0) = m(0);
    t.block<1, 2>(0, 1) = rest.transpose();
    t.block<2, 1>(1, 0) = -rest;
    t.block<2, 2>(1, 1) = p * Eigen::Matrix2d::Identity() - rest * rest.transpose() / ((printed ? 1.0 : p) + m(0));
}

void reference_nav_start(reference_nav_t *f, int form, int states, const double sigma[4], const double mag[3],
                         int printed)
{
    f->form = form;
    f->states = states;
    f->printed = printed;
    Vector diagonal(states);
    for (int i = 0; i < states; i++) {
        diagonal(i) = (form == REFERENCE_NAV_ROOT) ? sigma[i / 3] : sigma[i / 3] * sigma[i / 3];
    }
    keep(*f, diagonal.asDiagonal());
    reference_nav_tau(f->tau, mag, (printed & PRINTED_TAU) != 0);
}

void reference_nav_time(reference_nav_t *f, double step_s, const double force[3], const double dcm[9],
                        const double q[4])
{
    const int n = f->states;
    const Matrix phi = phi_of(*f, step_s, force, dcm);
    Vector each(n);
    for (int i = 0; i < n; i++) {
        each(i) = q[i / 3];
    }
    if (f->form == REFERENCE_NAV_ROOT) {
        Matrix t(2 * n, n); // (3.24) transposed
        t.topRows(n) = (phi * matrix_of(*f)).transpose();
        t.bottomRows(n) = each.asDiagonal();
        keep(*f, triangle(t).transpose()); // (3.25), (3.26)
    } else {
        const Matrix noise = each.cwiseAbs2().asDiagonal();
        keep(*f, phi * matrix_of(*f) * phi.transpose() + noise);
    }
}

void reference_nav_measure(reference_nav_t *f, bool field, bool gps, bool down, const double *z, const double y[4],
                           double *x)
{
    const Epoch e = epoch_of(*f, field, gps, down, y);
    const Matrix k = (f->form == REFERENCE_NAV_ROOT) ? gain_by_root(*f, e) : gain_by_covariance(*f, e);
    Eigen::Map<Vector>(x, f->states) = k * Eigen::Map<const Vector>(z, e.h.rows());
}

void reference_nav_variances(const reference_nav_t *f, double *variance)
{
    const Matrix p = covariance_of(*f);
    for (int i = 0; i < f->states; i++) {
        variance[ours(i)] = p(i, i);
    }
}
