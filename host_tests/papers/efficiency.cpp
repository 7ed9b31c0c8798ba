// K_ef: mean square error of the Kalman filter over that of the filter, on the same realisations.
#include "experiments.hpp"
#include "model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace papers
{
namespace
{
constexpr int samples = 400;
constexpr int warm_up_rows = 5;
constexpr std::size_t group = 50; // the paper's N_p

enum Window { steady, transient, transient_late, window_count };
const std::array<const char *, window_count> metric = { "k_ef_steady", "k_ef_transient", "k_ef_transient_6_60" };

struct Scores {
    std::array<std::vector<double>, window_count> square; // per run, summed over the window
    double locked = 0.0;
};

// One filter over one realisation.
void score(const Contestant &c, Realisation &realisation, double back_deg, Scores &scores)
{
    std::array<double, window_count> sum{};
    bool locked = true; // outside for all of the last hundred samples
    c.filter->restart();
    for (int k = 0; k < samples; k++) {
        const Sample &s = realisation.at(k);
        c.filter->tell(s.outlier);
        const double error = c.filter->step(s.y) - s.truth;
        // a filter that has left the world of numbers is as wrong as can be
        const double square = std::isfinite(error) ? std::fmin(error * error, 1e12) : 1e12;
        sum[steady] += (k >= 200) ? square : 0.0;
        sum[transient] += (k < 60) ? square : 0.0;
        sum[transient_late] += (k >= warm_up_rows && k < 60) ? square : 0.0;
        locked = locked && (k < samples - 100 || square >= back_deg * back_deg);
    }
    for (std::size_t w = 0; w < window_count; w++) {
        scores.square[w].push_back(sum[w]);
    }
    scores.locked += locked;
}

std::vector<Scores> scored(const std::vector<Contestant> &all, const Scenario &scenario, const Options &options)
{
    std::vector<Scores> scores(all.size());
    std::vector<double> back_deg;
    for (const Contestant &c : all) {
        back_deg.push_back(4.0 * steady_sigma_deg(c.name));
    }
    for (int run = 0; run < options.runs; run++) {
        Realisation realisation(scenario, run_seed(options.seed, static_cast<std::uint64_t>(run)));
        for (std::size_t i = 0; i < all.size(); i++) {
            score(all[i], realisation, back_deg[i], scores[i]);
        }
    }
    return scores;
}

std::size_t find(const std::vector<Contestant> &all, const std::string &name, Arithmetic arithmetic)
{
    std::size_t i = 0;
    while (i < all.size() && !(all[i].name == name && all[i].arithmetic == arithmetic)) {
        i++;
    }
    return i;
}

// Index of the filter that each is compared with, in the same arithmetic.
std::vector<std::size_t> standards(const std::vector<Contestant> &all, const std::string &name = plain_name)
{
    std::vector<std::size_t> result;
    for (const Contestant &c : all) {
        result.push_back(find(all, name, c.arithmetic));
    }
    return result;
}

void ratio_rows(const std::string &experiment, const std::vector<Contestant> &all, const std::vector<Scores> &scores,
                Window window, const std::string &name, const Options &options)
{
    const std::vector<std::size_t> standard = standards(all);
    std::vector<const std::vector<double> *> above;
    std::vector<const std::vector<double> *> below;
    for (std::size_t i = 0; i < all.size(); i++) {
        above.push_back(&scores[standard[i]].square[window]);
        below.push_back(&scores[i].square[window]);
    }
    const std::vector<Interval> ratios = bootstrap_ratios(above, below, options.seed);
    for (std::size_t i = 0; i < all.size(); i++) {
        if (i != standard[i]) {
            row(experiment, all[i], name, ratios[i], options.runs);
        }
    }
}

// Median over experiments of the paper's size; the interval holds nine in ten of them.
Interval group_ratio(const std::vector<double> &above, const std::vector<double> &below)
{
    std::vector<double> ratios;
    for (std::size_t first = 0; first + group <= above.size(); first += group) {
        double over = 0.0;
        double under = 0.0;
        for (std::size_t run = first; run < first + group; run++) {
            over += above[run];
            under += below[run];
        }
        ratios.push_back(over / under);
    }
    return Interval{ quantile(ratios, 0.5), quantile(ratios, 0.05), quantile(ratios, 0.95) };
}

void group_rows(const std::string &experiment, const std::vector<Contestant> &all, const std::vector<Scores> &scores,
                Window window, const Options &options)
{
    const std::vector<std::size_t> standard = standards(all);
    for (std::size_t i = 0; i < all.size(); i++) {
        if (i != standard[i] && options.runs >= static_cast<int>(group)) {
            row(experiment, all[i], std::string(metric[window]) + "_median_of_50",
                group_ratio(scores[standard[i]].square[window], scores[i].square[window]), options.runs);
        }
    }
}

// Of Table 2, and compared with the PBF there.
bool loses(const std::string &name)
{
    const std::vector<std::string> ours = library_names();
    const std::vector<PrintedCost> printed = printed_costs();
    return name != merged_name && std::find(ours.begin(), ours.end(), name) != ours.end() &&
           std::any_of(printed.begin(), printed.end(), [&](const PrintedCost &line) { return line.name == name; });
}

// Mean square error of the filters over that of the PBF.
void loss_rows(const std::string &experiment, const std::vector<Contestant> &all, const std::vector<Scores> &scores,
               const Options &options)
{
    const std::vector<std::size_t> standard = standards(all, merged_name);
    std::vector<const std::vector<double> *> above;
    std::vector<const std::vector<double> *> below;
    for (std::size_t i = 0; i < all.size(); i++) {
        above.push_back(&scores[i].square[steady]);
        below.push_back(&scores[standard[i]].square[steady]);
    }
    const std::vector<Interval> ratios = bootstrap_ratios(above, below, options.seed);
    for (std::size_t i = 0; i < all.size(); i++) {
        const std::string &name = all[i].name;
        if (loses(name)) {
            row(experiment, all[i], "loss_to_" + merged_name, ratios[i], options.runs);
            if (options.runs >= static_cast<int>(group)) {
                row(experiment, all[i], "loss_to_" + merged_name + "_median_of_50", group_ratio(*above[i], *below[i]),
                    options.runs);
            }
        }
    }
}

void lockout_rows(const std::string &experiment, const std::vector<Contestant> &all, const std::vector<Scores> &scores,
                  const Options &options)
{
    for (std::size_t i = 0; i < all.size(); i++) {
        row(experiment, all[i], "lockout_rate", share(scores[i].locked, options.runs), options.runs);
    }
}

// How far the fixed-point code's K_ef is from the reference's on the same runs.
void agreement_rows(const std::string &experiment, const std::vector<Contestant> &all,
                    const std::vector<Scores> &scores, const Options &options)
{
    for (std::size_t i = 0; i < all.size(); i++) {
        const std::size_t twin = find(all, all[i].name, Arithmetic::in_double);
        if (all[i].arithmetic == Arithmetic::fixed && twin < all.size() && all[i].name != plain_name) {
            const std::vector<std::size_t> s = standards(all);
            const double ours = total(scores[s[i]].square[steady]) / total(scores[i].square[steady]);
            const double theirs = total(scores[s[twin]].square[steady]) / total(scores[twin].square[steady]);
            row(experiment, all[i], "k_ef_steady_by_double", ours / theirs, options.runs);
        }
    }
}

// Everything that is told of a start.
void start_rows(const std::string &experiment, const std::vector<Contestant> &all, const Scenario &scenario,
                const Options &options)
{
    const std::vector<Scores> scores = scored(all, scenario, options);
    for (std::size_t w = 0; w < window_count; w++) {
        ratio_rows(experiment, all, scores, static_cast<Window>(w), metric[w], options);
    }
    group_rows(experiment, all, scores, steady, options);
    group_rows(experiment, all, scores, transient, options);
    loss_rows(experiment, all, scores, options);
    lockout_rows(experiment, all, scores, options);
    agreement_rows(experiment, all, scores, options);
}

std::string fraction(double factor)
{
    char buffer[16];
    std::snprintf(buffer, sizeof buffer, factor < 1.0 ? "1/%g" : "%g", factor < 1.0 ? 1.0 / factor : factor);
    return buffer;
}
} // namespace

void table1_start(const Options &options)
{
    start_rows("table1_start", contestants(reference_names(), { Start::table1 }), Scenario{}, options);
}

void first_sample_clean(const Options &options)
{
    Scenario scenario;
    scenario.first_clean = true;
    start_rows("first_sample_clean", contestants(reference_names(), { Start::table1 }), scenario, options);
}

static void after_warm_up(const std::string &experiment, Start start, const Options &options)
{
    const std::vector<Contestant> all = contestants(reference_names(), { start });
    for (const Contestant &c : all) {
        row(experiment, c, "warm_up_rows",
            c.name.compare(0, published_name.size(), published_name) == 0 ? 0 : warm_up_rows, 1);
    }
    start_rows(experiment, all, Scenario{}, options);
}

void median_start(const Options &options)
{
    after_warm_up("median_start", Start::median, options);
}

void shipped_start(const Options &options)
{
    after_warm_up("shipped_start", Start::shipped, options);
}

void clean_data(const Options &options)
{
    Scenario scenario;
    scenario.outliers = 0.0;
    const std::vector<Contestant> all = contestants(reference_names(), { Start::median });
    const std::vector<Scores> scores = scored(all, scenario, options);
    ratio_rows("clean", all, scores, steady, "clean_efficiency", options);
}

void printed_readings(const Options &options)
{
    std::vector<std::string> names = printed_names();
    names.insert(names.begin(), plain_name);
    std::vector<Contestant> all;
    for (const std::string &name : names) {
        all.push_back(contestant(name, Arithmetic::in_double, { Start::table1 }));
    }
    Scenario clean_start;
    clean_start.first_clean = true;
    for (const bool first_clean : { false, true }) {
        const std::string experiment = first_clean ? "printed_first_sample_clean" : "printed";
        const std::vector<Scores> scores = scored(all, first_clean ? clean_start : Scenario{}, options);
        ratio_rows(experiment, all, scores, steady, metric[steady], options);
        ratio_rows(experiment, all, scores, transient, metric[transient], options);
    }
}

void wrong_r(const Options &options)
{
    const std::array<double, 7> factors = { 1.0 / 16, 0.25, 0.5, 1.0, 2.0, 4.0, 16.0 };
    const std::vector<std::string> names = library_names();
    Scenario scenario;
    scenario.first_clean = true;
    for (const double factor : factors) {
        std::vector<Contestant> all = contestants(names, { Start::table1, factor });
        // the standard is the Kalman filter that knows R
        for (Contestant &c : all) {
            if (c.name == plain_name) {
                c = contestant(plain_name, c.arithmetic, { Start::table1 });
            }
        }
        const std::vector<Scores> scores = scored(all, scenario, options);
        ratio_rows("wrong_r_" + fraction(factor), all, scores, steady, metric[steady], options);
    }
}
} // namespace papers
