// Numbers without chance: covariances of the linear filters, gains at rest.
#include "experiments.hpp"
#include "model.hpp"
#include "reference_robust.h"

#include <algorithm>
#include <cmath>

namespace papers
{
void covariance(const Options & /*options*/)
{
    robust_reference_t kf;
    robust_reference_t lrf;
    robust_reference_table1(&kf, ROBUST_KF);
    robust_reference_table1(&lrf, ROBUST_LRF);
    double p[4];
    double kf_gain[2];
    double lrf_gain[2];
    double unused[4];
    robust_reference_steady(&kf, p, kf_gain);
    robust_reference_steady(&lrf, unused, lrf_gain);
    const Contestant of_kf = contestant("kf", Arithmetic::in_double, {});
    const Contestant of_lrf = contestant("lrf", Arithmetic::in_double, {});
    row("covariance", of_kf, "p11", p[0], 1);
    row("covariance", of_kf, "p12", p[1], 1);
    row("covariance", of_kf, "p22", p[3], 1);
    row("covariance", of_kf, "gain", kf_gain[0], 1);
    row("covariance", of_lrf, "gain", lrf_gain[0], 1);
    for (const bool with_outliers : { true, false }) {
        const double noise = with_outliers ? robust_reference_r(&lrf) : kf.r;
        const double ratio_of_variances = robust_reference_lyapunov(&kf, kf_gain, noise) /
                                          robust_reference_lyapunov(&lrf, lrf_gain, noise);
        row("covariance", of_lrf, with_outliers ? "variance_ratio" : "variance_ratio_clean", ratio_of_variances, 1);
    }
}

// The columns of Table 2 that are quotients of its others.
void table2(const Options & /*options*/)
{
    constexpr double kf_products = 47.0;
    constexpr double kf_sums = 32.0;
    const struct {
        const char *name;
        double products;
        double sums;
    } printed[] = { { "pbf", 84.0, 41.0 },
                    { "af_grid", 584.0, 292.0 },
                    { "shrf", 49.0, 37.0 },
                    { "sprf_paper", 53.0, 36.0 },
                    { "lrf", 47.0, 38.0 } };
    for (const auto &line : printed) {
        const Contestant c = contestant(line.name, Arithmetic::in_double, {});
        row("table2", c, "multiplications_by_kf", line.products / kf_products, 1);
        row("table2", c, "additions_by_kf", line.sums / kf_sums, 1);
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
