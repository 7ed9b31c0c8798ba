// What the figures of paper 002 and the comparison with other people's filters ask of C: realisations sample by sample,
// and every sample of a filter in double. A plain C interface for ctypes; arrays are runs x samples.
#include "papers/model.hpp"
#include "reference/robust_joint.h"

#include <cstddef>
#include <vector>

namespace
{
struct Facts {
    double *x;
    double *p11;
    double *abnormal; // posterior probability that the sample is an outlier
    double *q_mean;   // of q1, before the sample
};

// As the library re-acquires, or with 0 never.
void come_back(robust_reference_t &f, int reacquire, double rate_max)
{
    f.reacquire = reacquire;
    f.rate_max = rate_max;
    f.agree = 3.0 * 0.11313708498984761 + rate_max * papers::period_s; // 3 sqrt(2 R)
    f.doubts = reacquire != 0;
}
} // namespace

extern "C" {
void trace_realisations(const papers::Scenario *scenario, const std::uint64_t *seeds, int runs, int samples,
                        double *truth, double *y, double *outlier)
{
    for (int run = 0; run < runs; run++) {
        papers::Realisation realisation(*scenario, seeds[run]);
        for (int k = 0; k < samples; k++) {
            const papers::Sample &s = realisation.at(k);
            *truth++ = s.truth;
            *y++ = s.y;
            *outlier++ = s.outlier ? 1.0 : 0.0;
        }
    }
}

// A gated filter with Table 1 and the library's re-acquisition for each of several components, under one gate: its
// limit on the sum of their squares in sigmas; y, x: components x runs x samples. Not 0: refused.
int trace_joint(const char *name, double limit, int reacquire, double rate_max, int components, int runs, int samples,
                const double *y, double *x)
{
    std::vector<robust_reference_t> initial(static_cast<std::size_t>(components));
    for (robust_reference_t &f : initial) {
        if (!robust_reference_table1(&f, name)) {
            return 1;
        }
        come_back(f, reacquire, rate_max);
    }
    std::vector<double> now(initial.size());
    std::vector<double> estimate(initial.size());
    for (int run = 0; run < runs; run++) {
        std::vector<robust_reference_t> f = initial;
        for (int k = 0; k < samples; k++) {
            const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(run) * samples + k;
            const std::ptrdiff_t apart = static_cast<std::ptrdiff_t>(runs) * samples;
            for (int i = 0; i < components; i++) {
                now[static_cast<std::size_t>(i)] = y[i * apart + at];
            }
            robust_reference_step_joint(f.data(), components, now.data(), limit, estimate.data());
            for (int i = 0; i < components; i++) {
                x[i * apart + at] = estimate[static_cast<std::size_t>(i)];
            }
        }
    }
    return 0;
}

// A filter of reference/robust.h with Table 1, each run from its beginning; reacquire and rate_max as the library has
// them, or 0 as published. facts: x, P11, probability of an outlier, mean of q1, each runs x samples. density: what the
// grid thinks of q1 after each sample of the first run, samples x ROBUST_GRID, or NULL. Not 0: refused.
int trace_reference(const char *name, double gate_sigma, int reacquire, double rate_max, double stay, int runs,
                    int samples, const double *y, const double *outlier, double *facts, double *density)
{
    robust_reference_t initial;
    if (!robust_reference_table1(&initial, name)) {
        return 1;
    }
    initial.gate_sigma = gate_sigma;
    come_back(initial, reacquire, rate_max);
    initial.stay = stay;
    if (robust_reference_refused(&initial) != nullptr) {
        return 1;
    }
    const int all = runs * samples;
    Facts to{ facts, facts + all, facts + 2 * all, facts + 3 * all };
    for (int run = 0; run < runs; run++) {
        robust_reference_t f = initial;
        for (int k = 0; k < samples; k++) {
            f.outlier = *outlier++ != 0.0;
            *to.q_mean++ = f.q_mean;
            *to.x++ = robust_reference_step(&f, *y++);
            *to.p11++ = f.p[0];
            *to.abnormal++ = 1.0 - f.p_normal;
            for (int i = 0; density != nullptr && run == 0 && i < ROBUST_GRID; i++) {
                *density++ = f.weight[i];
            }
        }
    }
    return 0;
}
}
