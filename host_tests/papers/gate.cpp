// The width of the gate: false alarms, misses, and what it is good for.
#include "experiments.hpp"
#include "model.hpp"

#include <array>
#include <cmath>

namespace papers
{
namespace
{
constexpr int samples = 400;

struct Counts {
    double normal = 0.0;
    double outliers = 0.0;
    double false_alarms = 0.0;
    double misses = 0.0;
    std::vector<double> square;
};

void count(const Contestant &c, Realisation &realisation, Counts &counts)
{
    double sum = 0.0;
    c.filter->restart();
    for (int k = 0; k < samples; k++) {
        const Sample &s = realisation.at(k);
        const double error = c.filter->step(s.y) - s.truth;
        sum += (k >= 200) ? error * error : 0.0;
        if (k >= 100) {
            (s.outlier ? counts.outliers : counts.normal) += 1.0;
            counts.false_alarms += !s.outlier && c.filter->refused();
            counts.misses += s.outlier && !c.filter->refused();
        }
    }
    counts.square.push_back(sum);
}

void rows_of(const std::string &experiment, const std::vector<Contestant> &all, const std::vector<Counts> &counts,
             const Options &options)
{
    std::vector<const std::vector<double> *> above;
    std::vector<const std::vector<double> *> below;
    for (std::size_t i = 0; i < all.size(); i++) {
        above.push_back(&counts[(all[i].arithmetic == Arithmetic::fixed) ? 1 : 0].square); // the Kalman filters lead
        below.push_back(&counts[i].square);
    }
    const std::vector<Interval> ratios = bootstrap_ratios(above, below, options.seed);
    for (std::size_t i = 2; i < all.size(); i++) {
        row(experiment, all[i], "k_ef_steady", ratios[i], options.runs);
        if (all[i].name == gated_name) { // the printed one is locked out too often to tell of its gate
            row(experiment, all[i], "false_alarm", share(counts[i].false_alarms, counts[i].normal), options.runs);
            row(experiment, all[i], "miss", share(counts[i].misses, counts[i].outliers), options.runs);
        }
    }
}
} // namespace

void gate_width(const Options &options)
{
    const std::array<double, 6> widths = { 1.0, 2.0, 2.5, 3.0, 3.5, 4.0 };
    Scenario scenario;
    scenario.first_clean = true;
    for (const double width : widths) {
        std::vector<Contestant> all = contestants({ plain_name }, { Start::table1 });
        for (const std::string &name : { published_name, gated_name }) {
            for (Contestant &c : contestants({ name }, { Start::table1, 1.0, width })) {
                all.push_back(std::move(c));
            }
        }
        std::vector<Counts> counts(all.size());
        for (int run = 0; run < options.runs; run++) {
            Realisation realisation(scenario, run_seed(options.seed + 1, static_cast<std::uint64_t>(run)));
            for (std::size_t i = 0; i < all.size(); i++) {
                count(all[i], realisation, counts[i]);
            }
        }
        char name[32];
        std::snprintf(name, sizeof name, "gate_%g_sigma", width);
        rows_of(name, all, counts, options);
    }
}
} // namespace papers
