// Paper 002 in matrices, in double. Where an equation is not taken as printed, docs/papers-002.md says why.
#include "reference/robust.h"
#include "reference/matrices.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace
{
using namespace reference;

enum Kind {
    ROBUST_KF,
    ROBUST_LRF,         // linear: (40)
    ROBUST_SPRF,        // binary gate: (34), r^2 <= gate^2 Xi1; reacquire != 0 makes it SpRF+
    ROBUST_SOFT,        // not in the paper: W = P H' / max(Xi1, r^2 / soft^2)
    ROBUST_SHRF,        // structurally shortened: (25), (29)
    ROBUST_PBF,         // pseudo-Bayesian: (8), (12), (13), one merged Gaussian per step
    ROBUST_AF_GRID,     // adaptive: (14)..(19), distribution of q1 on 50 points
    ROBUST_AF,          // adaptive: q1 <- q1 + (p - q1) / (n + 1) instead of the grid
    ROBUST_CLAIRVOYANT, // told which samples are outliers: the bound
};
const char *const kind_names[] = { "kf", "lrf", "sprf", "soft", "shrf", "pbf", "af_grid", "af", "clairvoyant" };

struct Estimate {
    Vector s;
    Matrix p;
};

Matrix transition(const robust_reference_t &f)
{
    Matrix sigma;
    sigma << 1.0, f.period_s, 0.0, 1.0;
    return sigma;
}

Estimate held(const robust_reference_t &f)
{
    return { Eigen::Map<const Vector>(f.x), Eigen::Map<const Matrix>(f.p) };
}

void hold(robust_reference_t &f, const Estimate &e)
{
    Eigen::Map<Vector>(f.x) = e.s;
    Eigen::Map<Matrix>(f.p) = e.p;
}

Estimate predicted(const robust_reference_t &f, const Estimate &e)
{
    const Matrix sigma = transition(f);
    return { product(sigma, e.s), sum(1.0, congruent(sigma, e.p), 1.0, Matrix(Eigen::Map<const Matrix>(f.q))) };
}

// Xi_i = H P H' + i^2 R0, after (31)
double xi(const robust_reference_t &f, const Matrix &p, double i)
{
    return observed(observed_column(p)) + i * i * f.r;
}

// W_i before (24)
Vector gain(const robust_reference_t &f, const Matrix &p, double i)
{
    return observed_column(p) / xi(f, p, i);
}

// Logarithm of the density (10) of a sample under phi = i, without the common constant
double log_density(const robust_reference_t &f, const Estimate &e, double z, double i)
{
    const double variance = xi(f, e.p, i);
    const double r = z - observed(e.s);
    return -0.5 * std::log(variance) - 0.5 * r * r / variance;
}

// (12) with the a-priori value q1
double posterior(double q1, double log_normal, double log_outlier)
{
    return 1.0 / (1.0 + std::exp(std::log((1.0 - q1) / q1) + log_outlier - log_normal));
}

void note_gain(robust_reference_t &f, const Vector &w)
{
    f.gain[0] = w(0);
    f.gain[1] = w(1);
}

double grid_point(const robust_reference_t &f, int i)
{
    return (f.reading == ROBUST_PRINTED_GRID ? i : i + 0.5) / ROBUST_GRID;
}

double grid_mean(const robust_reference_t &f)
{
    double mean = 0.0;
    for (int i = 0; i < ROBUST_GRID; i++) {
        mean += grid_point(f, i) * f.weight[i];
    }
    return mean;
}

// (17), normalised
void grid_learns(robust_reference_t &f, double log_normal, double log_outlier)
{
    const double odds = std::exp(std::max(log_normal - log_outlier, -700.0));
    double sum = 0.0;
    for (int i = 0; i < ROBUST_GRID; i++) {
        const double q1 = grid_point(f, i);
        f.weight[i] *= q1 * odds + (1.0 - q1);
        sum += f.weight[i];
    }
    std::for_each(f.weight, f.weight + ROBUST_GRID, [sum](double &w) { w /= sum; });
}

// p[phi = 1 / Y], with what the adaptive filters learn of q1
double probability_normal(robust_reference_t &f, const Estimate &e, double z)
{
    const double log_normal = log_density(f, e, z, 1.0);
    const double log_outlier = log_density(f, e, z, f.ratio);
    if (f.kind == ROBUST_AF_GRID) {
        const double prior = grid_mean(f);
        grid_learns(f, log_normal, log_outlier);
        f.q_mean = (f.reading == ROBUST_PRINTED_15) ? grid_mean(f) : prior;
    }
    const double p = posterior(f.q_mean, log_normal, log_outlier);
    if (f.kind == ROBUST_AF) {
        f.q_count += 1.0;
        f.q_mean += (p - f.q_mean) / f.q_count;
    }
    if (f.stay > 0.0) { // (11) with the share of outliers that q1 says
        f.q_mean = 1.0 - f.stay + p * (f.clean + f.stay - 1.0) / f.clean;
    }
    return p;
}

// (8) and (13): the two conditional estimates merged into one Gaussian
Estimate merged(const Estimate &normal, const Estimate &outlier, double p)
{
    const Vector s = sum(p, normal.s, 1.0 - p, outlier.s);
    const Vector d1 = sum(1.0, normal.s, -1.0, s);
    const Vector dn = sum(1.0, outlier.s, -1.0, s);
    return { s, sum(p, sum(1.0, normal.p, 1.0, outer(d1, d1)), 1.0 - p, sum(1.0, outlier.p, 1.0, outer(dn, dn))) };
}

// Kalman's filter under phi = i: (22) with W_i, (26)
Estimate conditional(const robust_reference_t &f, const Estimate &e, double z, double i)
{
    const Vector w = gain(f, e.p, i);
    return { sum(1.0, e.s, z - observed(e.s), w), sum(1.0, e.p, -1.0, product(through(w), e.p)) };
}

void step_pbf(robust_reference_t &f, const Estimate &e, double z)
{
    const double p = f.p_normal = probability_normal(f, e, z);
    const Vector w1 = gain(f, e.p, 1.0);
    const Vector wn = gain(f, e.p, f.ratio);
    Estimate result = merged(conditional(f, e, z, 1.0), conditional(f, e, z, f.ratio), p);
    if (f.reading == ROBUST_PRINTED_26) {
        const Matrix first = product(e.p, product(through(w1), e.p));
        const Vector d = sum(f.innovation, w1, -f.innovation, wn);
        result.p = sum(1.0, sum(p, first, p - 1.0, product(through(wn), e.p)), p * (1.0 - p), outer(d, d));
    }
    note_gain(f, sum(p, w1, 1.0 - p, wn));
    hold(f, result);
}

// (21): both filters go on from their own estimates; only the output is weighted
void step_apart(robust_reference_t &f, const Estimate &normal, double z)
{
    const Estimate before = { Eigen::Map<const Vector>(f.second_x), Eigen::Map<const Matrix>(f.second_p) };
    const Estimate outlier = predicted(f, before);
    f.p_normal = posterior(f.clean, log_density(f, normal, z, 1.0), log_density(f, outlier, z, f.ratio));
    hold(f, conditional(f, normal, z, 1.0));
    const Estimate second = conditional(f, outlier, z, f.ratio);
    Eigen::Map<Vector>(f.second_x) = second.s;
    Eigen::Map<Matrix>(f.second_p) = second.p;
}

void step_shrf(robust_reference_t &f, const Estimate &before, Estimate e, double z)
{
    if (f.reading == ROBUST_PRINTED_25) {
        e.s = product(transition(f), e.s);
        f.innovation = z - observed(e.s);
    }
    const double p = f.p_normal = probability_normal(f, (f.reading == ROBUST_PRINTED_30) ? before : e, z);
    const Matrix p1 = product(keeping(gain(f, e.p, 1.0)), e.p);
    Vector w1 = observed_column(p1) / f.r; // (23)
    if (f.reading == ROBUST_PRINTED_24) {
        w1 = observed_column(e.p) * ((1.0 - xi(f, e.p, 0.0)) / f.r);
    }
    const Vector wm = p * w1;
    const double spread = (f.reading == ROBUST_PRINTED_27) ? 0.0 : p * (1.0 - p) * f.innovation * f.innovation;
    note_gain(f, wm);
    // (29) with W_M L W_M' (1 - p) / p, which is 0 / 0 for p = 0, written as p (1 - p) W1 L W1'
    hold(f, { sum(1.0, e.s, f.innovation, wm), sum(1.0, product(keeping(wm), e.p), spread, outer(w1, w1)) });
}

void step_lrf(robust_reference_t &f, const Estimate &e)
{
    const double r_l = robust_reference_r(&f);
    const Vector w = observed_column(e.p) / (xi(f, e.p, 0.0) + r_l);
    note_gain(f, w);
    hold(f, { sum(1.0, e.s, f.innovation, w), sum(1.0, congruent(keeping(w), e.p), r_l, outer(w, w)) }); // (40)
}

void limit_rate(robust_reference_t &f)
{
    if (f.rate_max > 0.0) {
        f.x[1] = std::clamp(f.x[1], -f.rate_max, f.rate_max);
    }
}

// What the library believes of the rate after a sample refused in a row: nothing after five, half where P11 >= R.
void doubt_rate(robust_reference_t &f, Estimate &e)
{
    f.refused = (f.run == 0) ? 1 : f.refused + 1;
    if (f.kind == ROBUST_SPRF && f.reacquire != 0 && f.refused > 5) {
        e.s(1) = 0.0;
    }
    if (f.doubts && e.p(0, 0) >= f.r) {
        e.s(1) *= 0.5;
    }
}

// Consistency re-acquisition: so many refused raw samples in a row, each near the one before, restart on their slope.
bool reacquired(robust_reference_t &f, double z)
{
    const bool agrees = f.run > 0 && (f.joint ? f.joint_agrees : std::abs(z - f.previous) <= f.agree);
    f.run = agrees ? f.run + 1 : 1;
    if (!agrees) {
        f.first = z;
    }
    if (f.reacquire == 0 || f.run < f.reacquire) {
        return false;
    }
    const double span = (f.run - 1) * f.period_s;
    Estimate e{ Vector(z, (z - f.first) / span), Matrix() };
    e.p << f.r, f.r / span, f.r / span, 2.0 * f.r / (span * span) + f.q[3];
    hold(f, e);
    f.run = 0;
    f.reacquired = true;
    return true;
}

bool within_gate(const robust_reference_t &f, const Estimate &e)
{
    const double xi1 = xi(f, e.p, 1.0);
    if (f.joint) {
        return f.joint_taken;
    }
    if (f.reading == ROBUST_PRINTED_33) {
        return std::abs(f.innovation) <= f.gate_sigma * xi1;
    }
    return f.innovation * f.innovation <= f.gate_sigma * f.gate_sigma * xi1;
}

// (34), and the soft gate, whose update goes on with a larger variance of the innovation
void step_gated(robust_reference_t &f, const Estimate &e, double z)
{
    Estimate now = e;
    f.gated = !within_gate(f, e);
    if (f.gated) {
        doubt_rate(f, now);
    } else {
        f.run = 0;
    }
    hold(f, now);
    if (f.gated && (reacquired(f, z) || f.kind == ROBUST_SPRF)) {
        return;
    }
    double s = xi(f, e.p, 1.0);
    if (f.kind == ROBUST_SOFT) {
        s = std::max(s, f.innovation * f.innovation / (f.softgate_sigma * f.softgate_sigma));
    }
    const Vector w = observed_column(e.p) / s;
    const Matrix keep = keeping(w);
    note_gain(f, w);
    hold(f, { sum(1.0, now.s, f.innovation, w),
              (f.reading == ROBUST_PRINTED_34) ? product(e.p, keep) : product(keep, e.p) });
}

// Median of the samples so far; with the last one the filter runs from it.
double start_median(robust_reference_t &f, double z)
{
    f.start_z[f.collected++] = z;
    std::vector<double> sorted(f.start_z, f.start_z + f.collected);
    std::sort(sorted.begin(), sorted.end());
    const double median = 0.5 * (sorted[static_cast<std::size_t>(f.collected - 1) / 2] +
                                 sorted[static_cast<std::size_t>(f.collected) / 2]);
    Estimate e{ Vector(median, 0.0), Matrix::Zero() };
    e.p(0, 0) = f.r;
    e.p(1, 1) = f.p22_start;
    hold(f, e);
    f.previous = z;
    return median;
}
} // namespace

