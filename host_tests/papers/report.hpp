// What every experiment of every paper prints: rows on standard output, for campaigns/papers/papers.py.
#ifndef PAPERS_REPORT_H
#define PAPERS_REPORT_H

#include "statistics.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace papers
{
enum class Arithmetic { in_double, in_float, fixed };

const char *text(Arithmetic arithmetic);

struct Options {
    int runs = 10000;
    std::uint64_t seed = 2024;
};

// `row`, experiment, filter, arithmetic, metric, value, low, high, runs, between tabs; low and high are empty without
// interval.
void row(const std::string &experiment, const std::string &filter, Arithmetic arithmetic, const std::string &metric,
         double value, int runs);
void row(const std::string &experiment, const std::string &filter, Arithmetic arithmetic, const std::string &metric,
         const Interval &value, int runs);

struct Experiment {
    const char *name;
    double work; // relative time, for the progress of all
    void (*run)(const Options &options);
};

// NAME --list | NAME EXPERIMENT [--runs N] [--seed N]: one of the experiments. The program's exit status.
int program(const char *name, const std::vector<Experiment> &experiments, int argc, char **argv);
} // namespace papers

#endif
