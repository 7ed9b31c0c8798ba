// Calibration by Eigen's quaternions, matrix products and a solver, none of which lib/tilt uses.
#include "reference/calibration.h"

#include <Eigen/Dense>

namespace
{
using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

void give(const Matrix &m, double rows[9])
{
    Eigen::Map<Rows>(rows, 3, 3) = m;
}

Vector taken(const double v[3])
{
    return Eigen::Map<const Vector>(v);
}

// By the quaternion 1 + d.z, d x z. FromTwoVectors, which would serve -z too, takes 17 s to compile.
Matrix smallest_turn(const Vector &u)
{
    const Vector d = u.normalized();
    const Vector axis = d.cross(Vector::UnitZ());
    return Eigen::Quaterniond(1.0 + d.z(), axis.x(), axis.y(), axis.z()).normalized().toRotationMatrix();
}

Matrix mounting(const Vector &level)
{
    const Matrix half_turn = Vector(1.0, -1.0, -1.0).asDiagonal();
    return level.z() < 0.0 ? Matrix(smallest_turn(half_turn * level) * half_turn) : smallest_turn(level);
}

Matrix named(const signed char axes[3])
{
    Matrix p = Matrix::Zero();
    for (int i = 0; i < 3; i++) {
        p(i, std::abs(axes[i]) - 1) = axes[i] < 0 ? -1.0 : 1.0;
    }
    return p;
}
} // namespace

void reference_smallest_turn(const double u[3], double m[9])
{
    give(smallest_turn(taken(u)), m);
}

void reference_tau(const double m[3], double tau[9])
{
    const Eigen::Vector2d m23(m[1], m[2]);
    const double p = taken(m).norm();
    Matrix t;
    t(0, 0) = m[0];
    t.block<1, 2>(0, 1) = m23.transpose();
    t.block<2, 1>(1, 0) = -m23;
    t.block<2, 2>(1, 1) = p * Eigen::Matrix2d::Identity() - m23 * m23.transpose() / (p + m[0]);
    give(t / p, tau);
}

void reference_mounting(const double level[3], double m[9])
{
    give(mounting(taken(level)), m);
}

void reference_calibrated(const double offset[3], const double scale[3], const signed char axes[3],
                          const double level[3], const double a[3], double out[3])
{
    const Vector gains = 256.0 * taken(scale).cwiseInverse();
    const Vector ours = mounting(taken(level)) * named(axes) * gains.asDiagonal() * (taken(a) - taken(offset));
    Eigen::Map<Vector>(out, 3) = ours;
}

double reference_orthogonality(const double m[9])
{
    const Matrix r = Eigen::Map<const Rows>(m, 3, 3);
    return (r * r.transpose() - Matrix::Identity()).cwiseAbs().maxCoeff();
}

void reference_six(const double readings[18], double offset[3], double scale[3])
{
    using Six = Eigen::Matrix<double, 6, 1>;
    for (int round = 0; round < 30; round++) {
        Six misfit;
        Eigen::Matrix<double, 6, 6> slope;
        for (int k = 0; k < 6; k++) {
            misfit(k) = -1.0;
            for (int i = 0; i < 3; i++) {
                const double g = (readings[3 * k + i] - offset[i]) / scale[i];
                misfit(k) += g * g;
                slope(k, i) = -2.0 * g / scale[i];
                slope(k, 3 + i) = -2.0 * g * g / scale[i];
            }
        }
        const Six step = slope.fullPivLu().solve(misfit);
        for (int i = 0; i < 3; i++) {
            offset[i] -= step(i);
            scale[i] -= step(3 + i);
        }
    }
}
