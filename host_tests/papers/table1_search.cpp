// Paper 000, Table 1: which roll, noise and gains could have given it? The synthesised filter's row is met exactly, by
// solving for the noise's variance, the roll's amplitude and the error of the start; the Kalman filter's row is then
// what it is.
#include "experiments_000.hpp"
#include "linear.hpp"
#include "roll.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <stdexcept>

namespace papers::roll
{
namespace
{
using Three = std::array<double, 3>;
constexpr std::array<WindowAt, 3> columns{ at_start, turning, settled };
constexpr Three synth_row{ 0.516, 0.875, 0.348 };
constexpr Three kalman_row{ 0.489, 1.419, 0.359 };

// Mean square error over the three columns: r noise + a^2 turn + 2 a e cross + e^2 start.
struct Parts {
    Three noise; // per R: of the estimate's error, or of g - x^
    Three residual;
    std::array<Three, 7> turn; // per profile, amplitude 1 degree
    std::array<Three, 7> cross;
    Three start; // initial error of 1 degree
};

Three over_columns(const std::vector<double> &values)
{
    const PerWindow all = mean_over_windows(values);
    return { all[columns[0]], all[columns[1]], all[columns[2]] };
}

Three product_means(const std::vector<double> &a, const std::vector<double> &b)
{
    std::vector<double> products;
    std::transform(a.begin(), a.end(), b.begin(), std::back_inserter(products), std::multiplies<>());
    return over_columns(products);
}

// of(x0): the filter with its past estimates at x0. It is linear in x0 and in its samples.
Parts parts_of(const std::function<Maker(double)> &of)
{
    Parts parts{};
    const NoiseGain gain = noise_gain(of(0.0), samples);
    parts.noise = over_columns(gain.estimate);
    parts.residual = over_columns(gain.residual);
    const std::vector<double> decay = bias_deg(of(1.0), std::vector<double>(samples, 0.0));
    parts.start = product_means(decay, decay);
    for (std::size_t i = 0; i < profiles().size(); i++) {
        std::vector<double> truth;
        for (int k = 0; k < samples; k++) {
            truth.push_back(profiles()[i].truth_deg(k) / profiles()[i].amplitude_deg);
        }
        const std::vector<double> bias = bias_deg(of(0.0), truth);
        parts.turn[i] = product_means(bias, bias);
        parts.cross[i] = product_means(bias, decay);
    }
    return parts;
}

// What is unknown about the experiment.
struct World {
    double r;
    double amplitude_deg;
    double start_deg;
};

enum Reading { true_error, residual, reading_count };

double mse(const Parts &p, Reading reading, std::size_t turn, const World &w, std::size_t column)
{
    const Three &noise = (reading == true_error) ? p.noise : p.residual;
    return w.r * noise[column] + w.amplitude_deg * w.amplitude_deg * p.turn[turn][column] +
           2.0 * w.amplitude_deg * w.start_deg * p.cross[turn][column] + w.start_deg * w.start_deg * p.start[column];
}

double determinant(const Three &a, const Three &b, const Three &c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// The world in which the synthesised filter has its row: linear in R, a^2, e^2 but for the small mixed term, which is
// put right by repetition. False when that takes a negative square.
bool solve(const Parts &p, Reading reading, std::size_t turn, World &w)
{
    const Three &noise = (reading == true_error) ? p.noise : p.residual;
    w = { 0, 0, 0 };
    for (int i = 0; i < 30; i++) {
        Three right = synth_row;
        for (std::size_t k = 0; k < 3; k++) {
            right[k] -= 2.0 * w.amplitude_deg * w.start_deg * p.cross[turn][k];
        }
        const double whole = determinant(noise, p.turn[turn], p.start);
        const double r = determinant(right, p.turn[turn], p.start) / whole;
        const double amplitude2 = determinant(noise, right, p.start) / whole;
        const double start2 = determinant(noise, p.turn[turn], right) / whole;
        if (!(r > 0.0) || !(amplitude2 >= 0.0) || !(start2 >= 0.0)) {
            return false;
        }
        w = { r, std::sqrt(amplitude2), std::sqrt(start2) };
    }
    for (std::size_t k = 0; k < 3; k++) {
        if (std::fabs(mse(p, reading, turn, w, k) - synth_row[k]) > 1e-6) {
            return false;
        }
    }
    return true;
}

struct Candidate {
    double a1 = 0.0;
    double b0 = 0.0;
    Parts parts{};
};

struct Rival {
    double log_lambda = 0.0;
    double alpha = 0.0;
    Parts parts{};
};

struct Found {
    double off = std::numeric_limits<double>::infinity(); // largest relative difference from the Kalman row
    Three row{};
    World world{};
    std::size_t turn = 0;
    double a1 = 0.0;
    double b0 = 0.0;
    double alpha = 0.0;
};

// The grid inside the printed region.
std::vector<Candidate> candidates()
{
    std::vector<Candidate> result;
    for (int i = 0; i < 20; i++) {
        for (int j = 1; j < 40; j++) {
            const double a1 = -0.05 * i;
            const double b0 = 0.025 * j;
            if (b0 > -a1 - 0.3 + 1e-9) {
                result.push_back({ a1, b0, parts_of([&](double x0) { return synthesised(a1, b0, x0); }) });
            }
        }
    }
    return result;
}

std::vector<Rival> rivals(StateSpace (*model)(double), bool from_start)
{
    constexpr double p0_by_r = p0_deg2 / 0.6;
    std::vector<Rival> result;
    for (int i = -40; i <= 40; i++) {
        const double lambda = std::pow(10.0, 0.1 * i);
        const StateSpace space = model(lambda);
        const auto of = [&](double x0) { return from_start ? kalman(space, p0_by_r, x0) : steady_kalman(space, x0); };
        result.push_back({ 0.1 * i, steady_gains(space)[0], parts_of(of) });
    }
    return result;
}

enum Shape { smooth, steps, any_shape };

struct Limits {
    Shape shape;
    double amplitude_deg;
    double start_deg;
};

// A roll, and a start that P(0) = 5 degree^2 knows to three standard deviations.
constexpr double roll_deg = 90.0;
constexpr double start_known_deg = 6.7;

void look(const Candidate &c, const std::vector<Rival> &all, Reading reading, std::size_t turn, const Limits &limits,
          Found &found)
{
    World world{};
    if (!solve(c.parts, reading, turn, world) || world.amplitude_deg > limits.amplitude_deg ||
        world.start_deg > limits.start_deg) {
        return;
    }
    for (const Rival &rival : all) {
        Three values{};
        double off = 0.0;
        for (std::size_t k = 0; k < 3; k++) {
            values[k] = mse(rival.parts, reading, turn, world, k);
            off = std::fmax(off, std::fabs(values[k] / kalman_row[k] - 1.0));
        }
        if (off < found.off) {
            found = { off, values, world, turn, c.a1, c.b0, rival.alpha };
        }
    }
}

struct Model {
    const char *name;
    StateSpace (*model)(double);
    bool from_start;
    std::vector<Rival> all = {};
};

bool wanted(std::size_t turn, Shape shape)
{
    const bool abrupt = std::string(profiles()[turn].name).rfind("steps", 0) == 0;
    return shape == any_shape || abrupt == (shape == steps);
}

// The closest over all models, gains and turns; names the model.
Found search(const std::vector<Candidate> &ours, const std::vector<Model> &models, Reading reading,
             const Limits &limits, std::string &name)
{
    Found found;
    for (const Model &model : models) {
        const double before = found.off;
        for (const Candidate &c : ours) {
            for (std::size_t turn = 0; turn < profiles().size(); turn++) {
                if (wanted(turn, limits.shape)) {
                    look(c, model.all, reading, turn, limits, found);
                }
            }
        }
        name = (found.off < before) ? model.name : name;
    }
    return found;
}

void found_rows(const std::string &experiment, const std::string &model, const Found &found)
{
    const std::string name = model + "/" + profiles()[found.turn].name;
    const auto one = [&](const std::string &metric, double value) {
        row(experiment, name, Arithmetic::in_double, metric, value, 1);
    };
    for (std::size_t k = 0; k < 3; k++) {
        one(std::string("mse_") + windows[columns[k]].name, found.row[k]);
    }
    one("largest_difference", found.off);
    one("amplitude", found.world.amplitude_deg);
    one("r", found.world.r);
    one("start_error", found.world.start_deg);
    one("a1", found.a1);
    one("b0", found.b0);
    one("kalman_alpha", found.alpha);
}
} // namespace

void table1_search(const Options &)
{
    std::vector<Model> models = { { "kf2_acceleration_steady", white_acceleration, false },
                                  { "kf2_acceleration_from_p0", white_acceleration, true },
                                  { "kf2_rate_steady", white_rate, false },
                                  { "kf2_rate_from_p0", white_rate, true },
                                  { "kf1_walk_steady", random_walk, false },
                                  { "kf1_walk_from_p0", random_walk, true } };
    for (Model &model : models) {
        model.all = rivals(model.model, model.from_start);
    }
    const std::vector<Model> two_states(models.begin(), models.begin() + 4);
    const std::vector<Candidate> ours = candidates();
    struct Trial {
        const char *name;
        const std::vector<Model> &models;
        Reading reading;
        Limits limits;
    };
    const std::vector<Trial> trials = {
        { "table1_smooth", two_states, true_error, { smooth, roll_deg, start_known_deg } },
        { "table1_steps", two_states, true_error, { steps, roll_deg, start_known_deg } },
        { "table1_walk", models, true_error, { any_shape, roll_deg, start_known_deg } },
        { "table1_residual", models, residual, { any_shape, roll_deg, start_known_deg } },
        { "table1_any_start", models, true_error, { any_shape, roll_deg, HUGE_VAL } },
        { "table1_any_roll", models, true_error, { any_shape, HUGE_VAL, HUGE_VAL } },
        { "table1_residual_any_roll", models, residual, { any_shape, HUGE_VAL, HUGE_VAL } },
    };
    Progress progress(static_cast<double>(trials.size()));
    for (const Trial &trial : trials) {
        std::string name;
        const Found found = search(ours, trial.models, trial.reading, trial.limits, name);
        if (!std::isfinite(found.off)) {
            throw std::runtime_error(std::string(trial.name) + ": no world gives the synthesised filter its row");
        }
        found_rows(trial.name, name, found);
        progress.advance();
    }
}
} // namespace papers::roll
