#include "reference/adaptive.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace
{
constexpr double q8 = 1.0 / 256.0;
constexpr double q16 = q8 * q8;
constexpr double q24 = q16 * q8;
constexpr double q32 = q16 * q16;
constexpr double x_max = 4608.0;
constexpr double turn_max = 127.0;
constexpr double size_max = 128.0;
constexpr int stray = 64, strays_max = 255, tight_run = 4;

// A number and the largest difference of its fixed-point twin.
struct Value {
    double v;
    double e;
};

struct Step {
    double before;
    Value size, spread, gate, taken, mean;
    bool clear = true; // every decision is
    bool above(double value, double limit, double error)
    {
        clear = clear && std::fabs(value - limit) > error;
        return value > limit;
    }
};

// The gate; the mean in it has 8 bits behind the point.
Value gate_of(const reference_adaptive_t &f, const Value &spread)
{
    if (f.strays > stray) {
        const double sigmas = (f.sigmas <= 3.0) ? f.sigmas : (f.run < tight_run) ? 2.25 : 9.0;
        return { sigmas * spread.v, sigmas * spread.e };
    }
    if (f.run != 0) {
        return { f.sigmas * spread.v, f.sigmas * spread.e };
    }
    return { f.sigmas * std::min(spread.v + std::fabs(f.now.mean), 256.0), f.sigmas * (spread.e + q8) };
}

// Innovation and gate. Of the scatter and of its product with k, 8 bits remain behind the point; k has 16.
void meet(reference_adaptive_t &f, double z, Step &s)
{
    s.before = f.broken ? 0.0 : f.before - f.now.x;
    f.now.x = std::clamp(f.now.x + f.now.rate, -x_max, x_max);
    const double u = z - f.now.x;
    const int side = (u == 0.0) ? f.side : (u < 0.0 ? -1 : 1);
    s.clear = s.clear && std::fabs(u) > q16;
    if (side != f.side) {
        f.side = side;
        f.run = 0;
    }
    s.size = { std::fabs(u), q16 };
    s.spread = { f.now.scatter * (1.0 + f.now.k), q8 * (2.0 + f.now.k) + f.now.scatter * q16 };
    s.gate = gate_of(f, s.spread);
}

// Beyond the gate.
void judge(reference_adaptive_t &f, Step &s)
{
    f.run++;
    double agreed = std::min(std::max(0.0, f.side * s.before), s.size.v);
    const double near = s.gate.e + q16;
    if (s.above(agreed, s.gate.v, near)) {
        // an eighth of the largest rate, rounded down to 8 bits
        const bool large = s.above(s.size.v - s.gate.v, f.rate_max / 8.0, near + q8);
        if (!large || f.run >= f.confirm) {
            f.verdict = large ? VERDICT_JUMP : VERDICT_MOTION;
            s.taken = { agreed, q16 };
            return;
        }
        agreed = s.gate.v;
    }
    const bool far = s.above(s.size.v, 2.0 * s.gate.v, 2.0 * s.gate.e + q16);
    s.taken = { far ? agreed : std::max(agreed, 2.0 * s.gate.v - s.size.v), 2.0 * s.gate.e + q16 };
    f.verdict = VERDICT_OUTLIER;
    if (far && agreed == 0.0) {
        f.verdict = VERDICT_UNUSED;
        f.strays = std::min(strays_max, f.strays + stray);
    }
}

// The mean innovation; both terms have 8 bits behind the point.
void average(reference_adaptive_t &f, Step &s)
{
    const double limited = std::min({ s.taken.v, s.gate.v, size_max });
    f.now.mean += f.share * (f.side * limited - f.now.mean);
    s.mean = { f.now.mean, f.share * (std::max(s.taken.e, s.gate.e) + 2.0 * q8) };
}

double adapt(reference_adaptive_t &f, Step &s)
{
    const double mean = std::fabs(f.now.mean);
    const double threshold = f.manoeuvre * s.spread.v;
    const double error = s.mean.e + f.manoeuvre * s.spread.e + 2.0 * q8;
    if (f.verdict >= VERDICT_MOTION || s.above(mean, threshold, error)) {
        f.now.k = std::max(f.now.k, f.fast);
        return 0.0;
    }
    if (s.above(mean, 0.75 * threshold, error + q8)) {
        return 0.0;
    }
    f.now.k = std::max(f.slow, f.now.k - 0.25 * f.now.k * f.now.k);
    return f.now.k * 1.2 * q16 + q32; // a square of k / 2 with 16 bits; k was less than 1.2 times what it is
}

// x + (2 k - k^2) t and v + k^2 t as w = k t, 2 w - k w and k w.
void follow(reference_adaptive_t &f, const Step &s, reference_adaptive_value_t &bound)
{
    bound.x = q16;
    bound.rate = 0.0;
    if (f.verdict == VERDICT_JUMP) {
        f.now.rate = 0.0;
        f.now.x += f.side * s.taken.v;
        bound.x += s.taken.e;
    } else {
        const double k_error = q16 + bound.k;
        const Value w = { f.now.k * s.taken.v, f.now.k * (s.taken.e + q8) + s.taken.v * k_error + q16 };
        const Value kw = { std::min(turn_max, f.now.k * w.v),
                           f.now.k * w.e + w.v * k_error + (w.v + w.e >= size_max ? q16 : q24) };
        f.now.x += f.side * (2.0 * w.v - kw.v);
        f.now.rate = f.side * std::min(f.rate_max, f.side * f.now.rate + kw.v);
        bound.x += 2.0 * w.e + kw.e + q16;
        bound.rate = kw.e + q24;
    }
    f.now.x = std::clamp(f.now.x, -x_max, x_max);
}

// Scatter of the innovations: an eighth of the first seven terms, then a sixteenth, unguarded half of it below the
// limit.
double disperse(reference_adaptive_t &f, Step &s)
{
    const double apart = std::fabs(std::min(s.size.v, size_max) - f.side * f.now.mean);
    const double term = std::min({ 1.375 * apart, 2.5 * s.spread.v, 256.0 });
    const double of_term = 1.375 * (3.0 * q8 + s.mean.e) + 2.0 * q8;
    const double of_limit = 2.5 * s.spread.e + q8;
    double weight = 0.0625;
    if (f.terms++ < 7) {
        weight = 0.125;
    } else if (!f.guarded && !s.above(1.375 * apart, 2.5 * s.spread.v, of_term + of_limit)) {
        weight = 0.03125;
    }
    f.now.scatter = std::clamp(f.now.scatter + weight * (term - s.spread.v), 26.0 * q8, 90.0);
    return weight * (std::max(of_term, of_limit) + s.spread.e) + q24;
}

Eigen::Matrix2d loop(double k)
{
    const double alpha = 2.0 * k - k * k;
    return (Eigen::Matrix2d() << 1.0 - alpha, 1.0 - alpha, -k * k, 1.0 - k * k).finished();
}

// Covariance of a state that begins with f of the one before and the gain times noise of variance 1, for ever.
template <int N>
Eigen::Matrix<double, N, N> steady(Eigen::Matrix<double, N, N> f, const Eigen::Matrix<double, N, 1> &gain)
{
    Eigen::Matrix<double, N, N> p = gain * gain.transpose();
    for (int i = 0; i < 60; i++) {
        p = (p + f * p * f.transpose()).eval();
        f = (f * f).eval();
    }
    return p;
}

Eigen::Matrix2d covariance(double k)
{
    return steady<2>(loop(k), Eigen::Vector2d(2.0 * k - k * k, k * k));
}

// Standard deviation of what an innovation differs from their mean, itself in it: (1 - share) (noise - x - v - mean).
double apart(double k, double share)
{
    Eigen::Matrix3d f = Eigen::Matrix3d::Zero();
    f.topLeftCorner<2, 2>() = loop(k);
    f.row(2) << -share, -share, 1.0 - share;
    const Eigen::Matrix3d p = steady<3>(f, Eigen::Vector3d(2.0 * k - k * k, k * k, share));
    return (1.0 - share) * std::sqrt(1.0 + p.sum());
}

// E min(|X|, limit), X standard normal.
double limited_mean(double limit)
{
    return std::sqrt(2.0 / EIGEN_PI) * (1.0 - std::exp(-0.5 * limit * limit)) +
           limit * std::erfc(limit / std::sqrt(2.0));
}
} // namespace

