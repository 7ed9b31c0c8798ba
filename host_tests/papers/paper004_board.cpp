// paper004_board --list | EXPERIMENT [--runs N] [--seed N]: what of paper 004 runs on the board, the supervisor `auto`
// on tilt streams of sixteen phases, beside the filters that it is to beat.
#include "report.hpp"

extern "C" {
#include "support/filters.h"
#include "support/tilt_phases.h"
}

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>

namespace papers::board
{
namespace
{
const char *const experiment = "board_phases";
const std::vector<std::string> kinds{ "still", "ramp", "sine", "vibration", "drop", "burst", "acceleration", "mixed" };
constexpr int training_runs = 60;
constexpr int fresh_runs = 200;

using Runs = std::vector<tilt_run_t>;
using Values = std::vector<double>;

Runs make(std::uint64_t seed, int count)
{
    Runs runs(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < runs.size(); i++) {
        tilt_run_make(&runs[i], seed + i);
    }
    return runs;
}

struct Parameter {
    std::string name;
    Values grid;
};

// A filter to be tuned: what it makes of a run with these parameters.
struct Subject {
    std::string name;
    Arithmetic arithmetic;
    std::vector<Parameter> parameters;
    std::function<void(const Values &, const tilt_run_t &, tilt_errors_t *, tilt_bank_t *)> judge;
};

// A filter of the list at 10 Hz, with R given and parameters by their names in the descriptor.
filter_t begun(const std::string &name, const std::vector<Parameter> &parameters, const Values &values)
{
    const filter_kind_t kind = filter_find(name.c_str());
    filter_config_t config = filter_defaults(filter_listed(kind), TILT_RATE_DHZ);
    for (std::uint8_t i = 0; i < parameter_count(kind); i++) {
        const filter_parameter_t entry = parameter_at(kind, i);
        if (std::string(entry.words) == "r") {
            config.value[i] = TILT_R_LSB2_Q8;
        }
        for (std::size_t k = 0; k < values.size(); k++) {
            if (parameters[k].name == entry.words) {
                config.value[i] = static_cast<std::int32_t>(std::lround(std::ldexp(values[k], entry.fraction_bits)));
            }
        }
    }
    filter_t f;
    if (filter_init(&f, filter_listed(kind), &config) != FILTER_ACCEPTED) {
        throw std::runtime_error(name + ": refuses the parameters of its grid");
    }
    return f;
}

Subject of_list(const std::string &name, const std::vector<Parameter> &parameters)
{
    return { name, Arithmetic::fixed, parameters,
             [name, parameters](const Values &values, const tilt_run_t &run, tilt_errors_t *errors, tilt_bank_t *bank) {
                 const filter_t f = begun(name, parameters, values);
                 tilt_judge(&f, &run, errors, bank);
             } };
}

Subject guarded_in_double()
{
    return { "sprf_guarded",
             Arithmetic::in_double,
             { { "q", { 5, 10, 15, 20, 30, 50, 75, 100, 200 } },
               { "gate", { 4, 6, 7, 8, 9, 10, 11, 12, 14, 16, 20 } },
               { "restart", { 2, 3, 4, 5, 6, 8 } } },
             [](const Values &v, const tilt_run_t &run, tilt_errors_t *errors, tilt_bank_t *) {
                 const tilt_guarded_t how{ v[0], v[1], static_cast<int>(v[2]) };
                 tilt_judge_guarded(&how, &run, errors);
             } };
}

Subject bayes_in_double()
{
    return { "pbf",
             Arithmetic::in_double,
             { { "q", { 100, 200, 300, 500, 700, 1000, 1500, 2000, 3000, 5000 } },
               { "clean", { 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7 } },
               { "ratio", { 5, 7, 10, 15, 20, 30, 40, 60, 100 } } },
             [](const Values &v, const tilt_run_t &run, tilt_errors_t *errors, tilt_bank_t *) {
                 const tilt_bayes_t how{ v[0], v[1], v[2] };
                 tilt_judge_bayes(&how, &run, errors);
             } };
}

// Values that the library takes: pbf needs a clean sample to be more likely than not.
std::vector<Subject> subjects()
{
    return { of_list("auto", { { "gate", { 3, 4, 5, 6, 7, 8, 10 } },
                               { "slow", { 1400, 2000, 2400, 2800, 3200, 4000, 5600 } },
                               { "middle", { 600, 800, 900, 1100, 1300, 1600, 2000, 2500, 3200 } },
                               { "fast", { 350, 400, 450, 500, 550, 650, 800 } } }),
             of_list("sprf", { { "q", { 2, 5, 10, 20, 40, 80, 150, 300 } },
                               { "gate", { 4, 6, 7, 8, 9, 10, 11, 12, 14, 16 } },
                               { "reacquire", { 3, 5, 9 } } }),
             guarded_in_double(),
             of_list("pbf", { { "q", { 100, 200, 400, 700, 1000, 1500, 2000, 3000, 5000, 10000 } },
                              { "clean", { 0.5, 0.6, 0.7, 0.85 } },
                              { "ratio", { 5, 7, 10, 15, 20, 30, 40, 60 } } }),
             bayes_in_double() };
}

double rms(const Subject &subject, const Values &values, const Runs &runs)
{
    tilt_errors_t errors{};
    for (const tilt_run_t &run : runs) {
        subject.judge(values, run, &errors, nullptr);
    }
    return tilt_rms_of_all(&errors);
}

// The best of all combinations.
Values tuned(const Subject &subject, const Runs &training)
{
    std::vector<std::size_t> at(subject.parameters.size(), 0);
    Values best;
    double least = std::numeric_limits<double>::infinity();
    for (bool more = true; more;) {
        Values values;
        for (std::size_t k = 0; k < at.size(); k++) {
            values.push_back(subject.parameters[k].grid[at[k]]);
        }
        const double found = rms(subject, values, training);
        if (found < least) {
            least = found;
            best = values;
        }
        std::size_t k = 0;
        while (k < at.size() && ++at[k] == subject.parameters[k].grid.size()) {
            at[k++] = 0;
        }
        more = k < at.size();
    }
    return best;
}

void tell_parameters(const Subject &subject, const Values &best)
{
    int edges = 0;
    for (std::size_t k = 0; k < best.size(); k++) {
        const Parameter &p = subject.parameters[k];
        row(experiment, subject.name, subject.arithmetic, "tuned_" + p.name, best[k], training_runs);
        edges += best[k] == p.grid.front() || best[k] == p.grid.back();
    }
    row(experiment, subject.name, subject.arithmetic, "edges", edges, training_runs);
}

struct Judged {
    tilt_errors_t errors{};
    tilt_bank_t bank{};
    Values squares; // mean of each run
};

Judged judged(const Subject &subject, const Values &best, const Runs &fresh)
{
    Judged all;
    for (const tilt_run_t &run : fresh) {
        tilt_errors_t one{};
        subject.judge(best, run, &one, (subject.name == "auto") ? &all.bank : nullptr);
        for (std::uint8_t p = 0; p < PHASES; p++) {
            all.errors.squares[p] += one.squares[p];
            all.errors.counts[p] += one.counts[p];
        }
        const double of_run = tilt_rms_of_all(&one);
        all.squares.push_back(of_run * of_run);
    }
    return all;
}

void tell_errors(const std::string &name, Arithmetic arithmetic, const tilt_errors_t &errors, int runs)
{
    row(experiment, name, arithmetic, "rmse", tilt_rms_of_all(&errors), runs);
    for (std::uint8_t p = 0; p < PHASES; p++) {
        row(experiment, name, arithmetic, "rmse_" + kinds[p], tilt_rms(&errors, p), runs);
    }
}

void tell_bank(const tilt_bank_t &bank, int runs)
{
    const std::vector<std::string> members{ "slow", "middle", "fast" };
    double samples = 0.0;
    for (const double n : bank.chosen) {
        samples += n;
    }
    for (std::size_t m = 0; m < members.size(); m++) {
        tell_errors("auto:" + members[m], Arithmetic::fixed, bank.members[m], runs);
        row(experiment, "auto", Arithmetic::fixed, "chosen_" + members[m], bank.chosen[m] / samples, runs);
    }
    row(experiment, "auto", Arithmetic::fixed, "s_per_change", samples * 10.0 / TILT_RATE_DHZ / bank.changes, runs);
}

Interval root(const Interval &v)
{
    return { std::sqrt(v.value), std::sqrt(v.low), std::sqrt(v.high) };
}

// Each filter tuned by its overall error on 60 runs, over a grid around its optimum, and judged on 200 others: rmse and
// rmse_KIND in degree, the parameters found, edges (how many of them lie at the end of their grid), and for `auto` its
// error over each other's with percentiles of 1,000 resamplings of the runs. At --runs 10000; fewer with fewer.
void phases(const Options &options)
{
    const auto part = [&options](int full) {
        return options.runs >= 1000 ? full : std::max(2, full * options.runs / 10000);
    };
    const Runs training = make(options.seed * 1000U, part(training_runs));
    const Runs fresh = make(options.seed * 1000U + 500U, part(fresh_runs));
    const int runs = static_cast<int>(fresh.size());
    const std::vector<Subject> all = subjects();
    std::vector<Judged> found;
    for (const Subject &subject : all) {
        const Values best = tuned(subject, training);
        tell_parameters(subject, best);
        found.push_back(judged(subject, best, fresh));
        tell_errors(subject.name, subject.arithmetic, found.back().errors, runs);
    }
    tell_bank(found.front().bank, runs);
    std::vector<const Values *> above;
    std::vector<const Values *> below;
    for (std::size_t i = 1; i < found.size(); i++) {
        above.push_back(&found.front().squares);
        below.push_back(&found[i].squares);
    }
    const std::vector<Interval> ratios = bootstrap_ratios(above, below, options.seed);
    for (std::size_t i = 1; i < found.size(); i++) {
        row(experiment, "auto", Arithmetic::fixed, "over_" + all[i].name + "_" + text(all[i].arithmetic),
            root(ratios[i - 1]), runs);
    }
}
} // namespace
} // namespace papers::board

int main(int argc, char **argv)
{
    return papers::program("paper004_board", { { "board_phases", 32, papers::board::phases } }, argc, argv);
}
