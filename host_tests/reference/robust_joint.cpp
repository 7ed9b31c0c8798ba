#include "reference/robust_joint.h"

#include <cmath>

namespace
{
// r^2 / Xi1 of the next sample, in scalars.
double distance(const robust_reference_t &f, double z)
{
    const double t = f.period_s;
    const double r = z - (f.x[0] + t * f.x[1]);
    const double p11 = f.p[0] + t * (f.p[1] + f.p[2]) + t * t * f.p[3] + f.q[0];
    return r * r / (p11 + f.r);
}
} // namespace

void robust_reference_step_joint(robust_reference_t *f, int count, const double *z, double limit, double *x)
{
    double sum = 0.0;
    bool agrees = true;
    for (int i = 0; i < count; i++) {
        sum += distance(f[i], z[i]);
        agrees = agrees && std::abs(z[i] - f[i].previous) <= f[i].agree;
    }
    for (int i = 0; i < count; i++) {
        f[i].joint = true;
        f[i].joint_taken = sum <= limit;
        f[i].joint_agrees = agrees;
        x[i] = robust_reference_step(&f[i], z[i]);
    }
}
