#include "linear.hpp"

#include <cmath>
#include <deque>
#include <stdexcept>

namespace papers
{
namespace
{
using Matrix = std::array<std::array<double, 3>, 3>;

constexpr Matrix one_state{ { { 1, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } } };
constexpr Matrix two_states{ { { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 0 } } };

Matrix product(const Matrix &a, const Matrix &b)
{
    Matrix c{};
    for (std::size_t i = 0; i < 9; i++) {
        for (std::size_t k = 0; k < 3; k++) {
            c[i / 3][i % 3] += a[i / 3][k] * b[k][i % 3];
        }
    }
    return c;
}

Matrix transposed(const Matrix &a)
{
    Matrix t{};
    for (std::size_t i = 0; i < 9; i++) {
        t[i / 3][i % 3] = a[i % 3][i / 3];
    }
    return t;
}

Matrix outer(double scale, const Gains &g)
{
    Matrix m{};
    for (std::size_t i = 0; i < 9; i++) {
        m[i / 3][i % 3] = scale * g[i / 3] * g[i % 3];
    }
    return m;
}

// Predicts P, gives the gains, updates P.
Gains riccati_step(const StateSpace &model, Matrix &p)
{
    p = product(product(model.f, p), transposed(model.f));
    Gains gains{};
    for (std::size_t i = 0; i < 9; i++) {
        p[i / 3][i % 3] += model.q[i / 3][i % 3];
    }
    const double s = p[0][0] + 1.0;
    for (std::size_t i = 0; i < 3; i++) {
        gains[i] = p[i][0] / s;
    }
    const Matrix taken = outer(s, gains);
    for (std::size_t i = 0; i < 9; i++) {
        p[i / 3][i % 3] -= taken[i / 3][i % 3];
    }
    return gains;
}

double advance(const StateSpace &model, const Gains &gains, Gains &x, double z)
{
    Gains predicted{};
    for (std::size_t i = 0; i < 9; i++) {
        predicted[i / 3] += model.f[i / 3][i % 3] * x[i % 3];
    }
    const double innovation = z - predicted[0];
    for (std::size_t i = 0; i < 3; i++) {
        x[i] = predicted[i] + gains[i] * innovation;
    }
    return x[0];
}
} // namespace

StateSpace random_walk(double lambda)
{
    return { 1, one_state, outer(lambda, { 1, 0, 0 }) };
}

StateSpace white_rate(double lambda)
{
    return { 2, two_states, outer(lambda, { 0, 1, 0 }) };
}

StateSpace white_acceleration(double lambda)
{
    return { 2, two_states, outer(lambda, { 0.5, 1, 0 }) };
}

StateSpace singer(double lambda, double rho)
{
    return { 3, { { { 1, 1, 0.5 }, { 0, 1, 1 }, { 0, 0, rho } } }, outer(lambda, { 0, 0, 1 }) };
}

StateSpace white_jerk(double lambda)
{
    return { 3, { { { 1, 1, 0.5 }, { 0, 1, 1 }, { 0, 0, 1 } } }, outer(lambda, { 0.5, 1, 1 }) };
}

Gains steady_gains(const StateSpace &model)
{
    Matrix p = outer(1.0, { 1, 0, 0 });
    p[1][1] = p[2][2] = 1.0;
    Gains before{};
    for (int n = 0; n < 200000; n++) {
        const Gains gains = riccati_step(model, p);
        double change = 0.0;
        for (std::size_t i = 0; i < 3; i++) {
            change = std::fmax(change, std::fabs(gains[i] - before[i]));
        }
        if (change < 1e-12) {
            return gains;
        }
        before = gains;
    }
    throw std::runtime_error("a Riccati recursion does not settle");
}

Maker with_gains(const StateSpace &model, const Gains &gains, std::optional<double> x0)
{
    return [model, gains, x0] {
        return [model, gains, begun = x0.has_value(), x = Gains{ x0.value_or(0.0), 0, 0 }](double z) mutable {
            if (!begun) {
                x[0] = z;
                begun = true;
                return z;
            }
            return advance(model, gains, x, z);
        };
    };
}

Maker steady_kalman(const StateSpace &model, std::optional<double> x0)
{
    return with_gains(model, steady_gains(model), x0);
}

Maker kalman(const StateSpace &model, double p0, double x0)
{
    Matrix p{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(model.order); i++) {
        p[i][i] = p0;
    }
    return [model, p, x0] {
        return [model, p, x = Gains{ x0, 0, 0 }](double z) mutable {
            const Gains gains = riccati_step(model, p);
            return advance(model, gains, x, z);
        };
    };
}

Maker fading_memory(int order, double theta)
{
    const double rest = 1.0 - theta;
    if (order == 1) {
        return with_gains(white_rate(0.0), { 1.0 - theta * theta, rest * rest, 0.0 });
    }
    return with_gains(white_jerk(0.0),
                      { 1.0 - theta * theta * theta, 1.5 * rest * rest * (1.0 + theta), rest * rest * rest });
}

namespace
{
// Weights of the end point, oldest first, by the orthogonal polynomials of n points up to order 2.
std::vector<double> end_weights(int order, int n)
{
    const double count = n;
    const double middle = (count - 1.0) / 2.0;
    const double second = (count * count - 1.0) / 12.0; // mean of t^2
    std::vector<double> weights;
    double norm2 = 0.0;
    for (int i = 0; i < n; i++) {
        const double t = i - middle;
        norm2 += (t * t - second) * (t * t - second);
    }
    for (int i = 0; i < n; i++) {
        const double t = i - middle;
        double w = 1.0 / count;
        w += (order >= 1 && n >= 2) ? t * middle / (count * second) : 0.0;
        w += (order >= 2 && n >= 3) ? (t * t - second) * (middle * middle - second) / norm2 : 0.0;
        weights.push_back(w);
    }
    return weights;
}
} // namespace

Maker end_point(int order, int length)
{
    std::vector<std::vector<double>> weights;
    for (int n = 1; n <= length; n++) {
        weights.push_back(end_weights(order, n));
    }
    return [weights] {
        return [weights, seen = std::deque<double>()](double z) mutable {
            seen.push_back(z);
            if (seen.size() > weights.size()) {
                seen.pop_front();
            }
            const std::vector<double> &w = weights[seen.size() - 1];
            double x = 0.0;
            for (std::size_t i = 0; i < w.size(); i++) {
                x += w[i] * seen[i];
            }
            return x;
        };
    };
}

namespace
{
constexpr int forgotten = 200; // samples after which none of these filters is in its start
constexpr int tail = 3000;
} // namespace

double stationary_noise_gain(const Maker &maker)
{
    const Estimator estimator = maker();
    double sum = 0.0;
    for (int k = 0; k < forgotten + tail; k++) {
        const double h = estimator(k == forgotten ? 1.0 : 0.0);
        sum += h * h;
    }
    return sum;
}

double stationary_lag(const Maker &maker)
{
    const Estimator estimator = maker();
    double error = 0.0;
    for (int k = 0; k < tail; k++) {
        const double truth = 0.5 * k * (k - 1.0);
        error = truth - estimator(truth);
    }
    return error;
}
} // namespace papers