bool robust_reference_table1(robust_reference_t *f, const char *name)
{
    const auto found = std::find_if(std::begin(kind_names), std::end(kind_names),
                                    [name](const char *each) { return std::strcmp(each, name) == 0; });
    if (found == std::end(kind_names)) {
        return false;
    }
    *f = robust_reference_t{};
    f->kind = static_cast<int>(found - std::begin(kind_names));
    f->period_s = 0.0247;
    f->r = 0.0064;
    f->q[3] = 0.0009;
    f->clean = f->q_mean = 0.85;
    f->ratio = 20.0;
    f->gate_sigma = 3.0;
    f->softgate_sigma = 2.0;
    f->p22_start = 0.04;
    f->x[0] = f->second_x[0] = 2.8;
    f->x[1] = f->second_x[1] = 0.008;
    f->p[0] = f->second_p[0] = 0.7;
    f->p[3] = f->second_p[3] = 0.04;
    std::fill_n(f->weight, ROBUST_GRID, 1.0 / ROBUST_GRID);
    if (f->kind == ROBUST_AF) {
        f->q_mean = 0.5;
        f->q_count = 2.0;
    }
    return true;
}

const char *robust_reference_refused(const robust_reference_t *f)
{
    const struct {
        const char *name;
        bool legal;
    } rules[] = {
        { "r", f->r > 0.0 && std::isfinite(f->r) },
        { "q", f->q[3] > 0.0 && std::isfinite(f->q[3]) },
        { "clean", f->clean > 0.0 && f->clean < 1.0 },
        { "ratio", f->ratio > 1.0 },
        { "gate", f->gate_sigma >= 1.0 },
        { "softgate", f->softgate_sigma >= 1.0 },
        { "median", f->median_window == 0 || (f->median_window % 2 == 1 && f->median_window <= ROBUST_MEDIAN_MAX) },
    };
    for (const auto &rule : rules) {
        if (!rule.legal) {
            return rule.name;
        }
    }
    return nullptr;
}

