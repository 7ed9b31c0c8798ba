// Algorithm (22) of paper 000 without data: its gains are made of P and R alone, and are looked at as such. Then what
// the filters with these gains do to the roll.
#include "experiments_000.hpp"
#include "roll.hpp"

extern "C" {
#include "reference/synthesis.h"
#include "support/random.h"
}

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace papers::roll
{
namespace
{
constexpr int starts = 400;
constexpr int paper_steps = samples - 1; // the paper's 15 s
constexpr int long_after = 8000;
constexpr std::uint64_t schedule_seed = 22; // no run of another seed: a fact about the equations

const char *name_of(int kind)
{
    static const char *const names[SCHEDULE_COUNT] = { "printed", "square", "corrected", "uncorrelated",
                                                       "uncorrelated_optimum" };
    return names[kind];
}

// Of each start, over its steps.
struct Facts {
    std::vector<double> inside; // shares of the samples
    std::vector<double> pe_negative;
    std::vector<double> p_negative;
    std::vector<double> growth;   // mean logarithm per step by which neighbours part
    std::vector<double> variance; // mean of the true one by R
    int period = 0;               // of all starts; 0: not the same for all, or none to 64
};

int period_of(const std::vector<double> &gains)
{
    for (std::size_t period = 1; period <= 64; period++) {
        const auto same = [&](double a, double b) { return std::fabs(a - b) < 1e-9; };
        if (std::equal(gains.begin() + static_cast<std::ptrdiff_t>(period), gains.end(), gains.begin(), same)) {
            return static_cast<int>(period);
        }
    }
    return 0;
}

void follow(reference_schedule_t &f, int before, Facts &facts, bool first)
{
    double s[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    for (int n = 0; n < before; n++) {
        reference_schedule_step(&f);
    }
    constexpr double each = 1.0 / paper_steps;
    std::vector<double> gains;
    double inside = 0.0;
    double pe_negative = 0.0;
    double p_negative = 0.0;
    double growth = 0.0;
    double variance = 0.0;
    for (int n = 0; n < paper_steps; n++) {
        reference_schedule_step(&f);
        reference_covariance_step(s, f.a1, f.b0, f.r);
        gains.push_back(f.b0);
        variance += s[0] * each;
        inside += reference_printed_region(f.a1, f.b0) ? each : 0.0;
        pe_negative += f.pe < 0.0 ? each : 0.0;
        p_negative += f.p[0] < 0.0 ? each : 0.0;
        growth += f.stretch * each;
    }
    facts.inside.push_back(inside);
    facts.pe_negative.push_back(pe_negative);
    facts.p_negative.push_back(p_negative);
    facts.growth.push_back(growth);
    facts.variance.push_back(variance);
    const int period = period_of(gains);
    facts.period = (first || facts.period == period) ? period : 0;
}

// Each P of the start anywhere from 0.05 R to 50 R on a logarithmic scale.
Facts facts_of(int kind, bool clamped, int before)
{
    test_random_t random;
    random_seed(&random, schedule_seed);
    Facts facts;
    for (int start = 0; start < starts; start++) {
        double p[5];
        std::generate(p, p + 5, [&] { return 0.05 * std::pow(1000.0, random_uniform(&random)); });
        reference_schedule_t f;
        reference_schedule_begin(&f, static_cast<reference_schedule_kind_t>(kind), 1.0, p);
        f.clamped = clamped;
        follow(f, before, facts, start == 0);
    }
    return facts;
}

void fact_rows(const std::string &experiment, const std::string &name, const Facts &facts)
{
    const auto one = [&](const char *metric, double value) {
        row(experiment, name, Arithmetic::in_double, metric, value, 1);
    };
    const auto mean = [&](const char *metric, const std::vector<double> &of_starts) {
        double sd = 0.0;
        row(experiment, name, Arithmetic::in_double, metric, mean_of(of_starts, sd), 1);
    };
    mean("in_region", facts.inside);
    mean("pe_negative", facts.pe_negative);
    mean("p_negative", facts.p_negative);
    mean("growth", facts.growth);
    one("true_variance_median", quantile(facts.variance, 0.5));
    one("true_variance_mean", total(facts.variance) / static_cast<double>(facts.variance.size()));
    one("period", facts.period);
}

// The filter (7) with a schedule's gains; not a number once (21) divides by zero.
Maker scheduled(int kind, bool clamped, double r = r_deg2)
{
    const double flat[5] = { p0_deg2, p0_deg2, p0_deg2, p0_deg2, p0_deg2 };
    reference_schedule_t begun;
    reference_schedule_begin(&begun, static_cast<reference_schedule_kind_t>(kind), r, flat);
    begun.clamped = clamped;
    return [begun] {
        return [f = begun, x = std::array<double, 3>{}, first = true](double z) mutable {
            if (first) {
                first = false;
                x.fill(z);
                return z;
            }
            if (!reference_schedule_step(&f)) {
                x.fill(std::numeric_limits<double>::quiet_NaN());
            }
            const double expected = (2.0 - f.a1) * x[0] - (1.0 - 2.0 * f.a1) * x[1] - f.a1 * x[2];
            x = { expected + f.b0 * (z - expected), x[0], x[1] };
            return x[0];
        };
    };
}

Maker exactly_scheduled()
{
    std::array<double, 9> s{};
    s.fill(p0_deg2); // one unknown, common error of the three
    reference_exact_t begun;
    reference_exact_begin(&begun, r_deg2, -1.0 / 3.0, 0.0, s.data());
    return [begun] {
        return [f = begun, x = std::array<double, 3>{}, first = true](double z) mutable {
            if (first) {
                first = false;
                x.fill(z);
                return z;
            }
            reference_exact_step(&f);
            const double expected = (2.0 - f.a1) * x[0] - (1.0 - 2.0 * f.a1) * x[1] - f.a1 * x[2];
            x = { expected + f.b0 * (z - expected), x[0], x[1] };
            return x[0];
        };
    };
}

void roll_rows(const std::string &name, const Maker &maker)
{
    for (const char *turn : { "ramp30", "cos60", "bump30" }) {
        const Exact value = exact(maker, profile(turn));
        for (std::size_t w = 0; w < window_count; w++) {
            const double mse = std::isfinite(value.mse_deg2[w]) ? value.mse_deg2[w] : HUGE_VAL;
            row(std::string("algorithm_22_") + turn, name, Arithmetic::in_double, std::string("mse_") + windows[w].name,
                mse, 1);
        }
    }
}
// The paper gives no R, and the schedule's course hangs on P(0) / R: any of 0.20, 0.21 .. 1.00.
void any_r_rows()
{
    std::array<std::vector<double>, window_count> all;
    for (int hundredth = 20; hundredth <= 100; hundredth++) {
        const double r = hundredth / 100.0;
        const Exact value = exact(scheduled(SCHEDULE_PRINTED, false, r), profile("cos60"), r);
        for (std::size_t w = 0; w < window_count; w++) {
            all[w].push_back(value.mse_deg2[w]);
        }
    }
    for (std::size_t w = 0; w < window_count; w++) {
        const std::string metric = std::string("mse_") + windows[w].name;
        row("algorithm_22_any_r", "printed", Arithmetic::in_double, metric + "_least", quantile(all[w], 0.0), 1);
        row("algorithm_22_any_r", "printed", Arithmetic::in_double, metric + "_median", quantile(all[w], 0.5), 1);
    }
}
} // namespace

void schedules(const Options &)
{
    Progress progress(2.0 * SCHEDULE_COUNT);
    for (int clamped = 0; clamped < 2; clamped++) {
        for (int kind = 0; kind < SCHEDULE_COUNT; kind++) {
            const std::string name = name_of(kind) + std::string(clamped != 0 ? "_clamped" : "");
            if (clamped == 0 || kind < SCHEDULE_UNCORRELATED) { // the others are held in the safe region by themselves
                fact_rows("schedule_15_s", name, facts_of(kind, clamped != 0, 0));
                fact_rows("schedule_later", name, facts_of(kind, clamped != 0, long_after));
                roll_rows(name, scheduled(kind, clamped != 0));
            }
            progress.advance();
        }
    }
    roll_rows("exact_covariance", exactly_scheduled());
    any_r_rows();
}
} // namespace papers::roll
