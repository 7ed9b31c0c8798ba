#include "reference/noise.h"

#include <cmath>

namespace
{
constexpr int steps = 400;

// P(X^2 > t) of a second difference in its sigmas, X normal about d, or spoilt by a bad read among its three samples.
double beyond(double t, double d, double bad)
{
    const double spoilt = 1.0 - std::pow(1.0 - bad, 3.0);
    const double root = std::sqrt(t);
    const double tail = 0.5 * (std::erfc((root - d) / std::sqrt(2.0)) + std::erfc((root + d) / std::sqrt(2.0)));
    return spoilt + (1.0 - spoilt) * tail;
}

// E min(X^2, Y^2, limit)
double limited_mean(double limit, double x, double y, double bad)
{
    double sum = 0.0;
    for (int i = 0; i < steps; i++) {
        const double t = limit * (i + 0.5) / steps;
        sum += beyond(t, x, bad) * beyond(t, y, bad);
    }
    return sum * limit / steps;
}

// w = E min(m, c w) by iteration: what a term is divided by, so that it has the variance as its mean.
double unbias(double c)
{
    double w = 0.3;
    for (int i = 0; i < 60; i++) {
        w = limited_mean(c * w, 0.0, 0.0, 0.0);
    }
    return w;
}

// Mean of the term behind sample k, where m is the estimate and c its limit: of the smaller of two second differences.
double expected_term(const reference_noise_t &of, int k, double m, double c)
{
    static const double opening = unbias(4.5);
    static const double later = unbias(3.0);
    const double w = c > 4.0 ? opening : later;
    const int apart = of.rate_dhz >= 700 ? 2 : 1; // samples of one difference
    const int other = apart == 2 ? 1 : 3;         // from one to the other difference
    double bend[2];
    for (int i = 0; i < 2; i++) {
        const double *at = of.truth_lsb + k - i * other;
        bend[i] = (at[0] - 2.0 * at[-apart] + at[-2 * apart]) / std::sqrt(6.0 * of.variance_lsb2);
    }
    return limited_mean(c * w * m, bend[0], bend[1], of.bad) / w;
}

double weight_of(int term)
{
    if (term < 4) {
        return 0.5;
    }
    return term < 255 ? std::exp2(-std::floor(std::log2(term))) : 1.0 / 256.0;
}
} // namespace

reference_noise_estimate_t reference_noise_estimate(const reference_noise_t *of)
{
    constexpr double h = 0.05;
    constexpr int history = 5;
    const int last = of->samples - 1;
    reference_noise_estimate_t e{ 0.002 * of->rate_dhz / of->variance_lsb2, 0.0, 0.0, 0.0 };
    for (int n = 0; n + history <= last; n++) {
        e.weight = weight_of(n);
        e.estimate += e.weight * (expected_term(*of, n + history, e.estimate, n < 64 ? 4.5 : 3.0) - e.estimate);
    }
    const double more = expected_term(*of, last, e.estimate + h, 3.0);
    const double less = expected_term(*of, last, e.estimate - h, 3.0);
    const double here = expected_term(*of, last, e.estimate, 3.0);
    e.again = (more - less) / (2.0 * h);
    e.bent = 0.5 * (2.0 * here - more - less) / (h * h) / (1.0 - e.again);
    return e;
}
