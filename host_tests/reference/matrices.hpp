/*
 * Matrices of a two-state filter (Eigen, double; C++ only). Each kind of expression stands here once, and under the
 * sanitizers not inlined, so that the references compile in seconds: instantiating Eigen's templates takes the time.
 */
#ifndef REFERENCE_MATRICES_H
#define REFERENCE_MATRICES_H

#include <Eigen/Core>

#ifdef __SANITIZE_ADDRESS__
#define REFERENCE_KIND __attribute__((noinline)) inline
#else
#define REFERENCE_KIND inline
#endif

namespace reference
{
using Matrix = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
using Vector = Eigen::Vector2d;
using Row = Eigen::RowVector2d;

const Row H(1.0, 0.0);

// Each kind of expression once, so that the file compiles in seconds: Eigen's templates are what takes the time.
REFERENCE_KIND Matrix product(const Matrix &a, const Matrix &b)
{
    return a.lazyProduct(b);
}

REFERENCE_KIND Vector product(const Matrix &a, const Vector &v)
{
    return a.lazyProduct(v);
}

REFERENCE_KIND Matrix outer(const Vector &a, const Vector &b)
{
    return a.lazyProduct(b.transpose());
}

REFERENCE_KIND Matrix sum(double a, const Matrix &m, double b, const Matrix &n)
{
    return a * m + b * n;
}

REFERENCE_KIND Vector sum(double a, const Vector &u, double b, const Vector &v)
{
    return a * u + b * v;
}

REFERENCE_KIND Matrix transposed(const Matrix &m)
{
    return m.transpose();
}

inline Vector observed_column(const Matrix &p) // P H'
{
    return product(p, Vector(H.transpose()));
}

inline double observed(const Vector &s) // H s
{
    return H(0) * s(0) + H(1) * s(1);
}

inline Matrix through(const Vector &w) // W H
{
    return outer(w, Vector(H.transpose()));
}

inline Matrix congruent(const Matrix &a, const Matrix &p) // A P A'
{
    return product(product(a, p), transposed(a));
}

inline Matrix keeping(const Vector &w) // I - W H
{
    return sum(1.0, Matrix::Identity(), -1.0, through(w));
}
} // namespace reference

#endif
