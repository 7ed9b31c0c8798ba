// What campaigns/synthesis (papers 000 and 001, and the page of the synthesised filters) asks of C: random numbers, the
// shipped filters, linear filters and the references, many samples at a time; campaigns/resilience (paper 002) asks it
// for names and defaults. A plain C interface for ctypes; arrays are runs x samples.
#include "batch.hpp"
#include "reference/noise.h"

extern "C" {
#include "filter_list.h"
#include "kalman.h"
#include "noise.h"
#include "reference/synthesis.h"
}

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace
{
using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;

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
    return { { { a[0][0], a[1][0], a[2][0] }, { a[0][1], a[1][1], a[2][1] }, { a[0][2], a[1][2], a[2][2] } } };
}

// Predicts P, gives the gains for a measurement of the first state with a variance of 1, updates P.
Vector riccati_step(const Matrix &f, const Matrix &q, Matrix &p)
{
    p = product(product(f, p), transposed(f));
    for (std::size_t i = 0; i < 9; i++) {
        p[i / 3][i % 3] += q[i / 3][i % 3];
    }
    const double s = p[0][0] + 1.0;
    const Vector gains{ p[0][0] / s, p[1][0] / s, p[2][0] / s };
    for (std::size_t i = 0; i < 9; i++) {
        p[i / 3][i % 3] -= s * gains[i / 3] * gains[i % 3];
    }
    return gains;
}

Vector predicted(const Matrix &f, const Vector &x)
{
    Vector result{};
    for (std::size_t i = 0; i < 9; i++) {
        result[i / 3] += f[i / 3][i % 3] * x[i % 3];
    }
    return result;
}
} // namespace

const char *papers::begun(const char *name, int rate_dhz, int count, const char *const *names, const double *values,
                          filter_t *f)
{
    const filter_kind_t kind = filter_find(name);
    if (kind == FILTER_KIND_COUNT) {
        return "not in FILTER_LIST";
    }
    filter_config_t config = filter_defaults(filter_listed(kind), static_cast<std::uint16_t>(rate_dhz));
    for (int k = 0; k < count; k++) {
        bool known = std::strcmp(names[k], "r") == 0; // a filter without one does not ask
        for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
            const filter_parameter_t parameter = parameter_at(kind, i);
            if (std::strcmp(parameter.words, names[k]) == 0) {
                config.value[i] = static_cast<std::int32_t>(
                    std::llround(std::ldexp(values[k], parameter.fraction_bits)));
                known = true;
            }
        }
        if (!known) {
            return "has no such parameter";
        }
    }
    return filter_init(f, filter_listed(kind), &config) == FILTER_ACCEPTED ? nullptr : "refuses these parameters";
}

extern "C" {
double batch_largest_r_lsb2(void)
{
    return FILTER_R_MAX_LSB2_Q8 / 256.0;
}

double batch_largest_rate_drive(void)
{
    return std::ldexp(static_cast<double>(KALMAN_Q22_MAX_UQ26), -26);
}

// Of FILTER_LIST; NULL past its end.
const char *batch_name(int kind)
{
    return kind < FILTER_KIND_COUNT ? filter_listed_name(static_cast<filter_kind_t>(kind)) : nullptr;
}

// The default at a rate; NULL, or what is wrong.
const char *batch_parameter(const char *name, int rate_dhz, const char *parameter, double *value)
{
    const filter_kind_t kind = filter_find(name);
    if (kind == FILTER_KIND_COUNT) {
        return "not in FILTER_LIST";
    }
    const filter_config_t config = filter_defaults(filter_listed(kind), static_cast<std::uint16_t>(rate_dhz));
    for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
        const filter_parameter_t entry = parameter_at(kind, i);
        if (std::strcmp(entry.words, parameter) == 0) {
            *value = std::ldexp(static_cast<double>(config.value[i]), -entry.fraction_bits);
            return nullptr;
        }
    }
    return "has no such parameter";
}

// Normal and uniform numbers by turns, or those that are wanted alone; each run from its own seed.
void batch_draws(const std::uint64_t *seeds, int runs, int samples, double *normal, double *uniform)
{
    for (int run = 0; run < runs; run++) {
        test_random_t random;
        random_seed(&random, seeds[run]);
        for (int k = 0; k < samples; k++) {
            if (normal != nullptr) {
                *normal++ = random_normal(&random);
            }
            if (uniform != nullptr) {
                *uniform++ = random_uniform(&random);
            }
        }
    }
}

// Estimates of a shipped filter, each run from its beginning: by the median of five, or reset to its first sample.
const char *batch_shipped(const char *name, int rate_dhz, int count, const char *const *names, const double *values,
                          double r_lsb2, int reset, int runs, int samples, const double *z_lsb, double *x_lsb_q16)
{
    filter_t initial;
    const char *refused = papers::begun(name, rate_dhz, count, names, values, &initial);
    if (refused != nullptr) {
        return refused;
    }
    filter_set_noise(&initial, static_cast<std::uint32_t>(std::lround(256.0 * r_lsb2)));
    for (int run = 0; run < runs; run++) {
        filter_t f = initial;
        if (reset != 0) {
            filter_reset(&f, as_sample(*z_lsb));
        }
        for (int k = 0; k < samples; k++) {
            *x_lsb_q16++ = filter_update(&f, as_sample(*z_lsb++));
        }
    }
    return nullptr;
}