void reference_adaptive_begin(reference_adaptive_t *f, double z)
{
    f->before = z;
    f->broken = false;
    f->run = f->samples = f->terms = f->strays = 0;
    f->side = 1;
    f->verdict = VERDICT_UNUSED;
}

bool reference_adaptive_step(reference_adaptive_t *f, double z, reference_adaptive_value_t *bound)
{
    Step s{};
    *bound = { 0.0, 0.0, 0.0, 0.0, 0.0 };
    meet(*f, z, s);
    if (f->guarded && s.above(s.size.v, s.gate.v, s.gate.e + q16)) {
        judge(*f, s);
    } else {
        s.taken = s.size;
        f->verdict = VERDICT_WITHIN;
        f->run = 0;
        f->strays = std::max(0, f->strays - 1);
    }
    average(*f, s);
    bound->mean = s.mean.e;
    bound->k = adapt(*f, s);
    follow(*f, s, *bound);
    f->samples++;
    if (f->identify && f->samples % 2 == 1) {
        bound->scatter = disperse(*f, s);
    }
    f->before = z;
    f->broken = false;
    return s.clear;
}

void reference_adaptive_coast(reference_adaptive_t *f)
{
    f->broken = true;
    f->now.x = std::clamp(f->now.x + f->now.rate, -x_max, x_max);
}

double reference_adaptive_scatter(double k, double share, double bad, bool guarded)
{
    double settled = 1.0; // by what the innovations deviate
    for (int i = 0; i < 200; i++) {
        const double limit = 2.5 * settled / 1.375;
        const double again = guarded ? 0.0
                                     : 1.5 * settled * std::erfc(limit / std::sqrt(2.0)); // limited ones weigh twice
        settled = (1.0 - bad) * (1.375 * limited_mean(limit) + again) + bad * 2.5 * settled;
    }
    return settled * apart(k, share) / (1.0 + k);
}

double reference_fading_noise_gain(double k)
{
    return covariance(k)(0, 0);
}

double reference_fading_prediction_gain(double k)
{
    return Eigen::Vector2d(1.0, 1.0).transpose() * covariance(k) * Eigen::Vector2d(1.0, 1.0);
}

double reference_fading_line_weight(double theta, int n)
{
    // position and slope at age 0 from sums of theta^i (1, i, i^2) over all ages i
    Eigen::Matrix2d sums = Eigen::Matrix2d::Zero();
    double weight = 1.0;
    for (int i = 0; i < 100000 && weight > 1e-300; i++) {
        const Eigen::Vector2d row(1.0, -i);
        sums += weight * row * row.transpose();
        weight *= theta;
    }
    return std::pow(theta, n) * (sums.inverse() * Eigen::Vector2d(1.0, -n))(0);
}

double reference_fading_impulse(double k, int n)
{
    Eigen::Vector2d state(2.0 * k - k * k, k * k);
    for (int i = 0; i < n; i++) {
        state = (loop(k) * state).eval();
    }
    return state(0);
}
