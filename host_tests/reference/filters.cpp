// The start, limits and rules of lib/filters for the filters of robust.cpp.
#include "reference/filters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

using Matrix = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;

void reference_library(robust_reference_t *f, const char *name, double rate_hz, double r, double q, int reacquire,
                       double rate_max, double x0)
{
    const double t = 1.0 / rate_hz;
    const double q22 = std::clamp(q * t * t * t / r, 4.0 / 67108864.0, 14.0);
    const double start = std::clamp(40000.0 * t * t / r, q22, 14.0);
    robust_reference_table1(f, name);
    f->period_s = t;
    f->r = r;
    f->q[3] = q22 * r / (t * t);
    f->gate_sigma = reacquire != 0 ? 3.0 : HUGE_VAL;
    f->reacquire = reacquire;
    f->agree = 3.0 * std::sqrt(2.0 * r) + rate_max * t;
    f->doubts = reacquire != 0;
    f->rate_max = rate_max;
    f->x[0] = x0;
    f->x[1] = 0.0;
    f->p[0] = r;
    f->p[3] = start * r / (t * t);
}

void reference_coast(robust_reference_t *f)
{
    Eigen::Map<Eigen::Vector2d> x(f->x);
    Eigen::Map<Matrix> p(f->p);
    const Matrix a = (Matrix() << 1.0, f->period_s, 0.0, 1.0).finished();
    x = (a * x).eval();
    p = (a * p * a.transpose() + Eigen::Map<const Matrix>(f->q)).eval();
}
