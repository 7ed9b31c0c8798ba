#include "reference/linear.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

double linear::spectral_radius(const Eigen::MatrixXd &f)
{
    return f.eigenvalues().cwiseAbs().maxCoeff();
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
