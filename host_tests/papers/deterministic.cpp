// Numbers without chance: covariances of the linear filters, gains at rest.
#include "experiments.hpp"
#include "model.hpp"
#include "reference/robust.h"

#include <algorithm>
#include <cmath>

namespace papers
{
void covariance(const Options & /*options*/)
{
    robust_reference_t plain;
    robust_reference_t linear;
    robust_reference_table1(&plain, plain_name.c_str());
    robust_reference_table1(&linear, linear_name.c_str());
    double p[4];
    double plain_gain[2];
    double linear_gain[2];
    double unused[4];
    robust_reference_steady(&plain, p, plain_gain);
    robust_reference_steady(&linear, unused, linear_gain);
    const Contestant of_plain = contestant(plain_name, Arithmetic::in_double, {});
    const Contestant of_linear = contestant(linear_name, Arithmetic::in_double, {});
    row("covariance", of_plain, "p11", p[0], 1);
    row("covariance", of_plain, "p12", p[1], 1);
    row("covariance", of_plain, "p22", p[3], 1);
    row("covariance", of_plain, "gain", plain_gain[0], 1);
    row("covariance", of_linear, "gain", linear_gain[0], 1);
    for (const bool with_outliers : { true, false }) {
        const double noise = with_outliers ? robust_reference_r(&linear) : plain.r;
        const double ratio_of_variances = robust_reference_lyapunov(&plain, plain_gain, noise) /
                                          robust_reference_lyapunov(&linear, linear_gain, noise);
        row("covariance", of_linear, with_outliers ? "variance_ratio" : "variance_ratio_clean", ratio_of_variances, 1);
    }
}

// The columns of Table 2 that are quotients of its others.
void table2(const Options & /*options*/)
{
    constexpr double plain_products = 47.0;
    constexpr double plain_sums = 32.0;
    for (const PrintedCost &line : printed_costs()) {
        const Contestant c = contestant(line.name, Arithmetic::in_double, {});
        row("table2", c, "multiplications_by_kf", line.products / plain_products, 1);
        row("table2", c, "additions_by_kf", line.sums / plain_sums, 1);
    }
}

// Both arithmetics read 3.2 degrees for ever: 160 counts, no innovation.
void steady_gain(const Options & /*options*/)
{
    for (const std::string &name : fixed_names()) {
        const Contestant fixed = contestant(name, Arithmetic::fixed, { Start::shipped });
        const Contestant reference = contestant(name, Arithmetic::in_double, { Start::shipped });
        fixed.filter->restart();
        reference.filter->restart();
        for (int k = 0; k < 2000; k++) {
            (void)fixed.filter->step(3.2);
            (void)reference.filter->step(3.2);
        }
        row("steady_gain", fixed, "gain", fixed.filter->gain(), 1);
        row("steady_gain", reference, "gain", reference.filter->gain(), 1);
        row("steady_gain", fixed, "gain_by_double", fixed.filter->gain() / reference.filter->gain(), 1);
    }
}
} // namespace papers
