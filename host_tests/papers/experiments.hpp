// The experiments of paper 002. Each prints rows on standard output: see report.hpp.
#ifndef PAPERS_EXPERIMENTS_H
#define PAPERS_EXPERIMENTS_H

#include "filters.hpp"
#include "report.hpp"

#include <string>

namespace papers
{
// As of report.hpp, for a filter with its arithmetic.
void row(const std::string &experiment, const Contestant &c, const std::string &metric, double value, int runs);
void row(const std::string &experiment, const Contestant &c, const std::string &metric, const Interval &value,
         int runs);

// K_ef from a start: of all references, of the printed readings, of the shipped code.
void table1_start(const Options &options);
void first_sample_clean(const Options &options);
void median_start(const Options &options);
void shipped_start(const Options &options);
void clean_data(const Options &options);
void printed_readings(const Options &options);
void wrong_r(const Options &options);

// Gate width.
void gate_width(const Options &options);

// Steps, bursts, lock-out.
void steps_clean(const Options &options);
void steps_with_outliers(const Options &options);
void bursts(const Options &options);
void lockout(const Options &options);

// No chance in them.
void covariance(const Options &options);
void table2(const Options &options);
void steady_gain(const Options &options);
} // namespace papers

#endif