double robust_reference_r(const robust_reference_t *f)
{
    const double n2 = f->ratio * f->ratio;
    return (f->kind == ROBUST_LRF) ? (f->clean * (1.0 - n2) + n2) * f->r : f->r;
}

double robust_reference_step(robust_reference_t *f, double z)
{
    if (f->collected < f->median_window) {
        return start_median(*f, z);
    }
    const Estimate before = held(*f);
    const Estimate e = (f->reading == ROBUST_PRINTED_39) ? before : predicted(*f, before);
    f->innovation = z - observed(e.s);
    f->gated = f->reacquired = false;
    f->gain[0] = f->gain[1] = 0.0;
    switch (f->kind) {
    case ROBUST_LRF:
        step_lrf(*f, e);
        break;
    case ROBUST_SPRF:
    case ROBUST_SOFT:
        step_gated(*f, e, z);
        break;
    case ROBUST_SHRF:
        step_shrf(*f, before, e, z);
        break;
    case ROBUST_PBF:
    case ROBUST_AF:
    case ROBUST_AF_GRID:
        f->reading == ROBUST_PRINTED_21 ? step_apart(*f, e, z) : step_pbf(*f, e, z);
        break;
    default:
        note_gain(*f, gain(*f, e.p, 1.0));
        hold(*f, conditional(*f, e, z, (f->kind == ROBUST_CLAIRVOYANT && f->outlier) ? f->ratio : 1.0));
        break;
    }
    limit_rate(*f);
    f->previous = z;
    return (f->reading == ROBUST_PRINTED_21) ? f->p_normal * f->x[0] + (1.0 - f->p_normal) * f->second_x[0] : f->x[0];
}

void robust_reference_steady(const robust_reference_t *f, double *p, double *gain_at_rest)
{
    const double r = robust_reference_r(f);
    robust_reference_t at_rest = *f;
    for (int k = 0; k < 20000; k++) {
        const Estimate e = predicted(at_rest, held(at_rest));
        const Vector w = observed_column(e.p) / (xi(*f, e.p, 0.0) + r);
        note_gain(at_rest, w);
        hold(at_rest, { e.s, product(keeping(w), e.p) });
    }
    std::copy_n(at_rest.p, 4, p);
    std::copy_n(at_rest.gain, 2, gain_at_rest);
}

double robust_reference_lyapunov(const robust_reference_t *f, const double *gain_at_rest, double r_true)
{
    const Vector w(gain_at_rest[0], gain_at_rest[1]);
    const Matrix m = product(keeping(w), transition(*f));
    const Matrix c = sum(1.0, congruent(keeping(w), Matrix(Eigen::Map<const Matrix>(f->q))), r_true, outer(w, w));
    Matrix e = c; // E = M E M' + C, the sum of M^k C M'^k
    for (int k = 0; k < 20000; k++) {
        e = sum(1.0, congruent(m, e), 1.0, c);
    }
    return e(0, 0);
}
