// Parametric synthesis in matrices: e(n) = F(a1, b0) e(n-1) + b0 v(n) for the last three errors.
#include "reference/synth_opt.h"
#include "reference/linear.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace
{
using Square = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

const Eigen::RowVector3d straight(2.0, -1.0, 0.0);
const Eigen::RowVector3d bend(-1.0, 2.0, -1.0);

Square closed_loop(double a1, double b0)
{
    Square f = Square::Zero();
    f.row(0) = (1.0 - b0) * (straight + a1 * bend);
    f(1, 0) = f(2, 1) = 1.0;
    return f;
}

// Found by a search that made the largest stretch of the three corners of the clamps small; checked by the test.
const Square certificate = (Square() << 1.0, -0.53419642, 0.21871849, -0.53419642, 0.58697287, -0.17872298, 0.21871849,
                            -0.17872298, 0.15849535)
                               .finished();
} // namespace

double reference_given_step(double s[9], double a1, double b0)
{
    Eigen::Map<Square> covariance(s);
    const Square f = closed_loop(a1, b0);
    covariance = (f * covariance * f.transpose()).eval();
    covariance(0, 0) += b0 * b0;
    return covariance(0, 0);
}

double reference_opt_filter(double x[3], double a1, double b0, double z)
{
    Eigen::Map<Eigen::Vector3d> state(x);
    state = (closed_loop(a1, b0) * state).eval();
    state(0) += b0 * z;
    return state(0);
}

double reference_stretch(double a1, double b0)
{
    const Eigen::LLT<Square> root(certificate);
    if (root.info() != Eigen::Success) {
        return 0.0;
    }
    const Square upper = root.matrixU();
    const Square seen = upper * closed_loop(a1, b0) * upper.inverse();
    return seen.jacobiSvd().singularValues()(0);
}

double reference_norm_loss(void)
{
    return std::sqrt(certificate(0, 0) * certificate.inverse()(0, 0));
}

double reference_product_radius(const double *a1, const double *b0, int n)
{
    Square product = Square::Identity();
    for (int i = 0; i < n; i++) {
        product = (closed_loop(a1[i], b0[i]) * product).eval();
    }
    return linear::spectral_radius(product);
}
