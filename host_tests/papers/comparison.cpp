// The synthesised filter against others that pass as much noise: what they lose while the roll turns.
#include "experiments_000.hpp"
#include "linear.hpp"
#include "roll.hpp"

extern "C" {
#include "reference/synthesis.h"
}

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

namespace papers::roll
{
namespace
{
struct Pair {
    double a1;
    double b0;
};
// the paper's point, what the paper's region has of least noise, the shipped preset, and one outside the region
constexpr std::array<Pair, 5> levels{ { { -0.3, 0.1 }, { 0.0, 0.1 }, { 0.0, 0.3 }, { -0.1, 0.3 }, { 0.9, 0.3 } } };

using OfParameter = std::function<Maker(double)>;

// A family and the ends of its parameter; the noise gain rises from the first to the second.
struct Family {
    const char *name;
    OfParameter make;
    double quiet;
    double loud;
    bool logarithmic;
};

const std::vector<Family> &families()
{
    static const std::vector<Family> all = {
        { "kf2_rate", [](double l) { return steady_kalman(white_rate(l)); }, 1e-6, 1e4, true },
        { "kf2_acceleration", [](double l) { return steady_kalman(white_acceleration(l)); }, 1e-6, 1e4, true },
        { "kf3_singer", [](double l) { return steady_kalman(singer(l, 0.9)); }, 1e-8, 1e4, true },
        { "alpha_beta_gamma", [](double l) { return steady_kalman(white_jerk(l)); }, 1e-8, 1e4, true },
        { "fading_memory_1", [](double theta) { return fading_memory(1, theta); }, 0.98, 0.01, false },
        { "fading_memory_2", [](double theta) { return fading_memory(2, theta); }, 0.98, 0.01, false },
    };
    return all;
}

// The member of a family with this noise gain, by halving.
Maker with_noise_gain(const Family &family, double wanted)
{
    const auto at = [&](double part) {
        return family.logarithmic ? family.quiet * std::pow(family.loud / family.quiet, part)
                                  : family.quiet + part * (family.loud - family.quiet);
    };
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 40; i++) {
        const double middle = 0.5 * (low + high);
        (stationary_noise_gain(family.make(at(middle))) < wanted ? low : high) = middle;
    }
    return family.make(at(0.5 * (low + high)));
}

// The nearest by ratio: a length is a whole number, and the row noise_gain says what it passes.
Maker end_point_near(int order, double wanted)
{
    int length = order + 1;
    while (stationary_noise_gain(end_point(order, length)) > wanted) {
        length++;
    }
    const double below = stationary_noise_gain(end_point(order, length)) / wanted;
    const double above = stationary_noise_gain(end_point(order, length - 1)) / wanted;
    return end_point(order, above * below < 1.0 ? length - 1 : length);
}

struct Rival {
    std::string name;
    Maker maker;
};

std::vector<Rival> rivals_at(double noise_gain)
{
    std::vector<Rival> result;
    for (const Family &family : families()) {
        result.push_back({ family.name, with_noise_gain(family, noise_gain) });
    }
    result.push_back({ "end_point_1", end_point_near(1, noise_gain) });
    result.push_back({ "end_point_2", end_point_near(2, noise_gain) });
    return result;
}

struct Tally {
    int cells = 0;
    int lost = 0;                                           // the synthesised filter's mean bias^2 is the larger
    int lost_peak = 0;                                      // its largest error is
    double least = std::numeric_limits<double>::infinity(); // its bias^2 by the rival's
    double most = 0.0;
};

void compare(const Exact &ours, const Exact &rival, Tally &tally)
{
    const double ratio = ours.bias2_deg2[turning] / rival.bias2_deg2[turning];
    tally.cells++;
    tally.lost += ratio > 1.0;
    tally.lost_peak += ours.peak_deg > rival.peak_deg;
    tally.least = std::fmin(tally.least, ratio);
    tally.most = std::fmax(tally.most, ratio);
}

void rows(const std::string &experiment, const std::string &name, const Profile &turn, const Exact &value)
{
    row(experiment, name, Arithmetic::in_double, std::string("bias2_") + turn.name, value.bias2_deg2[turning], 1);
    row(experiment, name, Arithmetic::in_double, std::string("peak_") + turn.name, value.peak_deg, 1);
}

std::string named(const char *what, const Pair &level)
{
    char text[60];
    std::snprintf(text, sizeof text, "%s(%g:%.3g)", what, level.a1, level.b0);
    return text;
}

// Lag under a constant acceleration of the two Kalman filters of two states by that of the synthesised one, at equal
// noise gain. Table 1 takes sqrt((1.419 - 0.359) / (0.875 - 0.348)) = 1.418 of it.
void lag_rows()
{
    constexpr std::array<Pair, 6> pairs{
        { { -0.3, 0.1 }, { -0.1, 0.3 }, { 0.0, 0.3 }, { -0.3, 0.5 }, { 0.0, 2.0 / 3.0 }, { -1.0 / 6.0, 11.0 / 13.0 } }
    };
    for (const Pair &pair : pairs) {
        const double noise = reference_closed_noise_gain(pair.a1, pair.b0);
        for (std::size_t i = 0; i < 2; i++) {
            const double lag = stationary_lag(with_noise_gain(families()[i], noise));
            row("equal_noise_lag", named("synth", pair), Arithmetic::in_double, families()[i].name,
                lag / reference_closed_lag(pair.a1, pair.b0), 1);
        }
    }
}
} // namespace

void equal_noise(const Options &)
{
    std::map<std::string, Tally> tallies;
    Progress progress(levels.size());
    for (const Pair &level : levels) {
        const std::string experiment = named("equal_noise", level);
        const double noise = reference_closed_noise_gain(level.a1, level.b0);
        const Maker synth = synthesised(level.a1, level.b0);
        row(experiment, "synth", Arithmetic::in_double, "noise_gain", stationary_noise_gain(synth), 1);
        std::map<std::string, Exact> ours;
        for (const Profile &turn : profiles()) {
            ours[turn.name] = exact(synth, turn, 0.0);
            rows(experiment, "synth", turn, ours[turn.name]);
        }
        for (const Rival &rival : rivals_at(noise)) {
            row(experiment, rival.name, Arithmetic::in_double, "noise_gain", stationary_noise_gain(rival.maker), 1);
            for (const Profile &turn : profiles()) {
                const Exact value = exact(rival.maker, turn, 0.0);
                rows(experiment, rival.name, turn, value);
                compare(ours[turn.name], value, tallies[rival.name]);
            }
        }
        progress.advance();
    }
    lag_rows();
    for (const auto &[name, tally] : tallies) {
        row("equal_noise_all", name, Arithmetic::in_double, "cells", tally.cells, 1);
        row("equal_noise_all", name, Arithmetic::in_double, "synth_loses", tally.lost, 1);
        row("equal_noise_all", name, Arithmetic::in_double, "synth_loses_peak", tally.lost_peak, 1);
        row("equal_noise_all", name, Arithmetic::in_double, "bias2_ratio_least", tally.least, 1);
        row("equal_noise_all", name, Arithmetic::in_double, "bias2_ratio_most", tally.most, 1);
    }
}
} // namespace papers::roll
