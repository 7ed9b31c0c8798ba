#include "reference_linear.hpp"

#include <Eigen/LU>
#include <cmath>

double linear::spectral_radius(const Eigen::MatrixXd &f)
{
    Eigen::MatrixXd power = f; // F^(2^i) e^(-logarithm 2^i)
    double logarithm = 0.0;
    for (int i = 0; i < 60; i++) {
        const double norm = power.norm();
        if (norm == 0.0) {
            return 0.0;
        }
        logarithm += std::log(norm) / std::exp2(i);
        power /= norm;
        power = (power * power).eval();
    }
    return std::exp(logarithm);
}

Eigen::MatrixXd linear::lyapunov(Eigen::MatrixXd f, Eigen::MatrixXd q)
{
    for (int i = 0; i < 60 && f.norm() > 1e-300; i++) {
        q = (q + f * q * f.transpose()).eval();
        f = (f * f).eval();
    }
    return q;
}

Eigen::Vector2d linear::line_end(const Eigen::VectorXd &values)
{
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (Eigen::Index i = 0; i < values.size(); i++) {
        const Eigen::Vector2d at(1.0, static_cast<double>(i - (values.size() - 1)));
        normal += at * at.transpose();
        right += at * values(i);
    }
    return normal.inverse() * right;
}