// R in force at the end of each run.
void batch_noise(int rate_dhz, int runs, int samples, const double *z_lsb, double *r_lsb2_q8)
{
    for (int run = 0; run < runs; run++) {
        noise_t n;
        filter_noise_init(&n, static_cast<std::uint16_t>(rate_dhz), false);
        for (int k = 0; k < samples; k++) {
            (void)filter_noise_update(&n, as_sample(*z_lsb++));
        }
        *r_lsb2_q8++ = filter_noise_r_lsb2_q8(&n);
    }
}

// Estimate, weight, again: see reference/noise.h.
void batch_noise_expected(int rate_dhz, int samples, const double *truth_lsb, double variance_lsb2, double bad,
                          double *expected)
{
    const reference_noise_t of = { truth_lsb, samples, static_cast<std::uint16_t>(rate_dhz), variance_lsb2, bad };
    const reference_noise_estimate_t found = reference_noise_estimate(&of);
    expected[0] = found.estimate;
    expected[1] = found.weight;
    expected[2] = found.again;
}

// Gains of the Kalman filter x = F x + w, cov w = Q, z = x[0] + noise of variance 1, from P = p0 on the first `order`
// states: of each step, or with steps = 0 those of the steady state. Not 0: they do not settle.
int batch_gains(const double *f, const double *q, double p0, int order, int steps, double *gains)
{
    Matrix model;
    Matrix noise;
    Matrix p{};
    std::memcpy(model.data(), f, sizeof model);
    std::memcpy(noise.data(), q, sizeof noise);
    for (std::size_t i = 0; i < static_cast<std::size_t>(order); i++) {
        p[i][i] = p0;
    }
    Vector before{};
    for (int n = 0; n < (steps > 0 ? steps : 200000); n++) {
        const Vector found = riccati_step(model, noise, p);
        std::memcpy(gains, found.data(), sizeof found);
        double change = 0.0;
        for (std::size_t i = 0; i < 3; i++) {
            change = std::fmax(change, std::fabs(found[i] - before[i]));
        }
        if (steps > 0) {
            gains += 3;
        } else if (change < 1e-12) {
            return 0;
        }
        before = found;
    }
    return steps > 0 ? 0 : 1;
}

// Predicts by F, adds gains (of each sample, where they change) times innovation; from x0 at rest, or where that is not
// a number from the first sample.
void batch_linear(const double *f, const double *gains, int changing, double x0, int runs, int samples, const double *z,
                  double *x)
{
    Matrix model;
    std::memcpy(model.data(), f, sizeof model);
    for (int run = 0; run < runs; run++) {
        Vector state{ std::isnan(x0) ? *z : x0, 0.0, 0.0 };
        for (int k = 0; k < samples; k++, z++) {
            if (k > 0 || !std::isnan(x0)) {
                const double *gain = gains + (changing != 0 ? 3 * k : 0);
                const Vector expected = predicted(model, state);
                const double innovation = *z - expected[0];
                for (std::size_t i = 0; i < 3; i++) {
                    state[i] = expected[i] + gain[i] * innovation;
                }
            }
            *x++ = state[0];
        }
    }
}

// The synthesised filter (7), from x0, or from the first sample if x0 is not a number. Gains a1, b0: constant, or of
// each step after the first sample, which then is taken as it is.
void batch_synthesised(const double *gains, int changing, double x0, int runs, int samples, const double *z, double *x)
{
    for (int run = 0; run < runs; run++) {
        const double start = std::isnan(x0) ? *z : x0;
        Vector past{ start, start, start }; // newest first
        for (int k = 0; k < samples; k++, z++) {
            if (changing == 0 || k > 0) {
                const double a1 = gains[changing != 0 ? 2 * k - 2 : 0];
                const double b0 = gains[changing != 0 ? 2 * k - 1 : 1];
                const double expected = (2.0 - a1) * past[0] - (1.0 - 2.0 * a1) * past[1] - a1 * past[2];
                past = { expected + b0 * (*z - expected), past[0], past[1] };
            }
            *x++ = past[0];
        }
    }
}

// Of each step after `before` others: whether (21) could be solved, a1, b0, the true variance from one of 1, Pe, P, and
// the stretch.
void batch_schedule(int kind, int clamped, double r, const double *p, int before, int steps, double *facts)
{
    double s[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    reference_schedule_t f;
    reference_schedule_begin(&f, static_cast<reference_schedule_kind_t>(kind), r, p);
    f.clamped = clamped != 0;
    for (int n = 0; n < before; n++) {
        reference_schedule_step(&f);
    }
    for (int n = 0; n < steps; n++) {
        const bool solved = reference_schedule_step(&f);
        reference_covariance_step(s, f.a1, f.b0, r);
        const double step[7] = { solved ? 1.0 : 0.0, f.a1, f.b0, s[0], f.pe, f.p[0], f.stretch };
        std::memcpy(facts, step, sizeof step);
        facts += 7;
    }
}

// a1 and b0 of each step of the schedule of the exact covariance, from one common error of variance p0.
void batch_exact(double r, double a1_min, double p0, int steps, double *gains)
{
    const double s[9] = { p0, p0, p0, p0, p0, p0, p0, p0, p0 };
    reference_exact_t f;
    reference_exact_begin(&f, r, a1_min, 0.0, s);
    for (int n = 0; n < steps; n++) {
        reference_exact_step(&f);
        *gains++ = f.a1;
        *gains++ = f.b0;
    }
}
}
