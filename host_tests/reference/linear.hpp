// What the references need of linear algebra, in one file: Eigen's solvers for fixed sizes take minutes to compile.
#ifndef REFERENCE_LINEAR_HPP
#define REFERENCE_LINEAR_HPP

#include <Eigen/Core>

namespace linear
{
// Largest |eigenvalue| of a square matrix.
double spectral_radius(const Eigen::MatrixXd &f);

// X = F X F' + Q of a stable F, by doubling.
Eigen::MatrixXd lyapunov(Eigen::MatrixXd f, Eigen::MatrixXd q);

// Value and slope at time 0 of the least-squares line through values at times -(n - 1)..0.
Eigen::Vector2d line_end(const Eigen::VectorXd &values);
} // namespace linear
#endif
