// Paper 003, 3.4: the flight in closed loop, the cases that the printed figures may belong to.
#include "navigation.hpp"

#include "../model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace papers::navigation
{
namespace
{
constexpr int runs_of_a_flight = 50;
constexpr int most_flights = 200; // of a case: so many that no verdict hangs on the seed
constexpr int near_a_limit = 5;   // times as many where the median is near a limit of what is printed
constexpr double degree = 57.29577951308232;
constexpr int lost = 160; // s: GPS is there up to here and again from 400 s on
constexpr int back = 399;
constexpr int roll = 0;
constexpr int pitch = 1;
constexpr int heading = 2;

struct Case {
    const char *name;
    const nav_variant_t *variant;
    const flight_drift_t *drift;
    double walk_scale;
    int field_every;
};

struct Metric {
    const char *name;
    double (*of)(const nav_flight_t &flight);
};

double distance(const nav_flight_t &flight, int t)
{
    return nav_worst_position(&flight, t - 1, t);
}

double heading_rms(const nav_flight_t &flight)
{
    double square = 0.0;
    for (int t = lost; t < back; t++) {
        square += flight.second[t].euler[heading] * flight.second[t].euler[heading];
    }
    return std::sqrt(square / (back - lost));
}

constexpr std::array<Metric, 7> metrics{ {
    { "heading_40_160", [](const nav_flight_t &f) { return degree * nav_worst_euler(&f, heading, 40, lost); } },
    { "heading_without_gps", [](const nav_flight_t &f) { return degree * nav_worst_euler(&f, heading, lost, back); } },
    { "heading_rms_without_gps", [](const nav_flight_t &f) { return degree * heading_rms(f); } },
    { "level_without_gps",
      [](const nav_flight_t &f) {
          return degree * std::max(nav_worst_euler(&f, roll, lost, back), nav_worst_euler(&f, pitch, lost, back));
      } },
    { "position_60_s", [](const nav_flight_t &f) { return distance(f, lost + 60); } },
    { "position_120_s", [](const nav_flight_t &f) { return distance(f, lost + 120); } },
    { "position_239_s", [](const nav_flight_t &f) { return distance(f, back); } },
} };

// Median with an interval between two order statistics: the narrowest symmetric one that holds the true median with
// 95 %, by the binomial distribution; of fewer than six from the least to the most.
Interval median_of(std::vector<double> values)
{
    const auto n = static_cast<int>(values.size());
    std::sort(values.begin(), values.end());
    double chance = std::pow(0.5, n); // of k of them below the median
    double below = chance;
    int k = 0;
    while (2 * (k + 1) < n) {
        chance *= static_cast<double>(n - k) / (k + 1);
        if (below + chance > 0.025) {
            break;
        }
        below += chance;
        k++;
    }
    return { quantile(values, 0.5), values[static_cast<std::size_t>(k)], values[static_cast<std::size_t>(n - 1 - k)] };
}

nav_plan_t plan_of(const Case &which)
{
    nav_plan_t plan{};
    plan.variant = which.variant;
    plan.drift = which.drift;
    plan.walk_scale = which.walk_scale;
    plan.field_every = which.field_every;
    plan.at_once = which.field_every == 1; // the queue cannot take 100 Hz
    plan.note_at = FLIGHT_RATE - 1;
    plan.seconds = FLIGHT_SECONDS;
    return plan;
}

using Values = std::array<std::vector<double>, metrics.size()>;

void fly(const Case &which, std::uint32_t seed, Values &values)
{
    const auto flight = std::make_unique<nav_flight_t>();
    nav_plan_t plan = plan_of(which);
    plan.seed = seed;
    nav_fly(flight.get(), &plan);
    for (std::size_t m = 0; m < metrics.size(); m++) {
        values[m].push_back(metrics[m].of(*flight));
    }
}

// Flight by flight, as cases of one drift have the same samples.
void fly_all(const char *experiment, const std::vector<Case> &cases, const Options &options, int times = 1)
{
    const int flights = times * std::clamp(options.runs / runs_of_a_flight, 1, most_flights);
    std::vector<Values> values(cases.size());
    for (int i = 0; i < flights; i++) {
        const auto seed = static_cast<std::uint32_t>(run_seed(options.seed, static_cast<std::uint64_t>(i)));
        for (std::size_t c = 0; c < cases.size(); c++) {
            fly(cases[c], seed, values[c]);
        }
    }
    for (std::size_t c = 0; c < cases.size(); c++) {
        for (std::size_t m = 0; m < metrics.size(); m++) {
            row(experiment, cases[c].name, arithmetic_of(*cases[c].variant), metrics[m].name, median_of(values[c][m]),
                flights);
        }
    }
}
} // namespace

void closed_loop(const Options &options)
{
    fly_all("closed_loop",
            { { "9_states(q1:1_hz)", &n9f, &flight_no_drift, 1.0, 100 },
              { "9_states(q1:10_hz)", &n9f, &flight_no_drift, 1.0, 10 },
              { "9_states_drift(q1:1_hz)", &n9f, &flight_gyro_drift, 1.0, 100 },
              { "12_states_drift(q1:1_hz)", &n12f, &flight_gyro_drift, 1.0, 100 },
              { "12_states_drift(q1:10_hz)", &n12f, &flight_gyro_drift, 1.0, 10 },
              { "12_states_drift(q25:1_hz)", &n12f, &flight_gyro_drift, 25.0, 100 },
              { "12_states_drift(q2:10_hz)", &n12f, &flight_gyro_drift, 2.0, 10 },
              { "12_states_both_drifts(q25:1_hz)", &n12f, &flight_both_drifts, 25.0, 100 } },
            options);
}

void closed_loop_100_hz(const Options &options)
{
    fly_all("closed_loop_100_hz",
            { { "9_states(q1:100_hz)", &n9d, &flight_no_drift, 1.0, 1 },
              { "9_states_drift(q1:100_hz)", &n9d, &flight_gyro_drift, 1.0, 1 },
              { "12_states_drift(q1:100_hz)", &n12d, &flight_gyro_drift, 1.0, 1 },
              { "12_states_drift(q25:100_hz)", &n12d, &flight_gyro_drift, 25.0, 1 } },
            options);
}

void closed_loop_100_hz_25_q(const Options &options)
{
    fly_all("closed_loop_100_hz", { { "9_states_drift(q25:100_hz)", &n9d, &flight_gyro_drift, 25.0, 1 } }, options,
            near_a_limit);
}
} // namespace papers::navigation
