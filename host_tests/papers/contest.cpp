// What the experiments of paper 002 (campaigns/resilience) ask of C: its filters, in double and as shipped, over the
// same realisations. A plain C interface for ctypes; a filter is a handle that lasts, arrays are filters x runs.
#include "batch.hpp"
#include "model.hpp"
#include "reference/robust.h"
#include "scope.hpp"

extern "C" {
#include "support/laws.h"
}

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace papers
{
namespace
{
constexpr double never = std::numeric_limits<double>::infinity();
constexpr int samples = 400;
constexpr int warm_up_rows = 5;
constexpr int in_a_row = 10;
constexpr int longest_return = 600; // after a burst

// As before its first sample after restart.
class Filter
{
  public:
    virtual ~Filter() = default;
    virtual void restart() = 0;
    virtual double step(double y_deg) = 0;
    virtual bool refused() const = 0;
    virtual double gain() const = 0;
    virtual double share() const = 0;        // of normal samples as the filter has it, q1
    virtual void reveal(bool /*outlier*/) {} // for the clairvoyant, before the step
};

// Over a state of either arithmetic, which restarts as it was at first.
template <typename State> class FilterOf : public Filter
{
  public:
    explicit FilterOf(const State &initial) : f_(initial), initial_(initial) {}
    void restart() final
    {
        f_ = initial_;
    }

  protected:
    State f_;

  private:
    State initial_;
};

class DoubleFilter final : public FilterOf<robust_reference_t>
{
  public:
    using FilterOf::FilterOf;
    double step(double y_deg) override
    {
        return robust_reference_step(&f_, y_deg);
    }
    bool refused() const override
    {
        return f_.gated;
    }
    double gain() const override
    {
        return f_.gain[0];
    }
    double share() const override
    {
        return f_.q_mean;
    }
    void reveal(bool outlier) override
    {
        f_.outlier = outlier;
    }
};

class FixedFilter final : public FilterOf<filter_t>
{
  public:
    using FilterOf::FilterOf;
    double step(double y_deg) override
    {
        return filter_update(&f_, as_sample(y_deg / lsb_deg)) * (lsb_deg / 65536.0);
    }
    bool refused() const override
    {
        return (f_.flags & FILTER_GATED) != 0;
    }
    double gain() const override
    {
        filter_probe_t probe;
        filter_probe(&f_, &probe);
        return probe.gain_uq16 / 65536.0;
    }
    double share() const override // of a filter that learns it
    {
        return f_.own.mixture.normal_uq24 / 16777216.0;
    }
};

std::uint32_t fixed(double value, int fraction_bits)
{
    return static_cast<std::uint32_t>(
        std::lround(std::ldexp(std::fmin(value, std::ldexp(1.0, 31 - fraction_bits)), fraction_bits)));
}

// Table 1's estimate and P. A law holds P in units of its R (lrf: R_L), with T = 1 sample.
bool begin_table1(filter_t &f)
{
    const auto x_q16 = static_cast<std::int32_t>(fixed(2.8 / lsb_deg, 16));
    const auto rate_q16 = static_cast<std::int32_t>(fixed(0.008 * period_s / lsb_deg, 16));
    const auto per_r = [](double variance_deg2, std::uint32_t r_lsb2_q8) {
        return variance_deg2 / (r_lsb2_q8 / 256.0 * lsb_deg * lsb_deg);
    };
    constexpr double p11_deg2 = 0.7;
    constexpr double p22_deg2 = 0.04 * period_s * period_s;
    if (f.law->start == filter_kalman_start) {
        const std::uint32_t r = f.own.kalman.r_lsb2_q8;
        kalman_from(&f, x_q16, rate_q16, { fixed(per_r(p11_deg2, r), 28), 0, fixed(per_r(p22_deg2, r), 28) });
        return true;
    }
    if (f.law->report == filter_wide_report) {
        const std::uint32_t r = f.own.wide.r_lsb2_q8;
        wide_from(&f, x_q16, rate_q16, { fixed(per_r(p11_deg2, r), 16), 0, fixed(per_r(p22_deg2, r), 28) });
        return true;
    }
    return false;
}

// Settles for a random number of samples, so that a step meets the filter in any phase.
int settling(std::uint64_t seed)
{
    test_random_t random;
    random_seed(&random, seed ^ 0x5555555555555555U);
    return 100 + static_cast<int>(random_below(&random, 100));
}

// Samples from `from` on until the first of ten in a row with an error below back_deg; infinite when not within limit.
double samples_to_return(Filter &f, Realisation &realisation, int from, int limit, double back_deg)
{
    f.restart();
    for (int k = 0; k < from; k++) {
        (void)f.step(realisation.at(k).y);
    }
    int good = 0;
    for (int k = from; k < from + limit + in_a_row; k++) {
        const Sample &s = realisation.at(k);
        good = (std::abs(f.step(s.y) - s.truth) < back_deg) ? good + 1 : 0;
        if (good == in_a_row) {
            return k - from - in_a_row + 1; // 0: at once
        }
    }
    return never;
}

// Peak of the error from the burst's first sample on, and samples from its end until back.
void through_burst(Filter &f, Realisation &realisation, const Scenario &scenario, double sigma_ss, double *peak,
                   double *back)
{
    const int from = scenario.burst_at;
    const int end = from + scenario.burst_length;
    int good = 0;
    *peak = 0.0;
    *back = never;
    f.restart();
    for (int k = 0; k < end + longest_return; k++) {
        const Sample &s = realisation.at(k);
        const double error = std::abs(f.step(s.y) - s.truth) / sigma_ss;
        if (k < from) {
            continue;
        }
        *peak = std::max(*peak, error);
        good = (k >= end && error < 4.0) ? good + 1 : 0;
        if (good == in_a_row) {
            *back = k - end - in_a_row + 1;
            return;
        }
    }
}

// Square errors in the steady state, of the start and of the start without the rows of the warm-up; whether the filter
// is outside for all of the last hundred samples. errors: of each sample.
bool score(Filter &f, Realisation &realisation, double back_deg, std::array<double, 3> &sum, double *errors)
{
    bool locked = true;
    f.restart();
    for (int k = 0; k < samples; k++) {
        const Sample &s = realisation.at(k);
        f.reveal(s.outlier);
        const double error = f.step(s.y) - s.truth;
        // a filter that has left the world of numbers is as wrong as can be
        const double square = std::isfinite(error) ? std::fmin(error * error, 1e12) : 1e12;
        *errors++ = std::copysign(std::sqrt(square), error);
        sum[0] += (k >= 200) ? square : 0.0;
        sum[1] += (k < 60) ? square : 0.0;
        sum[2] += (k >= warm_up_rows && k < 60) ? square : 0.0;
        locked = locked && (k < samples - 100 || square >= back_deg * back_deg);
    }
    return locked;
}

// counts: samples that are no outliers, outliers, false alarms, misses. The steady square error.
double gated(Filter &f, Realisation &realisation, double *counts)
{
    double sum = 0.0;
    f.restart();
    for (int k = 0; k < samples; k++) {
        const Sample &s = realisation.at(k);
        const double error = f.step(s.y) - s.truth;
        sum += (k >= 200) ? error * error : 0.0;
        if (k >= 100) {
            counts[s.outlier ? 1 : 0] += 1.0;
            counts[2] += !s.outlier && f.refused();
            counts[3] += s.outlier && !f.refused();
        }
    }
    return sum;
}
} // namespace
} // namespace papers

using papers::Filter;
using papers::Scenario;

extern "C" {
// A filter in double by its name in reference/robust.h, Table 1 with what differs from it; p22_start 0: Table 1's, else
// that variance of the rate, at most p22_limit_r times R. NULL: refused.
Filter *contest_in_double(const char *name, int reading, double r_factor, double gate_sigma, int reacquire,
                          double rate_max, int median_window, double p22_start, double p22_limit_r, double stay)
{
    robust_reference_t f;
    if (!robust_reference_table1(&f, name)) {
        return nullptr;
    }
    f.reading = static_cast<robust_reading_t>(reading);
    f.r *= r_factor;
    f.gate_sigma = gate_sigma;
    f.stay = stay;
    f.reacquire = reacquire;
    if (reacquire != 0) {
        f.rate_max = rate_max;
        f.agree = 3.0 * std::sqrt(2.0 * f.r) + rate_max * papers::period_s;
        f.doubts = true;
    }
    f.median_window = median_window;
    if (p22_start > 0.0) {
        f.p22_start = std::min(p22_start, p22_limit_r * f.r / (papers::period_s * papers::period_s));
    }
    return robust_reference_refused(&f) == nullptr ? new papers::DoubleFilter(f) : nullptr;
}

// A shipped one with parameters by their names in the descriptor. NULL, or what is wrong.
const char *contest_fixed(const char *name, int rate_dhz, int count, const char *const *names, const double *values,
                          int table1, Filter **made)
{
    filter_t f;
    const char *refused = papers::begun(name, rate_dhz, count, names, values, &f);
    if (refused == nullptr && table1 != 0 && !papers::begin_table1(f)) {
        refused = "cannot start from Table 1";
    }
    *made = refused == nullptr ? new papers::FixedFilter(f) : nullptr;
    return refused;
}

int contest_of_the_paper(const char *name)
{
    return papers::of_paper_002(name) ? 1 : 0;
}

int contest_learns(const char *name)
{
    return law_facts(filter_find(name)).learns ? 1 : 0;
}

double contest_gain_at_rest(Filter *f, double y_deg, int count)
{
    f->restart();
    for (int k = 0; k < count; k++) {
        (void)f->step(y_deg);
    }
    return f->gain();
}

// Of a linear filter: P (row-major) and gain at rest, its R for good samples and for both kinds, and the variances of
// its error in white noise of the variances given.
void contest_at_rest(const char *name, double *p, double *gain, double *r, int count, const double *noise,
                     double *variance)
{
    robust_reference_t f;
    (void)robust_reference_table1(&f, name);
    robust_reference_steady(&f, p, gain);
    r[0] = f.r;
    r[1] = robust_reference_r(&f);
    for (int i = 0; i < count; i++) {
        variance[i] = robust_reference_lyapunov(&f, gain, noise[i]);
    }
}

// Scenarios with a step between two sizes in sigma, to either side, in a random phase. outliers below 0: 0 to 30 %.
void contest_steps(const std::uint64_t *seeds, int runs, double outliers, double low_sigma, double high_sigma,
                   Scenario *scenarios)
{
    for (int run = 0; run < runs; run++) {
        test_random_t random;
        random_seed(&random, ~seeds[run]);
        scenarios[run].outliers = outliers < 0.0 ? 0.3 * random_uniform(&random) : outliers;
        scenarios[run].step_at = papers::settling(seeds[run]);
        scenarios[run].step_sigma = low_sigma + (high_sigma - low_sigma) * random_uniform(&random);
        scenarios[run].step_sigma *= (random_u32(&random) & 1U) != 0U ? 1.0 : -1.0;
    }
}

// squares: filters x windows x runs; locked: runs in which each is; errors: filters x runs x samples.
void contest_score(Filter *const *filters, int count, const Scenario *scenario, const std::uint64_t *seeds, int runs,
                   const double *back_deg, double *squares, double *locked, double *errors)
{
    for (int run = 0; run < runs; run++) {
        papers::Realisation realisation(*scenario, seeds[run]);
        for (int i = 0; i < count; i++) {
            std::array<double, 3> sum{};
            locked[i] += papers::score(*filters[i], realisation, back_deg[i], sum,
                                       errors + static_cast<std::ptrdiff_t>(i * runs + run) * papers::samples);
            for (int window = 0; window < 3; window++) {
                squares[(3 * i + window) * runs + run] = sum[static_cast<std::size_t>(window)];
            }
        }
    }
}

// Mean over the runs of q1 as a filter has it after each sample: filters x samples; within: after how many samples it
// stays within a part of the truth, filters x runs.
void contest_shares(Filter *const *filters, int count, const Scenario *scenario, const std::uint64_t *seeds, int runs,
                    double part, double *mean, double *within)
{
    for (int run = 0; run < runs; run++) {
        papers::Realisation realisation(*scenario, seeds[run]);
        for (int i = 0; i < count; i++) {
            filters[i]->restart();
            for (int k = 0; k < papers::samples; k++) {
                (void)filters[i]->step(realisation.at(k).y);
                const double share = filters[i]->share();
                mean[i * papers::samples + k] += share / runs;
                if (std::abs(share - papers::clean) > part * papers::clean) {
                    within[i * runs + run] = k + 2;
                }
            }
        }
    }
}

void contest_gate(Filter *const *filters, int count, const Scenario *scenario, const std::uint64_t *seeds, int runs,
                  double *squares, double *counts)
{
    for (int run = 0; run < runs; run++) {
        papers::Realisation realisation(*scenario, seeds[run]);
        for (int i = 0; i < count; i++) {
            squares[i * runs + run] = papers::gated(*filters[i], realisation, counts + 4 * i);
        }
    }
}

void contest_return(Filter *const *filters, int count, const Scenario *scenarios, const std::uint64_t *seeds, int runs,
                    const int *limits, const double *back_deg, double *found)
{
    for (int run = 0; run < runs; run++) {
        papers::Realisation realisation(scenarios[run], seeds[run]);
        for (int i = 0; i < count; i++) {
            found[i * runs + run] = papers::samples_to_return(*filters[i], realisation, scenarios[run].step_at,
                                                              limits[i], back_deg[i]);
        }
    }
}

void contest_burst(Filter *const *filters, int count, int length, const std::uint64_t *seeds, int runs, double sigma_ss,
                   double *peak, double *back)
{
    for (int run = 0; run < runs; run++) {
        Scenario scenario;
        scenario.outliers = 0.0;
        scenario.burst_at = papers::settling(seeds[run]);
        scenario.burst_length = length;
        papers::Realisation realisation(scenario, seeds[run]);
        for (int i = 0; i < count; i++) {
            papers::through_burst(*filters[i], realisation, scenario, sigma_ss, peak + i * runs + run,
                                  back + i * runs + run);
        }
    }
}
}
